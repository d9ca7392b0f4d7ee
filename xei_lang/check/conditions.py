"""`require`: a condition that is proved or refuted from what is known here, or else left for the run.

Known is what skills set (`holding`, `at`, the finite states of objects). Volumes and other amounts change in
ways that only state checking follows, so a condition on them is always left for the run; so is any condition
on the state in a branch that may overlap with others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from xei_lang.check.choices import condition
from xei_lang.check.expectation import Expectation
from xei_lang.check.names import ANY_WORD
from xei_lang.check.plan_builder import Where
from xei_lang.check.report import listed, meant
from xei_lang.check.run_time import needs_of
from xei_lang.check.scope import Scope
from xei_lang.check.state import NOTHING
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, ObjectValue, PlaceValue, Undecided, Val, Word
from xei_lang.diagnostics import Label, did_you_mean
from xei_lang.ir.skill_plan import Argument, ObjectRef, PlaceRef, Value
from xei_lang.syntax.ast import CallExpr, Name, Require

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander

_AMOUNTS = ("volume", "temperature", "contents", "age", "upright")


def require(expander: Expander, node: Require, scope: Scope, where: Where) -> None:
    """Nothing where the condition is proved, an error where it is refuted, else a step of kind `require`."""
    context = expander.context
    words = context.words(node.condition.span)
    asked = Asked(expander)
    value = condition(expander, node.condition, "`require`", scope, asked)
    if not isinstance(value, bool):
        told = value.formula if isinstance(value, Undecided) else words
        text = Argument("condition", told, "String", "call", node.condition.span)
        facts = expander.state.facts()
        expander.plan.add(node, "require", where, facts, args=(text,), needs=needs_of(value))
    elif not value:
        context.reporter.report(
            "XEI0331",
            f"`{words}` does not hold here",
            node.condition.span,
            "required, and known to be false",
            labels=tuple(asked.found),
            help=("change it by a step before this one, or leave the requirement out",),
        )


class Asked:
    """Answers what a condition asks of the state, and keeps the answers as labels."""

    def __init__(self, expander: Expander) -> None:
        self._expander = expander
        self.found: list[Label] = []

    def words(self, node: CallExpr, evaluate: Callable[[], Val]) -> tuple[str, ...]:
        """The words that a state, which is compared, may be: `closed`, `open`; `nothing` for what is held."""
        if (
            not isinstance(node.function, Name)
            or len(node.args) != 1
            or node.function.id in ("at", *_AMOUNTS)
        ):
            return ()
        if node.function.id == "holding":
            return (NOTHING,)
        thing = evaluate()
        registered = thing.registered if isinstance(thing, ObjectValue) else None
        states = registered.states if registered is not None else ()
        return next((state.values for state in states if state.name == node.function.id), ANY_WORD)

    def value(self, function: Name, node: CallExpr, subject: Val) -> Val:
        """The state that is asked for; POISON where it is not known here, or asked for wrongly."""
        context, state = self._expander.context, self._expander.state
        if len(node.args) != 1:
            context.reporter.report("XEI0319", f"`{function.id}` takes one argument", node.span)
            return POISON
        arms = function.id == "holding"
        expected = Expectation(f"`{function.id}`", "Arm" if arms else "object")
        subject = context.types.coerce(subject, expected, node.args[0].value, state)
        named = function.id not in ("at", *_AMOUNTS)
        if isinstance(subject, ObjectValue) and named and not self._has_state(function, subject):
            return POISON
        name = subject.name if isinstance(subject, ObjectValue) else show(subject)
        unsure = subject is POISON or function.id in _AMOUNTS or self._expander.overlapping > 0
        known = None if unsure else state.get(function.id, name)
        value = self._as_value(known)
        if value is not POISON:
            self.found.append(Label(node.span, f"is `{show(value)}` here"))
        return value

    def _has_state(self, function: Name, thing: ObjectValue) -> bool:
        if thing.registered is None:
            return False
        states = tuple(state.name for state in thing.registered.states)
        if function.id in states:
            return True
        reporter = self._expander.context.reporter
        reporter.report(
            "XEI0318",
            f"`{thing.name}` has no state `{function.id}`",
            function.span,
            f"its states are {listed(('at', 'volume', *states))}",
            notes=(reporter.rule(thing.registered.span),),
            help=meant(did_you_mean(function.id, states)),
        )
        return False

    def _as_value(self, known: Value | None) -> Val:
        objects = self._expander.context.registry.objects
        match known:
            case ObjectRef(name=name) if name in objects:
                return ObjectValue(name, objects[name])
            case PlaceRef() if known.object in objects:
                return PlaceValue(ObjectValue(known.object, objects[known.object]), known.kind, known.key)
            case str():
                return Word(known)
            case _:
                return POISON
