"""The grammar has no conflict, and its tables survive every state of the cache."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from lark import Lark
from lark.exceptions import GrammarError, UnexpectedToken

from tests.syntax import corpus
from tests.syntax.corpus import in_protocol
from xei_lang.quantity import UNITS
from xei_lang.resources import resource_path
from xei_lang.syntax.generate import make_tables
from xei_lang.syntax.tables import STARTS, load_tables

GRAMMAR = resource_path("grammar/xei.lark").read_text(encoding="utf-8")
PLAIN = Lark(GRAMMAR, parser="lalr", start=list(STARTS))


def test_grammar_has_no_conflict() -> None:
    tables = make_tables(GRAMMAR, strict=True)
    assert set(tables.start_states) == {"module", "predicate", "expression", "role_expression"}


@pytest.mark.parametrize(
    "change",
    [
        ('| sum "-" term -> binary', '| sum "-" term -> binary\n    | sum "+" term -> other'),
        ("step: [label] action clause*", "step: [label] action clause* clause*"),
    ],
)
def test_a_conflict_would_be_found(change: tuple[str, str]) -> None:
    assert change[0] in GRAMMAR
    with pytest.raises(GrammarError):
        make_tables(GRAMMAR.replace(*change), strict=True)


@pytest.mark.parametrize("text", [*map(in_protocol, corpus.MEMBERS.values()), *corpus.FILES.values()])
def test_grammar_stands_by_itself(text: str) -> None:
    """Plain lark accepts what xei accepts, but where it takes a name for a keyword of another context."""
    if "let a = b times:" in text:
        with pytest.raises(UnexpectedToken):
            PLAIN.parse(text, start="module")
        return
    PLAIN.parse(text, start="module")


def test_grammar_lists_the_units_that_there_are() -> None:
    pattern = dict(make_tables(GRAMMAR).patterns)["QUANTITY"]
    for symbol in UNITS:
        match = re.match(pattern, f"2 {symbol}")
        assert match is not None, symbol
        assert match[0] == f"2 {symbol}"
    listed = pattern[pattern.index("((") + 2 : pattern.index(")(?!")].replace("\\", "").split("|")
    assert {*listed, "%"} == set(UNITS)


def test_cache_gives_the_same_tables(tmp_path: Path) -> None:
    made = load_tables(tmp_path)
    assert (tmp_path / "grammar.table").is_file()
    assert load_tables(tmp_path) == made == make_tables(GRAMMAR)


@pytest.mark.parametrize("damage", [b"", b"xx", b"\0" * 5000, "truncate", "flip"])
def test_corrupt_cache_is_made_anew(
    tmp_path: Path, damage: bytes | str, capfd: pytest.CaptureFixture[str]
) -> None:
    made = load_tables(tmp_path)
    path = tmp_path / "grammar.table"
    whole = path.read_bytes()
    if damage == "truncate":
        path.write_bytes(whole[: len(whole) // 2])
    elif damage == "flip":
        path.write_bytes(whole[:2000] + bytes([whole[2000] ^ 1]) + whole[2001:])
    else:
        assert isinstance(damage, bytes)
        path.write_bytes(damage)
    damaged = path.read_bytes()
    assert load_tables(tmp_path) == made
    assert path.read_bytes() != damaged
    assert capfd.readouterr() == ("", "")


def test_unwritable_cache_is_no_error(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    assert load_tables(blocked / "xei") == make_tables(GRAMMAR)
    assert capfd.readouterr() == ("", "")


def test_warm_parser_does_not_import_lark(tmp_path: Path) -> None:
    code = (
        "import sys\n"
        "from xei_lang.syntax import parse_module\n"
        "from xei_lang.diagnostics import Source\n"
        "assert parse_module(Source('a.xei', 'protocol p { wait 1 s }'))[1] == ()\n"
        "heavy = ('lark', 'numpy', 'pydantic', 'click', 'yaml', 'networkx', 'pinocchio')\n"
        "print([name for name in heavy if name in sys.modules])\n"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(Path(__file__).parents[2])},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        for _ in range(2)
    ]
    assert outputs == ["['lark']", "[]"]
