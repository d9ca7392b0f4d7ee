"""Named configurations are for empty hands: a hand that holds something goes to its carry pose, upright."""

from __future__ import annotations

from dataclasses import replace

from tests.lower.plans import bench, obj, plan, station, with_skill
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import JointTarget, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import SkillPlan, Value
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.profiles.model import Profile, TemplateStep

Call = tuple[str, dict[str, Value]]


def pick(name: str, arm: str) -> Call:
    return ("pick", {"object": obj(name), "arm": arm})


def drive(name: str = "bench_b") -> Call:
    return ("nav_to", {"station": station(name)})


def lowered(of: SkillPlan, profile: Profile | None = None) -> MotionGoalGraph:
    known, world = bench()
    graph, problems = lower(of, profile or known, world)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def moves(graph: MotionGoalGraph, step_id: str) -> list[tuple[MotionGoal, MoveTo]]:
    found = [(goal, goal.action) for goal in graph.goals if goal.step_id == step_id]
    return [(goal, action) for goal, action in found if isinstance(action, MoveTo)]


def named(move: MoveTo) -> tuple[str, set[str]]:
    """The configuration of a move and the arms that it moves."""
    assert isinstance(move.target, JointTarget)
    return move.target.name, {joint.split("_")[1] for joint, _ in move.target.joints}


def configured(name: str, **fields: str) -> Profile:
    """The bench with a `slide_to` that moves to a named configuration instead."""
    profile, _ = bench()
    skill = profile.bank.skill("slide_to")
    assert skill is not None
    line = TemplateStep("move_to", (("configuration", name), *fields.items()), skill.span)
    return with_skill(profile, replace(skill, template=(line,)))


def test_empty_hands_go_to_the_configuration_together() -> None:
    (_, away), (_, back) = moves(lowered(plan(drive())), "nav_to#1")
    assert named(away) == ("transport", {"left", "right"})
    assert named(back) == ("ready", {"left", "right"})


def test_a_hand_that_holds_something_goes_to_its_carry_pose_upright() -> None:
    profile, _ = bench()
    graph = lowered(plan(pick("tube_1", "left"), drive()))
    (goal, carried), (_, away), (_, back) = moves(graph, "nav_to#1")
    pose = profile.calibration.carry_pose("left")
    assert pose is not None
    assert isinstance(carried.target, ToolTarget)
    assert carried.target.T_base_reference.position_m == pose.position_m
    assert carried.target.T_base_reference.axes()[2] == (0.0, 0.0, 1.0)
    assert carried.target.family == "pick#1.tube_1"
    assert carried.target.turn_reference
    assert (carried.arm, carried.path, carried.keep_upright) == ("left", "free", True)
    assert goal.resources == ("left_arm", "slide")
    assert named(away) == ("transport", {"right"})
    assert named(back) == ("ready", {"right"})


def test_on_arrival_the_slide_stays_and_with_it_what_is_carried() -> None:
    graph = lowered(plan(pick("tube_1", "left"), drive()))
    kinds = [goal.kind for goal in graph.goals if goal.step_id == "nav_to#1"]
    assert kinds == ["move_to", "move_to", "nav_to_pose", "perceive", "move_to"]


def test_the_carry_pose_says_why_and_where_it_is_written() -> None:
    profile, _ = bench()
    (goal, _), *_ = moves(lowered(plan(pick("tube_1", "right"), drive())), "nav_to#1")
    (why,) = goal.parameters
    pose = profile.calibration.carry_pose("right")
    assert pose is not None
    assert (why.name, why.value, why.source) == ("carry_pose", "(420, -360, 950) mm", "computed")
    assert "the right hand holds `tube_1`" in why.rule
    assert "`transport`" in why.rule
    assert why.span == pose.span


def test_it_touches_nothing_but_the_hand_on_its_way() -> None:
    (goal, _), *_ = moves(lowered(plan(pick("tube_1", "left"), drive())), "nav_to#1")
    assert {name for pair in goal.allowed_contacts for name in pair} == {
        "tube_1",
        "openarm_left_hand",
        "openarm_left_left_finger",
        "openarm_left_right_finger",
    }


def test_with_both_hands_full_no_arm_goes_to_the_configuration() -> None:
    graph = lowered(plan(pick("tube_1", "left"), pick("bottle_1", "right"), drive()))
    found = moves(graph, "nav_to#1")
    assert [move.arm for _, move in found] == ["left", "right"]
    assert all(isinstance(move.target, ToolTarget) and move.keep_upright for _, move in found)


def test_a_second_drive_carries_again() -> None:
    graph = lowered(plan(pick("tube_1", "left"), drive(), drive("bench_a")))
    assert isinstance(moves(graph, "nav_to#2")[0][1].target, ToolTarget)


def test_what_has_no_symmetry_is_carried_turned_as_it_was_grasped() -> None:
    _, world = bench()
    (_, move), *_ = moves(lowered(plan(pick("wipe_1", "left"), drive(), drive("bench_a"))), "nav_to#2")
    assert isinstance(move.target, ToolTarget)
    grasped = world.robot.T_world_base.inverse() @ world.T_world_object("wipe_1")
    assert move.target.T_base_reference.quaternion == grasped.quaternion
    assert not move.target.turn_reference


def test_a_configuration_of_one_arm_is_replaced_as_well() -> None:
    profile = configured("home", tool="left")
    steps = plan(pick("tube_1", "left"), ("slide_to", {}))
    ((_, move),) = moves(lowered(steps, profile), "slide_to#1")
    assert isinstance(move.target, ToolTarget)
    steps = plan(pick("tube_1", "right"), ("slide_to", {}))
    ((_, move),) = moves(lowered(steps, profile), "slide_to#1")
    assert named(move) == ("home", {"left"})


def test_a_configuration_of_the_slide_alone_stays_itself() -> None:
    steps = plan(pick("tube_1", "left"), ("slide_to", {}))
    ((_, move),) = moves(lowered(steps, configured("high")), "slide_to#1")
    assert isinstance(move.target, JointTarget)
    assert move.target.joints == (("slide_joint", 0.6),)


def test_a_profile_without_a_carry_pose_refuses_to_drive_with_a_full_hand() -> None:
    profile, world = bench()
    bare = replace(profile, calibration=replace(profile.calibration, carry=()))
    steps = plan(pick("tube_1", "left"), drive())
    graph, problems = lower(steps, bare, world)
    assert graph is None
    (said,) = problems
    assert said.code == "XEI0716"
    assert said.message == "it is not known where the left hand carries `tube_1`"
    assert said.span == steps.steps[1].span
    assert said.labels[0].span == steps.steps[0].span
    assert "`carry: left:`" in said.help[0]
    assert lower(plan(drive()), bare, world)[0] is not None
