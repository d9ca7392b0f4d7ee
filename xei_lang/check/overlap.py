"""`parallel` and `unordered`: branches that all follow the same steps, and that use nothing together."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from xei_lang.check.independence import Use, Uses, uses_of
from xei_lang.check.labels import Labels
from xei_lang.check.nominal import Read, check_reads
from xei_lang.check.paths import names_of_blocks
from xei_lang.check.plan_builder import Where
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import Fact
from xei_lang.syntax.ast import Parallel, Step

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def parallel(expander: Expander, step: Step, node: Parallel, scope: Scope, where: Where) -> None:
    """`parallel { {..} {..} }`: with a label it is one name space, which its branches share."""
    path = where.path(step)
    if step.label is not None:
        where = where.under(f"{path}.", names_of_blocks(node.branches))
    expander.labels.open()
    overlap = Overlap(
        expander, "branches of `parallel`", "do what they share in one branch, or one after the other"
    )
    for number, block in enumerate(node.branches, start=1):
        with overlap.branch():
            expander.block(block, scope, where.in_branch(f"{path}.{number}"))
    overlap.join()
    if step.label is None:
        expander.labels.close()
    else:
        expander.labels.close_named(step.label.id)


_Key = tuple[str, str]


class Overlap:
    """Steps that may overlap: each branch begins where all do, and sees nothing of the others.

    `parts` and `way_out` are words for messages: "branches of `parallel`".
    """

    def __init__(self, expander: Expander, parts: str, way_out: str) -> None:
        self._expander = expander
        self._parts = parts
        self._way_out = way_out
        self._base = expander.state
        self._before = expander.plan.tails
        self._start = len(expander.plan.steps)
        self._states: list[State] = []
        self._reads: list[list[Read]] = []
        self._tails: list[str] = []
        self._ends: list[int] = []
        self._labels: list[Labels] = []
        self._told: set[tuple[str, str]] = set()

    @contextmanager
    def branch(self) -> Generator[None]:
        """While one branch is expanded."""
        expander, plan = self._expander, self._expander.plan
        expander.state, plan.tails = self._base.fork(), self._before
        outer, expander.labels = expander.labels, expander.labels.branch()
        made, asked = len(plan.steps), len(expander.reads)
        expander.overlapping += 1
        yield
        expander.overlapping -= 1
        self._labels.append(expander.labels)
        expander.labels = outer
        self._states.append(expander.state)
        self._reads.append(expander.reads[asked:])
        self._ends.append(len(plan.steps))
        if len(plan.steps) > made:
            self._tails.extend(plan.tails)

    def join(self) -> None:
        """All branches have ended: what follows comes after each, and knows what each has done."""
        expander, plan = self._expander, self._expander.plan
        expander.state = self._base.copy()
        for state in self._states:
            expander.state.adopt(self._base, state)
        plan.tails = tuple(dict.fromkeys(self._tails)) or self._before
        for labels in self._labels:
            expander.labels.join(labels)
        plan.overlaps.append((self._start, len(plan.steps)))
        self._check_uses()
        check_reads(expander, self._reads, self._base, self._states)
        self._forget_what_others_do()

    def _check_uses(self) -> None:
        plan, uses = self._expander.plan, Uses()
        first = self._start
        for number, end in enumerate(self._ends, start=1):
            for step in plan.steps[first:end]:
                for use in uses_of(step, self._expander.context.registry):
                    before = uses.add(number, use)
                    if before is not None and use.thing not in self._told:
                        self._told.add(use.thing)
                        self._report(before, use)
            first = end

    def _report(self, before: Use, use: Use) -> None:
        reporter = self._expander.context.reporter
        same_place = before.span == use.span
        again = f"{use.verb} again" if before.verb == use.verb else _here(use)
        chain = tuple(
            Label(call.span, f"in this call of `{call.procedure}`")
            for call in reversed(use.step.origin)
            if call not in reporter.calls
        )
        first = () if same_place else (Label(before.span, _here(before)),)
        reporter.report(
            "XEI0330",
            f"{use.words} is used in two {self._parts}, which may overlap",
            use.span,
            f"{use.verb} in each of them" if same_place else again,
            labels=first + chain,
            notes=("rule: what may overlap may touch no object, place, named arm or instrument together",),
            help=(self._way_out,),
            about=use.words,
        )

    def _forget_what_others_do(self) -> None:
        """While a branch runs, what another one changes is not known."""
        plan, changes = self._expander.plan, [state.changed for state in self._states]
        count: dict[_Key, int] = {}
        for keys in changes:
            for key in keys:
                count[key] = count.get(key, 0) + 1
        first = self._start
        for keys, end in zip(changes, self._ends, strict=True):
            for index in range(first, end):
                step = plan.steps[index]
                known = tuple(fact for fact in step.state_before if _is_sure(fact, keys, count))
                if len(known) < len(step.state_before):
                    plan.steps[index] = replace(step, state_before=known)
            first = end


def _here(use: Use) -> str:
    return f"{use.verb} here" if use.exclusive else use.verb


def _is_sure(fact: Fact, own: frozenset[_Key], count: dict[_Key, int]) -> bool:
    key = (fact.variable, fact.subject)
    return count.get(key, 0) <= (key in own)
