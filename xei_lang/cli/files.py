"""The files that a command was given, by name or by folder."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from xei_lang.cli.exit_codes import WRONG_USAGE


def protocol_files(paths: tuple[Path, ...]) -> list[Path]:
    """The files, each once; a folder stands for all .xei files below it. Exits where there is none."""
    found = listed_files(paths)
    if not found:
        click.echo(f"error: {no_files(paths)}", err=True)
        sys.exit(WRONG_USAGE)
    return found


def listed_files(paths: tuple[Path, ...]) -> list[Path]:
    """The same, which may be none.

    Links to folders are not followed. A folder that cannot be read is listed itself, so that reading it says
    why.
    """
    found: list[Path] = []
    for path in paths:
        found.extend(sorted(_below(path)) if path.is_dir() else [path])
    return list(dict.fromkeys(found))


def no_files(paths: tuple[Path, ...]) -> str:
    """That there is nothing to check, in words."""
    from xei_lang.diagnostics.render.terminal import visible

    folders = ", ".join(f"`{visible(str(path))}`" for path in paths)
    return f"there is no .xei file in {folders}"


def _below(folder: Path) -> list[Path]:
    closed: list[Path] = []
    found: list[Path] = []
    for parent, _, names in os.walk(folder, onerror=lambda error: closed.append(Path(error.filename))):
        paths = (Path(parent, name) for name in names if name.endswith(".xei"))
        # Reading a pipe or device could wait forever; a link that leads nowhere is told of as unreadable.
        found.extend(path for path in paths if path.is_file() or (path.is_symlink() and not path.exists()))
    return found + closed


def count(number: int, noun: str) -> str:
    """`1 file`, `2 files`, `2 fixes`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}{'es' if noun.endswith('x') else 's'}"
