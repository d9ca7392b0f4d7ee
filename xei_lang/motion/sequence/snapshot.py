"""What holds between two goals: joint positions, where the base stands, and which object is where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Family
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import Attachment
from xei_lang.ir.world import World
from xei_lang.motion.robot import Robot

Array = NDArray[np.float64]

UNCHOSEN = -1
"""The member of a grasp that is still to be chosen."""


@dataclass(frozen=True, slots=True)
class Held:
    """An object in a hand by the grasp `member` of a family; `T_reference_object` places it in the family's
    reference.
    """

    object: str
    family: Family
    member: int
    T_reference_object: Pose

    @property
    def T_tool_object(self) -> Pose:
        """Where the object sits in the tool frame."""
        return self.family.members[self.member].T_reference_tool.inverse() @ self.T_reference_object


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state between two goals.

    `q` (nq,) is the configuration, `standing` maps each object that no hand holds to its pose in the root
    frame `world`, `held` maps an arm to what it holds.
    """

    q: Array
    T_world_base: Pose
    standing: Mapping[str, Pose]
    held: Mapping[Side, Held]

    def T_base_object(self, name: str) -> Pose:
        """Pose of a standing object in the base frame. KeyError for an object in a hand."""
        return self.T_world_base.inverse() @ self.standing[name]

    def holders(self, name: str) -> tuple[Side, ...]:
        """The hands that hold an object, sorted: two while it is handed over."""
        return tuple(side for side, held in sorted(self.held.items()) if held.object == name)

    def attached(self, side: Side, held: Held) -> Snapshot:
        """The state after the hand has taken the object."""
        standing = {name: pose for name, pose in self.standing.items() if name != held.object}
        return replace(self, standing=standing, held={**self.held, side: held})

    def detached(self, side: Side, T_base_object: Pose) -> Snapshot:
        """The state after the hand has left its object at a pose in the base frame, or to the other hand that
        holds it too.
        """
        held = {arm: item for arm, item in self.held.items() if arm != side}
        name = self.held[side].object
        if len(self.holders(name)) > 1:
            return replace(self, held=held)
        standing = dict(sorted({**self.standing, name: self.T_world_base @ T_base_object}.items()))
        return replace(self, standing=standing, held=held)

    def moved(self, q: Array) -> Snapshot:
        """The state at other joint positions."""
        return replace(self, q=q)

    def attachments(self, robot: Robot) -> tuple[Attachment, ...]:
        """What the hands hold, on the links of their tool frames."""
        return tuple(
            Attachment(held.object, robot.arm(side).tool_frame, held.T_tool_object)
            for side, held in sorted(self.held.items())
        )


def first_snapshot(robot: Robot, world: World) -> Snapshot:
    """The state before anything moves."""
    q = np.zeros(robot.nq)
    for joint, value in world.robot.joints:
        q[robot.joint_names.index(joint)] = value
    for arm in robot.arms.values():
        first, second = arm.finger_indices
        q[second] = q[first]
    standing = {item.name: world.T_world_object(item.name) for item in world.objects}
    return Snapshot(q, world.robot.T_world_base, dict(sorted(standing.items())), {})
