"""The holes of an object that other things go into: the inside of a vessel, the bores of a rack.

Vessels are taken as straight cylinders with a bottom as thick as their wall, as in pouring and pipetting.
"""

from __future__ import annotations

from xei_lang.ir.geometry import Cylinder, Pose
from xei_lang.ir.world import Opening
from xei_lang.profiles.grid import is_tip_grid
from xei_lang.profiles.model import LabObject, Profile, SlotGrid

_TIP_ROOM_M = 0.001
"""Room about a tip in its box: tips taper, and are known by their widest diameter alone."""


def openings_of(item: LabObject, profile: Profile) -> tuple[Opening, ...]:
    """The openings that the usage profile states of an object: `liquid.inner_diameter` and `slots.bore`."""
    found: list[Opening] = []
    if item.liquid is not None and isinstance(item.shape, Cylinder):
        radius_m = item.liquid.inner_diameter_m / 2
        height_m = item.shape.height_m
        bottom_m = item.shape.radius_m - radius_m
        found.append(Opening(Pose((0.0, 0.0, height_m)), radius_m, height_m - bottom_m))
    if item.slots is not None:
        grid, (x, y, z) = item.slots, item.slots.origin_m
        mouth = Pose((x - item.size_m[0] / 2, y - item.size_m[1] / 2, z))
        counts = (grid.columns, len(grid.rows))
        found.append(Opening(mouth, _radius_m(grid, profile), grid.depth_m, counts, grid.pitch_m))
    return tuple(found)


def _radius_m(grid: SlotGrid, profile: Profile) -> float:
    """The bore's; of a box of tips the tips' own, since a pipette goes there with a tip that it takes out."""
    tips = (other.tip for other in profile.objects if other.tip is not None)
    widths = [tip.diameter_m / 2 + _TIP_ROOM_M for tip in tips if is_tip_grid(grid, tip)]
    return max(widths, default=grid.bore_m / 2)
