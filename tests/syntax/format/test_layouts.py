"""What formatted protocols look like."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from xei_lang.diagnostics import Source
from xei_lang.syntax.format import WIDTH, Formatter, format_source

ROOT = Path(__file__).parents[3]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]
BLOCK = re.compile(r"^```xei\n(.*?)^```", re.DOTALL | re.MULTILINE)
PIECE = "protocol piece {{\n{}}}\n"
WHOLE = re.compile(r"^(xei \d|import|protocol|procedure)\b", re.MULTILINE)
FORMATTER = Formatter()


def formatted(text: str) -> str:
    result, diagnostics = FORMATTER.format(Source("t.xei", text))
    assert result is not None, [diagnostic.message for diagnostic in diagnostics]
    return result


def test_layouts(markdown: Callable[[Path, Callable[[str], str]], None]) -> None:
    markdown(Path(__file__).with_name("layouts.md"), formatted)


def test_long_lines_are_broken() -> None:
    text = (Path(__file__).with_name("layouts.md")).read_text(encoding="utf-8")
    for block in re.findall(r"^```text\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        assert all(len(line) <= WIDTH for line in block.splitlines())


@pytest.mark.parametrize("path", sorted((ROOT / "protocols").glob("**/*.xei")), ids=lambda path: path.name)
def test_the_protocols_of_the_project_are_formatted(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert formatted(text) == text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_protocols_of_the_documentation_are_formatted(page: Path) -> None:
    for block in re.findall(
        r"^```xei\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    ):
        text = block if WHOLE.search(block) else PIECE.format(re.sub(r"^(?=.)", "  ", block, flags=re.M))
        result, diagnostics = FORMATTER.format(Source("t.xei", text))
        if result is None:  # a page about mistakes
            assert diagnostics
        else:
            assert result == text, f"{page.name} should show\n{result}"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "# only this",
        'import "a.xei"\n',
        "protocol p {",
        "protocol p { wait 5 ul }",
        'protocol p { note "\\q" }',
    ],
)
def test_what_has_errors_is_not_formatted(text: str) -> None:
    result, diagnostics = format_source(Source("t.xei", text))
    assert result is None
    assert diagnostics


def test_long_files_are_formatted_in_linear_time() -> None:
    one = '  pour(source=a, target=rack.slot("A1"), volume=2 mL) # so\n'
    result = formatted("protocol p {\n" + one * 3000 + "}\n")
    assert result.count("\n") == 3002
    assert formatted("protocol p { let x = [" + "1, " * 5000 + "] }").count("\n") == 5004
