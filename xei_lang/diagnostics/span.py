"""Where something stands in a source: offsets are the truth, lines and columns are computed to be shown."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A half-open range of characters `[start, end)` of one file.

    `file` is the path as the user will see it (relative to the working folder where possible).
    Offsets count characters from 0; `Source` turns them into lines, columns and bytes.
    """

    file: str
    start: int
    end: int

    def join(self, other: Span) -> Span:
        """The smallest span that holds both; `other` must be of the same file."""
        return Span(self.file, min(self.start, other.start), max(self.end, other.end))


@dataclass(frozen=True, slots=True)
class Position:
    """A place as people count it: line and column from 1, the column in characters.

    `byte` is a UTF-8 offset.
    """

    line: int
    column: int
    byte: int


@dataclass(frozen=True)
class Source:
    """The text of one file, able to say where an offset stands."""

    file: str
    text: str

    @cached_property
    def _line_starts(self) -> tuple[int, ...]:
        starts = [0]
        starts.extend(index + 1 for index, char in enumerate(self.text) if char == "\n")
        return tuple(starts)

    @property
    def line_count(self) -> int:
        """How many lines the text has; an empty text has one."""
        return len(self._line_starts)

    def position(self, offset: int) -> Position:
        """Line, column and byte of a character offset; offsets past the end stand at the end."""
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(self._line_starts, offset)
        return Position(line, offset - self._line_starts[line - 1] + 1, len(self.text[:offset].encode()))

    def line_number(self, offset: int) -> int:
        """The line of a character offset, counted from 1; cheaper than its whole position."""
        return bisect_right(self._line_starts, max(0, min(offset, len(self.text))))

    def line(self, number: int) -> str:
        """The text of a line, counted from 1, without its line break."""
        start = self._line_starts[number - 1]
        end = self._line_starts[number] if number < self.line_count else len(self.text)
        return self.text[start:end].rstrip("\r\n")

    def slice(self, span: Span) -> str:
        """The words that a span covers."""
        return self.text[span.start : span.end]


Sources = Mapping[str, Source]
"""The texts that a renderer may quote, by `Span.file`."""
