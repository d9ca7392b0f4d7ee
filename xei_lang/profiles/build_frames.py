"""Static transforms of a deployment with their history, from the validated model."""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.profiles.build_objects import pose
from xei_lang.profiles.model import CalibratedFrame, EarlierTransform
from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.schema.frames import FrameModel, ResidualModel
from xei_lang.profiles.yaml_tree import Node


def build_frames(model: CalibrationProfile, root: Node) -> Iterator[CalibratedFrame]:
    """The frames in the order of the file, each with the place of its key."""
    for name, frame in model.frames.items():
        yield CalibratedFrame(
            name=name,
            parent=frame.parent,
            T_parent_frame=pose(frame.position, frame.rpy),
            status=frame.status,
            measured_on=frame.measured_on or "",
            method=frame.method,
            position_tolerance_m=frame.tolerance.position.si,
            rotation_tolerance_rad=frame.tolerance.rotation.si,
            span=root.key_span("frames", name),
            tolerance_as=frame.tolerance.kind,
            residual=residual_text(frame.residual),
            covariance=tuple(frame.covariance or ()),
            history=tuple(_history(name, frame, root)),
        )


def residual_text(residual: ResidualModel | None) -> str:
    """`0.21 mm and 0.034 deg` or `0.2 px`; empty where nothing is stated."""
    if residual is None:
        return ""
    parts = [
        f"{1e3 * residual.position.si:.3g} mm" if residual.position is not None else "",
        f"{math.degrees(residual.rotation.si):.3g} deg" if residual.rotation is not None else "",
        "" if residual.pixel is None else f"{residual.pixel:.3g} px",
    ]
    return " and ".join(part for part in parts if part)


def _history(name: str, frame: FrameModel, root: Node) -> Iterator[EarlierTransform]:
    for index, earlier in enumerate(frame.history):
        yield EarlierTransform(
            T_parent_frame=pose(earlier.position, earlier.rpy),
            status=earlier.status,
            measured_on=earlier.measured_on or "",
            method=earlier.method,
            position_tolerance_m=earlier.tolerance.position.si,
            rotation_tolerance_rad=earlier.tolerance.rotation.si,
            tolerance_as=earlier.tolerance.kind,
            residual=residual_text(earlier.residual),
            span=root.span_of("frames", name, "history", index),
        )
