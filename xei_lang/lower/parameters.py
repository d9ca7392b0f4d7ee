"""Operation parameters: which source won for each, and why.

Merge order: skill default < computed < usage profile < call. A parameter keeps its source and the rule
behind it, so that a trace can say for each number where it came from.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.goals import Parameter
from xei_lang.ir.skill_plan import Step, Value
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.grasp_words import parameter_of
from xei_lang.profiles.model import LabObject, OperationDefault, SkillSpec
from xei_lang.quantity import TYPE_DIMENSIONS, Dimension, Quantity
from xei_lang.quantity.dimension import LENGTH, NUMBER
from xei_lang.record import Record, record

Source = Literal["skill", "computed", "usage_profile", "call"]

_DIMENSIONS: Mapping[str, tuple[Dimension, ...]] = {**TYPE_DIMENSIONS, "Fraction": (NUMBER,)}
ROUNDING_M = 1e-6
"""What a computed length may be off by, so that comparisons with a limit leave this much room."""


@record
class Setting(Record):
    """A value of a parameter, the source that gave it, the rule behind it, and where it is written (None if
    computed).
    """

    name: str
    value: Quantity | str
    source: Source
    rule: str
    span: Span | None

    @property
    def text(self) -> str:
        """The value with its unit, as people write it."""
        return str(self.value)

    def provenance(self) -> Parameter:
        """What a goal keeps of it."""
        return Parameter(self.name, self.text, self.source, self.rule, self.span)

    def si(self, type_name: str) -> float:
        """The value in SI units; refuses the step (XEI0702) where it does not measure a `type_name`
        (`Length`).
        """
        expected = _DIMENSIONS[type_name]
        if isinstance(self.value, Quantity) and self.value.dimension in expected:
            return self.value.si
        return refuse(
            "XEI0702",
            f"`{self.name}` is `{self.text}`, which is no {type_name}",
            self.span,
            f"expected a {type_name}, found `{self.text}`",
        )


@record
class Layers(Record):
    """What the written sources say: skill defaults below, then the usage profile, then the call."""

    skill: Mapping[str, Setting]
    usage: Mapping[str, Setting]
    call: Mapping[str, Setting]

    def written(self, name: str) -> Setting | None:
        """The setting that outranks what is computed, or None."""
        return self.call.get(name) or self.usage.get(name)

    def merge(self, name: str, computed: Setting | None) -> Setting | None:
        """The setting that wins."""
        return self.written(name) or computed or self.skill.get(name)


def layers_of(step: Step, spec: SkillSpec, subject: LabObject | None) -> Layers:
    """The written settings that apply to a step whose operation works on `subject`."""
    usage = subject.grasp if subject else ()
    return Layers(
        {item.name: _of_profile(item, item.name, "skill") for item in spec.parameters},
        {
            name: _of_profile(item, name, "usage_profile")
            for item in usage
            if (name := parameter_of(item.name))
        },
        _of_call(step),
    )


def _of_profile(item: OperationDefault, name: str, source: Source) -> Setting:
    rule = "skill default" if source == "skill" else f"`grasp: {item.name}` of the object"
    return Setting(name, item.value, source, rule, item.span)


def _of_call(step: Step) -> dict[str, Setting]:
    settings: dict[str, Setting] = {}
    for argument in step.args:
        value: Value = argument.value
        if isinstance(value, int) and not isinstance(value, bool):
            value = Quantity(Fraction(value), NUMBER, "")
        if isinstance(value, (Quantity, str)):
            source: Source = "call" if argument.source == "call" else "skill"
            settings[argument.name] = Setting(argument.name, value, source, "argument", argument.span)
    return settings


def computed_length(name: str, value_m: float, rule: str) -> Setting:
    """A computed length, rounded to a micrometre so that the text says exactly what is used."""
    value = Quantity(Fraction(round(value_m * 1_000_000), 1_000_000), LENGTH, "mm")
    return Setting(name, value, "computed", rule, None)
