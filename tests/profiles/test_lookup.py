from __future__ import annotations

import shutil

from tests.profiles.changed import SMALL
from xei_lang.diagnostics import Span
from xei_lang.profiles.lookup import find_profile, missing_profile
from xei_lang.resources import resource_path


def test_upward_from_the_protocol_the_nearest_wins(tmp_path):
    outer = tmp_path / "profiles" / "lab"
    inner = tmp_path / "a" / "profiles" / "lab"
    shutil.copytree(SMALL, outer)
    protocol = tmp_path / "a" / "b" / "p.xei"
    protocol.parent.mkdir(parents=True)
    protocol.write_text("")
    assert find_profile("lab", protocol, None) == outer
    shutil.copytree(SMALL, inner)
    assert find_profile("lab", protocol, None) == inner
    assert find_profile("lab", protocol.parent, None) == inner


def test_the_package_is_the_last_place(tmp_path):
    assert find_profile("openarm_bench", tmp_path, None) == resource_path("profiles/openarm_bench")


def test_a_given_folder_is_the_only_place(tmp_path):
    lab = tmp_path / "lab"
    shutil.copytree(SMALL, lab)
    assert find_profile("lab", tmp_path, tmp_path) == lab
    assert find_profile("anything", tmp_path, lab) == lab
    assert find_profile("openarm_bench", tmp_path, tmp_path) is None


def test_what_is_missing_is_told_with_what_there_is(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(SMALL, tmp_path / "profiles" / "lab")
    span = Span("p.xei", 3, 8)
    near = missing_profile("lap", tmp_path / "p.xei", None, span)
    assert (near.code, near.message, near.span) == ("XEI0601", "there is no profile `lap`", span)
    assert near.help == ("did you mean `lab`?",)
    assert "`profiles`" in near.notes[0]
    far = missing_profile("kitchen", tmp_path / "p.xei", None, span)
    assert "`lab` (profiles/lab)" in far.help[0]
    assert "`openarm_bench`" in far.help[0]
    nothing = missing_profile("kitchen", tmp_path, tmp_path / "nowhere", None)
    assert nothing.help == (
        "make a folder `profiles/kitchen` beside the protocol, or name one with --profile",
    )
