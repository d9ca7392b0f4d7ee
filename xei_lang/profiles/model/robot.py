"""What the compiler reads of the robot's own description."""

from __future__ import annotations

from typing import Literal

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.record import Record, record


@record
class RobotJoint(Record):
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


@record
class NamedState(Record):
    """A named configuration of a group of joints in the SRDF (`home` of `left_arm`)."""

    name: str
    group: str
    joints: tuple[tuple[str, float], ...]


@record
class RobotDescription(Record):
    """The robot's tree and its named states; `root` is the link that no joint carries."""

    root: str
    links: tuple[str, ...]
    joints: tuple[RobotJoint, ...]
    states: tuple[NamedState, ...]

    def __hash__(self) -> int:
        """By little: what is worked out of a description once is kept by it, and few are there at a time."""
        return hash((self.root, self.links))

    def joint(self, name: str) -> RobotJoint | None:
        """The joint of this name, or None."""
        return next((item for item in self.joints if item.name == name), None)

    def state(self, name: str) -> tuple[tuple[str, float], ...]:
        """All joints that the groups' states of this name set, in the groups' order; empty for an unknown
        name.
        """
        return tuple(joint for state in self.states if state.name == name for joint in state.joints)
