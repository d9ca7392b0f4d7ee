"""What a protocol says is so before it begins: `given cap(bottle) == closed`."""

from __future__ import annotations

from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.functions import not_yet
from xei_lang.check.report import Reporter, guess, listed, meant
from xei_lang.check.scope import Scope
from xei_lang.check.state import NOTHING, State
from xei_lang.check.types import Types
from xei_lang.check.values import ObjectValue, PlaceValue, Poison, Val, Word, show, to_plan
from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.syntax.ast import CallExpr, Compare, Expression, Given, GivenContains, Name

_KNOWN = ("holding", "at", "volume")


class Givens:
    """Records what is given as facts of the state."""

    def __init__(self, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter

    def given(self, node: Given, scope: Scope, state: State) -> None:
        """`given variable(subject) == value`."""
        condition = node.condition
        if not (
            isinstance(condition, Compare) and condition.op == "==" and isinstance(condition.left, CallExpr)
        ):
            not_yet(self._reporter, "a `given` other than `given state(object) == value`", condition.span)
            return
        call = condition.left
        if not isinstance(call.function, Name) or len(call.args) != 1:
            not_yet(self._reporter, "a `given` other than `given state(object) == value`", condition.span)
            return
        self._fact(call.function, call.args[0].value, condition.right, scope, state)

    def contains(self, node: GivenContains, scope: Scope, state: State) -> None:
        """`given bottle contains 50 mL of "PBS"`."""
        thing = self._object(node.container, "`contains`", scope, state)
        amount = self._evaluator.value(node.amount, scope)
        amount = self._types.coerce(amount, Expectation("`contains`", "Volume"), node.amount, state)
        content = self._evaluator.value(node.content, scope)
        content = self._types.coerce(content, Expectation("`of`", "String"), node.content, state)
        if node.concentration is not None:
            not_yet(self._reporter, "a given concentration", node.concentration.span)
        if thing is not None and not isinstance(amount, Poison) and isinstance(content, str):
            state.set("contents", thing.name, (content,))
            state.set("volume", thing.name, to_plan(amount))

    def _fact(
        self, variable: Name, subject: Expression, right: Expression, scope: Scope, state: State
    ) -> None:
        what = f"`{variable.id}`"
        if variable.id == "holding":
            self._holding(subject, right, scope, state)
            return
        thing = self._object(subject, what, scope, state)
        if thing is None:
            return
        if variable.id == "at":
            value = self._types.coerce(
                self._evaluator.value(right, scope), Expectation(what, "Place"), right, state
            )
            if isinstance(value, PlaceValue):
                state.set("at", thing.name, value.ref)
        elif variable.id == "volume":
            value = self._types.coerce(
                self._evaluator.value(right, scope), Expectation(what, "Volume"), right, state
            )
            if not isinstance(value, Poison):
                state.set("volume", thing.name, to_plan(value))
        elif thing.registered is not None:
            self._finite(variable, thing, right, scope, state)

    def _holding(self, subject: Expression, right: Expression, scope: Scope, state: State) -> None:
        arm = self._types.coerce(
            self._evaluator.value(subject, scope), Expectation("`holding`", "Arm"), subject, state
        )
        value: Val = self._evaluator.value(right, scope, (NOTHING,))
        if not isinstance(value, Word) or value.text != NOTHING:
            value = self._types.coerce(value, Expectation("what is held", "object"), right, state)
        if isinstance(arm, Word) and isinstance(value, ObjectValue):
            state.set("holding", arm.text, ObjectRef(value.name))
        elif isinstance(arm, Word) and isinstance(value, Word):
            state.set("holding", arm.text, NOTHING)

    def _finite(
        self, variable: Name, thing: ObjectValue, right: Expression, scope: Scope, state: State
    ) -> None:
        assert thing.registered is not None
        declared = next((item for item in thing.registered.states if item.name == variable.id), None)
        if declared is None:
            known = (*_KNOWN, *(item.name for item in thing.registered.states))
            self._reporter.report(
                "XEI0318",
                f"`{thing.name}` has no state `{variable.id}`",
                variable.span,
                f"its states are {listed(known)}",
                notes=(self._reporter.rule(thing.registered.span),),
                help=meant(did_you_mean(variable.id, known)),
                fix=guess(variable.span, did_you_mean(variable.id, known)),
            )
            return
        value = self._evaluator.value(right, scope, declared.values)
        if isinstance(value, Poison):
            return
        if isinstance(value, Word) and value.text in declared.values:
            state.set(variable.id, thing.name, value.text)
            return
        self._reporter.report(
            "XEI0318",
            f"`{variable.id}` of `{thing.name}` cannot be `{show(value)}`",
            right.span,
            f"expected {' or '.join(declared.values)}",
            notes=(self._reporter.rule(declared.span),),
            help=meant(did_you_mean(show(value), declared.values)),
            fix=guess(right.span, did_you_mean(show(value), declared.values)),
        )

    def _object(self, node: Expression, what: str, scope: Scope, state: State) -> ObjectValue | None:
        value = self._types.coerce(
            self._evaluator.value(node, scope), Expectation(what, "object"), node, state
        )
        return value if isinstance(value, ObjectValue) else None
