"""What the program says where the robot cannot do what is asked: object, arm, distance, what would help."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, Ran, xei


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A working folder with a copy of the bench's profile."""
    shutil.copytree(PROFILES, tmp_path / "profiles")
    return tmp_path


def compiled(lab: Path, *steps: str) -> Ran:
    body = "\n".join(f"  {step}" for step in steps)
    (lab / "asked.xei").write_text(f'xei 1\nprotocol asked {{\n  profile "openarm_bench"\n{body}\n}}\n')
    ran = xei("compile", "asked.xei", "-o", "out", cwd=lab)
    assert ran.code == 1, ran.err
    assert not (lab / "out").exists()
    return ran


def changed(lab: Path, *pairs: tuple[str, str]) -> None:
    """The usage profile with texts replaced, each of which stands in it once."""
    usage = lab / "profiles" / "openarm_bench" / "usage_profile.yaml"
    text = usage.read_text(encoding="utf-8")
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    usage.write_text(text, encoding="utf-8")


def test_a_thing_out_of_reach_is_measured_and_a_station_offered(lab: Path) -> None:
    ran = compiled(lab, "pick(object=beaker_2)")
    assert "error[XEI0801]: the right arm cannot reach `beaker_2`" in ran.err
    assert "asked.xei:4:3" in ran.err
    assert "mm out of reach, with the slide at" in ran.err
    assert "the left arm was tried as well: the left arm cannot reach `beaker_2`" in ran.err
    assert "= help: it is in reach from `bench_b`: drive there first (`nav_to(station=bench_b)`)" in ran.err


def test_a_blocked_way_names_its_two_bodies_and_what_opens_it(lab: Path) -> None:
    # The bin hovers where the left arm hangs at first.
    changed(
        lab,
        (
            "{frame: table, position: [0.16 m, -0.52 m, 0 m]",
            "{frame: table, position: [-0.16 m, 0.16 m, 0 m]",
        ),
    )
    ran = compiled(lab, "pick(object=tube_1, arm=left)")
    assert "error[XEI0803]: the way of " in ran.err
    assert "`openarm_left_" in ran.err
    assert "would touch `waste_bin`" in ran.err
    assert "bound" not in ran.err


def test_a_slot_between_filled_neighbours_that_no_grasp_fits(lab: Path) -> None:
    tight = 'rack_2.slot("{}")'
    around = {"tube_2": "A2", "tube_3": "B1", "tube_4": "B3", "tube_5": "C2"}
    homes = {"tube_2": "A2", "tube_3": "A3", "tube_4": "A4", "tube_5": "B1"}
    usage = lab / "profiles" / "openarm_bench" / "usage_profile.yaml"
    head, rack_2 = usage.read_text(encoding="utf-8").split("  rack_2:", 1)
    rack_2 = rack_2.replace("pitch: [60 mm, 60 mm]", "pitch: [24 mm, 24 mm]", 1)
    usage.write_text(f"{head}  rack_2:{rack_2}", encoding="utf-8")
    changed(
        lab,
        *(
            (f"in: 'rack_1.slot(\"{homes[tube]}\")'", f"in: '{tight.format(slot)}'")
            for tube, slot in around.items()
        ),
    )
    ran = compiled(lab, "pick(object=tube_1)", 'insert(object=tube_1, into=rack_2.slot("B2"))')
    assert "error[XEI0802]: no grasp brings the " in ran.err
    assert 'hand to `rack_2.slot("B2")` with `tube_1`: every grasp in reach touches' in ran.err
    assert any(f"touch `{tube}`" in ran.err or f"touches `{tube}`" in ran.err for tube in around)
    assert "= help: choose a place farther from `tube_" in ran.err
