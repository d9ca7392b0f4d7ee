"""What holds between two goals: joint positions, where the base stands, and which object is where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.families import Family
from xei_lang.ir.geometry import Pose
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
class Ride:
    """What an object is fastened on, and where it sits there: wherever that one goes, this never changes."""

    carrier: str
    T_carrier_rider: Pose


@dataclass(frozen=True, slots=True)
class Carried:
    """An object that moves with a hand: the one that it holds, or what rides on that; `holds` names the one
    it holds.
    """

    side: Side
    object: str
    T_tool_object: Pose
    holds: str


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state between two goals.

    `q` (nq,) is the configuration, `standing` maps each object that moves with no hand to its pose in the
    root frame `world`, `held` maps an arm to what it holds. `riding` says of each object that is fastened on
    another one on which: it stands, or moves with a hand, as that does.
    """

    q: Array
    T_world_base: Pose
    standing: Mapping[str, Pose]
    held: Mapping[Side, Held]
    riding: Mapping[str, Ride] = field(default_factory=dict[str, Ride])

    def T_base_object(self, name: str) -> Pose:
        """Pose of a standing object in the base frame. KeyError for one that moves with a hand."""
        return self.T_world_base.inverse() @ self.standing[name]

    def holders(self, name: str) -> tuple[Side, ...]:
        """The hands that hold an object, sorted: two while it is handed over."""
        return tuple(side for side, held in sorted(self.held.items()) if held.object == name)

    def riders(self, name: str) -> tuple[tuple[str, Pose], ...]:
        """What rides on an object, and on that, carriers first, each with its pose in the object's frame."""
        own = [(rider, ride.T_carrier_rider) for rider, ride in self.riding.items() if ride.carrier == name]
        on = [(other, pose @ T) for rider, pose in own for other, T in self.riders(rider)]
        return (*own, *on)

    def carried(self) -> tuple[Carried, ...]:
        """All that moves with hands: twice what two hands hold."""
        found: list[Carried] = []
        for side, held in sorted(self.held.items()):
            found.append(Carried(side, held.object, held.T_tool_object, held.object))
            for rider, T_object_rider in self.riders(held.object):
                found.append(Carried(side, rider, held.T_tool_object @ T_object_rider, held.object))
        return tuple(found)

    def attached(self, side: Side, held: Held) -> Snapshot:
        """The state after the hand has taken the object, which rides on nothing any more; what rides on it
        comes along.
        """
        gone = {held.object, *(rider for rider, _ in self.riders(held.object))}
        standing = {name: pose for name, pose in self.standing.items() if name not in gone}
        riding = {name: ride for name, ride in self.riding.items() if name != held.object}
        return replace(self, standing=standing, held={**self.held, side: held}, riding=riding)

    def detached(self, side: Side, T_base_object: Pose, ride: Ride | None = None) -> Snapshot:
        """The state after the hand has left its object at a pose in the base frame, or to the other hand that
        holds it too. With a ride it is fastened there.
        """
        held = {arm: item for arm, item in self.held.items() if arm != side}
        name = self.held[side].object
        if len(self.holders(name)) > 1:
            return replace(self, held=held)
        riding = self.riding if ride is None else dict(sorted({**self.riding, name: ride}.items()))
        if ride is not None and ride.carrier not in self.standing:
            return replace(self, held=held, riding=riding)
        T_world_object = self.T_world_base @ T_base_object
        left = {rider: T_world_object @ T_object_rider for rider, T_object_rider in self.riders(name)}
        standing = dict(sorted({**self.standing, name: T_world_object, **left}.items()))
        return replace(self, standing=standing, held=held, riding=riding)

    def without(self, name: str) -> Snapshot:
        """The state were a standing object not there, nor what rides on it."""
        gone = {name, *(rider for rider, _ in self.riders(name))}
        standing = {other: pose for other, pose in self.standing.items() if other not in gone}
        riding = {other: ride for other, ride in self.riding.items() if other not in gone}
        return replace(self, standing=standing, riding=riding)

    def moved(self, q: Array) -> Snapshot:
        """The state at other joint positions."""
        return replace(self, q=q)

    def attachments(self, robot: Robot) -> tuple[Attachment, ...]:
        """What the hands hold, and what rides on it, on the links of their tool frames."""
        return tuple(
            Attachment(item.object, robot.arm(item.side).tool_frame, item.T_tool_object)
            for item in self.carried()
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
    riding = {
        item.name: Ride(item.fastened_to, standing[item.fastened_to].inverse() @ standing[item.name])
        for item in world.objects
        if item.fastened_to
    }
    return Snapshot(
        q, world.robot.T_world_base, dict(sorted(standing.items())), {}, dict(sorted(riding.items()))
    )
