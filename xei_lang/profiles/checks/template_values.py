"""What the values of a template's fields are: names, not numbers (XEI0623), of what measures what the field
is about (XEI0610).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.profiles.checks.operations import OPERATIONS, of_template
from xei_lang.profiles.model import Repeat, SkillSpec, TemplateStep
from xei_lang.profiles.trees import Trees
from xei_lang.quantity import TYPE_DIMENSIONS, Dimension, Quantity
from xei_lang.quantity.dimension import ANGLE, ANGULAR_SPEED, LENGTH, NUMBER, SPEED, TIME

MEASURED: Mapping[str, tuple[tuple[Dimension, ...], str]] = MappingProxyType(
    {
        "speed": ((NUMBER, SPEED, ANGULAR_SPEED), "a fraction, a Speed or an AngularSpeed"),
        "width": ((LENGTH,), "a Length"),
        "height": ((LENGTH,), "a Length"),
        "lead": ((LENGTH,), "a Length"),
        "pitch": ((LENGTH,), "a Length"),
        "angle": ((ANGLE,), "an Angle"),
        "for": ((TIME,), "a Time"),
        "times": ((NUMBER,), "a number"),
    }
)
"""What the values of a field measure, and how that is called."""

_LITERAL = ("text", "command")
"""Fields that say something as it stands."""


def check_values(skill: SkillSpec, line: TemplateStep, trees: Trees) -> Iterator[Diagnostic]:
    """Every field of a line: whether it is a name, and what that measures."""
    for field, value in line.fields:
        span = trees.of_skill(skill.name, "template", *line.path, line.kind, field)
        if isinstance(value, str):
            yield from _measured(skill, field, value.removeprefix("-"), span)
        elif field not in _LITERAL and not (field == "value" and isinstance(value, bool)):
            yield _no_name(skill, line, field, value, span)


def check_times(skill: SkillSpec, repeat: Repeat, trees: Trees) -> Iterator[Diagnostic]:
    """Whether the name that says how often lines are gone through is that of a number."""
    if isinstance(repeat.times, str):
        span = trees.of_skill(skill.name, "template", repeat.number, "repeat", "times")
        yield from _measured(skill, "times", repeat.times, span)


def fitting(skill: SkillSpec, field: str, known: Sequence[str]) -> Sequence[str]:
    """Those of the names of a field whose values measure what the field is about."""
    if field not in MEASURED:
        return known
    expected = set(MEASURED[field][0])
    stated = {name: dimensions_of(skill, name) for name in known}
    return [name for name, found in stated.items() if found is None or expected.intersection(found[0])]


def from_where(name: str) -> str:
    """What could give a name that is not known a value: the operation that computes it, or the skill."""
    computing = next((item for item in OPERATIONS if name in item.parameters), None)
    if computing is None:
        return f"a value of its own stands under `parameters`: `{name}: ...`"
    points = " or ".join(f"`{point}`" for point in computing.points[:2])
    return f"`{computing.name}` computes it, once a line names a point of it, such as {points}"


def _no_name(skill: SkillSpec, line: TemplateStep, field: str, value: object, span: Span) -> Diagnostic:
    shown = str(value).lower() if isinstance(value, bool) else str(value)
    mend = f"write it with its unit under `parameters`, and name it here: `{field}: some_{field}`"
    return Diagnostic(
        "XEI0623",
        f"`{field}: {shown}` in the template of `{skill.name}` names nothing",
        span,
        label="expected true, false or the name of an argument" if field == "value" else "expected a name",
        help=(mend,) if field in MEASURED else (),
    )


def _measured(skill: SkillSpec, field: str, name: str, span: Span) -> Iterator[Diagnostic]:
    """Names that nothing has, and heights of stations and objects, are looked after elsewhere."""
    stated = dimensions_of(skill, name) if field in MEASURED else None
    if stated is None:
        return
    found, where, what = stated
    expected, words = MEASURED[field]
    if not set(expected).intersection(found):
        yield Diagnostic(
            "XEI0610",
            f"`{field}: {name}` in the template of `{skill.name}` is no {field_word(field)}: it is {what}",
            span,
            label=f"expected {words}",
            labels=() if where is None else (Label(where, "it is given here"),),
        )


def field_word(field: str) -> str:
    """What a field asks for, in a word that may follow `is no`."""
    return {"for": "time", "times": "number of times"}.get(field, field)


def dimensions_of(skill: SkillSpec, name: str) -> tuple[tuple[Dimension, ...], Span | None, str] | None:
    """What the value of a name may measure, where that is stated, and in words; None for unknown names.

    An argument outranks what is computed, and that a parameter.
    """
    arg = skill.arg(name)
    if arg is not None:
        found = (NUMBER,) if arg.type == "Int" else TYPE_DIMENSIONS.get(arg.type, ())
        return found, arg.span, f"of type {arg.type}"
    types = (item.parameters.get(name) for item in of_template(skill))
    computed = next((type_ for type_ in types if type_ is not None), None)
    if computed is not None:
        article = "an" if computed[0] in "AI" else "a"
        return TYPE_DIMENSIONS.get(computed, (NUMBER,)), None, f"{article} {computed}"
    value = next((item for item in skill.parameters if item.name == name), None)
    if value is None:
        return None
    dimensions = (value.value.dimension,) if isinstance(value.value, Quantity) else ()
    return dimensions, value.span, f"`{value.value}`"
