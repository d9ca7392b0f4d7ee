"""`if`: decided here and now, or on both branches where an open parameter leaves it open."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.plan_builder import Where
from xei_lang.check.scope import Scope
from xei_lang.check.values import POISON, kind, show
from xei_lang.ir.skill_plan import Condition
from xei_lang.syntax.ast import Block, If, Step

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def choice(expander: Expander, step: Step, node: If, scope: Scope, where: Where) -> None:
    """Expand the branch that is taken, or both where that is not known."""
    value = expander.context.evaluator.value(node.condition, scope)
    if value is not POISON and not isinstance(value, bool):
        expander.context.reporter.report(
            "XEI0305",
            f"`{show(value)}` is {kind(value)}, but `if` takes a condition",
            node.condition.span,
            f"expected a Bool, found {kind(value)}",
        )
        value = POISON
    if value is POISON:
        _both(expander, step, node, scope, where)
    elif value:
        expander.named_block(step, node.body, scope, where)
        _skip(expander, node.otherwise, scope)
    else:
        expander.skip(node.body, scope)
        _otherwise(expander, step, node, scope, where)


def _both(expander: Expander, step: Step, node: If, scope: Scope, where: Where) -> None:
    plan, words, at = expander.plan, expander.context.words(node.condition.span), node.condition.span
    name, so = where.path(step), Condition(words, (), at)
    before, tails = expander.state.copy(), plan.tails
    expander.named_block(step, node.body, scope, where.in_branch(f"{name}.then").if_so(so))
    after_first, first_tails = expander.state, plan.tails
    expander.state, plan.tails = before, tails
    _otherwise(
        expander,
        step,
        node,
        scope,
        where.in_branch(f"{name}.else").if_so(Condition(f"not ({words})", (), at)),
    )
    expander.state = after_first.join(expander.state)
    plan.tails = tuple(dict.fromkeys((*first_tails, *plan.tails)))


def _otherwise(expander: Expander, step: Step, node: If, scope: Scope, where: Where) -> None:
    if isinstance(node.otherwise, If):
        choice(expander, step, node.otherwise, scope, where)
    elif isinstance(node.otherwise, Block):
        expander.named_block(step, node.otherwise, scope, where)


def _skip(expander: Expander, node: If | Block | None, scope: Scope) -> None:
    while isinstance(node, If):
        expander.skip(node.body, scope)
        node = node.otherwise
    if node is not None:
        expander.skip(node, scope)
