"""Whether what is known of the bench is known well enough for what is to fit into it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.world import World
from xei_lang.profiles.grid import T_object_slot
from xei_lang.profiles.model import Element, LabObject, Profile
from xei_lang.world.frames import world_at
from xei_lang.world.transforms import Transform, lookup

BASE = "robot_base"


@dataclass(frozen=True, slots=True)
class SlotPrecision:
    """How far an object may miss a slot, or a finger an element of a screen, and how far that may be from
    where the robot takes it to be.

    `capture_m` is the gap around the object and the chamfer that leads it in, or half the element;
    `tolerance_m` is what the error of the slot's mouth, or the element's middle, in the robot's base is taken
    to be at most, along `way`.
    """

    capture_m: float
    tolerance_m: float
    way: Transform

    @property
    def is_enough(self) -> bool:
        """Whether the object finds the slot wherever it may be."""
        return self.tolerance_m <= self.capture_m


@dataclass(frozen=True, slots=True, eq=False)
class Benches:
    """A grounded world as the robot sees it from each station, `by_station`."""

    profile: Profile
    by_station: Mapping[str, World]

    @classmethod
    def of(cls, world: World, profile: Profile) -> Benches:
        """The world with the robot where it is, and the same objects with the robot at the other stations."""
        stations = profile.calibration.stations
        seen = {one.name: world_at(profile, one, world.objects) for one in stations}
        return cls(profile, {**seen, world.robot.station: world})

    def slot(self, holder: LabObject, key: str, item: LabObject) -> SlotPrecision | None:
        """The precision of a slot for an object; None where the slot or its object has no place in the world.

        The bench is taken to be grounded by a camera wherever that is better than the way over the docked
        base.
        """
        grid, T_holder_slot = holder.slots, T_object_slot(holder, key)
        if grid is None or T_holder_slot is None:
            return None
        capture_m = (grid.bore_m - max(item.size_m[:2])) / 2 + grid.chamfer_m
        return self.point(holder.name, T_holder_slot.position_m, capture_m)

    def element(self, screen: LabObject, element: Element) -> SlotPrecision | None:
        """The precision of an element of a touch screen for what touches its middle; None where the screen
        has no place in the world.
        """
        depth, width, _ = screen.size_m
        right, up = element.center_m
        return self.point(screen.name, (-depth / 2, width / 2 - right, up), min(element.size_m) / 2)

    def point(self, holder: str, point_m: Vec3, capture_m: float) -> SlotPrecision | None:
        """The precision of a point of an object, in the object's frame, for what may miss it by `capture_m`;
        None where the object has no place in the world.
        """
        found = [_best_way(world, self.profile, holder, point_m) for world in self._before(holder)]
        known = [way for way in found if way is not None]
        if not known:
            return None
        best = min(known, key=lambda way: way.position_tolerance_m)
        return SlotPrecision(capture_m, best.position_tolerance_m, best)

    def _before(self, holder: str) -> list[World]:
        """The world from the stations that an object is worked from: those that ground a frame it stands in,
        or all of them.
        """
        world = next(iter(self.by_station.values()))
        placed = world.find(holder)
        if placed is None:
            return []
        way = {placed.frame_id, *(link.name for link in lookup(world, "world", placed.frame_id).links)}
        stations = [one.name for one in self.profile.calibration.stations if one.ground_frame in way]
        return [self.by_station[name] for name in stations or self.by_station]


def _best_way(world: World, profile: Profile, holder: str, point_m: Vec3) -> Transform | None:
    placed = world.find(holder)
    if placed is None:
        return None
    T_world_point = world.T_world_frame(placed.frame_id) @ placed.T_frame_object @ Pose(point_m)
    ways = [_way(world, end, T_world_point) for end in (placed.frame_id, *_cameras(world, profile))]
    return min(ways, key=lambda way: way.position_tolerance_m)


def _cameras(world: World, profile: Profile) -> list[str]:
    """The frames of the cameras that ground benches."""
    return [camera.frame for camera in profile.calibration.cameras if world.frame(camera.frame)]


def _way(world: World, end: str, T_world_slot: Pose) -> Transform:
    point = (world.T_world_frame(end).inverse() @ T_world_slot).position_m
    return lookup(world, BASE, end, point)
