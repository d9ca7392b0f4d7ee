"""One line a diagnostic, as grep and editors read them: `file:line:column: error[CODE] headline`."""

from __future__ import annotations

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics
from xei_lang.diagnostics.render.region import region_of
from xei_lang.diagnostics.render.terminal import visible
from xei_lang.diagnostics.span import Sources


def render_concise(diagnostics: Diagnostics, sources: Sources) -> str:
    """All diagnostics in their order; what has no place begins with its severity. Nothing is printed raw.

    Of a message of several lines the first is shown.
    """
    return "".join(f"{_line(diagnostic, sources)}\n" for diagnostic in diagnostics)


def _line(diagnostic: Diagnostic, sources: Sources) -> str:
    headline = diagnostic.message.partition("\n")[0]
    said = f"{diagnostic.severity}[{diagnostic.code}] {visible(headline)}"
    if diagnostic.span is None:
        return said
    region = region_of(diagnostic.span, sources)
    place = visible(diagnostic.span.file)
    return f"{place}: {said}" if region is None else f"{place}:{region.line}:{region.column}: {said}"
