"""A file with syntax errors is checked as far as it could be read; nothing follows from what could not."""

from __future__ import annotations

import random
from pathlib import Path

from tests.syntax.mistakes import KINDS, slip
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.pipeline import FRONT, Request, check_request, compile_request
from xei_lang.syntax import Parser

ROOT = Path(__file__).parents[2]
PARSER = Parser()

TEXT = """protocol p {
  profile "openarm_bench"
  object beaker: movable = beaker_2
  go: nav_to(station=bench_b)
  let height = 250 mm;
  rise: slide_to(height=height, tempo=3)
  wait 5 mL
  place(object=beaker on=table.spot("beaker"))
}
"""


def check(text: str) -> Diagnostics:
    source = Source("protocols/t.xei", text)
    return check_request(Request(source, profile_folder=ROOT / "profiles/openarm_bench", open_bindings=True))


def test_statements_that_could_be_read_are_checked() -> None:
    source = Source("protocols/t.xei", TEXT)
    found = [(source.line_number(item.span.start), item.code[:5]) for item in check(TEXT) if item.span]
    assert found == [(5, "XEI01"), (8, "XEI01"), (6, "XEI03"), (7, "XEI03")]


def test_unknown_names_are_told_unless_their_declaration_may_be_lost() -> None:
    step, lost = "protocol p {\n  go: nav_to(station=nowhere)\n  wait 5 s;\n", "  let = 5 s\n"
    assert [item.code for item in check(step + "}\n")] == ["XEI0104", "XEI0202"]
    assert [item.code for item in check(step + lost + "}\n")] == ["XEI0104", "XEI0104"]


def test_compiling_stops_at_the_first_pass_with_errors() -> None:
    source = Source("protocols/t.xei", TEXT)
    request = Request(source, profile_folder=ROOT / "profiles/openarm_bench", open_bindings=True)
    outcome = compile_request(request, FRONT)
    assert outcome.stopped_at == "parse"
    assert outcome.made.plan is None


def test_nothing_follows_from_a_syntax_error() -> None:
    """Slips in protocols that check without a finding: all that is said is what the parser says."""
    rng = random.Random(3)
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "protocols").glob("*.xei"))]
    texts = [text for text in texts if check(text) == ()]
    assert texts
    for number in range(100):
        lines = rng.choice(texts).split("\n")
        made = slip(rng, lines, list(KINDS)[number % len(KINDS)])
        text = "\n".join(lines)
        if made is not None:
            assert check(text) == PARSER.module(Source("protocols/t.xei", text))[1], text
