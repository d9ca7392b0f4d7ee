"""The files that a command was given, by name or by folder."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.exit_codes import WRONG_USAGE


def protocol_files(paths: tuple[Path, ...]) -> list[Path]:
    """The files, each once; a folder stands for all .xei files below it. Exits where there is none."""
    found: list[Path] = []
    for path in paths:
        found.extend(sorted(path.rglob("*.xei")) if path.is_dir() else [path])
    if not found:
        folders = ", ".join(f"`{path}`" for path in paths)
        click.echo(f"error: there is no .xei file in {folders}", err=True)
        sys.exit(WRONG_USAGE)
    return list(dict.fromkeys(found))


def count(number: int, noun: str) -> str:
    """`1 file`, `2 files`, `2 fixes`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}{'es' if noun.endswith('x') else 's'}"
