"""The one way to write a protocol: layout only, never the meaning, and never a comment lost."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostics, Source, has_errors
from xei_lang.syntax import ast
from xei_lang.syntax.format.comments import Cursor
from xei_lang.syntax.format.declarations import FilePrinter
from xei_lang.syntax.format.layout import render
from xei_lang.syntax.lexer import COMMENT, Scanner
from xei_lang.syntax.parser import Parser
from xei_lang.syntax.tables import END, load_tables

WIDTH = 100
"""Characters of a line, where breaks permit; comments and texts are never broken."""


class Formatter:
    """Formats any number of texts; loading the tables of the grammar is done once, when it is made."""

    def __init__(self) -> None:
        self._parser = Parser()
        self._scanner = Scanner(load_tables())

    def format(self, source: Source) -> tuple[str | None, Diagnostics]:
        """The text in the style of xei, its lines ended by line feeds; None where it has errors of syntax."""
        module, diagnostics = self._parser.module(source)
        if module is None or has_errors(diagnostics):
            return None, diagnostics
        words = [token for token in self._scanner.tokens(source.text) if token.kind not in (COMMENT, END)]
        cursor = Cursor(source.text, words, module.comments)
        text = render(FilePrinter(cursor).module(module), WIDTH)
        again, _ = self._parser.module(Source(source.file, text))
        # What is written replaces what somebody worked on: that it says the same is not left to tests alone.
        assert ast.equal_up_to_spans(module, again), "formatting changed the meaning or the comments"
        return text, diagnostics


def format_source(source: Source) -> tuple[str | None, Diagnostics]:
    """Format one text; to format several, make one Formatter."""
    return Formatter().format(source)
