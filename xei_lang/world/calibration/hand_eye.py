"""Where a camera is mounted, from a recording: closed form, refined, with a covariance, or a reason why not.

Samples that contradict the others are named and refuse the recording; they are never left out in silence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.world.calibration.closed_form import park_martin, rotation_spread
from xei_lang.world.calibration.fit import Fit, fit, residuals_of
from xei_lang.world.calibration.sample import Sample
from xei_lang.world.perception.optics import Array, pose_of

MIN_SAMPLES = 5
MIN_SPREAD_RAD = float(np.radians(5.0))
"""Root mean square rotation along the second principal axis below which one axis is all there is."""
OUTLIER = 5.0
"""How many times the others' noise a sample's residual must be, root mean square, to be called wrong."""
MAX_NOISE = {"position": 5e-3, "rotation": float(np.radians(1.0)), "pixel": 2.0}
"""Noise (m, rad, px) beyond which samples contradict each other altogether."""
_EXACT = {"position": 1e-6, "rotation": 1e-6, "pixel": 1e-3}
_UNITS = {"position": (1e3, "mm"), "rotation": (180.0 / np.pi, "deg"), "pixel": (1.0, "px")}


@dataclass(frozen=True, slots=True, eq=False)
class HandEye:
    """`T_parent_camera` in the camera's body frame, with the covariance (6, 6) of a small motion on its
    right: translation (m) before rotation (rad).

    `noise` is the standard deviation of a residual, by kind: `position` (m) and `rotation` (rad), or `pixel`.
    `spread_rad` (3,) is the root mean square rotation between samples along its principal axes.
    """

    T_parent_camera: Pose
    T_target_board: Pose
    covariance: Array
    noise: dict[str, float]
    spread_rad: tuple[float, float, float]
    samples: int

    @property
    def position_std_m(self) -> float:
        """Standard deviation of the position along its least certain direction."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[:3, :3])[-1]))

    @property
    def rotation_std_rad(self) -> float:
        """Standard deviation of the rotation about its least certain axis."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[3:, 3:])[-1]))

    def noise_text(self) -> str:
        """The residuals as people read them, such as `0.21 mm and 0.034 deg`."""
        return noise_text(self.noise)


@dataclass(frozen=True, slots=True)
class Unsolved:
    """Why a recording fixes nothing: `reason` for programs, the rest for people."""

    reason: Literal["too_few", "no_rotation", "one_axis", "outlier", "inconsistent"]
    message: str
    help: str
    samples: tuple[int, ...] = ()

    def diagnostic(self) -> Diagnostic:
        """The refusal as it is shown."""
        code = "XEI0686" if self.reason in ("outlier", "inconsistent") else "XEI0685"
        return Diagnostic(code, self.message, help=(self.help,))


def solve_hand_eye(samples: Sequence[Sample], focal_px: float) -> HandEye | Unsolved:
    """X of `A X B = Z` over all samples, which are all of one kind."""
    if len(samples) < MIN_SAMPLES:
        shown = "1 sample is" if len(samples) == 1 else f"{len(samples)} samples are"
        return Unsolved("too_few", f"{shown} not enough: {MIN_SAMPLES} are needed", "record 15 or more")
    A = np.array([sample.A for sample in samples])
    spread = rotation_spread(A)
    unobserved = _unobserved(spread)
    if unobserved is not None:
        return unobserved
    found, wrong = _without_outliers(list(samples), focal_px)
    if found is None or any(found.noise[kind] > MAX_NOISE[kind] for kind in found.noise):
        whole = _fit(samples, focal_px)
        message = f"no camera's place explains the samples: {noise_text(whole.noise)} are left over"
        return Unsolved("inconsistent", message, _CHECK)
    if wrong:
        named = ", ".join(str(number) for number in sorted(wrong))
        verb = "contradicts" if len(wrong) == 1 else "contradict"
        noun = "sample" if len(wrong) == 1 else "samples"
        message = f"{noun} {named} {verb} the others, which agree within {noise_text(found.noise)}"
        help_ = f"if you know why, take {noun} {named} out of the recording; else record again"
        return Unsolved("outlier", message, help_, tuple(sorted(wrong)))
    largest, middle, smallest = (float(value) for value in spread)
    return HandEye(
        pose_of(found.X), pose_of(found.Z), found.covariance, found.noise, (largest, middle, smallest),
        len(samples),
    )  # fmt: skip


_CHECK = "check the camera's intrinsics, the tags' size, joint offsets, and what the target is fixed to"


def noise_text(noise: dict[str, float]) -> str:
    """Standard deviations in mm, deg or px."""
    return " and ".join(f"{noise[kind] * _UNITS[kind][0]:.3g} {_UNITS[kind][1]}" for kind in sorted(noise))


def _unobserved(spread: Array) -> Unsolved | None:
    degrees = [float(np.degrees(value)) for value in spread]
    shown = ", ".join(f"{value:.1f}" for value in degrees)
    if spread[0] < MIN_SPREAD_RAD:
        message = f"the samples hardly turn: {shown} deg root mean square about the principal axes"
        return Unsolved("no_rotation", message, _TURN)
    if spread[1] < MIN_SPREAD_RAD:
        message = (
            f"the samples turn about one axis only: {shown} deg root mean square about the principal axes"
        )
        return Unsolved("one_axis", message, _TURN)
    return None


_TURN = "record samples in which the wrist turns by 30 deg or more about two different axes"


def _fit(samples: Sequence[Sample], focal_px: float) -> Fit:
    start = park_martin(np.array([one.A for one in samples]), np.array([one.B for one in samples]))
    return fit(samples, (start.X, start.Z), focal_px)


def _without_outliers(samples: list[Sample], focal_px: float) -> tuple[Fit | None, list[int]]:
    """The fit of the samples that agree, and the numbers of those that do not; None for too many of these."""
    wrong: list[int] = []
    most = len(samples) // 4
    whole = _fit(samples, focal_px)
    while True:
        index = whole.worst_sample()
        others = [sample for place, sample in enumerate(samples) if place != index]
        if len(others) < MIN_SAMPLES - 1 or rotation_spread(np.array([one.A for one in others]))[1] < 1e-3:
            return whole, wrong
        rest = _fit(others, focal_px)
        if _misfit(samples[index], rest, focal_px) < OUTLIER:
            return whole, wrong
        wrong.append(samples[index].number)
        if len(wrong) > most:
            return None, wrong
        samples, whole = others, rest


def _misfit(sample: Sample, rest: Fit, focal_px: float) -> float:
    """Root mean square residual of a sample under a fit that did not see it, in that fit's noise."""
    linear, kinds, _ = residuals_of([sample], focal_px)
    errors, _ = linear(rest.X, rest.Z)
    scale = np.array([max(rest.noise[kind], _EXACT[kind]) for kind in kinds])
    return float(np.sqrt(((errors / scale) ** 2).mean()))
