"""The safety gate: each sample of a goal is checked against the profile before an executor sees it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from xei_lang.ir.geometry import Vec3
from xei_lang.ir.goals import Attach, JointTarget, MotionGoal, MoveTo
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.runtime.failure import Failure, failure
from xei_lang.runtime.state import RunState
from xei_lang.runtime.tool import Tools

POSITION_TOLERANCE = 1e-6
VELOCITY_TOLERANCE = 0.02
"""A parameterisation holds its limits at its grid points; between them it may pass by this share."""


@dataclass(frozen=True, slots=True)
class Passed:
    """What the gate saw of a goal that it let through: ratios of 1.0 are at the limit."""

    samples: int
    speed: float
    peak_velocity_ratio: float
    payload_kg: float

    def to_json(self) -> dict[str, Any]:
        """As the trace keeps it."""
        return {
            "samples": self.samples,
            "speed": self.speed,
            "peak_velocity_ratio": round(self.peak_velocity_ratio, 6),
            "payload_kg": self.payload_kg,
        }


@dataclass(frozen=True, slots=True)
class Gate:
    """The limits of one run. `speed` scales the whole plan's clock, in (0, 1]."""

    profile: Profile
    world: World
    tools: Tools
    speed: float

    def check(
        self, goal: MotionGoal, timed: TimedGoal, state: RunState, running: tuple[TimedGoal, ...]
    ) -> Passed | Failure:
        """What was seen of the goal, or why it may not run."""
        payload = self._payload(goal, state)
        if isinstance(payload, Failure):
            return payload
        ratio = self._joints(goal, timed)
        if isinstance(ratio, Failure):
            return ratio
        outside = self._workspace(goal, timed, state, running)
        if outside:
            return outside
        return Passed(len(timed.samples.times_s) if timed.samples else 0, self.speed, ratio, payload)

    def _payload(self, goal: MotionGoal, state: RunState) -> float | Failure:
        held = dict(state.holding)
        if isinstance(goal.action, Attach):
            held[goal.action.arm] = goal.action.object
        heaviest, allowed = 0.0, self.profile.calibration.payload_kg
        for arm, name in held.items():
            riders = state.riders(name)
            mass = sum(found.mass_kg for one in (name, *riders) if (found := self.world.find(one)))
            if mass > allowed:
                more = f" with {', '.join(f'`{rider}`' for rider in riders)}" if riders else ""
                return _fail(
                    "XEI0923",
                    f"`{name}`{more} weighs {mass:g} kg and the {arm} hand may carry {allowed:g} kg",
                    goal,
                )
            heaviest = max(heaviest, mass)
        return heaviest

    def _joints(self, goal: MotionGoal, timed: TimedGoal) -> float | Failure:
        if timed.samples is None:
            return 0.0
        limits = {limit.joint: limit for limit in self.profile.calibration.limits}
        fraction = goal.action.speed_fraction if isinstance(goal.action, MoveTo) else 1.0
        peak = 0.0
        for column, joint in enumerate(timed.joints):
            limit = limits.get(joint)
            if limit is None:
                return _fail("XEI0920", f"the profile has no limits for `{joint}`", goal)
            for t, row, speeds in zip(
                timed.samples.times_s, timed.samples.positions, timed.samples.velocities, strict=True
            ):
                if not limit.lower - POSITION_TOLERANCE <= row[column] <= limit.upper + POSITION_TOLERANCE:
                    return _fail(
                        "XEI0920",
                        f"`{joint}` would be at {row[column]:.4f} at {t:.2f} s, outside "
                        f"{limit.lower:.4f} .. {limit.upper:.4f}",
                        goal,
                    )
                ratio = abs(speeds[column]) * self.speed / (limit.velocity * fraction)
                if not ratio <= 1.0 + VELOCITY_TOLERANCE:
                    return _fail(
                        "XEI0921",
                        f"`{joint}` would move at {abs(speeds[column]) * self.speed:.4f} at {t:.2f} s, "
                        f"and {limit.velocity * fraction:.4f} is allowed",
                        goal,
                    )
                peak = max(peak, ratio)
        return peak

    def _workspace(
        self, goal: MotionGoal, timed: TimedGoal, state: RunState, running: tuple[TimedGoal, ...]
    ) -> Failure | None:
        """A tool works inside the bounds, and leaves them only on the way to a named configuration."""
        working = None
        if isinstance(goal.action, MoveTo):
            if isinstance(goal.action.target, JointTarget):
                return None
            working = goal.action.arm
        if timed.samples is None:
            return None
        lower, upper = self.profile.calibration.workspace_bounds_m
        inside: dict[str, bool] = {}
        for t, row in zip(timed.samples.times_s, timed.samples.positions, strict=True):
            joints = {**state.joints, **_others_at(running, t), **dict(zip(timed.joints, row, strict=True))}
            for arm, at in self.tools.positions_m(joints).items():
                now_inside = all(a <= x <= b for a, x, b in zip(lower, at, upper, strict=True))
                works = arm == working and t == timed.samples.times_s[-1]
                if not now_inside and (works or inside.get(arm, False)):
                    return _fail(
                        "XEI0922",
                        f"the {arm} tool would be at ({_mm(at)}) mm at {t:.2f} s, outside the "
                        f"workspace ({_mm(lower)}) .. ({_mm(upper)}) mm",
                        goal,
                    )
                inside[arm] = now_inside
        return None


def _others_at(running: tuple[TimedGoal, ...], t: float) -> Mapping[str, float]:
    """The joints of goals that run at the same time, at the last sample not after `t`."""
    joints: dict[str, float] = {}
    for other in running:
        if other.samples and other.samples.times_s:
            index = max(0, bisect_right(other.samples.times_s, t) - 1)
            joints.update(zip(other.joints, other.samples.positions[index], strict=True))
    return joints


def _mm(at: Vec3) -> str:
    return ", ".join(f"{1000 * value:.0f}" for value in at)


def _fail(code: str, message: str, goal: MotionGoal) -> Failure:
    return failure("safety_validation", code, message, goal.span)
