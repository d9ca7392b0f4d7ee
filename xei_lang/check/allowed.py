"""Whether an object allows what a call does with it: the `skills` that the profile lists for it."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed
from xei_lang.check.values import ObjectValue, Val
from xei_lang.profiles.model import ArgSpec, LabObject, SkillSpec
from xei_lang.profiles.roles import fits
from xei_lang.syntax.ast import Arg


def acted_on(skill: SkillSpec) -> ArgSpec | None:
    """The argument that a skill acts on or with: its first object. What else it names (the vessel that is
    poured into, the waste) only takes part.
    """
    return next((spec for spec in skill.args if spec.type == "object"), None)


def is_allowed(
    skill: SkillSpec,
    given: Mapping[str, Arg],
    values: Mapping[str, Val | None],
    registry: Registry,
    reporter: Reporter,
) -> bool:
    """Whether the object of a call lists the skill, or lists none at all; reported where it does not.

    An object that is not bound yet is not judged: the one that will be is, once it is known.
    """
    spec = acted_on(skill)
    value = values.get(spec.name) if spec is not None else None
    if spec is None or spec.name not in given or not isinstance(value, ObjectValue):
        return True
    thing = value.registered
    if thing is None or thing.skills_span is None or skill.name in thing.skills:
        return True
    others = tuple(name for name, other in registry.objects.items() if _would_do(other, skill, spec))
    reporter.report(
        "XEI0326",
        f"`{thing.name}` does not allow `{skill.name}`",
        given[spec.name].value.span,
        f"its `skills` are {listed(thing.skills)}" if thing.skills else "its `skills` are none",
        notes=(reporter.rule(thing.skills_span),),
        help=(
            f"registered objects that would do: {listed(others)}"
            if others
            else "no registered object would do",
            f"add `{skill.name}` to the `skills` of `{thing.name}`, if that may be done with it",
        ),
    )
    return False


def _would_do(thing: LabObject, skill: SkillSpec, spec: ArgSpec) -> bool:
    allows = thing.skills_span is None or skill.name in thing.skills
    return allows and (spec.roles is None or fits(spec.roles, thing.roles))
