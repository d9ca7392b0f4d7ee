"""Options that several commands share, and the values that they stand for."""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

Pairs = tuple[tuple[str, str], ...]

PROFILE_WORLD = "profile"
"""The `--world` that asks nobody but the profile."""


@dataclass(frozen=True, slots=True, eq=False)
class Options:
    """What every command that compiles a protocol can be told."""

    profile: Path | None
    bindings: Pairs
    params: Pairs
    seed: int
    color: bool
    quiet: bool


def compiling(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the shared options; it receives them as one argument, `options`."""

    @functools.wraps(command)
    def with_options(
        profile: Path | None,
        bindings: tuple[str, ...],
        params: tuple[str, ...],
        seed: int,
        color: str,
        quiet: bool,
        **others: Any,
    ) -> None:
        bound, given = _pairs("--bind", bindings), _pairs("--param", params)
        command(options=Options(profile, bound, given, seed, wants_color(color), quiet), **others)

    wrapped: Callable[..., None] = with_options
    for option in _SHARED:
        wrapped = option(wrapped)
    return wrapped


_SHARED = (
    click.option("--quiet", is_flag=True, help="Print errors only."),
    click.option(
        "--color", type=click.Choice(["auto", "always", "never"]), default="auto", help="Colour messages.",
        show_default=True,
    ),
    click.option(
        "--seed", type=click.IntRange(min=0), default=0, show_default=True,
        help="Seed of everything that is random.",
    ),
    click.option(
        "--param", "params", multiple=True, metavar="NAME=VALUE",
        help='Give a parameter its value, such as --param volume="2 mL".',
    ),
    click.option(
        "--bind", "bindings", multiple=True, metavar="NAME=OBJECT",
        help="Bind an object of the protocol to a registered one.",
    ),
    click.option("--profile", type=click.Path(path_type=Path), help="Folder of the profile to use."),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class WorldOptions:
    """Who is asked where things are, besides the profile: `sources` as `--world` names them, each over those
    before it; for a pose service the picture that it looks at, and the file with its token.
    """

    sources: tuple[str, ...]
    picture: Path | None
    token_file: Path | None


def grounding(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of those that ground the world; it receives them as one, `world`."""

    @functools.wraps(command)
    def with_world(
        world: tuple[str, ...], picture: Path | None, token_file: Path | None, **others: Any
    ) -> None:
        sources = tuple(name for name in world if name != PROFILE_WORLD)
        command(world=WorldOptions(sources, picture, token_file), **others)

    wrapped: Callable[..., None] = with_world
    for option in _OF_THE_WORLD:
        wrapped = option(wrapped)
    return wrapped


_OF_THE_WORLD = (
    click.option(
        "--token-file", type=click.Path(path_type=Path), help="A file with the token of the pose service."
    ),
    click.option(
        "--picture", type=click.Path(path_type=Path), help="What a pose service is asked: a `pose_request`."
    ),
    click.option(
        "--world", metavar="SOURCE", multiple=True, default=(PROFILE_WORLD,), show_default=True,
        help="Who says where things are: `profile`, or over it a scene file or a pose service (http://...). "
        "May be repeated: each over those before it.",
    ),
)  # fmt: skip


def _pairs(option: str, values: tuple[str, ...]) -> Pairs:
    """`NAME=VALUE` texts as pairs; a text without `=`, or a name given twice, is wrong usage."""
    found: dict[str, str] = {}
    for text in values:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise click.BadParameter(f"`{text}` is not of the form NAME=VALUE", param_hint=option)
        if name.strip() in found:
            raise click.BadParameter(f"`{name.strip()}` is given twice", param_hint=option)
        found[name.strip()] = value.strip()
    return tuple(found.items())


def wants_color(choice: str) -> bool:
    """Whether to colour what goes to stderr (https://no-color.org)."""
    if choice != "auto":
        return choice == "always"
    return "NO_COLOR" not in os.environ and sys.stderr.isatty()
