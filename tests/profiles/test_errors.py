from __future__ import annotations

import itertools
import os
from pathlib import Path

import pytest

from tests.profiles.changed import changed_profile
from xei_lang.diagnostics import has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.sources import folder_sources


def test_every_mistake_is_told_with_its_place(markdown, tmp_path, monkeypatch):
    count = itertools.count()

    def produce(edit: str) -> str:
        place = tmp_path / str(next(count))
        place.mkdir()
        monkeypatch.chdir(place)
        lab = changed_profile(place, edit)
        profile, diagnostics = load_profile(lab, None)
        assert diagnostics, f"nothing is said about {edit}"
        assert (profile is None) == has_errors(diagnostics)
        return render_full(diagnostics, folder_sources(lab))

    markdown(Path(__file__).parent / "errors.md", produce)


def test_a_file_that_is_not_utf8(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    (lab / "usage_profile.yaml").write_bytes("version: 1\nobjects: {ä: ".encode() + b"\xff}")
    _, (found,) = load_profile(lab, None)
    assert (found.code, found.label) == ("XEI0602", "byte 0xff at line 2, byte 15")
    position = folder_sources(lab)["lab/usage_profile.yaml"].position(found.span.start)
    assert (position.line, position.column) == (2, 14)


def test_a_pipe_is_no_file_of_a_profile(tmp_path):
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    (lab / "usage_profile.yaml").unlink()
    os.mkfifo(lab / "usage_profile.yaml")
    _, (found,) = load_profile(lab, None)
    assert (found.code, found.message) == (
        "XEI0602", "`usage_profile.yaml` cannot be read: it is no regular file")  # fmt: skip


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "XEI0603"),
        ("- a\n- b\n", "XEI0603"),
        ("[" * 100_000, "XEI0603"),
        ("{a: " * 50 + "1" + "}" * 50, "XEI0603"),
        ("? [a, b]\n: 1\n", "XEI0603"),
        ("version: 1\n<<: {}\n", "XEI0605"),
        ("a: &a [x]\n" + "".join(f"b{i}: &b{i} [*a, *a]\n" for i in range(50)), "XEI0605"),
        ("\ufeffversion: 1\n", "XEI0602"),
        ("\x00", "XEI0603"),
        ("x: " + "a" * 2_000_001, "XEI0602"),
    ],
)
def test_hostile_yaml_is_a_diagnostic(tmp_path, text, code):
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    (lab / "usage_profile.yaml").write_text(text, encoding="utf-8")
    profile, diagnostics = load_profile(lab, None)
    assert profile is None
    assert code in {found.code for found in diagnostics}


def test_a_folder_where_a_file_should_be(tmp_path):
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    (lab / "usage_profile.yaml").unlink()
    (lab / "usage_profile.yaml").mkdir()
    _, (found,) = load_profile(lab, None)
    assert found.code == "XEI0602"


def test_no_folder_and_no_folder_but_a_file(tmp_path):
    assert load_profile(tmp_path / "nowhere", None)[1][0].code == "XEI0601"
    (tmp_path / "file").write_text("")
    assert load_profile(tmp_path / "file", None)[1][0].code == "XEI0601"


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads every file")
def test_an_unreadable_file(tmp_path):
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    (lab / "usage_profile.yaml").chmod(0)
    assert load_profile(lab, None)[1][0].code == "XEI0602"
