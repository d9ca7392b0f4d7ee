"""Files that can and cannot be read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from xei_lang.diagnostics import Diagnostic
from xei_lang.syntax import reading
from xei_lang.syntax.reading import read_source


def failure(path: Path) -> Diagnostic:
    source, diagnostics = read_source(path, path.name)
    assert source is None
    (found,) = diagnostics
    return found


def test_text_is_kept_but_for_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "a.xei"
    path.write_bytes(b"\xef\xbb\xbfprotocol p {\r\n}\r\n")
    source, diagnostics = read_source(path, "shown.xei")
    assert diagnostics == ()
    assert source is not None
    assert (source.file, source.text) == ("shown.xei", "protocol p {\r\n}\r\n")


def test_missing_file(tmp_path: Path) -> None:
    found = failure(tmp_path / "a.xei")
    assert (found.code, found.message) == ("XEI0101", "`a.xei` does not exist")


def test_folder(tmp_path: Path) -> None:
    found = failure(tmp_path)
    assert found.code == "XEI0101"
    assert found.message.endswith("is a folder, not a file")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_forbidden_file(tmp_path: Path) -> None:
    path = tmp_path / "a.xei"
    path.touch(mode=0o000)
    assert failure(path).message == "`a.xei` may not be read"


def test_impossible_name(tmp_path: Path) -> None:
    assert failure(tmp_path / "a\0b").code == "XEI0101"
    assert failure(tmp_path / ("a" * 5000)).code == "XEI0101"


def test_not_utf8(tmp_path: Path) -> None:
    path = tmp_path / "a.xei"
    path.write_bytes(b'protocol p {\n  note "\xb5L"\n}\n')
    found = failure(path)
    assert (found.code, found.message) == ("XEI0102", "`a.xei` is not UTF-8 text")
    assert found.notes == ("byte 0xB5 in line 2, at offset 21",)
    path.write_bytes("protocol".encode("utf-16"))
    assert failure(path).help == ("it looks like UTF-16; save it as UTF-8",)


def test_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MAX_BYTES", 2 * 1024 * 1024)
    path = tmp_path / "a.xei"
    path.write_bytes(b"#" * (2 * 1024 * 1024 + 1))
    assert (failure(path).code, failure(path).message) == ("XEI0107", "`a.xei` is larger than 2 MiB")
