"""`import table`: CSV files whose header row gives each column its name and type.

`volume [uL]` is a column of quantities in that unit, `tube [object]` one of registered objects, `count [Int]`
one of whole numbers; a name alone is a column of texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from xei_lang.check.cell_values import read_value
from xei_lang.check.csv_cells import CsvRow, NotCsvError, rows
from xei_lang.check.expectation import Expectation
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed, meant
from xei_lang.check.types import ANY_ARM, VALUE_TYPES
from xei_lang.check.units import Unit, read
from xei_lang.check.values import POISON, ListValue, RecordValue, TableValue, Val, Word, number
from xei_lang.diagnostics import Label, Source, Span, did_you_mean
from xei_lang.quantity import UNITS, Quantity, QuantityError, quantity
from xei_lang.syntax.ast import ImportTable
from xei_lang.syntax.loading import Files

MAX_CELLS = 1_000_000
MAX_COLUMNS = 300
"""How many cells and columns one table may have."""

_HEADER = re.compile(r"(?P<name>[^\[\]()]*?)\s*(?:(?P<open>[\[(])(?P<type>[^\[\]()]*)[\])])?")
_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True, slots=True, eq=False)
class _Column:
    """A column: its header in words and place, and how its cells are read (raising ValueError)."""

    name: str
    noun: str
    span: Span
    read: Callable[[str], Val]


def import_table(
    unit: Unit, node: ImportTable, files: Files | None, registry: Registry, reporter: Reporter
) -> Val:
    """The table, or POISON where it cannot be had; a wrong cell is POISON, and reported where it stands."""
    loaded = read(unit.source, node, files, reporter)
    if loaded is None:
        return POISON
    made = _Table(loaded.source, node, registry, reporter)
    try:
        return made.value()
    except NotCsvError as error:
        made.wrong("XEI0123", f"`{node.path.value}` cannot be read as CSV: {error}", error.span)
        return POISON


class _Table:
    def __init__(self, source: Source, node: ImportTable, registry: Registry, reporter: Reporter) -> None:
        self._source = source
        self._node = node
        self._registry = registry
        self._reporter = reporter

    def value(self) -> Val:
        found = rows(self._source)
        header = next(found, None)
        if header is None:
            self.wrong(
                "XEI0123", f"the table `{self._node.path.value}` is empty", Span(self._source.file, 0, 0)
            )
            return POISON
        columns = self._columns(header)
        if columns is None:
            return POISON
        made: list[RecordValue] = []
        for row in found:
            if self._reporter.is_full:
                return POISON
            if (len(made) + 1) * len(columns) > MAX_CELLS:
                self.wrong("XEI0123", f"a table may have {MAX_CELLS} cells", row.span(), "no more from here")
                return POISON
            made.append(self._row(row, header, columns))
        return TableValue(tuple(made), {
            column.name: ListValue(tuple(row.fields[column.name] for row in made)) for column in columns
        })  # fmt: skip

    def wrong(
        self,
        code: str,
        message: str,
        span: Span,
        label: str = "",
        help: tuple[str, ...] = (),
        *,
        labels: tuple[Label, ...] = (),
    ) -> None:
        """Report what is wrong with the file, with the import that led to it."""
        imported = Label(self._node.path.span, f"`{self._node.name.id}` is this table")
        self._reporter.report(code, message, span, label, labels=(*labels, imported), help=help)

    def _columns(self, header: CsvRow) -> list[_Column] | None:
        columns: list[_Column] = []
        if len(header.cells) > MAX_COLUMNS:
            self.wrong("XEI0123", f"a table may have {MAX_COLUMNS} columns", header.span(), "more than that")
            return None
        fine = True
        for index, text in enumerate(header.cells):
            column = self._column(text, header, index)
            twin = column and next((other for other in columns if other.name == column.name), None)
            if column is not None and twin is not None:
                self.wrong(
                    "XEI0123", f"two columns are called `{column.name}`", column.span, "a second one",
                    labels=(Label(twin.span, "the first one"),),
                )  # fmt: skip
            fine = fine and column is not None and twin is None
            if column is not None:
                columns.append(column)
        return columns if fine else None

    def _column(self, text: str, header: CsvRow, index: int) -> _Column | None:
        span = header.span(index)
        match = _HEADER.fullmatch(text)
        name, kind = (match["name"], match["type"]) if match else (text, None)
        if len(header.cells) == 1 and (";" in text or "\t" in self._source.text[header.start : header.end]):
            separator = "`;`" if ";" in text else "a tab"
            help = ("save it with commas between the cells",)
            self.wrong("XEI0123", f"the columns are separated by {separator}", span, "expected commas", help)
            return None
        if match is None or not _NAME.fullmatch(name):
            better = re.sub(r"\W+", "_", name.strip().lower(), flags=re.ASCII).strip("_")
            help = (f"write `{better}`",) if _NAME.fullmatch(better) else ()
            self.wrong(
                "XEI0123", f"`{text}` does not begin with a name", span, "expected a lower-case name", help
            )
            return None
        if match["open"] == "(":
            self.wrong("XEI0123", f"the unit or type of `{name}` stands in round brackets", span,
                       "expected square ones", (f"write `{name} [{kind}]`",))  # fmt: skip
            return None
        reader = self._reader(kind)
        if reader is None:
            near = did_you_mean(kind or "", (*UNITS, *VALUE_TYPES, "object"))
            help = meant(near) or ("write for example `volume [uL]`, `count [Int]`, `tube [object]`",)
            self.wrong("XEI0123", f"`{kind}` is no unit and no type", span, f"the type of `{name}`", help)
            return None
        return _Column(name, reader[0], span, reader[1])

    def _reader(self, kind: str | None) -> tuple[str, Callable[[str], Val]] | None:
        if kind is None:
            return "a text", lambda cell: cell
        if kind in UNITS:
            return f"a number of {kind}", lambda cell: _in_unit(cell, kind)
        if kind not in (*VALUE_TYPES, "object"):
            return None
        expected = Expectation("", kind)
        return expected.noun, lambda cell: _of_type(cell, expected, self._registry)

    def _row(self, row: CsvRow, header: CsvRow, columns: list[_Column]) -> RecordValue:
        if len(row.cells) != len(columns):
            found = f"this row has {len(row.cells)} cells, and the table {len(columns)} columns"
            self.wrong(
                "XEI0124", found, row.span(),
                f"expected {len(columns)} cells", labels=(Label(header.span(), "the columns"),),
            )  # fmt: skip
        cells = (*row.cells, *[""] * len(columns))
        short = len(row.cells) < len(columns)
        return RecordValue(
            {
                column.name: POISON if short else self._cell(cells[index], column, row, index)
                for index, column in enumerate(columns)
            }
        )

    def _cell(self, cell: str, column: _Column, row: CsvRow, index: int) -> Val:
        try:
            if cell:
                return column.read(cell)
            reason = "is empty"
        except QuantityError as error:
            reason = f"is `{cell}`: {error.reason.partition(';')[0]}"
        except ValueError as error:
            reason = f"is `{cell}`: {error}"
        self.wrong(
            "XEI0124",
            f"the cell of `{column.name}` in line {row.number} {reason}",
            row.span(index),
            f"expected {column.noun}",
            labels=(Label(column.span, f"the column `{column.name}`"),),
        )
        return POISON


def _in_unit(cell: str, unit: str) -> Val:
    digits = cell.removeprefix("-").replace(".", "", 1)
    if not (digits.isascii() and digits.isdigit() and len(digits) <= 40):
        raise ValueError(f"the header already says `{unit}`" if cell.endswith(unit) else "not a plain number")
    return number(quantity(Fraction(cell), unit))


def _of_type(cell: str, expected: Expectation, registry: Registry) -> Val:
    value = read_value(cell, expected, registry)
    if expected.type == "Arm" and value not in [Word(arm) for arm in (*registry.arms, ANY_ARM)]:
        raise ValueError(f"arms are {listed((*registry.arms, ANY_ARM))}")
    if expected.type == "Int" and not isinstance(value, int):
        raise ValueError("not a whole number")
    if isinstance(value, Quantity) and value.dimension not in _dimensions(expected.type):
        raise ValueError(f"this is a {value.dimension.name}")
    return value


def _dimensions(name: str) -> tuple[object, ...]:
    from xei_lang.quantity import TYPE_DIMENSIONS

    return TYPE_DIMENSIONS[name]
