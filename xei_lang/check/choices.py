"""`if`: decided here and now, or on both branches where an open parameter or a measurement leaves it open."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING

from xei_lang.check.plan_builder import Where
from xei_lang.check.run_time import negated
from xei_lang.check.scope import Scope
from xei_lang.check.state import EITHER, State
from xei_lang.check.value_words import kind, show
from xei_lang.check.values import POISON, Poison, Undecided
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.skill_plan import Condition, ObjectRef, Value
from xei_lang.syntax.ast import Block, Expression, If, Step

if TYPE_CHECKING:
    from xei_lang.check.conditions import Asked
    from xei_lang.check.expand import Expander


def choice(expander: Expander, step: Step, node: If, scope: Scope, where: Where) -> bool:
    """Expand the branch that is taken, or both where that is not known; whether it was reported that the ways
    through it leave different hands.
    """
    value = condition(expander, node.condition, "`if`", scope)
    if isinstance(value, Undecided):
        so = Condition(value.formula, value.needs, node.condition.span)
        not_so = Condition(negated(value).formula, value.needs, node.condition.span)
        return _both(expander, step, node, so, not_so, scope=scope, where=where)
    if value is POISON:
        words, at = expander.context.words(node.condition.span), node.condition.span
        so, not_so = Condition(words, (), at), Condition(f"not ({words})", (), at)
        return _both(expander, step, node, so, not_so, scope=scope, where=where)
    if value:
        expander.named_block(step, node.body, scope, where)
        _skip(expander, node.otherwise, scope)
        return False
    expander.skip(node.body, scope)
    return _otherwise(expander, step, node, scope, where)


def condition(
    expander: Expander, node: Expression, what: str, scope: Scope, asked: Asked | None = None
) -> bool | Undecided | Poison:
    """What a condition is worth; POISON also for what is none, which is reported. With `asked` it may ask for
    states.
    """
    evaluator = expander.context.evaluator
    with evaluator.asking(asked) if asked is not None else nullcontext():
        value = evaluator.value(node, scope)
    if isinstance(value, (bool, Undecided, Poison)):
        return value
    expander.context.reporter.report(
        "XEI0305",
        f"`{show(value)}` is {kind(value)}, but {what} takes a condition",
        node.span,
        f"expected a Bool, found {kind(value)}",
    )
    return POISON


def _both(
    expander: Expander, step: Step, node: If, so: Condition, not_so: Condition, *, scope: Scope, where: Where
) -> bool:
    plan, name = expander.plan, where.path(step)
    before, tails = expander.state.copy(), plan.tails
    expander.named_block(step, node.body, scope, where.in_branch(f"{name}.then").if_so(so))
    after_first, first_tails = expander.state, plan.tails
    expander.state, plan.tails = before, tails
    told = _otherwise(expander, step, node, scope, where.in_branch(f"{name}.else").if_so(not_so))
    if so.needs and not told:
        told = hands_differ(expander, after_first, end_of(node.body), expander.state, _end_of_else(node))
    if told and so.needs and after_first.ended is None:
        expander.state = after_first
    expander.state = after_first.join(expander.state)
    plan.tails = tuple(dict.fromkeys((*first_tails, *plan.tails)))
    return told


def hands_differ(expander: Expander, first: State, at: Span, second: State, other: Span) -> bool:
    """Report two ways to one point that leave different hands; one that ends the run leads nowhere."""
    if first.ended or second.ended or first.hands == second.hands:
        return False
    one, two = _told(first, second), _told(second, first)
    expander.context.reporter.report(
        "XEI0353",
        "what a measurement decides here leaves the hands differently",
        at,
        f"{one} here",
        labels=(Label(other, f"{two} here"),) if other != at else (),
        notes=("rule: whatever is measured, the steps that follow start with the same hands",),
        help=("let both ways pick up and put down the same, or end one of them with `stop`",),
    )
    return True


def _told(state: State, other: State) -> str:
    """What one of two states says of the hands and the other one does not."""
    own = [fact for fact in state.hands if fact not in other.hands]
    texts = [f"{_hand(fact.subject)} {_does(fact.value)}" for fact in own]
    return " and ".join(texts) or "it is not known what each hand holds"


def _hand(subject: str) -> str:
    return "one hand" if subject == EITHER else f"the {subject} hand"


def _does(value: Value) -> str:
    return f"holds `{value.name}`" if isinstance(value, ObjectRef) else "is empty"


def end_of(block: Block) -> Span:
    """The brace that closes a block."""
    return Span(block.span.file, block.span.end - 1, block.span.end)


def _end_of_else(node: If) -> Span:
    """The last brace of what happens otherwise; the condition where nothing does."""
    last = node.otherwise
    while isinstance(last, If) and last.otherwise is not None:
        last = last.otherwise
    if last is None:
        return node.condition.span
    return end_of(last.body if isinstance(last, If) else last)


def _otherwise(expander: Expander, step: Step, node: If, scope: Scope, where: Where) -> bool:
    if isinstance(node.otherwise, If):
        return choice(expander, step, node.otherwise, scope, where)
    if isinstance(node.otherwise, Block):
        expander.named_block(step, node.otherwise, scope, where)
    return False


def _skip(expander: Expander, node: If | Block | None, scope: Scope) -> None:
    while isinstance(node, If):
        expander.skip(node.body, scope)
        node = node.otherwise
    if node is not None:
        expander.skip(node, scope)
