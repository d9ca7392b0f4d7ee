"""Seeded faults in good plans. Each is a real violation by construction; the verifier takes no part in
making it.

`inject(plan, graph, world, robot, seed)` works on any TimedPlan. What makes a fault real stands in each
maker's docstring. Where a check is needed (a touch, a torque, a tool's error) it is pinocchio's or coal's
own, or a plain scan over angles. Knots that are changed are sampled again, so that a fault shows in one way
only.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from tests.motion.verify.fault_bench import Bench, Fault
from tests.motion.verify.faults_motion import (
    acceleration_spike,
    jump_between,
    jump_inside,
    position_limit,
    still_moving,
    torque_by_payload,
    torque_by_speed,
    velocity_limit,
    wrong_first,
    wrong_start,
)
from tests.motion.verify.faults_reach import crooked_line, wrong_goal
from tests.motion.verify.faults_riders import (
    forgotten_rider,
    loose_rider,
    object_in_riders_path,
    rider_left_behind,
    shifted_rider,
)
from tests.motion.verify.faults_said import (
    dropped_object,
    ends_first,
    extra_goal,
    false_samples,
    held_from_nowhere,
    missing_goal,
    moved_in_hand,
    not_a_number,
    short_rows,
    swapped,
    too_early,
    wrong_place,
)
from tests.motion.verify.faults_touch import (
    contact_not_allowed,
    object_in_path,
    path_into_body,
    thinner_than_the_grip,
)
from tests.motion.verify.maker import Arm
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify import RobotDescription

_ARMS: dict[str, Arm] = {}


def inject(
    plan: TimedPlan, graph: MotionGoalGraph, world: World, robot: RobotDescription, seed: int
) -> Fault:
    """One fault of the class `seed` counts to; where the plan has no place for that class, of the next one
    that fits."""
    arm = _ARMS.setdefault(robot.urdf_text, Arm(robot.urdf_text))
    for step in range(len(MAKERS)):
        maker = MAKERS[(seed + step) % len(MAKERS)]
        bench = Bench(plan, graph, world, robot, arm, Random(f"{seed} {maker.__name__}"))
        fault = maker(bench)
        if fault is not None:
            return fault
    raise ValueError("no class of faults fits this plan")


MAKERS: tuple[Callable[[Bench], Fault | None], ...] = (
    position_limit,
    velocity_limit,
    acceleration_spike,
    torque_by_speed,
    torque_by_payload,
    jump_inside,
    jump_between,
    wrong_first,
    wrong_start,
    still_moving,
    wrong_goal,
    crooked_line,
    object_in_path,
    path_into_body,
    contact_not_allowed,
    false_samples,
    dropped_object,
    moved_in_hand,
    held_from_nowhere,
    wrong_place,
    too_early,
    swapped,
    ends_first,
    missing_goal,
    extra_goal,
    not_a_number,
    short_rows,
    forgotten_rider,
    shifted_rider,
    rider_left_behind,
    loose_rider,
    object_in_riders_path,
    thinner_than_the_grip,
)
