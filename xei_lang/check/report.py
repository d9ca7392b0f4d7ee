"""Where the checker puts what it has to say: each mistake once, however often a loop or a call leads past
it.
"""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from xei_lang.diagnostics import Diagnostic, Diagnostics, Edit, Fix, Label, Sources, Span
from xei_lang.diagnostics.catalogue import CATALOGUE
from xei_lang.diagnostics.diagnostic import Applicability
from xei_lang.diagnostics.options import option_source
from xei_lang.ir.skill_plan import Call

MAX_ERRORS = 200
"""After so many nobody reads on, and looking for what was meant by each wrong name takes long."""


class Reporter:
    """Collects diagnostics in the order in which they are found.

    `calls` is the chain of procedure calls that the checker is in; what is reported inside shows it.
    """

    def __init__(self, sources: Sources) -> None:
        self._sources = sources
        self._found: dict[tuple[Span, str, str], Diagnostic] = {}
        self._errors = 0
        self.calls: tuple[Call, ...] = ()

    @property
    def is_full(self) -> bool:
        """Whether there are more errors than are shown, which then has been reported."""
        return self._errors > MAX_ERRORS

    @property
    def diagnostics(self) -> Diagnostics:
        """Everything that was reported, in the order of the text."""
        return tuple(self._found[key] for key in sorted(self._found))

    def report(
        self,
        code: str,
        message: str,
        span: Span,
        label: str = "",
        *,
        labels: tuple[Label, ...] = (),
        notes: tuple[str, ...] = (),
        help: tuple[str, ...] = (),
        fix: Fix | None = None,
        about: str = "",
    ) -> None:
        """Keep a diagnostic, unless the same code was reported at the same place.

        `about` tells apart what is rightly said twice of one place, such as two wrong options of the
        command line.
        """
        key = (span, code, about)
        if key not in self._found and self._has_room(code, span):
            chain = tuple(
                Label(call.span, f"in this call of `{call.procedure}`") for call in reversed(self.calls)
            )
            fix = None if option_source(span.file) else fix
            self._found[key] = Diagnostic(code, message, span, label, labels + chain, notes, help, fix)

    def _has_room(self, code: str, span: Span) -> bool:
        """Whether one more may be kept; the first error for which there is no room is told of."""
        if CATALOGUE[code].severity != "error":
            return True
        self._errors += 1
        if self._errors == MAX_ERRORS + 1:
            self._found[span, "XEI0109", ""] = Diagnostic(
                "XEI0109",
                f"only the first {MAX_ERRORS} errors are shown",
                span,
                "what follows was not checked",
                help=("mend these first",),
            )
        return self._errors <= MAX_ERRORS

    def keep(self, diagnostic: Diagnostic) -> None:
        """Keep a diagnostic that another room made of a file, which has a span."""
        assert diagnostic.span is not None
        key = (diagnostic.span, diagnostic.code, "")
        if key not in self._found and self._has_room(diagnostic.code, diagnostic.span):
            self._found[key] = diagnostic

    def rule(self, span: Span) -> str:
        """The note that says which line of a profile makes the rule; only the file where its text is not at
        hand.
        """
        source = self._sources.get(span.file)
        place = f"{span.file}:{source.line_number(span.start)}" if source and source.text else span.file
        return f"rule: {place}"

    @contextmanager
    def inside(self, call: Call) -> Generator[None]:
        """While the body of a called procedure is checked."""
        before = self.calls
        self.calls = (*before, call)
        try:
            yield
        finally:
            self.calls = before


def replace(span: Span, text: str, applicability: Applicability = "safe") -> Fix:
    """A fix of one edit."""
    return Fix(applicability, (Edit(span, text),))


def insert(at: Span, text: str, applicability: Applicability = "safe") -> Fix:
    """A fix that puts a text before a span."""
    return replace(Span(at.file, at.start, at.start), text, applicability)


def guess(span: Span, suggestions: tuple[str, ...]) -> Fix | None:
    """What was probably meant where only one thing can have been, for the one who asks for such mends."""
    return replace(span, suggestions[0], "unsafe") if len(suggestions) == 1 else None


def listed(names: tuple[str, ...], limit: int = 6) -> str:
    """Names in backticks; a long list says how many more there are."""
    shown = ", ".join(f"`{name}`" for name in names[:limit])
    return f"{shown} and {len(names) - limit} more" if len(names) > limit else shown


def meant(suggestions: tuple[str, ...]) -> tuple[str, ...]:
    """The help line that offers what a wrong name may have been meant to be."""
    return (f"did you mean {' or '.join(f'`{name}`' for name in suggestions)}?",) if suggestions else ()
