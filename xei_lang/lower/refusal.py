"""How a part of lowering gives up a step: it raises, and `lower` turns that into the step's diagnostic."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import replace
from typing import NoReturn

from xei_lang.diagnostics import Diagnostic, Label, Span


class Refusal(Exception):  # noqa: N818 (no error: how a step is given up)
    """A step that cannot be lowered. Never leaves this package."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@contextmanager
def told_at(span: Span) -> Generator[None]:
    """A refusal inside that knows no place of its own is told here."""
    try:
        yield
    except Refusal as refusal:
        if refusal.diagnostic.span is None:
            refusal.diagnostic = replace(refusal.diagnostic, span=span)
        raise


def refuse(
    code: str,
    message: str,
    span: Span | None,
    label: str = "",
    labels: tuple[Label, ...] = (),
    *,
    notes: tuple[str, ...] = (),
    help: tuple[str, ...] = (),
) -> NoReturn:
    """Give up the step that is being lowered, with this diagnostic."""
    raise Refusal(Diagnostic(code, message, span, label, labels, notes, help))
