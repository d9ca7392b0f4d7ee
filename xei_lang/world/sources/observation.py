"""What a source says of the world: one observation an object, and who made them.

A field that is absent (None, or empty) means that the source does not say; whoever was asked before then
still holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from xei_lang.ir.geometry import Pose, Vec3

if TYPE_CHECKING:
    from xei_lang.diagnostics import Diagnostics, Span
    from xei_lang.profiles.model import Profile


@dataclass(frozen=True, slots=True)
class Observation:
    """An object as one source saw it.

    `T_frame_object` places the object's frame (bottom centre, z up) in `frame_id`, `world` or a frame of the
    calibration; with no pose there is no frame. `confidence` is 0 .. 1 and goes with the pose. `covariance`
    is that of the pose: 36 numbers, row by row, of x, y, z (m) and fixed-axis roll, pitch, yaw (rad).
    `perception_args` are what another look for it may start from. `span` is where it is written, if it is.
    """

    name: str
    T_frame_object: Pose | None = None
    frame_id: str = ""
    confidence: float | None = None
    states: tuple[tuple[str, str], ...] = ()
    size_m: Vec3 | None = None
    stamp_ns: int | None = None
    covariance: tuple[float, ...] = ()
    perception_args: tuple[tuple[str, str], ...] = ()
    metadata: tuple[tuple[str, str], ...] = ()
    is_absent: bool = False
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Observations:
    """All that one source saw.

    `source` is its name as provenance keeps it (`scene_file monday.yaml`, `pose_service http://...`),
    `sha256` the digest of what it said, for the manifest; `looked_for` names the objects that it would have
    seen had they been in view, for those who ask why nobody saw one.
    """

    source: str
    items: tuple[Observation, ...]
    sha256: str
    stamp_ns: int | None = None
    looked_for: tuple[str, ...] = ()

    def find(self, name: str) -> Observation | None:
        """What the source says of this object, or None."""
        return next((item for item in self.items if item.name == name), None)


class WorldSource(Protocol):
    """Something that can be asked where things are. Asking may read a file or open a connection, so it is
    done before a compilation and its answer handed in.
    """

    @property
    def name(self) -> str:
        """The name that provenance keeps."""
        ...

    def observe(self, profile: Profile, /) -> tuple[Observations | None, Diagnostics]:
        """What it sees of the objects of this profile; None, with errors, where it cannot be believed."""
        ...
