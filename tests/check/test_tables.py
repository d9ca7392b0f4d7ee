"""Tables: rows as records, columns as lists, and spans that lead to the very cell."""

from __future__ import annotations

import csv
import io
import subprocess
import sys

from hypothesis import given
from hypothesis import strategies as st

from tests.check.checking import check, plan_of, protocol
from xei_lang.check.csv_cells import NotCsvError, rows
from xei_lang.diagnostics import Source
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.quantity import quantity

TABLE = """
# file: t.csv
tube [object], volume [uL], name, count [Int], dark [Bool], place [Place]
tube_1, 1500, "a, b", 2, true, "rack_2.slot(""A1"")"
tube_2, 0.75e0, c, 1, false, table
"""


def test_rows_are_records_and_columns_are_lists() -> None:
    body = """
      for row in t {
        if row.dark { repeat row.count times { pour(source=cup_1, target=row.tube, volume=row.volume) } }
        if row.name == "a, b" { place(object=row.tube, on=row.place) }
      }
      wait sum(t.volume) / (1 mL / 1 s)
      for tube, v in zip(t.tube, t.volume) { pour(source=cup_1, target=tube, volume=v) }
      repeat len(t) times { confirm "again" }
      pour(source=cup_1, target=t[2].tube, volume=t[2].volume)
    """
    text = f'import table "t.csv" as t\n{protocol(body)}{TABLE.replace("0.75e0", "750")}'
    steps = plan_of(text).steps
    assert [step.skill or step.kind for step in steps] == [
        "pour", "pour", "place", "wait", "pour", "pour", "confirm", "confirm", "pour",
    ]  # fmt: skip
    assert steps[0].arg("volume") == quantity(1500, "uL")
    assert steps[3].duration_s == (2.25, 2.25)
    assert steps[8].arg("target") == ObjectRef("tube_2")


def test_a_wrong_cell_is_shown_in_its_file_and_column() -> None:
    _, found = check(f'import table "t.csv" as t\n{protocol("for row in t { wait 1 s }")}{TABLE}')
    assert [(item.code, item.span and item.span.file) for item in found] == [("XEI0124", "t.csv")]
    span = found[0].span
    assert span is not None
    assert TABLE.partition("t.csv\n")[2][span.start : span.end] == "0.75e0"


def test_tables_belong_to_the_file_that_imports_them() -> None:
    files = (
        '# file: lib/a.xei\nimport table "../t.csv" as t\n'
        "procedure all() { for row in t { wait row.time } }\n"
        "# file: t.csv\ntime [s]\n1\n2\n"
    )
    assert len(plan_of(f'import "lib/a.xei"\n{protocol("all()")}{files}').steps) == 2
    assert [item.code for item in check(f'import "lib/a.xei"\n{protocol("wait t[1].time")}{files}')[1]] == [
        "XEI0202"
    ]


CELLS = st.text(st.sampled_from('ab1 ,"\n\r;\u2028é'), max_size=6)


@given(st.lists(st.lists(CELLS, min_size=1, max_size=4), min_size=1, max_size=5))
def test_cells_are_those_that_the_csv_module_wrote_and_stand_where_they_are_said_to(
    table: list[list[str]],
) -> None:
    text = io.StringIO(newline="")
    csv.writer(text).writerows(table)
    found = list(rows(Source("t.csv", text.getvalue())))
    written = [[cell.strip() for cell in row] for row in table]
    assert [list(row.cells) for row in found] == [row for row in written if any(row)]
    for row in found:
        for column, cell in enumerate(row.cells):
            shown = text.getvalue()[row.span(column).start : row.span(column).end]
            unquoted = shown[1:-1].replace('""', '"').strip() if shown.startswith('"') else shown
            assert unquoted == cell


@given(st.text(st.sampled_from('ab1 ,"\n\r;\x00[]()uL'), max_size=60))
def test_no_text_makes_a_table_raise(text: str) -> None:
    try:
        for row in rows(Source("t.csv", text)):
            for column in range(len(row.cells)):
                row.span(column)
    except NotCsvError:
        pass
    _, found = check(
        f'import table "t.csv" as t\n{protocol("for row in t {{ wait 1 s }}")}\n# file: t.csv\n{text}'
    )
    assert {item.code for item in found} <= {"XEI0123", "XEI0124", "XEI0501"}


def test_csv_is_imported_only_for_a_table() -> None:
    code = "import sys, xei_lang.check; print('csv' in sys.modules or 'xei_lang.check.tables' in sys.modules)"
    done = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_part_of_a_table_has_its_columns() -> None:
    text = """import table "t.csv" as t
protocol p {
  profile "lab"
  wait sum(t[2 .. 3].rest)
  for part in chunks(t, 2) { wait sum(part.rest) }
  wait shuffle(t, seed=3).rest[1] + [row for row in t if row.n > 1][1].rest
  for rest in t[2 .. 1].rest { wait rest }
}
# file: t.csv
n [Int],rest [s]
1,5
2,7
3,9
"""
    waits = [str(step.arg("duration")) for step in plan_of(text).steps]
    assert waits == ["16 s", "12 s", "9 s", "16 s"]
