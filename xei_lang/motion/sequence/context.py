"""What every part of the sequence planner reads and none changes: robot, solvers, limits, the deployment's
facts.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import JointLimit
from xei_lang.ir.world import World
from xei_lang.motion.collision import CollisionScene
from xei_lang.motion.kinematics import Solver
from xei_lang.motion.robot import Robot
from xei_lang.motion.sequence.choose import Speeds
from xei_lang.motion.sequence.shelf import SceneShelf
from xei_lang.profiles.model import Profile

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Context:
    """The unchanging side of a planning problem. `limits` maps a joint's name to its planning limits; `bare`
    is the collision scene of the robot alone; `scenes` remembers scenes by their content (`space.py`).
    """

    robot: Robot
    bare: CollisionScene
    solvers: Mapping[Side, Solver]
    limits: Mapping[str, JointLimit]
    world: World
    profile: Profile
    seed: int
    scenes: SceneShelf = field(default_factory=SceneShelf, repr=False)

    def arm_joints(self, side: Side) -> tuple[str, ...]:
        """The slide and the joints of an arm, in this order everywhere in this package."""
        return (self.slide_joint, *self.robot.arm(side).joint_names)

    def arm_indices(self, side: Side) -> list[int]:
        """Where `arm_joints` stand in a whole configuration."""
        return [self.robot.slide_index, *self.robot.arm(side).q_indices]

    @property
    def slide_joint(self) -> str:
        """The name of the slide's joint."""
        return self.robot.joint_names[self.robot.slide_index]

    @property
    def slide_limits(self) -> JointLimit:
        """Planning limits of the slide, m."""
        return self.limits[self.slide_joint]

    def limits_of(self, joints: tuple[str, ...]) -> tuple[JointLimit, ...]:
        """Planning limits of joints, in their order."""
        return tuple(self.limits[joint] for joint in joints)

    def speeds(self, joints: tuple[str, ...]) -> Speeds:
        """Velocity and acceleration limits of joints, in their order."""
        rows = self.limits_of(joints)
        return Speeds(np.array([row.velocity for row in rows]), np.array([row.acceleration for row in rows]))

    def lift(self, q: Array, side: Side, q_arm: Array) -> Array:
        """Whole configurations (..., nq): `q` (nq,) with slide and arm at `q_arm` (..., 8)."""
        whole = np.broadcast_to(q, (*q_arm.shape[:-1], len(q))).copy()
        whole[..., self.arm_indices(side)] = q_arm
        return whole

    def goal_seed(self, goal_id: str) -> int:
        """A seed of this goal's own, the same in every run and on every machine."""
        digest = hashlib.sha256(f"{self.seed}:{goal_id}".encode()).digest()
        return int.from_bytes(digest[:4], "big")


def planning_limits(robot: Robot, profile: Profile) -> dict[str, JointLimit]:
    """Limits by joint name: the calibration profile's, inside the robot description's where both speak."""
    rows: dict[str, JointLimit] = {}
    for limit in profile.calibration.limits:
        index = robot.joint_names.index(limit.joint)
        lower = max(limit.lower, float(robot.lower[index]))
        upper = min(limit.upper, float(robot.upper[index]))
        rows[limit.joint] = JointLimit(
            limit.joint, lower, upper, limit.velocity, limit.acceleration, limit.torque
        )
    return rows
