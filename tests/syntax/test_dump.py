from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.syntax.corpus import MEMBERS, in_protocol
from xei_lang.diagnostics import Source
from xei_lang.syntax import ast
from xei_lang.syntax.dump import to_text
from xei_lang.syntax.parser import parse_module

SMALL = """xei 1

## Cools a tube.
protocol cool {
  profile "openarm_bench"
  param time: Time = 1.5 min in 1 min .. 2 min   # how long
  object tube: movable & not fragile = tube_1
  first: pick(object=tube)
  for i, ok in zip([1, 2], [true, false]) unordered { wait -time * 2 after first by 0 s .. 1 min }
}
"""


def _parsed(text: str) -> tuple[ast.Module, Source]:
    source = Source("small.xei", text)
    module, problems = parse_module(source)
    assert module is not None, problems
    return module, source


def test_a_tree_in_words(golden: Callable[[str, str], None]) -> None:
    golden("syntax/tree.txt", to_text(*_parsed(SMALL)))


@pytest.mark.parametrize("member", MEMBERS.values(), ids=MEMBERS.keys())
def test_every_node_has_its_line(member: str) -> None:
    module, source = _parsed(in_protocol(member))
    assert to_text(module, source).count("\n") == sum(1 for _ in ast.walk(module))
