"""Arguments that a skill asks for and nothing uses (XEI0629): a slip in a template, most of the time."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.checks.names import OPERATION_PARAMETERS
from xei_lang.profiles.checks.operations import of_line
from xei_lang.profiles.model import Profile, SkillSpec
from xei_lang.syntax import ast


def check_unused(profile: Profile) -> Iterator[Diagnostic]:
    """Arguments that are in no rule, no line of the template, and read by none of its operations.

    A command to an instrument is given all of them.
    """
    for skill in profile.bank.skills:
        if any(line.kind == "instrument" for line in skill.template):
            continue
        used = _used(skill)
        for arg in skill.args:
            if arg.name not in used:
                yield Diagnostic(
                    "XEI0629",
                    f"`{skill.name}` asks for `{arg.name}` and does not use it",
                    arg.span,
                    label="neither its contract nor its template names it",
                    help=("name it in the template, or take the argument out",),
                )


def _used(skill: SkillSpec) -> frozenset[str]:
    names = {*skill.occupies, *OPERATION_PARAMETERS, *(item.name for item in skill.parameters)}
    for rule in (*skill.requires, *skill.ensures):
        names.update(node.id for node in ast.walk(rule.predicate) if isinstance(node, ast.Name))
    for line in skill.template:
        for _, value in line.fields:
            names.add(str(value).removeprefix("-").partition(".")[0])
        for _, operation in of_line(line):
            names.update((*operation.needs, *operation.called, *operation.reads))
        if line.repeat is not None:
            names.add(str(line.repeat.times))
    return frozenset(names)
