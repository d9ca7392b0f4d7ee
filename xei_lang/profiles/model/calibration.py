"""What a calibration profile says: frames, limits, stations, tolerances."""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.tolerance import ToleranceKind
from xei_lang.profiles.model.frames import CalibratedFrame, Status
from xei_lang.record import Record, record


@record
class PlanningLimit(Record):
    """The limits that plans keep for one joint, and why these: rad, rad/s, rad/s2, N m (m, N for prismatic
    joints).
    """

    joint: str
    lower: float
    upper: float
    velocity: float
    acceleration: float
    torque: float
    reason: str
    span: Span


@record
class SceneOrigin(Record):
    """A station: the base pose (in `world`) from which a bench is worked, and the frame to ground again
    there.
    """

    name: str
    aliases: tuple[str, ...]
    T_world_base: Pose
    status: Status
    ground_frame: str
    slide_m: float
    span: Span


@record
class CarryPose(Record):
    """Where the hand of an arm keeps what it holds while the base drives: the object's origin in the base
    frame, m.
    """

    arm: Side
    position_m: Vec3
    status: Status
    reason: str
    span: Span


@record
class Tag(Record):
    """One AprilTag of the layout: the length of its black square's edge, and its centre's pose in `frame`.

    x to the right and y up on the tag as AprilTag's published images show it, z out of the paper.
    """

    id: int
    size_m: float
    frame: str
    T_frame_tag: Pose
    span: Span


@record
class TagLayout(Record):
    """All AprilTags of the deployment, and what a detection of them must meet to be believed.

    `minimum_tags` must be seen of a frame; `residual_px` bounds the root mean square distance of a corner
    from where the joint pose puts it.
    """

    family: str = "tag36h11"
    status: Status = "placeholder"
    tags: tuple[Tag, ...] = ()
    minimum_tags: int = 2
    residual_px: float = 0.8


@record
class Camera(Record):
    """A pinhole camera in pixels; the centre of the top left pixel is (0, 0).

    `distortion` has OpenCV's order k1, k2, p1, p2[, k3[, k4, k5, k6[, s1, s2, s3, s4[, tx, ty]]]]. `frame`
    is the camera's body: x forward, y left, z up (REP 103); its optical frame is turned against that.
    """

    name: str
    frame: str
    status: Status
    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int
    distortion: tuple[float, ...]
    topics: tuple[tuple[str, str], ...]
    span: Span


@record
class Lidar(Record):
    """A planar lidar: its frame (x forward, y left, z up: the scan's plane is z = 0) and topics."""

    name: str
    frame: str
    status: Status
    topics: tuple[tuple[str, str], ...]
    span: Span


@record
class MapFiles(Record):
    """The map's files, as paths below the profile's folder, and the SHA-256 of their bytes: those of the YAML
    file, then those of the image. What the profile leaves open is empty; `span` is the section.
    """

    yaml: str
    image: str
    sha256: str
    status: Status
    measured_on: str
    span: Span
    sha256_span: Span

    @property
    def is_named(self) -> bool:
        """Whether there is a map to read: a section with gaps is a placeholder."""
        return bool(self.yaml and self.image and self.sha256)


@record
class Placeholder(Record):
    """Something that nobody has measured yet: the item of the calibration profile, and how to measure it."""

    item: str
    measure: str
    span: Span


@record
class Calibration(Record):
    """Frames, limits and tolerances of this deployment. Bounds are `(min xyz, max xyz)` in their frame,
    metres.

    `robot_frames` maps frames that the robot carries to links of its description. `placeholders` lists what
    nobody has measured yet and what therefore blocks a run on hardware. A measurement older than `max_age_s`
    is stale; None where none ever is.
    """

    frames: tuple[CalibratedFrame, ...]
    limits: tuple[PlanningLimit, ...]
    stations: tuple[SceneOrigin, ...]
    start_station: str
    table_height_m: float
    table_height_status: Status
    table_bounds_m: tuple[Vec3, Vec3]
    workspace_bounds_m: tuple[Vec3, Vec3]
    map_frame: str
    docking_position_tolerance_m: float
    docking_rotation_tolerance_rad: float
    base_speed_m_s: float
    base_turn_rad_s: float
    payload_kg: float
    spill_tilt_rad: float
    clearance_m: float
    placeholders: tuple[Placeholder, ...]
    robot_frames: tuple[tuple[str, str], ...] = ()
    carry: tuple[CarryPose, ...] = ()
    apriltags: TagLayout = TagLayout()
    cameras: tuple[Camera, ...] = ()
    lidars: tuple[Lidar, ...] = ()
    map: MapFiles | None = None
    docking_tolerance_as: ToleranceKind = "bound"
    max_age_s: float | None = None
    payload_span: Span | None = None

    def carry_pose(self, arm: Side) -> CarryPose | None:
        """Where this arm carries what it holds, or None where the profile does not say."""
        return next((pose for pose in self.carry if pose.arm == arm), None)
