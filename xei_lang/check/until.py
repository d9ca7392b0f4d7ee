"""`repeat 5 times until od < 0.1 { } else { }`: as many turns as there may be, each under its conditions.

A turn happens if the condition was false after every turn before it; `else` happens if it was false after the
last one, too. The plan has the steps of all turns, so that it is finite and each step says when it happens.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check import choices, loops
from xei_lang.check.budget import TURN
from xei_lang.check.plan_builder import Where
from xei_lang.check.run_time import negated
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.values import POISON, Poison, Undecided
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Condition
from xei_lang.syntax.ast import Expression, Name, Repeat, Step, walk

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def repeat_until(
    expander: Expander, step: Step, loop: Repeat, until: Expression, scope: Scope, where: Where
) -> None:
    """Expand the turns and what happens otherwise; what is known after them is what all ways out share."""
    count = loops.turns_of(expander, loop, scope)
    if count > expander.plan.max_steps and loop.body.statements:
        loops.too_many(expander, loop, f"takes {count} turns")
        return
    if not count:
        expander.skip(loop.body, scope)
        _use_names(until, scope)
    exits: list[tuple[State, Span]] = []
    expander.loops.append(loop.span)
    later = where
    for number in range(1, count + 1):
        before = len(expander.plan.steps)
        names = loops.turn(expander, step, loop, number, POISON, scope=scope, where=later)
        made = frozenset(item.step_id for item in expander.plan.steps[before:])
        value = _ended(expander, until, names, made)
        if value is None or not _affordable(expander, loop, later, before):
            break
        if number < count or loop.otherwise is not None:
            exits.append((expander.state.copy(), choices.end_of(loop.body)))
            later = later.if_so(_false(expander, value, until))
    expander.loops.pop()
    if loop.otherwise is not None and expander.state.ended is None:
        expander.named_block(step, loop.otherwise, scope, later.in_branch(f"{where.path(step)}.else"))
    _join(expander, loop, exits)
    if expander.plan.full and not expander.loops and count > 1:
        loops.too_many(expander, loop, "makes too many steps")


def _ended(
    expander: Expander, until: Expression, names: Scope, turn: frozenset[str]
) -> Undecided | Poison | None:
    """The condition after a turn; None where nothing is left to decide: the run has ended, or no measurement
    decides it, which is reported.
    """
    if expander.state.ended is not None:
        _use_names(until, names)
        return None
    value = choices.condition(expander, until, "`until`", names)
    words = expander.context.words(until.span)
    if isinstance(value, Undecided) and turn.isdisjoint(value.needs):
        expander.context.reporter.report(
            "XEI0354",
            f"`{words}` is the same after every turn",
            until.span,
            f"{' and '.join(f'`{name}`' for name in value.needs)} was measured before the loop",
            notes=("rule: `until` asks for something that the turn has measured",),
            help=("measure again inside of the loop",),
        )
        return None
    if not isinstance(value, bool):
        return value
    expander.context.reporter.report(
        "XEI0354",
        f"`{words}` is {'always' if value else 'never'} true after the first turn",
        until.span,
        f"is {'true' if value else 'false'}, whatever is measured",
        notes=("rule: `until` asks for something that the turn has measured",),
        help=("one turn is enough: leave out `repeat`",)
        if value
        else ("without `until`, every turn happens",),
    )
    return None


def _false(expander: Expander, value: Undecided | Poison, until: Expression) -> Condition:
    if isinstance(value, Undecided):
        return Condition(negated(value).formula, value.needs, until.span)
    return Condition(f"not ({expander.context.words(until.span)})", (), until.span)


def _affordable(expander: Expander, loop: Repeat, where: Where, before: int) -> bool:
    """Each step carries the conditions of all turns before its own, so turns cost more and more."""
    plan, own = expander.plan, len(expander.plan.steps) - before
    if not expander.context.evaluator.budget.spend(TURN + own * len(where.when), loop.span):
        plan.full, plan.overflow = True, plan.overflow or loop.span
    return not plan.full


def _join(expander: Expander, loop: Repeat, exits: list[tuple[State, Span]]) -> None:
    """What all ways out share. The last way is the state as it is now: never true, or `else` has happened."""
    last = choices.end_of(loop.otherwise) if loop.otherwise is not None else choices.end_of(loop.body)
    first: tuple[State, Span] | None = None
    joined: State | None = None
    for state, at in (*exits, (expander.state, last)):
        if first is None and state.ended is None:
            first = (state, at)
        if first is not None and choices.hands_differ(expander, first[0], first[1], state, at):
            continue
        joined = state if joined is None else joined.join(state)
    assert joined is not None
    expander.state = joined


def _use_names(until: Expression, scope: Scope) -> None:
    for node in walk(until):
        if isinstance(node, Name):
            scope.find(node.id)
