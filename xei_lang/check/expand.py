"""Statements to steps: loops are unrolled, choices taken, procedures inlined, and the state walks along."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from xei_lang.check import (
    choices,
    conditions,
    endings,
    instruments,
    keeps,
    loops,
    meanwhile,
    measure,
    overlap,
)
from xei_lang.check.blank import check_statement_text
from xei_lang.check.context import Context
from xei_lang.check.declarations import declare
from xei_lang.check.labels import Labels
from xei_lang.check.named_work import Begun
from xei_lang.check.nominal import Nominal, Read
from xei_lang.check.paths import label_of, step_names
from xei_lang.check.perform import call_skill, confirm, wait
from xei_lang.check.plan_builder import PlanBuilder, Where
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.unpack import unpack
from xei_lang.check.until import repeat_until
from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import (
    Await,
    Block,
    Call,
    Confirm,
    Do,
    For,
    If,
    Keep,
    Leave,
    Let,
    Measure,
    Member,
    Note,
    Parallel,
    Pause,
    Procedure,
    Repeat,
    Require,
    Start,
    Step,
    Stop,
    StopRun,
    Unmapped,
    Wait,
    walk,
)
from xei_lang.syntax.ast import Name as NameNode

MAX_DEPTH = 40
"""How deep blocks and calls may lie in each other once procedures are inlined."""


class Expander:
    """Walks the statements of a protocol once, in their order, and adds their steps to a plan."""

    def __init__(self, context: Context, plan: PlanBuilder, state: State) -> None:
        self.context = context
        self.plan = plan
        self.state = state
        self.labels = Labels()
        self.loops: list[Span] = []
        self.called: set[Procedure] = set()
        self.running: list[Procedure] = []
        self.overlapping = 0
        self.begun = Begun()
        self.keeping: list[keeps.Kept] = []
        self.told_ends: set[Span] = set()
        self.reads: list[Read] = []
        self.alone = False
        context.evaluator.nominal = Nominal(self)
        self._names: dict[Span, Mapping[Span, str]] = {}
        self.resources: dict[tuple[object, ...], tuple[str, ...]] = {}

    @property
    def stopped(self) -> bool:
        """Whether a bound was reached, which then has been reported; what follows is not looked at."""
        context = self.context
        return self.plan.full or context.evaluator.budget.is_spent or context.reporter.is_full

    def members(self, members: Iterable[Member], scope: Scope, where: Where) -> None:
        """Expand declarations and statements in their order; stops where a bound is reached."""
        budget = self.context.evaluator.budget
        for member in members:
            if self.stopped:
                return
            budget.reached(len(self.plan.steps))
            if self.state.ended is not None:
                endings.pass_over(self, member, scope, where)
            else:
                self._member(member, scope, where)

    def block(self, block: Block, scope: Scope, where: Where) -> Scope:
        """Expand a block in a scope of its own, which is returned."""
        inner = scope.child()
        self.members(block.statements, inner, where.deeper())
        return inner

    def names_of(self, block: Block) -> Mapping[Span, str]:
        """The names of the steps of a block that is a name space."""
        if block.span not in self._names:
            self._names[block.span] = step_names(block.statements)
        return self._names[block.span]

    def skip(self, block: Block, scope: Scope) -> None:
        """Pass over a block that does not happen; what it names counts as used."""
        for node in walk(block):
            if isinstance(node, NameNode):
                scope.find(node.id)

    def _member(self, member: Member, scope: Scope, where: Where) -> None:
        match member:
            case Step():
                self._step(member, scope, where)
            case Let():
                value = self.context.evaluator.value(member.value, scope)
                unpack(member.names, value, scope, self.context.reporter, member.value.span)
            case Note() | Unmapped():
                check_statement_text(member, self.context.reporter)
                self.plan.remark(member, where.origin)
            case Require():
                conditions.require(self, member, scope, where)
            case _:
                declare(self, member, scope, where)

    def _step(self, step: Step, scope: Scope, where: Where) -> None:
        before, label = len(self.plan.steps), label_of(step)
        self._action(step, scope, where)
        if self.keeping:
            keeps.watch(self, step, before)
        if self.state.works and len(self.plan.steps) == before + 1:
            meanwhile.watch(self, self.plan.steps[-1])
        if not step.clauses and label is None:
            return
        found = self.plan.since(before)
        for clause in step.clauses:
            constraints = self.context.clauses.constraint(clause, found, self.labels, scope, self.state)
            self.plan.constraints.extend(constraints)
        if label is not None:
            self.labels.add(label.id, found)

    def _action(  # noqa: PLR0912 one branch for each kind of action
        self, step: Step, scope: Scope, where: Where
    ) -> None:
        action = step.action
        match action:
            case Call():
                call_skill(self, step, action, scope, where)
            case Wait():
                wait(self, step, action, scope, where)
            case Confirm():
                check_statement_text(action, self.context.reporter)
                confirm(self, step, action, where)
            case Do():
                self.named_block(step, action.body, scope, where)
            case For():
                loops.for_loop(self, step, action, scope, where)
            case Repeat(until=until) if until is not None:
                repeat_until(self, step, action, until, scope, where)
            case Repeat():
                loops.repeat(self, step, action, scope, where)
            case Parallel():
                overlap.parallel(self, step, action, scope, where)
            case If():
                choices.choice(self, step, action, scope, where)
            case Start():
                instruments.start(self, step, action, scope, where)
            case Await() | Stop() | Leave():
                instruments.end(self, step, action, where)
            case Pause():
                instruments.pause(self, step, action, scope, where)
            case Measure():
                measure.measure(self, step, action, scope, where)
            case StopRun():
                check_statement_text(action, self.context.reporter)
                endings.stop(self, step, action, where)
            case Keep():
                keeps.keep(self, step, action, scope, where)

    def named_block(self, step: Step, block: Block, scope: Scope, where: Where) -> None:
        """Expand the block of a step that happens once; with a label it is a name space."""
        self.labels.open()
        if step.label is None:
            self.block(block, scope, where)
            self.labels.close()
        else:
            self.block(block, scope, where.under(f"{where.path(step)}.", self.names_of(block)))
            self.labels.close_named(step.label.id)
