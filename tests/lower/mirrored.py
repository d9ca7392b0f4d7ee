"""The bench with left and right changed over: everything that lies free of the robot stands mirrored in the
plane between its arms.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from tests.lower.plans import bench
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.model import Profile


@lru_cache(maxsize=1)
def mirrored() -> tuple[Profile, World]:
    """The bench's profile, and its world mirrored. The places of the bench's table are not there any more, so
    that what stood in one stands just on the table.
    """
    profile, world = bench()
    objects = tuple(_changed_over(item, world) for item in world.objects)
    return profile, replace(world, objects=objects)


def _changed_over(item: WorldObject, world: World) -> WorldObject:
    place = "" if item.place.startswith("table.") else item.place
    T_world_object = _reflected(world.T_world_object(item.name))
    return replace(item, frame_id="world", T_frame_object=T_world_object, place=place)


def _reflected(pose: Pose) -> Pose:
    """The pose seen in a mirror at y = 0: of turns, those about the normal of the mirror stay as they are."""
    x, y, z = pose.position_m
    qx, qy, qz, qw = pose.quaternion
    return Pose((x, -y, z), (-qx, qy, -qz, qw))
