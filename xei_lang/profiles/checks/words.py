"""Names that are words of the language, so that no protocol can write what they name (XEI0621).

Most keywords are fine names: they are keywords only where they may stand. A test holds the lists against the
grammar.
"""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.profiles.model import Profile, SkillSpec
from xei_lang.profiles.trees import Trees

NO_VALUES = ("false", "not", "true")
"""What is never a name where a value is meant."""
_VALUES = ("either", *NO_VALUES, "nothing")
"""The same, and the values that are spelt like names."""

STATEMENTS = (
    *("await", "confirm", "do", "for", "given", "if", "keep", "leave", "let", "measure", "note", "object"),
    *("parallel", "param", "pause", "profile", "repeat", "require", "start", "stop", "unmapped", "wait"),
)
"""What is never a name where a statement begins, as a call does."""


def check_words(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Objects, their roles and states, stations, skills and their arguments."""
    values = (*_VALUES, *profile.bank.arms)
    for station in profile.calibration.stations:
        if station.name in values:
            yield _taken(station.name, "station", station.span)
    for item in profile.objects:
        if item.name in values:
            yield _taken(item.name, "object", item.span)
        for index, role in enumerate(item.roles):
            if role == "not":
                yield _taken(role, "role", trees.of_object(item, "roles", index))
        for state in item.states:
            if state.name in NO_VALUES:
                yield _taken(state.name, "state", state.span)
            for index, value in enumerate(state.values):
                if value in NO_VALUES:
                    span = trees.of_object(item, "states", state.name, "values", index)
                    yield _taken(value, "state's value", span)
    for skill in profile.bank.skills:
        yield from _skill(skill)


def _skill(skill: SkillSpec) -> Iterator[Diagnostic]:
    if skill.exposed and skill.name in STATEMENTS:
        yield _taken(skill.name, "skill", skill.span)
    for arg in skill.args:
        if arg.name in NO_VALUES:
            yield _taken(arg.name, "argument", arg.span)
        for word in arg.choices if arg.type == "choice" else ():
            if word in NO_VALUES:
                yield _taken(word, "choice", arg.span)


def _taken(name: str, what: str, span: Span) -> Diagnostic:
    article = "an" if what[0] in "ao" else "a"
    return Diagnostic(
        "XEI0621",
        f"`{name}` names two things",
        span,
        label=f"names {article} {what} here",
        notes=(f"`{name}` is a word of the language, which a protocol means wherever it says so",),
        help=(f"rename the {what}",),
    )
