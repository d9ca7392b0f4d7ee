"""Held objects on a drive, on the real bench: upright from the grasp until they stand, and what is said where
that cannot be.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tests.motion.sequence.bench import (
    DESCRIPTION,
    SRDF,
    URDF,
    bench,
    goals,
    obj,
    plan,
    planned,
    spot,
    station,
)
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.goals import JointTarget, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.robot import load_robot
from xei_lang.motion.verify import RobotDescription, VerifyOptions, verify_timed
from xei_lang.profiles.model import Profile

FETCH = plan(
    ("nav_to", {"station": station("bench_b")}),
    ("pick", {"object": obj("beaker_2"), "arm": "either"}),
    ("nav_to", {"station": station("bench_a")}),
    ("place", {"object": obj("beaker_2"), "on": spot("table", "beaker"), "arm": "either"}),
)
ROUND_TRIP = plan(
    ("pick", {"object": obj("tube_4"), "arm": "left"}),
    ("pick", {"object": obj("bottle_1"), "arm": "right"}),
    ("nav_to", {"station": station("bench_b")}),
    ("nav_to", {"station": station("bench_a")}),
    ("place", {"object": obj("bottle_1"), "on": spot("table", "bottle"), "arm": "right"}),
    ("nav_to", {"station": station("bench_b")}),
    ("place", {"object": obj("tube_4"), "on": spot("table_b", "spare"), "arm": "left"}),
)


def findings(timed: TimedPlan, steps: SkillPlan) -> list[str]:
    profile, world = bench()
    report = verify_timed(
        timed, goals(steps, profile, world), world, RobotDescription(URDF, SRDF),
        profile.calibration.limits,
        options=VerifyOptions(upright_tilt_rad=profile.calibration.spill_tilt_rad),
    )  # fmt: skip
    return [f"{item.goal_id}: {item.message}" for item in report.findings]


def tilts(timed: TimedPlan) -> dict[str, float]:
    """The largest tilt of anything held, by goal, over the sampled motion, deg: forward kinematics alone."""
    robot = load_robot(URDF, SRDF)
    now = np.zeros(robot.nq)
    for joint, value in timed.start:
        now[robot.joint_names.index(joint)] = value
    found: dict[str, float] = {}
    for goal in timed.goals:
        rows = [now]
        if goal.samples is not None:
            rows = np.tile(now, (len(goal.samples.positions), 1))
            columns = [robot.joint_names.index(joint) for joint in goal.joints]
            rows[:, columns] = goal.samples.positions
        for row in rows[:: max(1, len(rows) // 200)]:
            for item in goal.attached:
                up = np.array(item.T_link_object.axes()[2])
                z = float((robot.T_base_frame(row, item.link)[:3, :3] @ up)[2])
                tilt = math.degrees(math.acos(min(1.0, z)))
                found[goal.id] = max(found.get(goal.id, 0.0), tilt)
        now = np.array(rows[-1])
    return found


def made(steps: SkillPlan) -> TimedPlan:
    profile, world = bench()
    timed, problems = planned(steps, profile, world)
    assert timed is not None, problems
    return timed


def refused(graph: MotionGoalGraph, profile: Profile) -> Diagnostic:
    timed, problems = plan_motion(graph, bench()[1], profile, DESCRIPTION, 1)
    assert timed is None
    (said,) = problems
    return said


def with_carry(x_m: float, y_m: float, z_m: float) -> Profile:
    """The bench with the left carry pose elsewhere."""
    profile, _ = bench()
    carry = tuple(
        replace(pose, position_m=(x_m, y_m, z_m)) if pose.arm == "left" else pose
        for pose in profile.calibration.carry
    )
    return replace(profile, calibration=replace(profile.calibration, carry=carry))


def test_a_beaker_stays_upright_from_the_second_bench_to_the_first() -> None:
    timed = made(FETCH)
    assert findings(timed, FETCH) == []
    found = tilts(timed)
    assert {"pick#1/6", "nav_to#2/1", "nav_to#2/3", "nav_to#2/5", "place#1/1", "place#1/2"} <= set(found)
    assert max(found.values()) < 8.0


def test_both_hands_carry_over_several_drives() -> None:
    timed = made(ROUND_TRIP)
    assert findings(timed, ROUND_TRIP) == []
    assert max(tilts(timed).values()) < 8.0
    assert {item.choice for item in timed.goals if item.step_id == "nav_to#2" and item.choice}


def test_the_grasp_serves_pick_carry_pose_and_place_alike() -> None:
    chosen = {item.choice for item in made(FETCH).goals if item.choice}
    assert len(chosen) == 1


def test_a_carry_pose_out_of_reach_is_named_before_anything_is_picked() -> None:
    profile = with_carry(1.6, 0.3, 0.95)
    said = refused(goals(FETCH, profile, bench()[1]), profile)
    assert said.code == "XEI0808"
    assert said.message == "the left arm cannot bring `beaker_2` to its carry pose"
    assert said.span == FETCH.steps[2].span
    assert "252 out of reach there" in said.notes[0]
    assert said.labels[0].message == "carry pose of the left arm"
    assert any("set `beaker_2` down before this step" in text for text in said.help)


def test_a_carry_pose_in_the_robot_itself_names_what_is_in_the_way() -> None:
    profile = with_carry(0.115, 0.0, 0.9)
    said = refused(goals(FETCH, profile, bench()[1]), profile)
    assert said.code == "XEI0808"
    assert "none serves" in said.notes[0]


def test_what_is_tilted_already_is_not_carried_on_in_silence() -> None:
    profile, world = bench()
    graph = goals(FETCH, profile, world)
    state = next(s for s in profile.robot.states if (s.name, s.group) == ("transport", "left_arm"))
    tipped = MoveTo(JointTarget(state.name, state.joints), "left")
    graph = replace(
        graph,
        goals=tuple(
            replace(item, action=tipped) if item.id == "nav_to#2/1" else item for item in graph.goals
        ),
    )
    said = refused(graph, profile)
    assert said.code == "XEI0809"
    assert said.message == "`beaker_2` is tilted before a move that must keep it upright"
    assert said.span == FETCH.steps[3].span
    assert "expected at most 8 deg" in said.label
