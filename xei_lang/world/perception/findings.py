"""What an image says of a deployment, as diagnostics, as JSON and as text."""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.geometry import Pose
from xei_lang.ir.tolerance import as_bound, tolerance_text
from xei_lang.ir.world import Frame
from xei_lang.profiles.model import Camera, Profile
from xei_lang.world.perception.detect_tags import TagDetection
from xei_lang.world.perception.frame_anchor import FrameAnchor
from xei_lang.world.perception.look import Sighting, Verified, verify
from xei_lang.world.perception.refusal import Refused


@dataclass(frozen=True, slots=True, eq=False)
class FrameFinding:
    """A frame of the layout: its anchor beside the profile (None where no station grounds it), or why
    there is none.
    """

    frame: str
    anchor: FrameAnchor | Refused
    verified: Verified | None


@dataclass(frozen=True, slots=True, eq=False)
class Findings:
    """All that one image says; `refused` where the image itself is of no use."""

    tags: tuple[tuple[TagDetection, str], ...]
    frames: tuple[FrameFinding, ...]
    refused: Refused | None

    @property
    def diagnostics(self) -> Diagnostics:
        """What is wrong: refusals, and frames that are found out of their tolerance."""
        if self.refused is not None:
            return (self.refused.diagnostic(),)
        said: list[Diagnostic] = []
        for found in self.frames:
            if isinstance(found.anchor, Refused):
                said.append(found.anchor.diagnostic())
            elif found.verified is not None and not found.verified.deviation.within:
                said.append(_off(found.frame, found.verified))
        return tuple(said)


def findings(seen: Sighting | Refused, profile: Profile, camera: Camera) -> Findings:
    """A sighting beside the profile."""
    if isinstance(seen, Refused):
        return Findings((), (), seen)
    frame_of = {tag.id: tag.frame for tag in profile.calibration.apriltags.tags}
    frames = tuple(
        FrameFinding(name, anchor, None if isinstance(anchor, Refused) else verify(profile, camera, anchor))
        for name, anchor in seen.frames
    )
    return Findings(tuple((tag, frame_of.get(tag.id, "")) for tag in seen.detections), frames, None)


def to_json(found: Findings, image: str, camera: str) -> Json:
    """The form that `xei schema tags` describes."""
    tags = [
        {
            "id": tag.id,
            "frame": frame or None,
            "corners_px": [[float(u), float(v)] for u, v in tag.corners_px],
        }
        for tag, frame in found.tags
    ]
    refused = found.refused
    return {
        "version": 1,
        "image": image,
        "camera": camera,
        "refused": None if refused is None else {"reason": refused.reason, "message": refused.message},
        "tags": tags,
        "frames": [_frame_json(one) for one in found.frames],
    }


def to_text(found: Findings) -> str:
    """The same for people: a line for each tag, and some for each frame that was found."""
    lines = [f"tag {tag.id:<4} {frame or 'of no frame':<12} at {_centre(tag)}" for tag, frame in found.tags]
    for one in found.frames:
        if isinstance(one.anchor, Refused):
            lines.append(f"{one.frame}: not found")
            continue
        lines += _anchor_lines(one.frame, one.anchor, one.verified)
    return "".join(f"{line}\n" for line in lines)


def _anchor_lines(frame: str, anchor: FrameAnchor, verified: Verified | None) -> list[str]:
    ids = ", ".join(str(number) for number in anchor.tag_ids)
    lines = [
        f"{frame}: from tags {ids}, residual {anchor.rms_px:.2f} px, standard deviation "
        f"{1e3 * anchor.position_std_m:.2f} mm, {math.degrees(anchor.rotation_std_rad):.3f} deg",
        f"  in the camera   {pose_text(anchor.T_camera_frame)}",
    ]
    if verified is None:
        return lines
    apart, stated = verified.deviation, verified.stated
    verdict = "within" if apart.within else "out of"
    seen_from = f"from {verified.station}" if verified.by_base else "by a camera that stands still"
    return [
        *lines,
        f"  in robot_base   {pose_text(verified.T_base_frame)}",
        f"  expected there  {pose_text(verified.expected_T_base_frame)}",
        f"  {1e3 * apart.position_m:.2f} mm and {math.degrees(apart.rotation_rad):.3f} deg apart, {verdict} "
        f"the tolerance of {_allowed(stated)}, {seen_from}",
    ]


def _frame_json(one: FrameFinding) -> Json:
    if isinstance(one.anchor, Refused):
        why = {"reason": one.anchor.reason, "message": one.anchor.message}
        return {"frame": one.frame, "verdict": "refused", "refused": why, "tag_ids": list(one.anchor.tag_ids)}
    anchor, verified = one.anchor, one.verified
    form: dict[str, Json] = {
        "frame": one.frame,
        "verdict": "unverified",
        "tag_ids": list(anchor.tag_ids),
        "residual_px": anchor.rms_px,
        "tag_residual_px": list(anchor.tag_rms_px),
        "size_ratio": anchor.size_ratio,
        "position_std_m": anchor.position_std_m,
        "rotation_std_rad": anchor.rotation_std_rad,
        "covariance": [[float(value) for value in row] for row in anchor.covariance],
        "T_camera_frame": anchor.T_camera_frame.matrix(),
    }
    if verified is None:
        return form
    stated, apart = verified.stated, verified.deviation
    return {
        **form,
        "verdict": "within_tolerance" if apart.within else "out_of_tolerance",
        "station": verified.station,
        "T_base_frame": verified.T_base_frame.matrix(),
        "expected_T_base_frame": verified.expected_T_base_frame.matrix(),
        "parent": stated.parent,
        "T_parent_frame": verified.T_parent_found.matrix(),
        "deviation": {"position_m": apart.position_m, "rotation_rad": apart.rotation_rad},
        "tolerance": {
            "position_m": as_bound(stated.position_tolerance_m, stated.tolerance_as),
            "rotation_rad": as_bound(stated.rotation_tolerance_rad, stated.tolerance_as),
        },
    }


def _off(frame: str, verified: Verified) -> Diagnostic:
    apart, stated = verified.deviation, verified.stated
    message = (
        f"`{frame}` stands {1e3 * apart.position_m:.1f} mm and {math.degrees(apart.rotation_rad):.2f} deg "
        f"from where the profile says"
    )
    allowed = _allowed(stated)
    measured = pose_text(verified.T_parent_found)
    rests_on, if_so = "the camera stands still in the world", "if the camera is calibrated"
    if verified.by_base:
        rests_on = f"the base is taken to stand at `{verified.station}`"
        if_so = "if the robot stands there and its camera is calibrated"
    return Diagnostic(
        "XEI0683",
        message,
        notes=(f"its tolerance is {allowed}; {rests_on}",),
        help=(f"{if_so}, write in `frames.{frame}`: {measured}",),
    )


def _allowed(stated: Frame) -> str:
    return tolerance_text(stated.position_tolerance_m, stated.rotation_tolerance_rad, stated.tolerance_as)


def pose_text(pose: Pose) -> str:
    """A pose as a calibration profile writes it, to 10 um and 0.001 deg."""
    position = ", ".join(f"{value + 0.0:.5f} m" for value in pose.position_m)
    turns = ", ".join(f"{math.degrees(value) + 0.0:.3f} deg" for value in rpy(pose))
    return f"position: [{position}], rpy: [{turns}]"


def rpy(pose: Pose) -> tuple[float, float, float]:
    """Fixed-axis roll, pitch and yaw (rad) of `R = Rz(yaw) Ry(pitch) Rx(roll)`, yaw 0 where they are not told
    apart (pitch of a right angle).
    """
    x_axis, y_axis, z_axis = pose.axes()
    flat = math.hypot(x_axis[0], x_axis[1])
    pitch = math.atan2(-x_axis[2], flat)
    if flat < 1e-9:
        return (math.atan2(-z_axis[1], y_axis[1]), pitch, 0.0)
    return (math.atan2(y_axis[2], z_axis[2]), pitch, math.atan2(x_axis[1], x_axis[0]))


def _centre(tag: TagDetection) -> str:
    u, v = tag.corners_px.mean(axis=0)
    return f"({u:.1f}, {v:.1f})"
