"""Paths of the tool that a template states: a turn about an axis (arc, screw) and a cover of a rectangle
(raster).

They are told in the base frame of the goal's epoch and begin where the goal before left the tool, so that
they say how the tool is displaced: `T_base_tool(share) = displacement(share) @ T_base_tool(0)`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose, Vec3


@dataclass(frozen=True, slots=True)
class Turn:
    """The tool turns by `angle_rad` (right-handed, more than a revolution allowed) about the line through
    `point_m` along the unit vector `direction`, and moves by `lead_m` along it per revolution.

    An arc has no lead: what lies on the line stays where it is.
    """

    point_m: Vec3
    direction: Vec3
    angle_rad: float
    lead_m: float = 0.0

    @property
    def travel_m(self) -> float:
        """The way along the axis at the end, signed."""
        return self.lead_m * self.angle_rad / math.tau

    def end(self) -> Pose:
        """The whole displacement."""
        half = self.angle_rad / 2
        x, y, z = (math.sin(half) * value for value in self.direction)
        turned = Pose((0.0, 0.0, 0.0), (x, y, z, math.cos(half))) @ Pose()
        px, py, pz = self.point_m
        along = (self.travel_m * value for value in self.direction)
        qx, qy, qz = (a + b for a, b in zip(self.point_m, along, strict=True))
        return Pose((qx, qy, qz)) @ turned @ Pose((-px, -py, -pz))


@dataclass(frozen=True, slots=True)
class Raster:
    """The tool covers a rectangle and keeps its orientation: the origin of the target's reference goes from
    `corner_m` to and fro along `along_m`, lane after lane across `across_m`.

    The two edges stand at right angles. Lanes are even and at most `pitch_m` apart, the first and the last
    on the rectangle's edges. Half circles, half a lane's distance in radius, join them inside the rectangle;
    so no point of it is farther than 0.71 of that distance from the path.
    """

    corner_m: Vec3
    along_m: Vec3
    across_m: Vec3
    pitch_m: float

    @property
    def lanes(self) -> int:
        """How many lanes there are."""
        width = math.hypot(*self.across_m)
        return 1 if width <= 1e-9 else 1 + max(1, math.ceil(width / self.pitch_m - 1e-9))

    @property
    def lane_distance_m(self) -> float:
        """From lane to lane; 0 for a single one."""
        return math.hypot(*self.across_m) / max(1, self.lanes - 1)

    def end(self) -> Pose:
        """The whole displacement."""
        along = self.along_m if self.lanes % 2 else (0.0, 0.0, 0.0)
        x, y, z = (a + b for a, b in zip(along, self.across_m, strict=True))
        return Pose((x, y, z))


ToolPath = Turn | Raster
