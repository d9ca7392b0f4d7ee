"""What is said of wrong protocols: each page is a test, and every code of the checker stands on one."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from tests.check.checking import check, rendered, rendered_plan
from xei_lang.diagnostics import CATALOGUE

PAGES = sorted((Path(__file__).parent / "errors").glob("*.md"))
ELSEWHERE = {"XEI0125", "XEI0321", "XEI0326"}
"""What the command line says of a baseline (tests/cli), what no text of a bearable length can show (see
test_expand.py), and what needs objects that list their skills (see test_allowed.py).
"""


def produce(text: str) -> str:
    """What the checker says; a first line `# options: --bind a=b --param c=d --open` sets its options.

    A text that begins as JSON does is a plan.
    """
    if text.startswith(("{", "[")):
        return rendered_plan(text)
    first = text.partition("\n")[0]
    words = shlex.split(first.removeprefix("# options:")) if first.startswith("# options:") else []
    pairs = {"--bind": {}, "--param": {}}
    for flag, value in pairwise(words):
        if flag in pairs:
            name, _, given = value.partition("=")
            pairs[flag][name] = given
    options = {"bindings": pairs["--bind"], "params": pairs["--param"], "open_bindings": "--open" in words}
    return rendered(text, check(text, **options)[1])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_messages(page: Path, markdown: Callable[[Path, Callable[[str], str]], None]) -> None:
    markdown(page, produce)


def test_every_code_of_the_checker_is_shown() -> None:
    shown = {
        code for page in PAGES for code in re.findall(r"\[(XEI\d{4})\]", page.read_text(encoding="utf-8"))
    }
    ours = {
        code
        for code in CATALOGUE
        if "XEI0120" <= code < "XEI0130"
        or "XEI0201" <= code < "XEI0240"
        or code.startswith(("XEI03", "XEI05"))
    }
    assert ours - shown == ELSEWHERE
