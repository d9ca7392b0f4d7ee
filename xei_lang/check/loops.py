"""Loops, unrolled up to a bound that is known before the loop is."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

from xei_lang.check.budget import TURN
from xei_lang.check.overlap import Overlap
from xei_lang.check.plan_builder import Where
from xei_lang.check.run_time import known_now
from xei_lang.check.scope import Scope
from xei_lang.check.unpack import unpack
from xei_lang.check.value_words import kind, show
from xei_lang.check.values import POISON, Val, nominal
from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import Call, CallExpr, For, If, Let, Name, Repeat, Step, walk

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


_UNORDERED = ("turns of an `unordered` loop", "leave out `unordered`, and the turns follow each other")


def for_loop(expander: Expander, step: Step, loop: For, scope: Scope, where: Where) -> None:
    """`for a, b in list { }`: one turn for each member."""
    context = expander.context
    value = context.evaluator.value(loop.iterable, scope)
    items = context.evaluator.lists.members(value, loop.iterable)
    if items is None:
        items = (POISON,)
    _turns(expander, step, loop, items, scope=scope, where=where)


def repeat(expander: Expander, step: Step, loop: Repeat, scope: Scope, where: Where) -> None:
    """`repeat 3 times { }`."""
    _turns(expander, step, loop, range(1, turns_of(expander, loop, scope) + 1), scope=scope, where=where)


def turns_of(expander: Expander, loop: Repeat, scope: Scope) -> int:
    """How many turns a `repeat` may take; 1 where its number is wrong, which is reported, or open."""
    context = expander.context
    value = context.evaluator.value(loop.count, scope)
    count = nominal(known_now(value, "the number of turns", loop.count.span, context.reporter))
    if count is POISON:
        return 1
    if isinstance(count, int) and not isinstance(count, bool) and count >= 0:
        return count
    is_number = isinstance(count, int)
    context.reporter.report(
        "XEI0317",
        f"`{show(count)}` is no number of turns",
        loop.count.span,
        "expected 0 or more" if is_number else f"expected a whole number, found {kind(count)}",
    )
    return 1


def _turns(
    expander: Expander, step: Step, loop: For | Repeat, items: Sequence[Val], *, scope: Scope, where: Where
) -> None:
    plan, count = expander.plan, len(items)
    if count > plan.max_steps and loop.body.statements:
        too_many(expander, loop, f"takes {count} turns")
        return
    if not count:
        expander.skip(loop.body, scope)
    overlap = Overlap(expander, *_UNORDERED) if isinstance(loop, For) and loop.unordered else None
    expander.loops.append(loop.span)
    start = len(plan.steps)
    for number, item in enumerate(items, start=1):
        if not expander.context.evaluator.budget.spend(TURN, loop.span):
            plan.full, plan.overflow = True, plan.overflow or loop.span
            break
        with overlap.branch() if overlap else nullcontext():
            turn(expander, step, loop, number, item, scope=scope, where=where)
        made = len(plan.steps) - start
        if number == 1 and start + made * count > plan.max_steps and is_regular(expander, loop):
            plan.full = True
            too_many(expander, loop, f"makes {made * count} steps")
        if plan.full:
            break
    expander.loops.pop()
    if overlap is not None:
        overlap.join()
    if plan.full and not expander.loops and count > 1:
        too_many(expander, loop, "makes too many steps")


def turn(
    expander: Expander, step: Step, loop: For | Repeat, number: int, item: Val, *, scope: Scope, where: Where
) -> Scope:
    """Expand one turn, which has its own names; they are returned."""
    inner = scope.child()
    if isinstance(loop, For):
        unpack(loop.names, item, inner, expander.context.reporter)
    expander.labels.open()
    if step.label is None:
        names = expander.block(loop.body, inner, where.in_turn(number))
        expander.labels.close(number)
        return names
    before = len(expander.plan.steps)
    prefix = f"{where.path(step)}[{number}]."
    names = expander.block(loop.body, inner, where.under(prefix, expander.names_of(loop.body), number))
    expander.labels.close_named(step.label.id, f"[{number}]")
    expander.labels.add(step.label.id, expander.plan.since(before), f"[{number}]")
    return names


def too_many(expander: Expander, loop: For | Repeat, what: str) -> None:
    """One report for one expansion: the first loop that is seen to be too much is the one to name."""
    plan, reporter = expander.plan, expander.context.reporter
    if plan.overflow is not None:
        return
    head = Span(loop.span.file, loop.span.start, loop.body.span.start)
    shown = " ".join(expander.context.words(head).split())
    head = Span(head.file, head.start, head.start + len(expander.context.words(head).rstrip()))
    plan.full, plan.overflow = True, head
    reporter.report(
        "XEI0316",
        f"`{shown}` {what}",
        head,
        f"a plan may have {plan.max_steps} steps",
        help=("do fewer turns, or divide the work into several protocols",),
    )


def is_regular(expander: Expander, loop: For | Repeat) -> bool:
    """Whether each turn makes as many steps as the first: nothing in the body counts by the turn."""
    names: set[str] = {name.id for name in loop.names} if isinstance(loop, For) else set()
    nodes = list(walk(loop.body))
    names |= {name.id for node in nodes if isinstance(node, Let) for name in node.names}
    for node in nodes:
        if (
            isinstance(node, If)
            or _asks(node)
            or (isinstance(node, Call) and expander.context.procedure(node.callee))
        ):
            return False
        head = node.iterable if isinstance(node, For) else node.count if isinstance(node, Repeat) else None
        if head is not None and any(isinstance(part, Name) and part.id in names for part in walk(head)):
            return False
    return True


def _asks(node: object) -> bool:
    """Whether it asks for a volume, which may be such that there is nothing to do in some turns."""
    return isinstance(node, CallExpr) and isinstance(node.function, Name) and node.function.id == "volume"
