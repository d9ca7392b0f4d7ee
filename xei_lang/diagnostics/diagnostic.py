"""One type for everything that xei has to say about its input."""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics.catalogue import CATALOGUE
from xei_lang.diagnostics.span import Span
from xei_lang.record import Record, record

Severity = Literal["error", "warning", "info"]
Applicability = Literal["safe", "unsafe", "display"]


@record
class Label(Record):
    """A secondary place that matters, and why."""

    span: Span
    message: str


@record
class Edit(Record):
    """Replace what the span covers by `text`; an empty span inserts."""

    span: Span
    text: str


@record
class Fix(Record):
    """A mend: `safe` ones keep the meaning that was intended and may be applied unasked by `xei fix`."""

    applicability: Applicability
    edits: tuple[Edit, ...]


@record
class Diagnostic(Record):
    """What is wrong, where, by which rule, and the way out.

    `message` stands alone; `label` is written under the primary span and says expected against found.
    `span` is None only for what has no place in any file (an unreadable path, a missing folder).
    """

    code: str
    message: str
    span: Span | None = None
    label: str = ""
    labels: tuple[Label, ...] = ()
    notes: tuple[str, ...] = ()
    help: tuple[str, ...] = ()
    fix: Fix | None = None

    def __post_init__(self) -> None:
        if self.code not in CATALOGUE:
            raise KeyError(f"diagnostic code {self.code} is not in the catalogue")

    @property
    def severity(self) -> Severity:
        """The severity that the catalogue gives to the code."""
        return CATALOGUE[self.code].severity


Diagnostics = tuple[Diagnostic, ...]


def has_errors(diagnostics: Diagnostics) -> bool:
    """Whether the compilation must stop after the pass that gave these."""
    return any(diagnostic.severity == "error" for diagnostic in diagnostics)
