"""How long a drive takes: straight without a map, along its way with one."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.world.map.lab import mapped_lab, room, with_box
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.ir.goals import MotionGoal, NavToPose
from xei_lang.pipeline import ALL, Outcome, Request, compile_request

PROTOCOL = 'protocol there {\n  profile "lab"\n  nav_to(station=bench_b)\n}\n'
TO_TIMED = ALL[: [step.adds for step in ALL].index("timed") + 1]


def compiled(folder: Path) -> Outcome:
    return compile_request(Request(Source("there.xei", PROTOCOL), profile_folder=folder), TO_TIMED)


def drive_of(outcome: Outcome) -> tuple[MotionGoal, float]:
    assert outcome.made.graph is not None, outcome.diagnostics
    assert outcome.made.timed is not None, outcome.diagnostics
    [goal] = [goal for goal in outcome.made.graph.goals if isinstance(goal.action, NavToPose)]
    [timed] = [one for one in outcome.made.timed.goals if one.id == goal.id]
    return goal, timed.end_s - timed.start_s


def said(outcome: Outcome) -> set[str]:
    found: Diagnostics = outcome.diagnostics
    return {one.code for one in found} & {"XEI0665", "XEI0666", "XEI0677", "XEI0678"}


STRAIGHT_S = 2.2 / 0.3 + 1.5707963 / 0.65


def test_a_way_around_a_box_takes_its_own_time_and_says_why(tmp_path: Path) -> None:
    around = with_box(room(lower=(-2.5, -3.5)), (-0.2, 0.2), (-1.3, -1.0))
    goal, lasts_s = drive_of(compiled(mapped_lab(tmp_path, around)))
    assert lasts_s == pytest.approx(goal.min_duration_s)
    assert lasts_s > STRAIGHT_S + 1.0
    told = {parameter.name: parameter for parameter in goal.parameters}
    assert told["drive_length"].source == "computed"
    assert "map" in told["drive_length"].rule


def test_a_free_floor_is_driven_over_as_without_a_map(tmp_path: Path) -> None:
    outcome = compiled(mapped_lab(tmp_path, room()))
    assert said(outcome) == set()
    assert drive_of(outcome)[1] == pytest.approx(STRAIGHT_S, abs=1e-5)


def test_a_map_without_a_way_warns_and_the_simulation_drives_straight(tmp_path: Path) -> None:
    outcome = compiled(mapped_lab(tmp_path, with_box(room(), (-1.5, 1.5), (-1.2, -1.1))))
    assert said(outcome) == {"XEI0678"}
    goal, lasts_s = drive_of(outcome)
    assert goal.min_duration_s == 0.0 and goal.parameters == ()
    assert lasts_s == pytest.approx(STRAIGHT_S, abs=1e-5)


def test_another_map_is_not_driven_by(tmp_path: Path) -> None:
    lab = mapped_lab(tmp_path, with_box(room(), (-0.2, 0.2), (-1.3, -1.0)))
    image = lab / "map" / "lab.pgm"
    image.write_bytes(image.read_bytes().replace(b"\xfe", b"\x00", 1))
    outcome = compiled(lab)
    assert said(outcome) == {"XEI0666"}
    assert drive_of(outcome)[0].parameters == ()
