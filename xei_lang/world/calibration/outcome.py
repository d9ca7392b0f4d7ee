"""What a solved recording says of the camera's frame: where it is, and how well that is known."""

from __future__ import annotations

import math

from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.tolerance import SIGMAS, ToleranceKind
from xei_lang.profiles.model import CalibratedFrame, EarlierTransform
from xei_lang.world.calibration.carriers import BASE
from xei_lang.world.calibration.hand_eye import HandEye
from xei_lang.world.calibration.measured import Measured
from xei_lang.world.calibration.recording import Recording
from xei_lang.world.history import changes, jump_diagnostic
from xei_lang.world.transforms import lookup


def outcome(recording: Recording, solved: HandEye) -> Measured:
    """The transform of the camera's frame with its tolerance.

    On the robot that is a standard deviation, of the samples alone. In the room, what the base may have stood
    off its station adds to it: then the tolerance is a bound, if the docking tolerance is one.
    """
    position_m, rotation_rad = solved.position_std_m, solved.rotation_std_rad
    kind: ToleranceKind = "std"
    told = "the tolerance is a standard deviation"
    if recording.standing is not None:
        parent = recording.frame.parent
        T_parent_base = lookup(recording.standing, parent, BASE).T_target_source
        point = T_parent_base.inverse().apply(solved.T_parent_camera.position_m)
        way = lookup(recording.standing, parent, BASE, point)
        position_m = math.hypot(position_m, way.position_std_m)
        rotation_rad = math.hypot(rotation_rad, way.rotation_std_rad)
        at = f"the base's place at {recording.standing.robot.station}"
        told = f"{told}, with that of {at}"
        if way.position_bound_m or way.rotation_bound_rad:
            position_m = way.position_bound_m + SIGMAS * position_m
            rotation_rad = way.rotation_bound_rad + SIGMAS * rotation_rad
            kind = "bound"
            told = f"the tolerance bounds that of {at} with {SIGMAS:g} standard deviations"
    return Measured(
        frame=recording.frame.name,
        parent=recording.frame.parent,
        T_parent_frame=solved.T_parent_camera,
        measured_on=recording.recorded_on,
        method=(
            f"hand-eye calibration from {solved.samples} samples with tags on {recording.target}, "
            f"residuals {solved.noise_text()}; {told}"
        ),
        position_tolerance_m=position_m,
        rotation_tolerance_rad=rotation_rad,
        tolerance_as=kind,
        residual=tuple(sorted(solved.noise.items())),
        covariance=tuple(float(value) for value in solved.covariance.reshape(-1)),
    )


def jump_warning(before: CalibratedFrame, measured: Measured) -> Diagnostics:
    """A warning where the new place is further from the measured one before than both tolerances allow."""
    earlier = EarlierTransform(
        before.T_parent_frame, before.status, before.measured_on, before.method,
        before.position_tolerance_m, before.rotation_tolerance_rad, before.tolerance_as, before.residual,
        before.span,
    )  # fmt: skip
    now = CalibratedFrame(
        measured.frame, measured.parent, measured.T_parent_frame, "measured", measured.measured_on,
        measured.method, measured.position_tolerance_m, measured.rotation_tolerance_rad, before.span,
        measured.tolerance_as, history=(earlier,),
    )  # fmt: skip
    return tuple(jump_diagnostic(measured.frame, one) for one in changes(now) if one.is_jump)
