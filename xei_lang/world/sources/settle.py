"""What an object that was seen somewhere stands in or on: eyes are off by millimetres, slots are not.

An object that was seen upright, its axis through a slot's bore and its bottom near the slot's floor, stands
in that slot. Near a named spot it stands there, where it was seen; a cap near its thread is screwed on, in
the middle of it. On a surface it stands on the surface; what leans or lies has its lowest point there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.profiles import grid as grids
from xei_lang.profiles.checks.leaning import TILT_RAD
from xei_lang.profiles.checks.overlap import lowest_m
from xei_lang.profiles.model import LabObject
from xei_lang.world.places import accepts, slots

HEIGHT_M = 0.010
"""A bottom that was seen this far above or below where it can stand, stands there: what depth cameras and
tags at a metre are good for.
"""
SPOT_M = 0.010
"""What was seen this near to a named spot, along the surface, stands on the spot."""


@dataclass(frozen=True, slots=True)
class Floor:
    """A slot, and the middle of its floor in the frame of the object that has it."""

    place: PlaceRef
    position_m: Vec3


@dataclass(frozen=True, slots=True)
class Host:
    """Something that others may stand in or on, where it stands itself, and the floors of its slots."""

    item: LabObject
    T_world_host: Pose
    floors: tuple[Floor, ...]


@dataclass(frozen=True, slots=True)
class Settled:
    """Where an object stands: its host, the place there (a whole surface has an empty key), and its pose."""

    host: LabObject
    place: PlaceRef
    T_host_object: Pose


def is_host(item: LabObject) -> bool:
    """Whether anything can stand in or on it."""
    return item.slots is not None or bool(item.spots) or _takes(item)


def floors_of(item: LabObject) -> tuple[Floor, ...]:
    """The floors of all slots of an object."""
    found = ((place, grids.T_object_standing(item, place.kind, place.key)) for place in slots(item))
    return tuple(Floor(place, pose.position_m) for place, pose in found if pose is not None)


def settle(item: LabObject, T_world_object: Pose, hosts: Iterator[Host]) -> Settled | None:
    """Where the object stands that was seen at `T_world_object`; None where that is in and on nothing.

    Slots come before spots, and spots before surfaces; of several, the nearest.
    """
    found: list[tuple[int, float, str, Settled]] = []
    for host in hosts:
        T_host_object = host.T_world_host.inverse() @ T_world_object
        leans = T_host_object.axes()[2][2] < math.cos(TILT_RAD)
        candidates = _lying if leans else _candidates
        for rank, distance_m, settled in candidates(item, host, T_host_object):
            found.append((rank, distance_m, settled.place.object + settled.place.key, settled))
    return min(found, key=lambda one: one[:3])[3] if found else None


def foot(item: LabObject, T_frame_object: Pose) -> Vec3:
    """Where an object touches what is below it: its bottom, or, of what leans, the height of its lowest point
    below its middle.
    """
    if T_frame_object.axes()[2][2] >= math.cos(TILT_RAD):
        return T_frame_object.position_m
    x, y, _ = T_frame_object.apply((0.0, 0.0, item.size_m[2] / 2))
    return (x, y, lowest_m(item, T_frame_object))


def _lying(item: LabObject, stand: Host, seen: Pose) -> Iterator[tuple[int, float, Settled]]:
    """On the top of a host as it was turned, not in a slot or on a spot."""
    host, (x, y, low) = stand.item, foot(item, seen)
    off_m = low - host.size_m[2]
    if _takes(host) and _is_over(host, x, y) and abs(off_m) <= HEIGHT_M:
        there = Pose((0.0, 0.0, -off_m)) @ seen
        yield 2, abs(off_m), Settled(host, PlaceRef(host.name, "surface", ""), there)


def _is_over(host: LabObject, x: float, y: float) -> bool:
    return abs(x) <= host.size_m[0] / 2 and abs(y) <= host.size_m[1] / 2


def _candidates(item: LabObject, stand: Host, seen: Pose) -> Iterator[tuple[int, float, Settled]]:
    host, (x, y, z) = stand.item, seen.position_m
    for floor in stand.floors if host.slots is not None else ():
        fx, fy, fz = floor.position_m
        distance_m = math.hypot(x - fx, y - fy)
        near = host.slots is not None and distance_m <= host.slots.bore_m / 2 and abs(z - fz) <= HEIGHT_M
        if near and accepts(host, floor.place, item.roles):
            yield 0, distance_m, Settled(host, floor.place, _upright(seen, fx, fy, fz))
    for spot in host.spots:
        sx, sy, sz = spot.T_object_spot.position_m
        distance_m = math.hypot(x - sx, y - sy)
        if distance_m <= SPOT_M and abs(z - sz) <= HEIGHT_M:
            place = PlaceRef(host.name, "spot", spot.name)
            screwed = _is_screwed(item, place)
            yield 1, distance_m, Settled(host, place, _upright(seen, *((sx, sy) if screwed else (x, y)), sz))
    top = host.size_m[2]
    if _takes(host) and _is_over(host, x, y) and abs(z - top) <= HEIGHT_M:
        yield 2, abs(z - top), Settled(host, PlaceRef(host.name, "surface", ""), _upright(seen, x, y, top))


def _is_screwed(item: LabObject, place: PlaceRef) -> bool:
    """Whether its thread holds it there, which centres it better than eyes see."""
    thread = item.thread
    return thread is not None and (thread.on_object, thread.on_key) == (place.object, place.key)


def leveled(pose: Pose) -> Pose:
    """A pose that leans a little, made upright about its own origin; others as they are."""
    x_axis, _, z_axis = pose.axes()
    if z_axis[2] < math.cos(TILT_RAD):
        return pose
    return Pose.from_rpy(pose.position_m, (0.0, 0.0, math.atan2(x_axis[1], x_axis[0])))


def _upright(seen: Pose, x: float, y: float, z: float) -> Pose:
    """The pose at this point, z up, turned about z as it was seen."""
    x_axis = seen.axes()[0]
    return Pose.from_rpy((x, y, z), (0.0, 0.0, math.atan2(x_axis[1], x_axis[0])))


def _takes(item: LabObject) -> bool:
    return "surface" in item.roles or "place_target" in item.roles
