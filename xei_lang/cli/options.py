"""Options that several commands share, and the values that they stand for."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

Command = TypeVar("Command", bound=Callable[..., Any])


def compiling(command: Command) -> Command:
    """The options of every command that compiles a protocol."""
    options = [
        click.option("--profile", type=click.Path(path_type=Path), help="Folder of the profile to use."),
        click.option("--bind", "bindings", multiple=True, metavar="NAME=OBJECT",
                     help="Bind an object of the protocol to a registered one."),
        click.option("--param", "params", multiple=True, metavar="NAME=VALUE",
                     help='Give a parameter its value, such as --param volume="2 mL".'),
        click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
                     help="Seed of everything that is random."),
        click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto",
                     show_default=True, help="Colour messages."),
        click.option("--quiet", is_flag=True, help="Print errors only."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def pairs(option: str, values: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
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
    return "NO_COLOR" not in os.environ and click.get_text_stream("stderr").isatty()


def cache_folder() -> Path:
    """Where compiled profiles and parse tables are kept (XDG Base Directory Specification)."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "xei"
