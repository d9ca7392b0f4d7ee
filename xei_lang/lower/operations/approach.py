"""Approach: how far the open hand stands back before it comes in along the tool's z axis, and where that
is.
"""

from __future__ import annotations

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.lower.hand import Hand

_FREE_M = 0.010


def standoff_needed_m(depth_m: float, half_depth_m: float, down: float, level: float, hand: Hand) -> float:
    """The way back, along the approach, that takes the fingertips 10 mm clear of the object; `down` and
    `level` are sine and cosine of the approach's elevation.

    The object's extent against the approach from the grasp point (`depth_m` under its top, on its axis) is
    that of its upright outline; the fingertips reach further than the grasp point.
    """
    extent = depth_m * down + half_depth_m * level
    return extent + hand.fingertip_m + _FREE_M


def back_off(family_id: str, T_base_reference: Pose, standoff_m: float, turn: bool = False) -> ToolTarget:
    """The tool stands off its place at the reference by `standoff_m`, straight back along its approach."""
    return ToolTarget(family_id, T_base_reference, (0.0, 0.0, 0.0), (0.0, 0.0, -standoff_m), turn)
