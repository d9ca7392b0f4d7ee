"""How the base drives: straight ahead or backwards, and turns in place; the way of least time by the map.

That is what nominal drives were timed as before there was a map, and what any base can do, with two driven
wheels or four that are steered. Where one turn, one leg and one turn get there, that is the way; else a
lattice is searched (`lattice.py`) and what it finds is made shorter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from xei_lang.world.map.footprint import Footprint
from xei_lang.world.map.grid import OccupancyGrid
from xei_lang.world.map.sweep import Station, is_leg_free, is_turn_free

_SAME = 1e-9


@dataclass(frozen=True, slots=True)
class Floor:
    """What drives are planned on: the map, the base's outline, how fast it goes and turns (m/s, rad/s)."""

    grid: OccupancyGrid
    footprint: Footprint
    speed_m_s: float
    turn_rad_s: float

    def seconds(self, poses: tuple[Station, ...]) -> float:
        """How long a way takes at these speeds."""
        length_m, turn_rad = measures(poses)
        return length_m / self.speed_m_s + turn_rad / self.turn_rad_s


def plan_drive(floor: Floor, start: Station, goal: Station) -> tuple[Station, ...] | None:
    """The poses from start to goal, one after each turn or leg; None where there is no way.

    There and back are the same way, so that one of the two is searched only.
    """
    if goal < start:
        back = plan_drive(floor, goal, start)
        return None if back is None else back[::-1]
    direct = straight_way(floor, start, goal)
    if direct is not None:
        return direct
    from xei_lang.world.map.lattice import search

    found = search(floor, start, goal)
    return None if found is None else _shortened(floor, _tidy(floor, found))


def straight_way(floor: Floor, start: Station, goal: Station) -> tuple[Station, ...] | None:
    """One turn, one leg and one turn, ahead or backwards, whichever is quicker of those that are free."""
    distance_m = math.dist(start[:2], goal[:2])
    if distance_m < _SAME:
        ways = [(start, goal)]
    else:
        ahead = math.atan2(goal[1] - start[1], goal[0] - start[0])
        headings = (ahead, _wrapped(ahead + math.pi))
        ways = [(start, (*start[:2], yaw), (*goal[:2], yaw), goal) for yaw in headings]
    for way in sorted(ways, key=floor.seconds):
        if is_free(floor, way):
            return _tidy(floor, way)
    return None


def is_free(floor: Floor, poses: tuple[Station, ...]) -> bool:
    """Whether every turn and leg of a way stays on free floor."""
    return all(_is_step_free(floor, a, b) for a, b in pairwise(poses))


def measures(poses: tuple[Station, ...]) -> tuple[float, float]:
    """The length of all legs (m) and the sum of all turns (rad)."""
    length_m = sum(math.dist(a[:2], b[:2]) for a, b in pairwise(poses))
    return length_m, sum(abs(_wrapped(b[2] - a[2])) for a, b in pairwise(poses))


def _is_step_free(floor: Floor, a: Station, b: Station) -> bool:
    turn = _wrapped(b[2] - a[2])
    if math.dist(a[:2], b[:2]) > _SAME and not is_leg_free(floor.grid, floor.footprint, a, b[:2]):
        return False
    return is_turn_free(floor.grid, floor.footprint, b[:2], a[2], turn)


def _shortened(floor: Floor, poses: tuple[Station, ...]) -> tuple[Station, ...]:
    """The way with detours taken out, until none is found."""
    while True:
        shorter = _tidy(floor, _without_detours(floor, poses))
        if floor.seconds(shorter) >= floor.seconds(poses) - _SAME:
            return shorter
        poses = shorter


def _without_detours(floor: Floor, poses: tuple[Station, ...]) -> tuple[Station, ...]:
    """From each pose straight to the last one that is come to quicker so."""
    kept: list[Station] = [poses[0]]
    index = 0
    while index < len(poses) - 1:
        for later in range(len(poses) - 1, index + 1, -1):
            taken_s = floor.seconds(poses[index : later + 1])
            straight = straight_way(floor, poses[index], poses[later])
            if straight and floor.seconds(straight) < taken_s - _SAME:
                kept += straight[1:]
                index = later
                break
        else:
            index += 1
            kept.append(poses[index])
    return tuple(kept)


def _tidy(floor: Floor, poses: tuple[Station, ...]) -> tuple[Station, ...]:
    """Poses without repetitions; legs that go on in the same direction, and turns after turns, made one."""
    kept: list[Station] = [poses[0]]
    for pose in poses[1:]:
        while len(kept) > 1 and _goes_on(kept[-2], kept[-1], pose) and _is_step_free(floor, kept[-2], pose):
            kept.pop()
        if not _is_same(kept[-1], pose):
            kept.append(pose)
    return (*kept[:-1], poses[-1]) if len(kept) > 1 else (poses[0], poses[-1])


def _is_same(a: Station, b: Station) -> bool:
    return math.dist(a[:2], b[:2]) < _SAME and abs(_wrapped(a[2] - b[2])) < _SAME


def _goes_on(a: Station, b: Station, c: Station) -> bool:
    """Whether c lies on the straight leg from a beyond b, or all three are one place."""
    first, second = math.dist(a[:2], b[:2]), math.dist(b[:2], c[:2])
    if max(first, second) < _SAME:
        return True
    if max(abs(_wrapped(b[2] - a[2])), abs(_wrapped(c[2] - b[2]))) > _SAME:
        return False
    return abs(math.dist(a[:2], c[:2]) - first - second) < _SAME


def _wrapped(angle: float) -> float:
    """The angle in -pi .. pi, rad."""
    return math.remainder(angle, 2.0 * math.pi)
