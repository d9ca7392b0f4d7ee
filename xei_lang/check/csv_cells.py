"""CSV text as rows of cells, each able to say where it stands.

The csv module reads the rows (RFC 4180, commas); where a cell stands is found again only for one that is
wrong.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.diagnostics import Source, Span


class NotCsvError(Exception):
    """The text cannot be read as CSV; `span` is the line where reading stopped."""

    def __init__(self, reason: str, span: Span) -> None:
        super().__init__(reason)
        self.span = span


@dataclass(frozen=True, slots=True, eq=False)
class CsvRow:
    """A row of a table: its cells without the blanks around them, and the offsets of its text."""

    source: Source
    number: int
    cells: tuple[str, ...]
    start: int
    end: int

    def span(self, column: int | None = None) -> Span:
        """Where the row stands, or its cell in a column, counted from 0; an empty cell has its place too."""
        text = self.source.text[self.start : self.end].rstrip("\r\n")
        bounds = None if column is None else _cells(text)[column]
        first, last = (0, len(text)) if bounds is None else bounds
        return Span(self.source.file, self.start + first, self.start + last)


def rows(source: Source) -> Iterator[CsvRow]:
    """The rows of a text that are not blank. Raises NotCsvError."""
    lines = list(io.StringIO(source.text, newline=""))
    offsets = [0]
    for line in lines:
        offsets.append(offsets[-1] + len(line))
    reader = csv.reader(lines, strict=True, skipinitialspace=True)
    before = 0
    while True:
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            after = min(max(reader.line_num, before + 1), len(lines))
            where = CsvRow(source, before + 1, (), offsets[before], offsets[after])
            raise NotCsvError(str(error), where.span()) from error
        if any(cell.strip() for cell in cells):
            stripped = tuple(cell.strip() for cell in cells)
            yield CsvRow(source, before + 1, stripped, offsets[before], offsets[reader.line_num])
        before = reader.line_num


def _cells(text: str) -> list[tuple[int, int]]:
    """The bounds of the cells of a row, without the blanks around them.

    As in the csv module, a quote opens a cell only at its beginning, and a doubled one stands for itself.
    """
    bounds, start = list[tuple[int, int]](), 0
    blank, opened, quoted = True, False, False
    for index, char in enumerate(text):
        if char == '"' and (blank or opened):
            blank, opened, quoted = False, True, not quoted
        elif char == "," and not quoted:
            bounds.append((start, index))
            start, blank, opened = index + 1, True, False
        elif char != " ":
            blank = False
    bounds.append((start, len(text)))
    return [_trimmed(text, first, last) for first, last in bounds]


def _trimmed(text: str, first: int, last: int) -> tuple[int, int]:
    while first < last and text[first].isspace():
        first += 1
    while first < last and text[last - 1].isspace():
        last -= 1
    return first, last
