"""What a command changes in a file, as a unified diff."""

from __future__ import annotations

import difflib
import sys

import click

from xei_lang.diagnostics.render.terminal import visible_lines


def echo_diff(file: str, before: str, after: str) -> None:
    """Print the difference: for `patch` as it is, for a terminal without control characters."""
    for line in difflib.unified_diff(_lines(before), _lines(after), f"a/{file}", f"b/{file}"):
        whole = line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
        click.echo("\n".join(visible_lines(whole)) if sys.stdout.isatty() else whole, nl=False)


def _lines(text: str) -> list[str]:
    """Lines as `patch` counts them: ended by line feeds only."""
    *whole, last = text.split("\n")
    return [f"{line}\n" for line in whole] + ([last] if last else [])
