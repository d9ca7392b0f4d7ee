"""The verifier of MotionGoalGraph finds every fault that is put into a sound graph."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import (
    Action,
    Attach,
    Detach,
    Epoch,
    GoalKind,
    Grip,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    Perceive,
    SlideMove,
    Wait,
)
from xei_lang.ir.verify_goals import verify_goals

FAR = Pose((1.0, 2.0, 0.0))
BENT = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.5, 1.0))
LOST = Pose((math.nan, 0.0, 0.0))


def goal(name: str, kind: GoalKind, action: Action, epoch: int, provisional: bool = False) -> MotionGoal:
    return MotionGoal(name, "s", kind, action, epoch, (), Span("a.xei", 0, 1), provisional=provisional)


def sound() -> MotionGoalGraph:
    target = ToolTarget("f", Pose((0.5, 0.0, 0.8)))
    goals = (
        goal("0", "move_to", MoveTo(JointTarget("ready", (("j", 0.5),))), 0),
        goal("1", "open_gripper", Grip("left", 0.03), 0),
        goal("2", "move_to", MoveTo(target, "left"), 0),
        goal("3", "attach", Attach("tube", "left", "f"), 0),
        goal("4", "nav_to_pose", NavToPose("b", FAR, 0.1, 0.1), 0),
        goal("5", "perceive", Perceive("table"), 1),
        goal("6", "slide_move", SlideMove(0.2), 1, True),
        goal("7", "move_to", MoveTo(target, "left", "linear"), 1, True),
        goal("8", "detach", Detach("tube", "left", "spot", Pose()), 1, True),
        goal("9", "wait", Wait(3.0), 1, True),
    )
    edges = tuple((before.id, after.id) for before, after in pairwise(goals))
    family = Family("f", "tube", (ToolPose("m", Pose()),))
    return MotionGoalGraph(goals, edges, (family,), (Epoch(0, "a", Pose()), Epoch(1, "b", FAR)))


def changed(index: int, **fields: Any) -> MotionGoalGraph:
    graph = sound()
    goals = list(graph.goals)
    goals[index] = replace(goals[index], **fields)
    return replace(graph, goals=tuple(goals))


def acted(index: int, **fields: Any) -> MotionGoalGraph:
    action: Any = sound().goals[index].action
    return changed(index, action=replace(action, **fields))


def aimed(**fields: Any) -> MotionGoalGraph:
    action: Any = sound().goals[2].action
    return acted(2, target=replace(action.target, **fields))


def without(index: int) -> MotionGoalGraph:
    graph = sound()
    kept = tuple(item for k, item in enumerate(graph.goals) if k != index)
    edges = tuple(edge for edge in graph.edges if str(index) not in edge)
    return replace(graph, goals=kept, edges=edges)


def membered(*members: ToolPose) -> MotionGoalGraph:
    return replace(sound(), families=(Family("f", "tube", members),))


FAULTS: dict[str, tuple[Callable[[], MotionGoalGraph], str]] = {
    "an id twice": (lambda: changed(1, id="0"), "used twice"),
    "an edge to nothing": (lambda: replace(sound(), edges=(("0", "99"),)), "no goal `99`"),
    "a cycle": (lambda: replace(sound(), edges=(*sound().edges, ("7", "2"))), "backward"),
    "an edge to itself": (lambda: replace(sound(), edges=(("2", "2"),)), "backward"),
    "an edge twice": (lambda: replace(sound(), edges=(("0", "1"), ("0", "1"))), "stands twice"),
    "a wrong action": (lambda: changed(1, kind="wait"), "does not fit the kind"),
    "an unknown kind": (lambda: changed(1, kind="fly"), "does not fit the kind"),
    "an unknown family": (lambda: aimed(family="g"), "no family `g`"),
    "an attach by an unknown family": (lambda: acted(3, family="g"), "no family `g`"),
    "an empty family": (membered, "no member"),
    "a family twice": (lambda: replace(sound(), families=sound().families * 2), "used twice"),
    "a bent member": (lambda: membered(ToolPose("m", BENT)), "no unit quaternion"),
    "a lost member": (lambda: membered(ToolPose("m", LOST)), "not finite"),
    "a member without cost": (lambda: membered(ToolPose("m", Pose(), math.nan)), "no finite cost"),
    "a bent target": (lambda: aimed(T_base_reference=BENT), "no unit quaternion"),
    "a lost target": (lambda: aimed(T_base_reference=LOST), "not finite"),
    "an endless offset": (lambda: aimed(offset_base_m=(0.0, 0.0, math.inf)), "offsets"),
    "a lost offset": (lambda: aimed(offset_tool_m=(0.0, 0.0, math.nan)), "offsets"),
    "a tool without an arm": (lambda: acted(2, arm=None), "without an arm"),
    "no speed": (lambda: acted(2, speed_fraction=0.0), "speed fraction"),
    "too much speed": (lambda: acted(2, speed_fraction=1.5), "speed fraction"),
    "no joints": (lambda: acted(0, target=JointTarget("ready", ())), "no finite joints"),
    "a lost joint": (lambda: acted(0, target=JointTarget("r", (("j", math.nan),))), "no finite joints"),
    "a negative gap": (lambda: acted(1, opening_m=-0.01), "no gap"),
    "a lost height": (lambda: acted(6, height_m=math.nan), "height"),
    "a negative wait": (lambda: acted(9, duration_s=-1.0), "no duration"),
    "an endless wait": (lambda: acted(9, duration_s=math.inf), "no duration"),
    "durations the wrong way": (lambda: changed(9, min_duration_s=5.0, max_duration_s=1.0), "no range"),
    "a lost duration": (lambda: changed(9, min_duration_s=math.nan), "no range"),
    "a wrong epoch": (lambda: changed(6, epoch=0), "of epoch 0"),
    "a drive too early": (lambda: changed(4, epoch=1), "of epoch 1"),
    "a missing epoch": (lambda: replace(sound(), epochs=sound().epochs[:1]), "1 epochs for 1 drives"),
    "an epoch too many": (
        lambda: replace(sound(), epochs=(*sound().epochs, Epoch(2, "c", Pose()))),
        "3 epochs",
    ),
    "an epoch misnumbered": (
        lambda: replace(sound(), epochs=(Epoch(0, "a", Pose()), Epoch(3, "b", FAR))),
        "expected number 1",
    ),
    "a drive elsewhere": (lambda: acted(4, T_world_base=Pose((9.0, 0.0, 0.0))), "drives elsewhere"),
    "a bent base": (lambda: acted(4, T_world_base=BENT), "no unit quaternion"),
    "a goal that forgot to be provisional": (lambda: changed(6, provisional=False), "not provisional"),
    "a goal that is provisional too early": (lambda: changed(1, provisional=True), "is provisional"),
    "no attach": (lambda: without(3), "does not hold"),
    "no detach, then another attach": (
        lambda: changed(8, kind="attach", action=Attach("cup", "left", "f")),
        "already holds `tube`",
    ),
    "an object in two hands": (
        lambda: changed(8, kind="attach", action=Attach("tube", "right", "f")),
        "already in a hand",
    ),
    "the wrong hand lets go": (lambda: acted(8, arm="right"), "does not hold"),
    "the wrong object is let go": (lambda: acted(8, object="cup"), "does not hold `cup`"),
    "a lost object": (lambda: acted(8, T_base_object=LOST), "not finite"),
    "another family while holding": (
        lambda: replace(
            acted(3, family="g"), families=(*sound().families, Family("g", "cup", (ToolPose("m", Pose()),)))
        ),
        "another family",
    ),
}


def test_a_sound_graph_has_no_problem() -> None:
    assert verify_goals(sound()) == ()


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_a_fault_is_found(name: str) -> None:
    make, words = FAULTS[name]
    problems = verify_goals(make())
    assert any(words in problem for problem in problems), problems
