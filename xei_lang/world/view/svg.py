"""The world from above, as SVG: x up, y to the left, in mm, as one who stands behind the robot sees it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.sax.saxutils import escape

from xei_lang.ir.geometry import Cylinder, Pose, Vec3
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.grid import T_object_slot, slot_keys
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.ground import is_prior
from xei_lang.world.reach import ArmReach, arm_reaches, stations_that_reach
from xei_lang.world.view.table import reach_text

_MARGIN_MM = 120.0
_LARGEST_M = 3.0
"""Floors and rooms are not drawn: they would make all else small."""
_STYLE = """text{font:22px sans-serif;text-anchor:middle;dominant-baseline:middle}
.system{fill:#f3efe6;stroke:#8a8372}.prior{fill:#e9e9e9;stroke:#777;stroke-dasharray:8 5}
.seen{fill:#cfe3f6;stroke:#2b6ca3}.slot{fill:#fff;stroke:#999}.key{font-size:13px;fill:#666}
.reach{fill:none;stroke-dasharray:3 9}.left{stroke:#2b6ca3}.right{stroke:#b5561c}.base{fill:#444}"""


def to_svg(world: World, profile: Profile) -> str:
    """A drawing of the benches: tables, objects with their names and slots, bases of the stations, and how
    far each arm comes at most at the height of the station's bench.

    What was seen is filled with blue; what only a prior places has a dashed edge.
    """
    drawn = [item for item in world.objects if max(item.size_m[:2]) <= _LARGEST_M]
    drawn.sort(key=lambda item: (world.T_world_object(item.name).position_m[2], item.name))
    shapes = [line for item in drawn for line in _object(item, world, profile)]
    names = [_name(item, world, profile) for item in drawn]
    stations = list(_stations(world, profile))
    left, top, width, height = _view(world, profile, drawn)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left:.0f} {top:.0f} {width:.0f} {height:.0f}" '
        f'stroke-width="3">'
    )
    title = f"<title>{escape(profile.name)}, asked: {escape(', '.join(world.sources))}</title>"
    return "\n".join([head, title, f"<style>{_STYLE}</style>", *shapes, *stations, *names, "</svg>", ""])


def _object(item: WorldObject, world: World, profile: Profile) -> Iterator[str]:
    known = profile.object(item.name)
    pose = world.T_world_object(item.name)
    x, y = _mm(pose.position_m)
    kind = "system" if known is not None and known.system else "prior" if is_prior(item) else "seen"
    title = f"<title>{escape(_title(item, world, profile, known))}</title>"
    if known is not None and isinstance(known.shape, Cylinder):
        radius = known.shape.radius_m * 1000
        yield f'<circle class="{kind}" cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}">{title}</circle>'
    else:
        yield f'<polygon class="{kind}" points="{_corners(pose, item.size_m)}">{title}</polygon>'
    if known is not None and known.slots is not None:
        radius = known.slots.bore_m * 500
        for key in slot_keys(known.slots):
            T_object_mouth = T_object_slot(known, key)
            if T_object_mouth is not None:
                sx, sy = _mm((pose @ T_object_mouth).position_m)
                yield f'<circle class="slot" cx="{sx:.1f}" cy="{sy:.1f}" r="{radius:.1f}"/>'
                yield f'<text class="key" x="{sx:.1f}" y="{sy + radius + 9:.1f}">{escape(key)}</text>'


def _title(item: WorldObject, world: World, profile: Profile, known: LabObject | None) -> str:
    said = dict(item.provenance).get("pose", "")
    where = f" in {item.place}" if item.place else ""
    reach = ""
    if known is None or not known.system:
        reach = f"; within reach: {reach_text(stations_that_reach(profile, world, item.name))}"
    return f"{item.name}{where}: {said}, confidence {item.confidence:g}{reach}"


def _name(item: WorldObject, world: World, profile: Profile) -> str:
    """The name in the middle; at the far edge of a table, under a thing with slots, small over what is in
    one.
    """
    pose, known = world.T_world_object(item.name), profile.object(item.name)
    x, y = _mm(pose.position_m)
    corners = [point.split(",")[1] for point in _corners(pose, item.size_m).split()]
    small = ""
    if known is not None and known.system:
        y = min(float(corner) for corner in corners) + 20
    elif known is not None and known.slots is not None:
        y = max(float(corner) for corner in corners) + 16
    elif ".slot(" in item.place:
        small, y = ' class="key"', y - item.size_m[0] * 500 - 8
    return f'<text{small} x="{x:.1f}" y="{y:.1f}">{escape(item.name)}</text>'


def _stations(world: World, profile: Profile) -> Iterator[str]:
    """The base of each station as an arrow, and the arms' reach there at the height of its bench."""
    for station in profile.calibration.stations:
        pose = station.T_world_base
        tip, *back = (
            _mm(pose.apply(point)) for point in ((0.15, 0.0, 0.0), (-0.1, 0.1, 0.0), (-0.1, -0.1, 0.0))
        )
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in (tip, *back))
        x, y = _mm(pose.apply((-0.16, 0.0, 0.0)))
        yield f'<polygon class="base" points="{points}"/>'
        yield f'<text x="{x:.1f}" y="{y:.1f}">{escape(station.name)}</text>'
        bench = world.frame(station.ground_frame)
        height_m = world.T_world_frame(bench.name).position_m[2] if bench else pose.position_m[2]
        for arm in arm_reaches(profile):
            radius = _radius_m(arm, height_m - pose.position_m[2]) * 1000
            cx, cy = _mm(pose.apply(arm.lowest_m))
            title = f"<title>{escape(arm.arm)} arm at {escape(station.name)}, at most</title>"
            circle = f'<circle class="reach {escape(arm.arm)}" cx="{cx:.1f}" cy="{cy:.1f}" r="{radius:.1f}">'
            yield f"{circle}{title}</circle>"


def _radius_m(arm: ArmReach, height_m: float) -> float:
    """The radius of the reach at a height over the floor of the base."""
    nearest = min(max(height_m, arm.lowest_m[2]), arm.highest_m[2])
    return math.sqrt(max(0.0, arm.radius_m**2 - (height_m - nearest) ** 2))


def _view(world: World, profile: Profile, drawn: list[WorldObject]) -> tuple[float, float, float, float]:
    """Left, top, width and height of what is drawn, with a margin, mm."""
    points = [_mm(station.T_world_base.position_m) for station in profile.calibration.stations]
    for item in drawn:
        x, y = _mm(world.T_world_object(item.name).position_m)
        far = math.hypot(*item.size_m[:2]) * 500
        points += [(x - far, y - far), (x + far, y + far)]
    left, top = min(x for x, _ in points) - _MARGIN_MM, min(y for _, y in points) - _MARGIN_MM
    right, bottom = max(x for x, _ in points) + _MARGIN_MM, max(y for _, y in points) + 2 * _MARGIN_MM
    return left, top, right - left, bottom - top


def _corners(pose: Pose, size_m: Vec3) -> str:
    dx, dy = size_m[0] / 2, size_m[1] / 2
    corners = [_mm(pose.apply((x, y, 0.0))) for x, y in ((dx, dy), (-dx, dy), (-dx, -dy), (dx, -dy))]
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)


def _mm(point_m: Vec3) -> tuple[float, float]:
    """A point of `world` on the drawing: right is -y, down is -x."""
    return (-point_m[1] * 1000 + 0.0, -point_m[0] * 1000 + 0.0)
