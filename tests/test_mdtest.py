"""The helpers of the tests must themselves be able to fail."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import conftest
from tests.mdtest import run_markdown

PAGE = (
    "# Title\n\n## One\n\n```xei\na\n```\n\nProse.\n\n```text\nA\n```\n\n## Two\n\n```xei\nb\n```\n\nEnd.\n"
)


def test_differences_are_found_and_named(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_text(PAGE)
    with pytest.raises(AssertionError, match="## Two\nno expected block"):
        run_markdown(path, str.upper)
    path.write_text(PAGE.replace("A\n", "X\n"))
    with pytest.raises(AssertionError, match=r"## One\n(.*\n)*-X\n\+A"):
        run_markdown(path, str.upper)


def test_update_writes_blocks_and_keeps_prose(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_text(PAGE.replace("A\n", "X\n"))
    run_markdown(path, str.upper, update=True)
    assert path.read_text() == PAGE.replace("b\n```\n", "b\n```\n\n```text\nB\n```\n")
    run_markdown(path, str.upper)


def test_a_page_without_input_fails(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_text("# Title\n")
    with pytest.raises(AssertionError, match="no input block"):
        run_markdown(path, str.upper)


def test_golden_compares_and_misses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conftest, "GOLDEN", tmp_path)
    compare, update = conftest.golden_comparer(update=False), conftest.golden_comparer(update=True)
    with pytest.raises(pytest.fail.Exception, match="is missing"):
        compare("a.txt", "text\n")
    update("a.txt", "text\n")
    compare("a.txt", "text\n")
    with pytest.raises(AssertionError, match="differs from"):
        compare("a.txt", "other\n")
