"""Files that come with xei are found in a working copy and in an installed package."""

from __future__ import annotations

from pathlib import Path

import pytest

from xei_lang import resources
from xei_lang.resources import resource_path


def test_working_copy() -> None:
    assert resource_path("grammar/xei.lark") == Path(__file__).parents[1] / "grammar" / "xei.lark"
    assert resource_path("grammar/xei.lark").is_file()


def test_installed_package_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "site-packages" / "xei_lang"
    (package / "_data" / "grammar").mkdir(parents=True)
    (package / "_data" / "grammar" / "xei.lark").touch()
    monkeypatch.setattr(resources, "_PACKAGE", package)
    assert resource_path("grammar/xei.lark") == package / "_data" / "grammar" / "xei.lark"
    assert resource_path("profiles/none") == tmp_path / "site-packages" / "profiles" / "none"
