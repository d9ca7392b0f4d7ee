"""`xei explain`: every page can be read in a terminal, and what is asked for wrongly is answered."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tests.docs.error_pages import FOLDER, read_page
from xei_lang.cli.explain_command import command
from xei_lang.diagnostics import CATALOGUE


def explain(*arguments: str) -> Result:
    return CliRunner().invoke(command, arguments, env={"COLUMNS": "80"}, prog_name="xei explain")


def test_a_page_whole(golden: Callable[[str, str], None]) -> None:
    golden("cli/explain.txt", explain("XEI0241").output)


@pytest.mark.parametrize("code", CATALOGUE)
def test_every_page_is_shown_whole_within_the_width(code: str) -> None:
    shown = explain(code)
    assert shown.exit_code == 0
    lines = shown.output.splitlines()
    assert lines[0].startswith(f"{code}: ")
    assert all(len(line) <= 80 for line in lines if not line.startswith("    "))
    assert not any(mark in shown.output for mark in ("```", "## ", "---\n", "\x1b"))
    page = (FOLDER / f"{code}.md").read_text(encoding="utf-8")
    words = page.partition("# ")[2].replace("## ", "").split()
    assert [word for word in words if not word.startswith("```")] == shown.output.split()


def test_headings_are_bold_where_that_is_asked_for() -> None:
    shown = explain("XEI0302", "--color", "always").output
    assert "\x1b[1mWhy\x1b[0m" in shown
    assert shown.replace("\x1b[1m", "").replace("\x1b[0m", "") == explain("XEI0302").output


def test_small_letters_do() -> None:
    assert explain("xei0302").output == explain("XEI0302").output


def test_an_unknown_code_is_wrong_usage() -> None:
    near = explain("XEI0399")
    assert near.exit_code == 2
    assert "there is no code `XEI0399`; did you mean `XEI03" in near.output
    far = explain("../../README")
    assert far.exit_code == 2
    assert "`xei explain` lists all codes" in far.output


def test_without_a_code_all_are_listed() -> None:
    lines = explain().output.splitlines()
    assert [line.split()[0] for line in lines if line.startswith("  ")] == list(CATALOGUE)
    assert "  XEI0302  an argument that is missing" in lines
    assert lines[0] == "XEI01xx  files and syntax"


def test_the_pages_are_in_the_package() -> None:
    text = (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    assert '"docs/errors" = "xei_lang/_data/docs/errors"' in text
    assert read_page(FOLDER / "XEI0302.md").title == CATALOGUE["XEI0302"].title
