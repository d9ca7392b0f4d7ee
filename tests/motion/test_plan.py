"""Plans of the real bench, from lowered goals to timed motion, checked by the verifier that shares no code
with them.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.motion.sequence.bench import (
    DESCRIPTION,
    SRDF,
    URDF,
    bench,
    beside,
    goals,
    moved,
    obj,
    plan,
    planned,
    put_on_rack,
    slot,
    spot,
    station,
)
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.goals import Detach, SlideMove
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.verify import RobotDescription, VerifyOptions, verify_timed
from xei_lang.quantity import parse_quantity


@cache
def put() -> TimedPlan:
    profile, world = bench()
    timed, problems = planned(put_on_rack(), profile, world)
    assert timed is not None, problems
    return timed


def goal(timed: TimedPlan, goal_id: str) -> TimedGoal:
    return next(item for item in timed.goals if item.id == goal_id)


def findings(timed: TimedPlan, steps: SkillPlan, world: World) -> list[str]:
    profile, _ = bench()
    tilt = profile.calibration.spill_tilt_rad
    report = verify_timed(
        timed, goals(steps, profile, world), world, RobotDescription(URDF, SRDF),
        profile.calibration.limits, options=VerifyOptions(upright_tilt_rad=tilt),
    )  # fmt: skip
    return [f"{item.goal_id}: {item.message}" for item in report.findings]


def test_one_tube_is_put_on_the_other_rack() -> None:
    _, world = bench()
    assert findings(put(), put_on_rack(), world) == []
    assert dict(put().solvers) == {"left": "srs-closed-form", "right": "srs-closed-form"}


def test_goals_follow_each_other_without_a_gap_and_begin_where_the_last_ended() -> None:
    assert [item.start_s for item in put().goals[1:]] == [item.end_s for item in put().goals[:-1]]
    now = dict(put().start)
    for item in put().goals:
        if item.samples is not None:
            begins = dict(zip(item.joints, item.samples.positions[0], strict=True))
            assert all(math.isclose(now[joint], value, abs_tol=1e-9) for joint, value in begins.items())
            now.update(zip(item.joints, item.samples.positions[-1], strict=True))


def test_the_grasp_of_the_pick_is_kept_until_the_tube_stands() -> None:
    chosen = {item.choice for item in put().goals if item.choice}
    assert len(chosen) == 1
    held = {item.attached for item in put().goals if item.attached}
    assert len(held) == 1


def test_a_round_tube_may_turn_where_it_is_set_down_but_not_lean() -> None:
    profile, world = bench()
    detach = next(
        item for item in goals(put_on_rack(), profile, world).goals if isinstance(item.action, Detach)
    )
    assert isinstance(detach.action, Detach)
    placed = goal(put(), detach.id).placed[0].T_base_object
    wanted = detach.action.T_base_object
    assert np.allclose(placed.position_m, wanted.position_m, atol=1e-9)
    assert np.allclose(placed.axes()[2], wanted.axes()[2], atol=1e-9)


def test_equal_input_gives_equal_bytes() -> None:
    profile, world = bench()
    again, _ = planned(put_on_rack(), profile, world)
    assert again is not None
    assert repr(again).encode() == repr(put()).encode()


def test_six_tubes_are_chosen_together_and_all_motion_holds() -> None:
    profile, world = bench()
    pairs = zip(range(1, 7), ("A1", "A2", "A3", "A4", "B1", "B3"), strict=True)
    calls = [
        call
        for number, key in pairs
        for call in (
            ("pick", {"object": obj(f"tube_{number}"), "arm": "either"}),
            ("insert", {"object": obj(f"tube_{number}"), "into": slot("rack_2", key), "arm": "either"}),
        )
    ]
    steps = plan(*calls)
    timed, problems = planned(steps, profile, world)
    assert timed is not None, problems
    assert findings(timed, steps, world) == []


def test_a_grasp_is_chosen_that_also_serves_at_the_other_station() -> None:
    profile, world = bench()
    steps = plan(
        ("nav_to", {"station": station("bench_b")}),
        ("pick", {"object": obj("beaker_2"), "arm": "either"}),
        ("nav_to", {"station": station("bench_a")}),
        ("place", {"object": obj("beaker_2"), "on": spot("table", "beaker"), "arm": "either"}),
    )
    timed, problems = planned(steps, profile, world)
    assert timed is not None, problems
    assert findings(timed, steps, world) == []
    drive = next(item for item in timed.goals if item.kind == "nav_to_pose")
    assert drive.end_s - drive.start_s == pytest.approx(2.2 / 0.3 + math.pi / 2 / 0.65)


def refusal(steps: SkillPlan, world: World) -> Diagnostic:
    profile, _ = bench()
    timed, problems = planned(steps, profile, world)
    assert timed is None
    assert len(problems) == 1
    return problems[0]


def take(name: str, arm: str = "either") -> SkillPlan:
    return plan(("pick", {"object": obj(name), "arm": arm}))


def test_an_object_too_far_away_says_how_far() -> None:
    _, world = bench()
    said = refusal(take("bottle_1"), moved(world, "bottle_1", 0.25, 0.0))
    assert said.code == "XEI0801"
    assert said.message == "the right arm cannot reach `bottle_1`"
    assert said.span is not None
    assert any("mm out of reach, with the slide at" in note for note in said.notes)


def test_an_object_of_another_station_names_it() -> None:
    _, world = bench()
    said = refusal(take("beaker_2"), world)
    assert said.code == "XEI0801"
    assert any("`bench_b`" in text for text in said.help)


def test_a_hemmed_in_object_counts_what_its_grasps_touch() -> None:
    _, world = bench()
    around = {
        "pipette_1": (0.055, 0.0),
        "beaker_1": (-0.07, 0.0),
        "waste_bin": (0.0, -0.095),
        "beaker_2": (0.0, 0.07),
    }
    for name, (x_m, y_m) in around.items():
        world = beside(world, name, "bottle_1", x_m, y_m)
    said = refusal(take("bottle_1"), world)
    assert said.code == "XEI0802"
    assert "touches" in said.message
    assert said.notes[0].startswith("of ")
    assert "touch `beaker_1`" in said.notes[0]
    counts = [int(word) for word in said.notes[0].split() if word.isdigit()]
    assert counts[0] == sum(counts[1:])


def test_a_slide_height_outside_the_stroke_says_what_the_stroke_is() -> None:
    profile, world = bench()
    graph = goals(plan(("slide_to", {"height": parse_quantity("500 mm")})), profile, world)
    last = replace(graph.goals[-1], action=SlideMove(0.7))
    graph = replace(graph, goals=(*graph.goals[:-1], last))
    timed, problems = plan_motion(graph, world, profile, DESCRIPTION, 1)
    assert timed is None
    assert [item.code for item in problems] == ["XEI0805"]
    assert problems[0].label == "expected 0 mm .. 600 mm"


def test_a_blocked_way_names_the_two_bodies() -> None:
    _, world = bench()
    # The bin hovers where the left arm hangs at first: the way to `ready` begins in it.
    world = beside(world, "waste_bin", "wipe_1", -0.24, -0.28)
    said = refusal(take("tube_1", "left"), world)
    assert said.code == "XEI0803"
    assert "`waste_bin`" in said.message
    assert "`openarm_left_" in said.message


def test_one_hand_keeps_its_tube_while_the_other_works() -> None:
    profile, world = bench()
    steps = plan(
        ("pick", {"object": obj("tube_4"), "arm": "left"}),
        ("pick", {"object": obj("bottle_1"), "arm": "right"}),
        ("place", {"object": obj("bottle_1"), "on": spot("table", "bottle"), "arm": "right"}),
        ("insert", {"object": obj("tube_4"), "into": slot("rack_2", "B3"), "arm": "left"}),
    )
    timed, problems = planned(steps, profile, world)
    assert timed is not None, problems
    assert findings(timed, steps, world) == []
    assert any({item.object for item in goal.attached} == {"tube_4", "bottle_1"} for goal in timed.goals)


def test_a_load_that_is_too_heavy_names_the_joint_and_its_torque() -> None:
    profile, world = bench()
    graph = goals(take("bottle_1"), profile, world)
    heavy = tuple(replace(item, mass_kg=9.0) if item.name == "bottle_1" else item for item in world.objects)
    timed, problems = plan_motion(graph, replace(world, objects=heavy), profile, DESCRIPTION, 1)
    assert timed is None
    assert [item.code for item in problems] == ["XEI0804"]
    assert problems[0].message.startswith("`openarm_right_joint")
    assert "only to hold still" in problems[0].label
