"""The profiles as the compiler sees them: frozen, in SI units, each part with the place that it was written
at.

These are plain dataclasses so that an unchanged profile is loaded from its compiled form without pydantic.
The pydantic models that validate the YAML files stand in `profiles/schema/`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose, Primitive, Shape, Vec3
from xei_lang.quantity import Quantity

if TYPE_CHECKING:
    from xei_lang.ir.goals import GoalKind
    from xei_lang.syntax.ast import Predicate, TypeExpr

Status = Literal["measured", "estimated", "placeholder"]


# usage_profile.yaml: what is in the lab


@dataclass(frozen=True, slots=True)
class Liquid:
    """A container's volumes in m3 and its inner diameter in m."""

    capacity_m3: float
    dead_volume_m3: float
    inner_diameter_m: float


@dataclass(frozen=True, slots=True)
class FiniteState:
    """A declared state of an object, its values and the value it starts with."""

    name: str
    values: tuple[str, ...]
    initial: str
    span: Span


@dataclass(frozen=True, slots=True)
class SlotGrid:
    """A grid of slots: `rows[i]` and column j (from 1) name the slot `A1`; its mouth stands at `origin_m +
    (j-1) * pitch_m[0] * x + i * pitch_m[1] * y` in the object's frame, its axis along z.

    `origin_m` is given from the corner of the bounding box with the smallest x and y, z from the bottom.
    """

    rows: tuple[str, ...]
    columns: int
    pitch_m: tuple[float, float]
    origin_m: Vec3
    bore_m: float
    chamfer_m: float
    depth_m: float
    accepts: tuple[str, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Spot:
    """A named place on a surface: where the bottom centre of an object stands, in the surface's frame."""

    name: str
    T_object_spot: Pose
    span: Span


@dataclass(frozen=True, slots=True)
class Element:
    """An element of a touch screen: centre and size on the screen's plane, metres."""

    name: str
    center_m: tuple[float, float]
    size_m: tuple[float, float]
    span: Span


@dataclass(frozen=True, slots=True)
class Prior:
    """Where an object is believed to be: in a place of another object, or (`in_object` empty) at a pose in a
    frame.
    """

    in_object: str
    in_key: str
    frame: str
    T_frame_object: Pose
    confidence: float
    span: Span
    in_kind: Literal["", "slot", "spot"] = ""


@dataclass(frozen=True, slots=True)
class OperationDefault:
    """An operation parameter that a profile states for an object or a skill (`approach`, `width`,
    `standoff`).
    """

    name: str
    value: Quantity | str
    span: Span


@dataclass(frozen=True, slots=True)
class LabObject:
    """An object of the usage profile or a system object of the registry. Its frame is at its bottom centre, z
    up.
    """

    name: str
    aliases: tuple[str, ...]
    roles: tuple[str, ...]
    shape: Shape
    geometry: tuple[Primitive, ...]
    size_m: Vec3
    mass_kg: float
    skills: tuple[str, ...]
    states: tuple[FiniteState, ...]
    liquid: Liquid | None
    grasp: tuple[OperationDefault, ...]
    slots: SlotGrid | None
    spots: tuple[Spot, ...]
    elements: tuple[Element, ...]
    prior: Prior | None
    assets: tuple[tuple[str, str | None], ...]
    system: bool
    span: Span


# development_profile.yaml: the skill bank


@dataclass(frozen=True, slots=True)
class ArgSpec:
    """An argument of a skill. `type` is `object`, `Place`, `Station`, `Arm`, a quantity's type, `Int`,
    `Float`, `Bool`, `String`, or `choice` (then `choices` are its words). Bounds hold for quantities and
    numbers, ends included.

    For a Place, `choices` are the kinds that it admits (`slot`, `spot`, `surface`; empty admits all), and an
    object whose roles satisfy `roles` may be given for its whole surface. `roles_text` is what the profile
    says, for messages.
    """

    name: str
    type: str
    roles: TypeExpr | None
    min: Quantity | None
    max: Quantity | None
    default: str | Quantity | int | float | bool | None
    required: bool
    choices: tuple[str, ...]
    span: Span
    roles_text: str = ""


@dataclass(frozen=True, slots=True)
class SkillRule:
    """A predicate of a skill's contract, in its words and parsed."""

    text: str
    predicate: Predicate
    span: Span


@dataclass(frozen=True, slots=True)
class TemplateStep:
    """One line of a skill's template: a goal kind and its fields, whose values may name arguments (`arm`),
    points of an operation (`object.pregrasp`) or operation parameters (`open_width`).
    """

    kind: GoalKind
    fields: tuple[tuple[str, str | int | float | bool], ...]
    span: Span

    def field(self, name: str) -> str | int | float | bool | None:
        """The value of a field, or None."""
        return dict(self.fields).get(name)


@dataclass(frozen=True, slots=True)
class SkillSpec:
    """A registered skill: its contract and its template."""

    name: str
    owner: str
    summary: str
    args: tuple[ArgSpec, ...]
    exposed: bool
    requires: tuple[SkillRule, ...]
    ensures: tuple[SkillRule, ...]
    duration_s: tuple[float, float]
    unsupported: tuple[str, ...]
    process: str
    phrases: tuple[str, ...]
    parameters: tuple[OperationDefault, ...]
    template: tuple[TemplateStep, ...]
    span: Span

    def arg(self, name: str) -> ArgSpec | None:
        """The argument of this name, or None."""
        return next((item for item in self.args if item.name == name), None)


@dataclass(frozen=True, slots=True)
class SkillBank:
    """The capability contract: the robot's parts and everything it has learnt to do."""

    urdf: str
    srdf: str
    arms: tuple[str, ...]
    owners: tuple[str, ...]
    skills: tuple[SkillSpec, ...]

    def skill(self, name: str) -> SkillSpec | None:
        """The skill of this name, or None."""
        return next((item for item in self.skills if item.name == name), None)


# calibration_profile.yaml: geometric deployment facts


@dataclass(frozen=True, slots=True)
class CalibratedFrame:
    """A static transform of the deployment and how well it is known."""

    name: str
    parent: str
    T_parent_frame: Pose
    status: Status
    measured_on: str
    method: str
    position_tolerance_m: float
    rotation_tolerance_rad: float
    span: Span


@dataclass(frozen=True, slots=True)
class PlanningLimit:
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


@dataclass(frozen=True, slots=True)
class SceneOrigin:
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


@dataclass(frozen=True, slots=True)
class Calibration:
    """Frames, limits and tolerances of this deployment. Bounds are `(min xyz, max xyz)` in their frame,
    metres.

    `robot_frames` maps frames that the robot carries to links of its description. `placeholders` lists what
    nobody has measured yet and what therefore blocks a run on hardware.
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
    placeholders: tuple[tuple[str, Span], ...]
    robot_frames: tuple[tuple[str, str], ...] = ()


# robot/: what the compiler reads of the robot's own description


@dataclass(frozen=True, slots=True)
class RobotJoint:
    """A joint of the URDF: its links, its place in the parent link, and its range and rating (rad or m, rad/s
    or m/s, N m or N).

    A fixed joint has no range. `mimic` names the joint that it follows, or is empty.
    """

    name: str
    kind: Literal["fixed", "revolute", "continuous", "prismatic"]
    parent: str
    child: str
    T_parent_joint: Pose
    axis: Vec3
    lower: float
    upper: float
    velocity: float
    effort: float
    mimic: str


@dataclass(frozen=True, slots=True)
class NamedState:
    """A named configuration of a group of joints in the SRDF (`home` of `left_arm`)."""

    name: str
    group: str
    joints: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """The robot's tree and its named states; `root` is the link that no joint carries."""

    root: str
    links: tuple[str, ...]
    joints: tuple[RobotJoint, ...]
    states: tuple[NamedState, ...]

    def joint(self, name: str) -> RobotJoint | None:
        """The joint of this name, or None."""
        return next((item for item in self.joints if item.name == name), None)

    def state(self, name: str) -> tuple[tuple[str, float], ...]:
        """All joints that the groups' states of this name set, in the groups' order; empty for an unknown
        name.
        """
        return tuple(joint for state in self.states if state.name == name for joint in state.joints)


@dataclass(frozen=True, slots=True)
class Profile:
    """A whole profile folder: all objects sorted by name, the skill bank, the calibration, the robot's
    description.

    `files` maps each file (path relative to the folder) to the SHA-256 of its bytes; `hazards` lists those of
    each liquid.
    """

    name: str
    folder: str
    objects: tuple[LabObject, ...]
    bank: SkillBank
    calibration: Calibration
    incompatible: tuple[tuple[str, str], ...]
    files: tuple[tuple[str, str], ...]
    robot: RobotDescription
    hazards: tuple[tuple[str, tuple[str, ...]], ...] = ()

    def object(self, name: str) -> LabObject | None:
        """The object of this name, or None."""
        return next((item for item in self.objects if item.name == name), None)
