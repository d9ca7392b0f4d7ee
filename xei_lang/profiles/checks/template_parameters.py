"""Parameters of a skill that its template does not read (XEI0649), or that are no measure of what reads them
(XEI0610).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.diagnostics import Diagnostic, did_you_mean
from xei_lang.profiles.checks.operations import of_template
from xei_lang.profiles.model import SkillSpec
from xei_lang.profiles.trees import Trees
from xei_lang.quantity import TYPE_DIMENSIONS, Quantity
from xei_lang.quantity.dimension import NUMBER

_LOOKING = {"look_margin": "Fraction"}
"""What the height for looking at an object reads."""


def check_parameters(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Every key under `parameters`, against the operations and the words of the template."""
    named, read = _named(skill), _read(skill)
    given = [item.name for item in skill.parameters]
    for item in skill.parameters:
        type_ = read.get(item.name)
        if type_ is not None and not _measures(item.value, type_):
            yield Diagnostic(
                "XEI0610",
                f"`{item.name}` of `{skill.name}` is `{item.value}`, which is no {type_}",
                item.span,
                label=f"expected a quantity of {type_}" if type_ in TYPE_DIMENSIONS else "expected a number",
            )
        elif type_ is None and item.name not in named:
            near = did_you_mean(item.name, [name for name in (*read, *named) if name not in given])
            yield Diagnostic(
                "XEI0649",
                f"`{skill.name}` gives `{item.name}`, and nothing in its template reads it",
                trees.development.key_span("skills", skill.name, "parameters", item.name),
                label="no line names it, and none of the operations reads it",
                help=(f"did you mean `{near[0]}`?" if near else "take it out, or name it in the template",),
            )


def _named(skill: SkillSpec) -> tuple[str, ...]:
    """The words of the template, and how often its lines are gone through."""
    values = [str(value).removeprefix("-") for line in skill.template for _, value in line.fields]
    return (*values, *(str(line.repeat.times) for line in skill.template if line.repeat is not None))


def _read(skill: SkillSpec) -> Mapping[str, str]:
    """What the operations of the template read, with its type."""
    found: dict[str, str] = {}
    for item in of_template(skill):
        found.update({**item.parameters, **item.needs, **item.reads})
    looks = any(str(line.field("height")).endswith(".look_height") for line in skill.template)
    return {**found, **_LOOKING} if looks else found


def _measures(value: Quantity | str, type_: str) -> bool:
    expected = TYPE_DIMENSIONS.get(type_, (NUMBER,))
    return isinstance(value, Quantity) and value.dimension in expected
