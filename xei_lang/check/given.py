"""What a protocol says is so before it begins: `given cap(bottle) == closed`."""

from __future__ import annotations

from typing import TypeGuard

from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.report import Reporter, guess, listed, meant, replace
from xei_lang.check.scope import Scope
from xei_lang.check.state import NOTHING, State
from xei_lang.check.types import Types
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, ObjectValue, Poison, Val, Word, nominal, to_plan
from xei_lang.check.volumes import WRONG, Amount
from xei_lang.diagnostics import Label, Span, did_you_mean
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.profiles.model import FiniteState
from xei_lang.quantity import Quantity
from xei_lang.syntax.ast import BoolOp, CallExpr, Compare, Expression, Given, GivenContains, Name

_TYPES = {
    "at": "Place",
    "volume": "Volume",
    "temperature": "Temperature",
    "age": "Time",
    "contents": "String",
}
_KNOWN = ("holding", *_TYPES)


class Givens:
    """Records what is given as facts of the state."""

    def __init__(self, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter
        self._said: dict[tuple[str, str], Span] = {}

    def given(self, node: Given, scope: Scope, state: State) -> None:
        """`given variable(subject) == value`, or several of them joined by `and`."""
        self._condition(node.condition, scope, state)

    def contains(self, node: GivenContains, scope: Scope, state: State) -> None:
        """`given bottle contains 50 mL of "PBS"`, `given bottle contains 1 mL of "NaCl" at 1 mM`."""
        thing = self._object(node.container, "`contains`", scope, state)
        amount = self._value(node.amount, "`contains`", "Volume", scope, state)
        content = self._content(node.content, scope, state)
        strength = None
        if node.concentration is not None:
            strength = self._value(node.concentration, "`at`", "Concentration", scope, state)
        if thing is None:
            return
        if isinstance(content, str) and self._is_new("contents", thing.name, node.span):
            known = isinstance(strength, (Quantity, Interval))
            state.set("contents", thing.name, ((content, to_plan(strength)) if known else content,))
        self._volume(thing, amount, node.amount, node.span, state)

    def _condition(self, node: Expression, scope: Scope, state: State) -> None:
        if isinstance(node, BoolOp) and node.op == "and":
            self._condition(node.left, scope, state)
            self._condition(node.right, scope, state)
        elif isinstance(node, Compare) and node.op == "==" and _is_state(node.left):
            self._fact(node.left, node.right, node.span, scope, state)
        else:
            self._no_fact(node)

    def _no_fact(self, node: Expression) -> None:
        """Report what may well be true, but is no value of a state."""
        help = "write it as `given state(object) == value`"
        if isinstance(node, Compare) and node.op == "==" and _is_state(node.right):
            label = "the state stands on the left"
        elif isinstance(node, Compare) and _is_state(node.left):
            label = f"expected `==`, found `{node.op}`"
            help = "give the one value that it nominally has, as `given volume(bottle) == 50 mL`"
        elif isinstance(node, BoolOp):
            label = "one of two, and it is not said which"
        elif _is_state(node):
            label = "expected `== value` after it"
        else:
            label = "expected the state of an object"
        self._reporter.report(
            "XEI0325", "this `given` does not say what a state is", node.span, label, help=(help,)
        )

    def _fact(self, call: CallExpr, right: Expression, span: Span, scope: Scope, state: State) -> None:
        assert isinstance(call.function, Name)
        variable, subject = call.function, call.args[0].value
        what = f"`{variable.id}`"
        if variable.id == "holding":
            self._holding(subject, right, span, scope, state)
            return
        thing = self._object(subject, what, scope, state)
        if thing is None:
            return
        declared = _declared(thing, variable.id)
        if variable.id not in _TYPES or declared is not None:
            self._finite(variable, thing, right, span, scope, state)
            return
        value = self._value(right, what, _TYPES[variable.id], scope, state)
        if variable.id == "volume":
            self._volume(thing, value, right, span, state)
        elif not isinstance(value, Poison) and self._is_new(variable.id, thing.name, span):
            made = (to_plan(value),) if variable.id == "contents" else to_plan(value)
            state.set(variable.id, thing.name, made)

    def _volume(self, thing: ObjectValue, value: Val, node: Expression, span: Span, state: State) -> None:
        low = value.lower if isinstance(value, Interval) else value
        if isinstance(low, Quantity) and low.value < 0:
            message = f"`{thing.name}` cannot hold {show(value)}, less than nothing"
            self._reporter.report("XEI0323", message, node.span, f"this is {show(value)}")
            state.set_volume(thing.name, WRONG)
        elif not isinstance(value, (Quantity, Interval)):
            state.set_volume(thing.name, WRONG)
        elif self._is_new("volume", thing.name, span):
            label = Label(node.span, f"`{thing.name}` holds {show(nominal(value))} to begin with")
            state.set_volume(thing.name, Amount(value, (label,)))

    def _holding(
        self, subject: Expression, right: Expression, span: Span, scope: Scope, state: State
    ) -> None:
        arm = self._value(subject, "`holding`", "Arm", scope, state)
        value: Val = self._evaluator.value(right, scope, (NOTHING,))
        if not isinstance(value, Word) or value.text != NOTHING:
            value = self._types.coerce(value, Expectation("what is held", "object"), right, state)
        if not isinstance(arm, Word) or not isinstance(value, (ObjectValue, Word)):
            return
        if self._is_new("holding", arm.text, span):
            held = ObjectRef(value.name) if isinstance(value, ObjectValue) else NOTHING
            state.set("holding", arm.text, held)

    def _finite(
        self, variable: Name, thing: ObjectValue, right: Expression, span: Span, scope: Scope, state: State
    ) -> None:
        if thing.registered is None:
            return
        declared = _declared(thing, variable.id)
        if declared is None:
            known = (*_KNOWN, *(item.name for item in thing.registered.states))
            self._reporter.report(
                "XEI0318",
                f"`{thing.name}` has no state `{variable.id}`",
                variable.span,
                f"its states are {listed(known, 12)}",
                notes=(self._reporter.rule(thing.registered.span),),
                help=meant(did_you_mean(variable.id, known)),
                fix=guess(variable.span, did_you_mean(variable.id, known)),
            )
            return
        value = self._evaluator.value(right, scope, declared.values)
        if isinstance(value, Poison):
            return
        if isinstance(value, Word) and value.text in declared.values:
            if self._is_new(variable.id, thing.name, span):
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

    def _is_new(self, variable: str, subject: str, span: Span) -> bool:
        before = self._said.setdefault((variable, subject), span)
        if before != span:
            self._reporter.report(
                "XEI0325",
                f"`{variable}({subject})` is given twice",
                span,
                "given again here",
                labels=(Label(before, "first given here"),),
                help=("keep one of the two",),
            )
        return before == span

    def _content(self, node: Expression, scope: Scope, state: State) -> Val:
        if isinstance(node, Name) and scope.find(node.id) is None:
            quoted = f'"{node.id}"'
            self._reporter.report(
                "XEI0202",
                f"`{node.id}` is not known here",
                node.span,
                "expected the name of a liquid, in quotes",
                help=(f"write `{quoted}`",),
                fix=replace(node.span, quoted),
            )
            return POISON
        return self._value(node, "`of`", "String", scope, state)

    def _value(self, node: Expression, what: str, type: str, scope: Scope, state: State) -> Val:
        return self._types.coerce(self._evaluator.value(node, scope), Expectation(what, type), node, state)

    def _object(self, node: Expression, what: str, scope: Scope, state: State) -> ObjectValue | None:
        value = self._value(node, what, "object", scope, state)
        return value if isinstance(value, ObjectValue) else None


def _is_state(node: Expression) -> TypeGuard[CallExpr]:
    return isinstance(node, CallExpr) and isinstance(node.function, Name) and len(node.args) == 1


def _declared(thing: ObjectValue, name: str) -> FiniteState | None:
    states = thing.registered.states if thing.registered is not None else ()
    return next((item for item in states if item.name == name), None)
