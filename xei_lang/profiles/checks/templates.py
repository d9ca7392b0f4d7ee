"""The lines of a template one by one: whether each has the fields of its kind, and words that there are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from xei_lang.diagnostics import Diagnostic, did_you_mean
from xei_lang.profiles.checks.repeats import check_repeats
from xei_lang.profiles.checks.template_needs import check_needs
from xei_lang.profiles.checks.template_parameters import check_parameters
from xei_lang.profiles.checks.template_paths import check_path
from xei_lang.profiles.checks.template_values import MEASURED, check_values, fitting, from_where
from xei_lang.profiles.checks.template_words import FIELDS, words_of
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import Profile, SkillSpec, TemplateStep
from xei_lang.profiles.trees import Trees

_MINUS = ("", "-")


def check_template(profile: Profile, skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Repeats of the template, the fields of its lines, and the names in them (XEI0623)."""
    yield from check_repeats(skill, trees)
    yield from check_needs(skill, trees)
    yield from check_parameters(skill, trees)
    for step in skill.template:
        yield from _fields(skill, step)
        yield from check_path(skill, step, trees)
        yield from check_values(skill, step, trees)
        for field, value in step.fields:
            known = words_of(profile, skill, step, field) if isinstance(value, str) else None
            if known is not None and str(value).removeprefix(_MINUS[field == "angle"]) not in known:
                span = trees.of_skill(skill.name, "template", *step.path, step.kind, field)
                what = f"a `{field}` for the template of `{skill.name}`"
                near = fitting(skill, field, known)
                found = unknown(what, str(value), near, span, "XEI0623")
                if field in MEASURED and not did_you_mean(str(value), near):
                    known_help = found.help if near else ()
                    found = replace(found, help=(*known_help, from_where(str(value))))
                yield found


def _fields(skill: SkillSpec, step: TemplateStep) -> Iterator[Diagnostic]:
    """Whether a goal of a template has the fields that its kind needs, and no others."""
    required, optional = FIELDS[step.kind]
    given = [name for name, _ in step.fields]
    for name in given:
        if name not in (*required, *optional):
            yield unknown(f"a field of `{step.kind}`", name, (*required, *optional), step.span, "XEI0623")
    for name in required:
        if name not in given:
            yield Diagnostic(
                "XEI0623",
                f"`{step.kind}` in the template of `{skill.name}` has no `{name}`",
                step.span,
                label=f"expected `{name}`",
                help=(f"add `{name}: ...`",),
            )
    if step.kind == "move_to" and ("configuration" in given) == ("at" in given):
        yield Diagnostic(
            "XEI0623",
            f"`move_to` in the template of `{skill.name}` needs one target",
            step.span,
            label="expected `at` with `tool`, or `configuration`",
        )
