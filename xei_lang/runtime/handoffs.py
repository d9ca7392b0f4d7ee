"""Everything that a run is handed, and the checks that each handoff must pass before anything moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.tolerance import as_bound
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.runtime.failure import Failure, failure
from xei_lang.world.use import MIN_CONFIDENCE, uses

TIME_TOLERANCE_S = 1e-6


@dataclass(frozen=True, slots=True)
class Handoffs:
    """The inputs of a run: every representation from the plan on, and the profile that they were made with.

    `urdf` is the text of the robot's description, which the safety gate places the tools with. `sha256` maps
    `plan.json`, `goals.json` and `timed.json` to the hash of these representations as the bundle keeps them.
    """

    plan: SkillPlan
    graph: MotionGoalGraph
    timed: TimedPlan
    world: World
    profile: Profile
    urdf: str
    sha256: Mapping[str, str]


def check_scene(given: Handoffs) -> Failure | None:
    """The robot stands at a station of the profile whose table is known, and every drive has a target."""
    stations = {station.name: station for station in given.profile.calibration.stations}
    known = ", ".join(f"`{name}`" for name in stations)
    robot = given.world.robot
    for name in (robot.station, *(epoch.station for epoch in given.graph.epochs)):
        if name not in stations:
            return failure(
                "scene_origin",
                "XEI0901",
                f"`{name}` is no station of this profile",
                note=f"calibration_profile.yaml has the stations {known}",
            )
    calibration, nominal = given.profile.calibration, stations[robot.station].T_world_base
    if not _near(
        robot.T_world_base,
        nominal,
        as_bound(calibration.docking_position_tolerance_m, calibration.docking_tolerance_as),
        as_bound(calibration.docking_rotation_tolerance_rad, calibration.docking_tolerance_as),
    ):
        return failure(
            "scene_origin",
            "XEI0901",
            f"the robot does not stand at `{robot.station}`",
            note="its base is further from the station's pose than the docking tolerance",
            help=f"drive it to `{robot.station}`, or start from where it stands",
        )
    epochs = given.graph.epochs
    if epochs and epochs[0].station != robot.station:
        return failure(
            "scene_origin",
            "XEI0901",
            f"the plan starts at `{epochs[0].station}` but the robot stands at `{robot.station}`",
            help=f"compile again with the robot at `{robot.station}`",
        )
    ground = stations[robot.station].ground_frame
    if ground != "world" and given.world.frame(ground) is None:
        return failure(
            "scene_origin",
            "XEI0901",
            f"the frame `{ground}` of `{robot.station}` is not known",
            help="add the frame to calibration_profile.yaml",
        )
    return None


def check_grounding(given: Handoffs) -> Failure | None:
    """Every object that the plan handles is in the world, in a known frame, and sure enough."""
    for name, step_id, needed in _handled(given):
        found = given.world.find(name)
        if found is None:
            return failure(
                "world_grounding",
                "XEI0902",
                f"`{name}` of step `{step_id}` is not in the world",
                help="ground the scene again, or give it a prior in usage_profile.yaml",
            )
        if found.confidence < needed:
            return failure(
                "world_grounding",
                "XEI0903",
                f"the place of `{name}` is known with confidence {found.confidence:g} only",
                note=f"step `{step_id}` handles it, which needs {needed:g}",
                help="let the perception ground it again",
            )
        if found.frame_id != "world" and given.world.frame(found.frame_id) is None:
            return failure(
                "world_grounding",
                "XEI0902",
                f"`{name}` stands in the frame `{found.frame_id}`, which is not known",
            )
    return None


def _handled(given: Handoffs) -> Iterator[tuple[str, str, float]]:
    """Objects with the step that handles them, and how surely that must know where they are."""
    for use in uses(given.plan, given.profile):
        yield use.name, use.step.step_id, use.needed
    for goal in given.graph.goals:
        if isinstance(goal.action, (Attach, Detach)):
            yield goal.action.object, goal.step_id, MIN_CONFIDENCE


def _near(a: Pose, b: Pose, position_m: float, rotation_rad: float) -> bool:
    turn = 2.0 * math.acos(min(1.0, abs((a.inverse() @ b).quaternion[3])))
    return math.dist(a.position_m, b.position_m) <= position_m + 1e-9 and turn <= rotation_rad + 1e-9
