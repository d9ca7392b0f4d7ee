"""The compiled form of a profile: right when nothing changed, absent when anything is odd, and cheap."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from tests.profiles.changed import changed_profile
from xei_lang.profiles import compiled
from xei_lang.profiles.files import read_folder
from xei_lang.profiles.load import load_profile
from xei_lang.syntax.ast import equal_up_to_spans

ROOT = Path(__file__).parents[2]
HEAVY = ("yaml", "pydantic", "numpy", "xml.etree.ElementTree", "pinocchio", "networkx", "jsonschema")


@pytest.fixture
def lab(tmp_path):
    return changed_profile(tmp_path, "usage_profile.yaml")


def forbid_building(monkeypatch):
    def fail(*_args):
        raise AssertionError("the profile was built anew")

    monkeypatch.setattr("xei_lang.profiles.build.build_profile", fail)


def test_an_unchanged_profile_comes_back_whole(lab, tmp_path, monkeypatch):
    built, nothing = load_profile(lab, tmp_path / "cache")
    assert built is not None
    assert nothing == ()
    forbid_building(monkeypatch)
    loaded, nothing = load_profile(lab, tmp_path / "cache")
    assert nothing == ()
    assert loaded is not None
    assert loaded.objects == built.objects
    assert loaded.calibration == built.calibration
    assert loaded.robot == built.robot
    before, after = (
        [rule for skill in profile.bank.skills for rule in skill.requires + skill.ensures]
        for profile in (built, loaded)
    )
    assert before
    for old, new in zip(before, after, strict=True):
        assert old.span == new.span
        assert equal_up_to_spans(old.predicate, new.predicate)


def test_warnings_come_back_too(tmp_path, monkeypatch):
    lab = changed_profile(
        tmp_path, "development_profile.yaml\n- movable & not fixture\n+ movable & not fragile"
    )
    _, warned = load_profile(lab, tmp_path / "cache")
    forbid_building(monkeypatch)
    assert [found.code for found in warned] == ["XEI0625"]
    assert load_profile(lab, tmp_path / "cache")[1] == warned


@pytest.mark.parametrize("file", ["usage_profile.yaml", "robot/small.urdf", "robot/small.srdf"])
def test_any_changed_byte_is_seen(lab, tmp_path, file):
    first, _ = load_profile(lab, tmp_path / "cache")
    with open(lab / file, "a", encoding="utf-8") as opened:
        opened.write("\n")
    second, _ = load_profile(lab, tmp_path / "cache")
    assert first is not None
    assert second is not None
    assert dict(first.files)[file] != dict(second.files)[file]
    assert len(list((tmp_path / "cache").iterdir())) == 2


@pytest.mark.parametrize("garbage", [b"", b"\x80", b"not a pickle", pickle.dumps((1, 2)), pickle.dumps(1)])
def test_a_damaged_cache_is_ignored(lab, tmp_path, garbage):
    cache = tmp_path / "cache"
    load_profile(lab, cache)
    (stored,) = cache.iterdir()
    whole = stored.read_bytes()
    for data in (garbage, whole[: len(whole) // 2]):
        stored.write_bytes(data)
        assert load_profile(lab, cache)[0] is not None
        assert stored.read_bytes()[:2] == whole[:2]


class Bomb:
    def __reduce__(self):
        return os.mkdir, ("exploded",)


@pytest.mark.parametrize("protocol", range(6))
def test_a_cache_that_somebody_else_wrote_runs_no_code(lab, tmp_path, monkeypatch, protocol):
    monkeypatch.chdir(tmp_path)
    cache = tmp_path / "cache"
    load_profile(lab, cache)
    (stored,) = cache.iterdir()
    stored.write_bytes(pickle.dumps((Bomb(), ()), protocol=protocol))
    assert compiled.read(cache, compiled.key_of(read_folder(lab))) is None
    assert not (tmp_path / "exploded").exists()


def test_a_name_that_a_module_imports_is_no_way_out(tmp_path):
    """`xei_lang.profiles.compiled` imports os: a dotted name must not lead through it."""
    data = b"\x80\x04\x8c\x1bxei_lang.profiles.compiled\x94\x8c\x08os.mkdir\x94\x93\x94."
    (tmp_path / f"profile-{'0' * 40}.pickle").write_bytes(data)
    assert compiled.read(tmp_path, "0" * 64) is None


def test_a_cache_that_cannot_be_written_costs_nothing_but_time(lab, tmp_path):
    (tmp_path / "file").write_text("")
    assert load_profile(lab, tmp_path / "file")[0] is not None
    assert load_profile(lab, tmp_path / "file" / "below")[0] is not None
    assert (tmp_path / "file").read_text() == ""


def test_a_broken_profile_is_not_stored(tmp_path):
    lab = changed_profile(tmp_path, "usage_profile.yaml\n- mass: 6.5 g\n+ mass: 6.5 mm")
    assert load_profile(lab, tmp_path / "cache")[0] is None
    assert not (tmp_path / "cache").exists()


def test_the_default_place_follows_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert compiled.default_cache() == tmp_path / "xei"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative/is/ignored")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert compiled.default_cache() == tmp_path / ".cache" / "xei"


def test_an_unchanged_profile_needs_nothing_heavy(tmp_path):
    program = f"""
import sys
from pathlib import Path
from xei_lang.profiles.load import load_profile
from xei_lang.world import places
profile, found = load_profile(Path("profiles/openarm_bench"), Path({str(tmp_path)!r}))
assert profile is not None, found
assert places.slots(profile.object("rack_1"))
print(*[name for name in {HEAVY!r} if name in sys.modules])
"""
    cold, warm = (
        subprocess.run([sys.executable, "-c", program], cwd=ROOT, text=True, capture_output=True, check=True)
        for _ in range(2)
    )
    assert "pydantic" in cold.stdout
    assert warm.stdout.strip() == ""


def test_a_change_behind_a_link_is_seen(lab, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "robot.urdf").write_text("<robot/>", encoding="utf-8")
    (lab / "linked").symlink_to(elsewhere)
    (lab / "itself").symlink_to(lab)
    before = compiled.key_of(read_folder(lab))
    assert before == compiled.key_of(read_folder(lab))
    (elsewhere / "robot.urdf").write_text("<robot />", encoding="utf-8")
    assert compiled.key_of(read_folder(lab)) != before
