"""The skills of a bank: their owners, the roles that they ask for, names in contracts, phrases, templates."""

from __future__ import annotations

import re
from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.profiles.checks.templates import check_template
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.instruments import OWNER
from xei_lang.profiles.model import Profile, SkillSpec
from xei_lang.profiles.trees import Trees
from xei_lang.syntax import ast


def check_skills(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Every skill: its owner, the roles that it asks for, the names in its contract, phrases and template."""
    roles = sorted({role for item in profile.objects for role in item.roles})
    for skill in profile.bank.skills:
        if skill.owner not in profile.bank.owners:
            span = trees.of_skill(skill.name, "owner")
            yield unknown("an owner of this profile", skill.owner, profile.bank.owners, span)
        for arg in skill.args:
            names = [node for node in ast.walk(arg.roles) if isinstance(node, ast.Role)] if arg.roles else []
            yield from (
                unknown("a role of any object", role.id, roles, role.span, "XEI0625")
                for role in names
                if role.id not in roles
            )
        yield from _contract(skill)
        yield from _occupied(skill, trees)
        yield from _phrases(skill, trees)
        yield from check_template(profile, skill, trees)


def _contract(skill: SkillSpec) -> Iterator[Diagnostic]:
    names = [arg.name for arg in skill.args]
    for rule in (*skill.requires, *skill.ensures):
        for node in ast.walk(rule.predicate):
            if isinstance(node, ast.CallExpr):
                subjects = [arg.value for arg in node.args if isinstance(arg.value, ast.Name)]
                yield from (
                    _no_argument(skill, name.id, names, name.span)
                    for name in subjects
                    if name.id not in names
                )


def _occupied(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Whether what an instrument holds are arguments of its skill."""
    if skill.occupies_span is not None and skill.owner != OWNER:
        yield Diagnostic(
            "XEI0623",
            f"`{skill.name}` occupies something, and no instrument performs it",
            skill.occupies_span,
            label=f"performed by `{skill.owner}`",
            help=("leave it out; what an arm works with is in its `requires` and `ensures`",),
        )
        return
    names = [arg.name for arg in skill.args if arg.type in ("object", "Place")]
    for index, name in enumerate(skill.occupies):
        if name not in names:
            yield _no_argument(skill, name, names, trees.of_skill(skill.name, "occupies", index))


def _phrases(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    names = [arg.name for arg in skill.args]
    for index, phrase in enumerate(skill.phrases):
        for name in re.findall(r"\{([^{}]*)\}", phrase):
            if name not in names:
                span = trees.of_skill(skill.name, "phrases", index)
                yield _no_argument(skill, name, names, span)
        if re.search(r"[{}]", re.sub(r"\{[^{}]*\}", "", phrase)):
            yield Diagnostic(
                "XEI0623",
                f"`{phrase}` has a brace without its partner",
                trees.of_skill(skill.name, "phrases", index),
                label="expected `{` and `}` around an argument's name",
            )


def _no_argument(skill: SkillSpec, name: str, names: list[str], span: Span) -> Diagnostic:
    return unknown(f"an argument of `{skill.name}`", name, names, span, "XEI0623")
