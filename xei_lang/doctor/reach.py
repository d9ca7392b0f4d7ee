"""Whether the workspace that a profile allows is one that the arms can work in at all."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.ir.geometry import Vec3
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import Profile
from xei_lang.world.reach import arm_reaches

Box = tuple[Vec3, Vec3]
_AXES = "xyz"


def reach_blockers(profile: Profile) -> Iterator[Blocker]:
    """Sides of the workspace bounds that lie beyond everything that any hand can come to."""
    lower, upper = profile.calibration.workspace_bounds_m
    reached = tool_bounds(profile)
    if reached is None:
        return
    for name, bound, sign, limit in (("lower", lower, -1.0, reached[0]), ("upper", upper, 1.0, reached[1])):
        for axis, value, far in zip(_AXES, bound, limit, strict=True):
            if sign * (value - far) > 0.0:
                item = f"workspace.{name}.{axis}"
                measure = f"bring it to {far:.2f} m at most: it is {value:.2f} m, and no hand comes that far"
                measure = measure if sign > 0 else measure.replace("at most", "at least")
                yield Blocker(
                    "XEI0675",
                    "calibration_profile",
                    item,
                    "out of reach",
                    "hardware",
                    measure,
                    f"{CALIBRATION}:{item}",
                )


def tool_bounds(profile: Profile) -> Box | None:
    """A box in the robot's root frame, m, that holds every point that a tool frame can come to; None for a
    robot without tools.

    An outer bound: each arm is taken as a chain that stretches straight from the first of its joints that
    turns, at both ends of the slide.
    """
    arms = arm_reaches(profile)
    if not arms:
        return None
    spheres = [(center, arm.radius_m) for arm in arms for center in (arm.lowest_m, arm.highest_m)]
    lower = tuple(min(center[axis] - radius for center, radius in spheres) for axis in range(3))
    upper = tuple(max(center[axis] + radius for center, radius in spheres) for axis in range(3))
    return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])
