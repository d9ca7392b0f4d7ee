"""What sources say and cannot be: two things in one place, things in each other, under a table, out of reach
of every station.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.checks.convex import TOUCH_M
from xei_lang.profiles.checks.leaning import leans, turned_text
from xei_lang.profiles.checks.overlap import Solid, Upright, overlap_m, solids_at
from xei_lang.profiles.model import Profile
from xei_lang.quantity.lengths import mm
from xei_lang.world.places import place_text
from xei_lang.world.sources.belief import Belief
from xei_lang.world.sources.settle import HEIGHT_M, foot, leveled
from xei_lang.world.sources.standing import Standing

_CODE = "XEI0658"


@dataclass(frozen=True, slots=True)
class Known:
    """An object of which something is known: who said so, and where it stands by that."""

    belief: Belief
    standing: Standing

    @property
    def name(self) -> str:
        """The object's name."""
        return self.belief.item.name

    @property
    def is_moved(self) -> bool:
        """Whether it is not just where its prior has it: it was seen, or what it stands in was."""
        return self.belief.seen is not None or bool(self.standing.carried_by)


def contradictions(
    profile: Profile, known: tuple[Known, ...], frames: Mapping[str, Pose]
) -> Iterator[Diagnostic]:
    """One error for each object, or pair of objects, that cannot be where the sources have it."""
    shared: set[frozenset[str]] = set()
    for first, second, place in _shared_places(known):
        shared.add(frozenset((first.name, second.name)))
        yield _error(
            first,
            f"`{first.name}` was seen in `{place}`, where `{second.name}` is",
            f"taken by `{second.name}`",
            second,
        )
    for one in known:
        if one.belief.seen is not None and not one.belief.item.system:
            yield from _outside(profile, one)
            yield from _below(profile, one, frames)
    for first, second, depth_m in _overlaps(known):
        pair, carriers = frozenset((first.name, second.name)), frozenset((_carrier(first), _carrier(second)))
        if pair not in shared and (pair == carriers or carriers not in shared):
            shared |= {pair, carriers}
            message = f"`{first.name}` and `{second.name}` would stand in each other"
            yield _error(first, message, f"overlap by {mm(depth_m)}", second)


def _shared_places(known: tuple[Known, ...]) -> Iterator[tuple[Known, Known, str]]:
    taken: dict[str, Known] = {}
    for one in sorted(known, key=lambda item: (item.belief.seen is not None, item.name)):
        place = one.standing.place
        if place is None or not place.key:
            continue
        text = place_text(place)
        if text in taken and one.belief.seen is not None:
            yield one, taken[text], text
        taken.setdefault(text, one)


def _outside(profile: Profile, one: Known) -> Iterator[Diagnostic]:
    lower, upper = profile.calibration.workspace_bounds_m
    seen_m = one.standing.T_world_object.position_m
    for station in profile.calibration.stations:
        at = station.T_world_base.inverse().apply(seen_m)
        if all(low <= value <= high for low, value, high in zip(lower, at, upper, strict=True)):
            return
    where = ", ".join(f"{value:.2f}" for value in seen_m)
    message = f"`{one.name}` was seen outside of the workspace of every station"
    yield _error(one, message, f"at ({where}) m in `world`")


def _below(profile: Profile, one: Known, frames: Mapping[str, Pose]) -> Iterator[Diagnostic]:
    """Things seen lower than a table top, within its bounds."""
    lower, upper = profile.calibration.table_bounds_m
    for name in sorted({station.ground_frame for station in profile.calibration.stations}):
        T_world_table = frames.get(name)
        if T_world_table is None:
            continue
        x, y, z = foot(one.belief.item, T_world_table.inverse() @ one.standing.T_world_object)
        if lower[0] <= x <= upper[0] and lower[1] <= y <= upper[1] and z < -HEIGHT_M:
            reaches = "would reach" if leans(one.standing.T_world_object) else "was seen"
            message = f"`{one.name}` {reaches} {mm(-z)} below the top of `{name}`"
            yield _error(one, message, "expected a height of 0 or above")


def _overlaps(known: tuple[Known, ...]) -> Iterator[tuple[Known, Known, float]]:
    """Pairs of which one at least was moved by what was seen, with how deep they are in each other.

    What leans a little is taken to be upright, and what leans more as it is; what was put into or onto a
    thing touches it rightly, and so does furniture the floor.
    """
    known = tuple(sorted(known, key=lambda one: (bool(one.standing.carried_by), one.name)))
    bodies = [(one, solids_at(one.belief.item, leveled(one.standing.T_world_object))) for one in known]
    extents, moved = [_extent(one) for one in known], [one.is_moved for one in known]
    for index, (first, parts) in enumerate(bodies):
        for other in range(index):
            second, others = bodies[other]
            if not (moved[index] or moved[other]) or not _near(extents[index], extents[other]):
                continue
            if _belong_together(first, second):
                continue
            depth_m = max((_depth_m(a, b) for a in parts for b in others), default=0.0)
            if depth_m > TOUCH_M:
                pair = (first, second) if first.belief.seen is not None else (second, first)
                yield *pair, depth_m


def _depth_m(a: Solid, b: Solid) -> float:
    if isinstance(a, Upright) and isinstance(b, Upright):
        apart = a.lower_m >= b.upper_m or b.lower_m >= a.upper_m
        return 0.0 if apart else overlap_m(a, b)
    return overlap_m(a, b)


def _carrier(one: Known) -> str:
    """What takes it along: a rack in the way is told of once, and not for each tube in it."""
    return one.standing.carried_by or one.name


def _belong_together(first: Known, second: Known) -> bool:
    hosts = [(one.standing.place.object if one.standing.place else "") for one in (first, second)]
    both_furniture = first.belief.item.system and second.belief.item.system
    return both_furniture or hosts[0] == second.name or hosts[1] == first.name


@dataclass(frozen=True, slots=True)
class _Extent:
    """An upright cylinder (m, in `world`) that an object is within."""

    x: float
    y: float
    radius: float
    lower: float
    upper: float


def _extent(one: Known) -> _Extent:
    size, pose = one.belief.item.size_m, leveled(one.standing.T_world_object)
    if pose.axes()[2][2] > 1.0 - 1e-9:
        x, y, z = pose.position_m
        return _Extent(x, y, math.hypot(size[0], size[1]) / 2, z, z + size[2])
    x, y, z = pose.apply((0.0, 0.0, size[2] / 2))
    radius = math.hypot(*size) / 2
    return _Extent(x, y, radius, z - radius, z + radius)


def _near(a: _Extent, b: _Extent) -> bool:
    if a.lower >= b.upper or b.lower >= a.upper:
        return False
    return math.hypot(a.x - b.x, a.y - b.y) < a.radius + b.radius


def _error(one: Known, message: str, label: str, other: Known | None = None) -> Diagnostic:
    seen = one.belief.seen
    span = seen.span if seen else None
    both = [item for item in (one, other) if item is not None]
    says = [_who(item) for item in both]
    says += [
        f"`{item.name}`: {turned_text(item.standing.T_world_object)}" for item in both if _is_turned(item)
    ]
    labels = ()
    if other is not None and other.belief.seen is not None and other.belief.seen.span is not None:
        labels = (Label(other.belief.seen.span, f"`{other.name}` was seen here"),)
    help_ = "look again, or correct what is wrong"
    if other is not None and other.belief.seen is None and not other.belief.item.system:
        help_ = f"look for `{other.name}` too, or say that it is absent: only its prior has it there"
    return Diagnostic(_CODE, message, span, label if span else "", labels, tuple(says), (help_,))


def _is_turned(one: Known) -> bool:
    return one.belief.seen is not None and leans(one.standing.T_world_object)


def _who(one: Known) -> str:
    if one.belief.seen is not None:
        return f"`{one.name}` was placed by {one.belief.seen.source}"
    if one.standing.carried_by:
        return f"`{one.name}` is where its prior has it in `{one.standing.carried_by}`, which was seen"
    return f"`{one.name}` is where its prior has it"
