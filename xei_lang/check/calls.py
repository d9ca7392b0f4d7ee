"""A call against the skill bank: its skill and owner, every argument's type, unit, range and roles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.check import arithmetic
from xei_lang.check.amounts import Amounts, in_range, is_less_than_nothing, is_nothing
from xei_lang.check.arguments import Signature, match_arguments
from xei_lang.check.callees import Callees
from xei_lang.check.effects import Effect, effects_of, moves
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.names import ANY_WORD
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.transfers import Transfer, transfers_of
from xei_lang.check.types import ANY_ARM, Types
from xei_lang.check.units import Unit
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, ObjectValue, PlaceValue, Val, Word, to_plan
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Argument, Value
from xei_lang.profiles.model import ArgSpec, SkillSpec
from xei_lang.quantity import Quantity, QuantityError, parse_quantity
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Arg, Call, Expression
from xei_lang.world.places import accepting, accepts, place_text


@record
class CheckedCall(Shown):
    """A call that holds: its skill, its effects, and its arguments in the skill's order."""

    skill: SkillSpec
    effects: tuple[Effect, ...]
    transfers: tuple[Transfer, ...]
    given: Mapping[str, Val | None]
    arguments: tuple[Argument, ...]
    span: Span

    @property
    def moves_nothing(self) -> bool:
        """Whether it is a transfer of nothing at all, which need not happen."""
        if not self.transfers:
            return False
        amounts = (transfer.amount for transfer in self.transfers)
        return all(name is not None and is_nothing(self.given.get(name)) for name in amounts)

    @property
    def values(self) -> dict[str, Value]:
        """The arguments' values by name."""
        return {argument.name: argument.value for argument in self.arguments}


@record
class _Formal(Shown):
    spec: ArgSpec
    expected: Expectation
    is_amount: bool


@record
class _Prepared(Shown):
    skill: SkillSpec
    signature: Signature
    formals: tuple[_Formal, ...]
    effects: tuple[Effect, ...]
    transfers: tuple[Transfer, ...]


class Calls:
    """Checks calls of skills; the contracts are prepared once.

    `units` are the files, each with the procedures that can be called in it, too; where an import could
    not be read there may be more of them than are known.
    """

    def __init__(
        self,
        registry: Registry,
        evaluator: Evaluator,
        types: Types,
        reporter: Reporter,
        units: Mapping[str, Unit],
    ) -> None:
        self._registry = registry
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter
        self._callees = Callees(registry, reporter, units)
        self._amounts = Amounts(evaluator, types, reporter)
        self._prepared: dict[str, _Prepared] = {}

    def check(self, call: Call, scope: Scope, state: State) -> CheckedCall | None:
        """The call with its arguments as they are at this point of the plan; None where it does not hold."""
        skill = self._callees.skill(call)
        if skill is None:
            self._look_at_arguments(call, scope)
            return None
        prepared = self._prepare(skill)
        given = match_arguments(call, prepared.signature, self._reporter)
        if given is None:
            self._look_at_arguments(call, scope)
            return None
        values = {
            formal.spec.name: self._argument(given.get(formal.spec.name), formal, scope, state)
            for formal in prepared.formals
        }
        if not self._slots_accept(prepared, given, values):
            return None
        found = tuple(_planned(spec, value, given) for spec, value in _present(prepared, values))
        return CheckedCall(skill, prepared.effects, prepared.transfers, values, found, call.callee.span)

    def _look_at_arguments(self, call: Call, scope: Scope) -> None:
        """Evaluate the arguments of a call that cannot be checked, for the mistakes in themselves."""
        for arg in call.args:
            self._evaluator.value(arg.value, scope, ANY_WORD)

    def _prepare(self, skill: SkillSpec) -> _Prepared:
        prepared = self._prepared.get(skill.name)
        if prepared is None:
            signature = Signature(
                "skill",
                skill.name,
                tuple(spec.name for spec in skill.args),
                tuple(spec.name for spec in skill.args if spec.required),
                skill.span,
            )
            transfers = transfers_of(skill)
            amounts = {transfer.amount for transfer in transfers}
            formals = tuple(
                _Formal(spec, expectation(spec, skill.name), spec.name in amounts) for spec in skill.args
            )
            prepared = _Prepared(skill, signature, formals, effects_of(skill), transfers)
            self._prepared[skill.name] = prepared
        return prepared

    def _argument(self, given: Arg | None, formal: _Formal, scope: Scope, state: State) -> Val | None:
        """The checked value of one argument; None for one that neither the call nor the skill bank gives."""
        spec, expected = formal.spec, formal.expected
        if given is None:
            return default_of(spec, self._registry)
        words = (
            (*self._registry.arms, ANY_ARM)
            if spec.type == "Arm"
            else spec.choices
            if spec.type == "choice"
            else ()
        )
        value = self._evaluator.value(given.value, scope, words)
        value = self._types.coerce(value, expected, given.value, state)
        if (
            isinstance(value, PlaceValue)
            and spec.type == "Place"
            and spec.choices
            and value.kind not in spec.choices
        ):
            return self._wrong_kind_of_place(value, spec, expected, given.value)
        if formal.is_amount and is_nothing(value):
            return value
        if is_less_than_nothing(value, spec):
            self._amounts.less_than_nothing(value, expected, given.value, scope, state)
            return POISON
        return in_range(value, spec, expected, given.value, self._reporter)

    def _wrong_kind_of_place(
        self, value: PlaceValue, spec: ArgSpec, expected: Expectation, node: Expression
    ) -> Val:
        wanted = " or ".join(f"a {choice}" for choice in spec.choices)
        self._reporter.report(
            "XEI0305",
            f"`{show(value)}` is a {value.kind}, but {expected.what} takes {wanted}",
            node.span,
            f"expected {wanted}, found a {value.kind}",
            notes=(self._reporter.rule(spec.span),),
        )
        return POISON

    def _slots_accept(
        self, prepared: _Prepared, given: Mapping[str, Arg], values: Mapping[str, Val | None]
    ) -> bool:
        """Whether each slot takes the object that the skill brings there."""
        for moved, target in moves(prepared.effects):
            thing, place = values.get(moved), values.get(target)
            if not isinstance(thing, ObjectValue) or not isinstance(place, PlaceValue) or target not in given:
                continue
            owner = place.owner.registered
            if owner is None or thing.registered is None:
                continue
            if not accepts(owner, place.ref, thing.registered.roles):
                self._refused(thing, place, given[target])
                return False
        return True

    def _refused(self, thing: ObjectValue, place: PlaceValue, arg: Arg) -> None:
        assert thing.registered is not None
        assert place.owner.registered is not None
        stated = accepting(place.owner.registered, place.ref)
        self._reporter.report(
            "XEI0310",
            f"`{place_text(place.ref)}` does not accept `{thing.name}`",
            arg.value.span,
            f"accepts {listed(stated.accepts if stated else ())}; "
            f"`{thing.name}` has the roles {', '.join(thing.registered.roles)}",
            notes=(self._reporter.rule(stated.span),) if stated else (),
        )


def _present(prepared: _Prepared, values: Mapping[str, Val | None]) -> Iterator[tuple[ArgSpec, Val]]:
    for formal in prepared.formals:
        value = values[formal.spec.name]
        if value is not None:
            yield formal.spec, value


def _planned(spec: ArgSpec, value: Val, given: Mapping[str, Arg]) -> Argument:
    arg = given.get(spec.name)
    planned = _typed(value, spec)
    if arg is None:
        return Argument(spec.name, planned, spec.type, "default", spec.span)
    return Argument(spec.name, planned, spec.type, "call", arg.span)


def _typed(value: Val, spec: ArgSpec) -> Value:
    planned = to_plan(value)
    return float(planned) if spec.type == "Float" and isinstance(planned, int) else planned


def expectation(spec: ArgSpec, skill: str) -> Expectation:
    """What an argument of a skill takes, and why."""
    what = f"`{spec.name}` of `{skill}`"
    inner, lists = spec.type, 0
    while inner.startswith("List[") and inner.endswith("]"):
        inner, lists = inner[5:-1], lists + 1
    choices = spec.choices if inner == "choice" else ()
    return Expectation(what, inner, spec.span, spec.roles, choices, lists)


def default_of(spec: ArgSpec, registry: Registry) -> Val | None:
    """The skill bank's own value of an argument, of whose type the profile's check has made sure."""
    default = spec.default
    if default is None or isinstance(default, (bool, int, Quantity)):
        return default
    if isinstance(default, float):
        return arithmetic.exact(default)
    if spec.type in ("Arm", "choice"):
        return Word(default)
    if spec.type == "object" and default in registry.objects:
        return ObjectValue(default, registry.objects[default])
    try:
        return default if spec.type == "String" else parse_quantity(default)
    except QuantityError:
        return default
