"""Stated paths of a graph: what is not described, not sound or leads elsewhere is told."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Epoch, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.ir.verify_goals import verify_goals

START = Pose((0.5, 0.0, 0.8))
ARC = Turn((0.5, 0.0, 1.0), (0.0, 1.0, 0.0), 1.0)
SCREW = Turn((0.5, 0.0, 0.0), (0.0, 0.0, 1.0), 7.0, 0.003)
RASTER = Raster((0.5, 0.0, 0.8), (0.2, 0.0, 0.0), (0.0, 0.1, 0.0), 0.05)


def graph(path: Any, along: Any, **fields: Any) -> MotionGoalGraph:
    end = along.end() @ START if along is not None else START
    goals = tuple(
        MotionGoal(name, "s", "move_to", move, 0, (), Span("a.xei", 0, 1))
        for name, move in (
            ("0", MoveTo(ToolTarget("f", START), "left")),
            ("1", MoveTo(ToolTarget("f", end), "left", path, **{"along": along, **fields})),
        )
    )
    family = Family("f", "tube", (ToolPose("m", Pose()),))
    return MotionGoalGraph(goals, (("0", "1"),), (family,), (Epoch(0, "a", Pose()),))


@pytest.mark.parametrize(("path", "along"), [("arc", ARC), ("screw", SCREW), ("raster", RASTER)])
def test_a_path_that_leads_to_its_target_is_sound(path: str, along: Any) -> None:
    assert verify_goals(graph(path, along)) == ()


@pytest.mark.parametrize(
    ("path", "along", "fields", "said"),
    [
        ("arc", None, {}, "its path `arc` is not described"),
        ("linear", ARC, {}, "describes another path than `linear`"),
        ("raster", ARC, {}, "describes another path than `raster`"),
        ("arc", SCREW, {}, "an arc has no lead"),
        ("arc", ARC, {"keep_upright": True}, "an arc cannot be kept upright"),
        ("arc", replace(ARC, angle_rad=0.0), {}, "it turns by no angle"),
        ("arc", replace(ARC, direction=(0.0, 1.1, 0.0)), {}, "no unit vector"),
        ("screw", replace(SCREW, angle_rad=math.nan), {}, "not finite"),
        ("arc", ARC, {"tool_turn_rad_s": 0.0}, "is no bound"),
        ("raster", replace(RASTER, corner_m=(0.4, 0.0, 0.8)), {}, "does not begin at its corner"),
        ("raster", replace(RASTER, across_m=(0.05, 0.1, 0.0)), {}, "no right angle"),
        ("raster", replace(RASTER, across_m=(0.0, 0.0005, 0.0)), {}, "less than a millimetre apart"),
        ("raster", replace(RASTER, along_m=(0.01, 0.0, 0.0)), {}, "shorter than the half circles"),
        ("raster", replace(RASTER, pitch_m=-1.0), {}, "no pitch"),
    ],
)
def test_an_unsound_path_is_told(path: str, along: Any, fields: dict[str, Any], said: str) -> None:
    assert any(said in problem for problem in verify_goals(graph(path, along, **fields)))


def test_a_path_to_another_place_or_from_nowhere_is_told() -> None:
    made = graph("arc", ARC)
    action: Any = made.goals[1].action
    moved = replace(action, target=replace(action.target, T_base_reference=START))
    elsewhere = replace(made, goals=(made.goals[0], replace(made.goals[1], action=moved)))
    assert any("does not lead" in problem for problem in verify_goals(elsewhere))
    alone = replace(made, goals=made.goals[1:], edges=())
    assert any("begins nowhere" in problem for problem in verify_goals(alone))
    other = replace(made.goals[0], action=replace(made.goals[0].action, arm="right"))
    assert any(
        "begins nowhere" in problem for problem in verify_goals(replace(made, goals=(other, made.goals[1])))
    )
