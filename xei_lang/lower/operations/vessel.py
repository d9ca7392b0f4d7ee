"""A round vessel as pouring sees it: how much stays in it at which tilt."""

from __future__ import annotations

import math
from dataclasses import dataclass

_STEPS = 60


@dataclass(frozen=True, slots=True)
class Vessel:
    """A straight cylinder, open at its top: inner radius and inner height, m."""

    radius_m: float
    height_m: float

    @property
    def brimful_m3(self) -> float:
        """What it holds upright, filled to the brim."""
        return math.pi * self.radius_m**2 * self.height_m

    def holds_m3(self, tilt_rad: float) -> float:
        """The most that stays in it at a tilt from upright, in [0, pi/2]: what lies under the level plane
        through its lip.

        At a distance u from the axis, towards the lip positive, the liquid stands `(u - dry) tan(tilt)` high
        over the bottom from `dry` on, times the chord of the circle at u. Integrated in closed form: where
        the bottom is covered it is a cylinder cut askew, else a cylindrical hoof.
        """
        r, slope = self.radius_m, math.tan(min(tilt_rad, math.pi / 2 - 1e-9))
        if self.height_m >= 2 * r * slope:
            return math.pi * r**2 * (self.height_m - r * slope)
        dry = 1.0 - self.height_m / (r * slope)
        chord = math.sqrt(1.0 - dry * dry)
        return slope * r**3 * (2 / 3 * chord**3 - dry * (math.acos(dry) - dry * chord))

    def tilt_rad(self, left_m3: float) -> float:
        """The tilt at which just `left_m3` stay in it; 0 where it is brimful, 90 degrees for nothing."""
        low, high = 0.0, math.pi / 2
        for _ in range(_STEPS):
            middle = (low + high) / 2
            low, high = (middle, high) if self.holds_m3(middle) > left_m3 else (low, middle)
        return high
