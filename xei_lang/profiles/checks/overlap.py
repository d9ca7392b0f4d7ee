"""Objects whose priors put them into each other.

Boxes and cylinders that stand upright are tested exactly in the plane; what leans or lies, and other shapes,
as convex solids. An object may overlap what it stands in.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.ir.geometry import Box, Cylinder, Pose, Shape
from xei_lang.profiles.checks.convex import TOUCH_M, Convex, convex, convex_overlap_m
from xei_lang.profiles.grid import T_frame_object, T_world_frame, prior_chain
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.quantity.lengths import mm


@dataclass(frozen=True, slots=True)
class Upright:
    """A solid that stands upright in `world`: a footprint (a disc, or a rectangle turned by `yaw_rad`) over a
    range of z.
    """

    x_m: float
    y_m: float
    lower_m: float
    upper_m: float
    yaw_rad: float
    half_m: tuple[float, float]
    radius_m: float

    @property
    def as_convex(self) -> Convex:
        """The same solid, for one that leans to be held against."""
        c, s = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        centre = (self.x_m, self.y_m, (self.lower_m + self.upper_m) / 2)
        axes = ((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0))
        return Convex(centre, axes, (*self.half_m, (self.upper_m - self.lower_m) / 2), disc_m=self.radius_m)


Solid = Upright | Convex


def check_overlap(profile: Profile) -> Iterator[Diagnostic]:
    """Pairs of objects that stand in each other, each pair once."""
    solids = [(item, _solids(profile, item)) for item in profile.objects]
    for index, (first, parts) in enumerate(solids):
        for second, others in solids[index + 1 :]:
            if second in prior_chain(profile, first) or first in prior_chain(profile, second):
                continue
            if first.system and second.system and not _all_upright(parts, others):
                continue  # Furniture whose measured frame leans a little reaches into the floor a little.
            depth = max((overlap_m(a, b) for a in parts for b in others), default=0.0)
            if depth > TOUCH_M:
                yield _diagnostic(first, second, depth)


def _diagnostic(first: LabObject, second: LabObject, depth_m: float) -> Diagnostic:
    mover, other = (second, first) if first.system else (first, second)
    span = mover.prior.span if mover.prior else mover.span
    other_span = other.prior.span if other.prior else other.span
    return Diagnostic(
        "XEI0642",
        f"`{mover.name}` and `{other.name}` stand in each other",
        span,
        label=f"overlaps by {mm(depth_m)}",
        labels=(Label(other_span, f"`{other.name}` stands here"),),
        help=("move one of the two, or correct its size",),
    )


def _all_upright(parts: tuple[Solid, ...], others: tuple[Solid, ...]) -> bool:
    return all(isinstance(part, Upright) for part in (*parts, *others))


def _solids(profile: Profile, item: LabObject) -> tuple[Solid, ...]:
    placed = T_frame_object(profile, item)
    T_world_frame_ = T_world_frame(profile, placed[0]) if placed else None
    return solids_at(item, T_world_frame_ @ placed[1]) if placed and T_world_frame_ else ()


def solids_at(item: LabObject, T_world_object: Pose) -> tuple[Solid, ...]:
    """The parts of an object where it is put."""
    return tuple(_solid(part.shape, T_world_object @ part.T_object_shape) for part in item.geometry)


def _solid(shape: Shape, pose: Pose) -> Solid:
    x_axis, _, z_axis = pose.axes()
    if z_axis[2] < 1.0 - 1e-9 or not isinstance(shape, (Box, Cylinder)):
        return convex(shape, pose)
    x, y, z = pose.position_m
    height = shape.size_m[2] if isinstance(shape, Box) else shape.height_m
    half = (shape.size_m[0] / 2, shape.size_m[1] / 2) if isinstance(shape, Box) else (0.0, 0.0)
    radius = shape.radius_m if isinstance(shape, Cylinder) else 0.0
    return Upright(x, y, z - height / 2, z + height / 2, math.atan2(x_axis[1], x_axis[0]), half, radius)


def lowest_m(item: LabObject, T_frame_object: Pose) -> float:
    """The height in a frame of an object's lowest point; its origin's where it has no geometry."""
    parts = solids_at(item, T_frame_object)
    heights = [part.lower_m if isinstance(part, Upright) else _lowest(part) for part in parts]
    return min(heights, default=T_frame_object.position_m[2])


def _lowest(part: Convex) -> float:
    return part.centre_m[2] - part.reach_m((0.0, 0.0, 1.0))


def overlap_m(a: Solid, b: Solid) -> float:
    """How deep two solids are in each other, by the best direction to part them; at most 0 where apart."""
    if isinstance(a, Upright) and isinstance(b, Upright):
        return _upright_overlap_m(a, b)
    one, other = (solid.as_convex if isinstance(solid, Upright) else solid for solid in (a, b))
    return convex_overlap_m(one, other)


def _upright_overlap_m(a: Upright, b: Upright) -> float:
    """The overlap of two solids that stand upright.

    A disc is a rectangle of zero size with a rounding radius. Footprints are parted along the rectangles'
    axes and, for a disc, also along the direction from the other footprint's nearest point (the separating
    axis theorem).
    """
    vertical = min(a.upper_m, b.upper_m) - max(a.lower_m, b.lower_m)
    axes = [
        (math.cos(yaw), math.sin(yaw))
        for solid in (a, b)
        for yaw in (solid.yaw_rad, solid.yaw_rad + math.pi / 2)
    ]
    for disc, other in ((a, b), (b, a)):
        if disc.radius_m > 0.0:
            near = _nearest(other, disc.x_m, disc.y_m)
            dx, dy = disc.x_m - near[0], disc.y_m - near[1]
            length = math.hypot(dx, dy)
            if length > 0.0:
                axes.append((dx / length, dy / length))
    return min(vertical, *(_along(a, b, axis) for axis in axes))


def _along(a: Upright, b: Upright, axis: tuple[float, float]) -> float:
    apart = abs((b.x_m - a.x_m) * axis[0] + (b.y_m - a.y_m) * axis[1])
    return _reach(a, axis) + _reach(b, axis) - apart


def _reach(solid: Upright, axis: tuple[float, float]) -> float:
    c, s = math.cos(solid.yaw_rad), math.sin(solid.yaw_rad)
    along_x, along_y = abs(axis[0] * c + axis[1] * s), abs(axis[1] * c - axis[0] * s)
    return solid.half_m[0] * along_x + solid.half_m[1] * along_y + solid.radius_m


def _nearest(solid: Upright, x: float, y: float) -> tuple[float, float]:
    """The point of the rectangle (for a disc: its centre) that is nearest to a point."""
    c, s = math.cos(solid.yaw_rad), math.sin(solid.yaw_rad)
    dx, dy = x - solid.x_m, y - solid.y_m
    u = max(-solid.half_m[0], min(solid.half_m[0], dx * c + dy * s))
    v = max(-solid.half_m[1], min(solid.half_m[1], dy * c - dx * s))
    return solid.x_m + u * c - v * s, solid.y_m + u * s + v * c
