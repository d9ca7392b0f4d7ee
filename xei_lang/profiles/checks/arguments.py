"""Keys of an argument that its type does not have (XEI0607), and those that it must have (XEI0608)."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.model import Profile
from xei_lang.profiles.trees import Trees

_TYPES = {"roles": ("object", "Place"), "choices": ("choice",), "places": ("Place",)}
"""The types of argument that a key is for."""


def check_arguments(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Every argument of every skill: choices without words, and keys of other types."""
    for skill in profile.bank.skills:
        for arg in skill.args:
            path = ("skills", skill.name, "args", arg.name)
            stated = trees.development.find(path)
            if arg.type == "choice" and not arg.choices:
                yield Diagnostic(
                    "XEI0608",
                    f"`{arg.name}` of `{skill.name}` is a choice without `choices`",
                    arg.span,
                    label="expected the words that may be chosen",
                    help=("add `choices: [...]`",),
                )
            given = (("roles", arg.roles_text), *((key, arg.choices) for key in ("choices", "places")))
            for key, value in given:
                if value and arg.type not in _TYPES[key] and stated.child(key):
                    types = " or ".join(f"`{type_}`" for type_ in _TYPES[key])
                    yield Diagnostic(
                        "XEI0607",
                        f"`{arg.name}` of `{skill.name}` is of type {arg.type}, which has no `{key}`",
                        trees.development.key_span(*path, key),
                        label=f"expected only with the type {types}",
                        help=(f"take `{key}` out, or write another `type`",),
                    )
