"""Diagnostics as plain lists and texts, to be kept or to be sent from process to process, and back."""

from __future__ import annotations

from typing import Any

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics, Edit, Fix, Label
from xei_lang.diagnostics.span import Span

Plain = list[Any]
"""Lists, texts, numbers and None only, as JSON and marshal take them."""


def to_plain(diagnostics: Diagnostics) -> Plain:
    """Diagnostics without any class of ours; `from_plain` makes equal ones of it."""
    return [
        [
            item.code,
            item.message,
            _span(item.span),
            item.label,
            [[_span(label.span), label.message] for label in item.labels],
            list(item.notes),
            list(item.help),
            item.fix and [item.fix.applicability, [[_span(edit.span), edit.text] for edit in item.fix.edits]],
        ]
        for item in diagnostics
    ]


def from_plain(plain: Any) -> Diagnostics:
    """The diagnostics that `to_plain` made this of; raises ValueError where it made no such thing."""
    try:
        return tuple(_diagnostic(*item) for item in plain)
    except (TypeError, KeyError) as error:
        raise ValueError("no plain form of diagnostics") from error


def _diagnostic(
    code: str,
    message: str,
    span: Plain | None,
    label: str,
    labels: Plain,
    notes: Plain,
    help: Plain,
    fix: Any,
) -> Diagnostic:
    return Diagnostic(
        code,
        message,
        None if span is None else Span(*span),
        label,
        tuple(Label(Span(*place), text) for place, text in labels),
        tuple(notes),
        tuple(help),
        None if fix is None else Fix(fix[0], tuple(Edit(Span(*place), text) for place, text in fix[1])),
    )


def _span(span: Span | None) -> Plain | None:
    return None if span is None else [span.file, span.start, span.end]
