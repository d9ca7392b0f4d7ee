"""The contract of a skill as a call of it is checked against: its arguments and what it brings about."""

from __future__ import annotations

from xei_lang.check.arguments import Signature
from xei_lang.check.effects import Effect, effects_of
from xei_lang.check.expectation import Expectation
from xei_lang.check.transfers import Transfer, transfers_of
from xei_lang.profiles.model import ArgSpec, SkillSpec
from xei_lang.record import Shown, record


@record
class Formal(Shown):
    """An argument that a skill declares; `is_amount` says that the skill transfers as much as it says."""

    spec: ArgSpec
    expected: Expectation
    is_amount: bool


@record
class Contract(Shown):
    """A skill with its arguments, in the skill bank's order, and what it brings about."""

    skill: SkillSpec
    signature: Signature
    formals: tuple[Formal, ...]
    effects: tuple[Effect, ...]
    transfers: tuple[Transfer, ...]


class Contracts:
    """The contracts of skills, each prepared once, when it is first asked for."""

    def __init__(self) -> None:
        self._prepared: dict[str, Contract] = {}

    def of(self, skill: SkillSpec) -> Contract:
        """The contract of a skill of the bank."""
        contract = self._prepared.get(skill.name)
        if contract is None:
            contract = self._prepared[skill.name] = _contract(skill)
        return contract


def _contract(skill: SkillSpec) -> Contract:
    transfers = transfers_of(skill)
    amounts = {transfer.amount for transfer in transfers}
    formals = tuple(Formal(spec, _expectation(spec, skill.name), spec.name in amounts) for spec in skill.args)
    return Contract(skill, _signature(skill), formals, effects_of(skill), transfers)


def _signature(skill: SkillSpec) -> Signature:
    return Signature(
        "skill",
        skill.name,
        tuple(spec.name for spec in skill.args),
        tuple(spec.name for spec in skill.args if spec.required),
        skill.span,
    )


def _expectation(spec: ArgSpec, skill: str) -> Expectation:
    """What an argument of a skill takes, and why."""
    what = f"`{spec.name}` of `{skill}`"
    inner, lists = spec.type, 0
    while inner.startswith("List[") and inner.endswith("]"):
        inner, lists = inner[5:-1], lists + 1
    choices = spec.choices if inner == "choice" else ()
    return Expectation(what, inner, spec.span, spec.roles, choices, lists)
