"""A call against the skill bank: its skill, its arguments, and whether slots take what it brings there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.check.allowed import is_allowed
from xei_lang.check.amounts import is_nothing
from xei_lang.check.argument_values import ArgumentValues
from xei_lang.check.arguments import match_arguments
from xei_lang.check.callees import Callees
from xei_lang.check.contracts import Contract, Contracts
from xei_lang.check.effects import Effect, moves
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.transfers import Transfer
from xei_lang.check.types import Types
from xei_lang.check.units import Unit
from xei_lang.check.values import ObjectValue, PlaceValue, Val, to_plan
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Argument, Value
from xei_lang.profiles.model import ArgSpec, SkillSpec
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Arg, Call
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


class Calls:
    """Checks calls of skills.

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
        self._reporter = reporter
        self._callees = Callees(registry, reporter, units)
        self._contracts = Contracts()
        self._arguments = ArgumentValues(registry, evaluator, types, reporter)

    def check(self, call: Call, scope: Scope, state: State) -> CheckedCall | None:
        """The call with its arguments as they are at this point of the plan; None where it does not hold."""
        skill = self._callees.skill(call)
        if skill is None:
            self._arguments.look_at(call, scope)
            return None
        contract = self._contracts.of(skill)
        given = match_arguments(call, contract.signature, self._reporter)
        if given is None:
            self._arguments.look_at(call, scope)
            return None
        values = {
            formal.spec.name: self._arguments.value(given.get(formal.spec.name), formal, scope, state)
            for formal in contract.formals
        }
        if not is_allowed(skill, given, values, self._registry, self._reporter):
            return None
        if not self._slots_accept(contract, given, values):
            return None
        found = tuple(_planned(spec, value, given) for spec, value in _present(contract, values))
        return CheckedCall(skill, contract.effects, contract.transfers, values, found, call.callee.span)

    def _slots_accept(
        self, contract: Contract, given: Mapping[str, Arg], values: Mapping[str, Val | None]
    ) -> bool:
        """Whether each slot takes the object that the skill brings there."""
        for moved, target in moves(contract.effects):
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


def _present(contract: Contract, values: Mapping[str, Val | None]) -> Iterator[tuple[ArgSpec, Val]]:
    for formal in contract.formals:
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
