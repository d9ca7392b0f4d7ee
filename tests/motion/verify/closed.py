"""The tube that is picked and placed, closed: a cap is fastened on it, and a ring on the cap."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from tests.motion.verify.scene import TUBE_HEIGHT, Case, pick_and_place, thing
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.timed import Attachment, Placement, TimedGoal
from xei_lang.ir.world import WorldObject

TUBE, CAP, RING = "tube_1", "cap_1", "ring_1"
T_TUBE_CAP = Pose.from_rpy((0.0, 0.0, TUBE_HEIGHT - 0.006), (0.0, 0.0, 0.4))
T_CAP_RING = Pose.from_rpy((0.001, 0.0, 0.013), (0.0, 0.0, -1.0))


@cache
def closed_tube() -> Case:
    """`pick_and_place` with what rides on the tube, which the plan lists wherever it lists the tube."""
    plan, graph, world, robot = pick_and_place()
    T_tube = world.T_world_object(TUBE)
    cap = rider(CAP, TUBE, T_tube @ T_TUBE_CAP, 0.010, 0.014)
    ring = rider(RING, CAP, T_tube @ T_TUBE_CAP @ T_CAP_RING, 0.007, 0.004)
    goals = tuple(with_riders(goal) for goal in plan.goals)
    return replace(plan, goals=goals), graph, replace(world, objects=(*world.objects, cap, ring)), robot


def rider(name: str, on: str, T_world_object: Pose, radius_m: float, height_m: float) -> WorldObject:
    shape = Primitive(Cylinder(radius_m, height_m), Pose((0.0, 0.0, height_m / 2)))
    size = (2 * radius_m, 2 * radius_m, height_m)
    return replace(thing(name, T_world_object, (shape,), size, 0.002, True), fastened_to=on)


def with_riders(goal: TimedGoal) -> TimedGoal:
    tube = next((item for item in goal.attached if item.object == TUBE), None)
    left = next((item for item in goal.placed if item.object == TUBE), None)
    if tube is not None:
        T_cap = tube.T_link_object @ T_TUBE_CAP
        on = (Attachment(CAP, tube.link, T_cap), Attachment(RING, tube.link, T_cap @ T_CAP_RING))
        goal = replace(goal, attached=(*goal.attached, *on))
    if left is not None:
        T_cap = left.T_base_object @ T_TUBE_CAP
        placed = (Placement(CAP, T_cap), Placement(RING, T_cap @ T_CAP_RING))
        goal = replace(goal, placed=(*goal.placed, *placed))
    return goal
