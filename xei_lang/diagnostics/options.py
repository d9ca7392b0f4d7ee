"""Options of the command line as texts that a message can point into, such as `--param volume=9mL`.

The text is the name of its file too, so that whoever shows a message has it at hand.
"""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics.span import Source, Span

_MARKS = ("--param ", "--bind ")


def option_value(flag: Literal["param", "bind"], name: str, given: str) -> Span:
    """Where the value stands in the text of its option."""
    text = f"--{flag} {name}={given}"
    return Span(text, len(text) - len(given), len(text))


def option_source(file: str) -> Source | None:
    """The text of an option that a span names as its file; None for any other file."""
    return Source(file, file) if file.startswith(_MARKS) else None
