"""A measured transform as lines of a calibration profile, and in the place of the present ones.

What the transform was before goes to the head of its history, whole; comments, order and everything else of
the file stay as they are, to the byte.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.ir.geometry import Pose
from xei_lang.ir.tolerance import ToleranceKind
from xei_lang.profiles.yaml_edit import edit, flow, plain_at
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.world.perception.findings import rpy

_FORMER = ("measured_on", "status", "position", "rpy", "tolerance", "residual", "method", "covariance")
_RESIDUALS = {"position": (1e3, " mm"), "rotation": (180.0 / math.pi, " deg"), "pixel": (1.0, "")}


@dataclass(frozen=True, slots=True)
class Measured:
    """A transform that was measured: `T_parent_frame`, when and how, and how well.

    The tolerance is a bound or a standard deviation, as `tolerance_as` says; it is written rounded up.
    `residual` is what the measurement left over: `position` (m) and `rotation` (rad), or `pixel`.
    `covariance` (36) is that of a small motion on the right: translation (m) before rotation (rad).
    """

    frame: str
    parent: str
    T_parent_frame: Pose
    measured_on: str
    method: str
    position_tolerance_m: float
    rotation_tolerance_rad: float
    tolerance_as: ToleranceKind
    residual: tuple[tuple[str, float], ...]
    covariance: tuple[float, ...]

    def values(self) -> Mapping[str, str]:
        """The value of each key of the transform, as YAML on one line."""
        position = ", ".join(f"{value + 0.0:.6f} m" for value in self.T_parent_frame.position_m)
        turns = ", ".join(f"{math.degrees(value) + 0.0:.5f} deg" for value in rpy(self.T_parent_frame))
        millimetres = math.ceil(1e7 * self.position_tolerance_m) / 1e4
        degrees = math.ceil(1e5 * math.degrees(self.rotation_tolerance_rad)) / 1e5
        left = ", ".join(_residual(kind, value) for kind, value in self.residual)
        return {
            "parent": self.parent,
            "position": f"[{position}]",
            "rpy": f"[{turns}]",
            "status": "measured",
            "measured_on": f'"{self.measured_on}"',
            "method": json.dumps(self.method),
            "tolerance": (
                f"{{position: {millimetres:.4f} mm, rotation: {degrees:.5f} deg, as: {self.tolerance_as}}}"
            ),
            "residual": f"{{{left}}}",
            "covariance": flow([float(f"{value:.6e}") for value in self.covariance]),
        }

    def snippet(self) -> str:
        """The transform as it stands under `frames:` of a calibration profile."""
        lines = [f"    {key}: {value}" for key, value in self.values().items()]
        return "\n".join(["frames:", f"  {self.frame}:", *lines, ""])


def put_in(source: Source, measured: Measured) -> str | Diagnostic:
    """The text of a calibration profile with this transform in the place of the present one, which becomes
    the first of its history. A transform that stands there already changes nothing; an older one does not
    take the place of a newer one.
    """
    path = ("frames", measured.frame)
    present = plain_at(source, path)
    if present is None or "parent" not in present:
        return _refused(source, f"`{source.file}` has no transform `{measured.frame}` that can be replaced")
    if present["parent"] != measured.parent:
        hangs = f"`{measured.frame}` hangs on `{present['parent']}` by now, and was measured in"
        return _refused(source, f"{hangs} `{measured.parent}`")
    values = measured.values()
    written, _ = read_yaml("snippet", measured.snippet())
    now = {key: value for key, value in present.items() if key != "history"}
    if written is not None and written.find(path).plain() == now:
        return source.text
    stands = str(present.get("measured_on") or "")
    if measured.measured_on < stands:
        message = (
            f"the recording is of {measured.measured_on}, and `{measured.frame}` was measured on {stands}"
        )
        return _refused(source, message)
    former = {key: present[key] for key in _FORMER if key in present}
    text = edit(source, path, values, former if "status" in former else None)
    return text or _refused(source, f"the lines of `{measured.frame}` cannot be replaced for sure")


def _residual(kind: str, value: float) -> str:
    factor, unit = _RESIDUALS[kind]
    return f"{kind}: {value * factor:.5f}{unit}"


def _refused(source: Source, message: str) -> Diagnostic:
    help_ = "leave `--write` out, and copy the lines that are printed"
    return Diagnostic("XEI0687", message, notes=(f"`{source.file}` was left as it is",), help=(help_,))
