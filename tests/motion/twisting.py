"""The bench's bottle opened and closed by two hands: goals, plans, and what the verifier says of those."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from tests.lower.mirrored import mirrored
from tests.motion.sequence.bench import SRDF, URDF, bench, goals, obj, plan, planned
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify import Finding, RobotDescription, VerifyOptions, verify_timed
from xei_lang.profiles.model import Profile

BOTTLE, CAP = "bottle_2", "bottle_2_cap"
OPEN = plan(("twist_open", {"object": obj(BOTTLE), "hold": "left", "twist": "right"}))
_OTHER_HANDS = {"object": obj(BOTTLE), "hold": "right", "twist": "left"}
OTHER_WAY_ROUND = plan(("twist_open", _OTHER_HANDS), ("twist_close", _OTHER_HANDS))


@cache
def opened() -> tuple[TimedPlan, MotionGoalGraph]:
    """The bottle opened, held by the left hand."""
    return _made(OPEN, *bench())


@cache
def the_other_way_round() -> tuple[TimedPlan, MotionGoalGraph]:
    """The bottle opened and closed, held by the right hand, where everything stands mirrored."""
    return _made(OTHER_WAY_ROUND, *mirrored())


def _made(steps: SkillPlan, profile: Profile, world: World) -> tuple[TimedPlan, MotionGoalGraph]:
    timed, problems = planned(steps, profile, world)
    assert timed is not None, problems
    return timed, goals(steps, profile, world)


def with_thread(profile: Profile, **changes: float) -> Profile:
    """The profile with another thread of the cap."""
    cap = profile.object(CAP)
    assert cap is not None
    assert cap.thread is not None
    changed = replace(cap, thread=replace(cap.thread, **changes))  # type: ignore[arg-type]
    return replace(profile, objects=tuple(changed if item.name == CAP else item for item in profile.objects))


def findings(timed: TimedPlan, graph: MotionGoalGraph, world: World) -> tuple[Finding, ...]:
    """What the verifier finds, held objects upright within the bench's bound."""
    calibration = bench()[0].calibration
    options = VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad)
    robot = RobotDescription(URDF, SRDF)
    return verify_timed(timed, graph, world, robot, calibration.limits, options=options).findings
