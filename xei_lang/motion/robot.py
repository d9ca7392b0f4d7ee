"""The robot as rigid bodies: kinematics and dynamics over one configuration vector, rooted at `base_link`.

A configuration `q` has one entry a joint, in pinocchio's order (`Robot.joint_names`): the slide, then for
each arm, left first, its seven joints and its two fingers. Both fingers stand in `q`; the second one's travel
must equal the first one's (`with_opening` sets both). All joints are prismatic or revolute with limits, so
`q`, `v` and `a` have equal length.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import JointLimit

pin: Any = importlib.import_module("pinocchio")  # ships no type information

Array = NDArray[np.float64]
SIDES: tuple[Side, Side] = ("left", "right")


@dataclass(frozen=True, slots=True)
class ArmChain:
    """One arm: seven joints from shoulder to wrist, and the frame that grasps are told in.

    `tool_frame` lies on the jaws' mid-plane, z along the approach, y along the opening.
    """

    side: Side
    joint_names: tuple[str, ...]
    q_indices: tuple[int, ...]
    finger_indices: tuple[int, int]
    shoulder_frame: str
    tool_frame: str

    @property
    def span(self) -> slice:
        """The arm's entries of `q`: its joints are neighbours in the model's order."""
        return slice(self.q_indices[0], self.q_indices[-1] + 1)


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot model with its arms, slide and named configurations. Make one with `load_robot`.

    `lower` and `upper` (nq,) are the joint limits in rad or m; `rated_velocity` and `rated_effort` the
    motors' rated figures of the URDF, which a calibration profile's planning limits should not exceed.
    """

    model: Any = field(repr=False, compare=False)
    data: Any = field(repr=False, compare=False)
    urdf_text: str = field(repr=False)
    srdf_text: str = field(repr=False)
    joint_names: tuple[str, ...] = field(repr=False)
    arms: Mapping[Side, ArmChain] = field(repr=False, compare=False)
    slide_index: int
    slide_axis: tuple[float, float, float]
    states: Mapping[str, Mapping[str, float]] = field(repr=False, compare=False)
    disabled_pairs: tuple[tuple[str, str], ...] = field(repr=False)
    lower: Array = field(repr=False, compare=False)
    upper: Array = field(repr=False, compare=False)
    rated_velocity: Array = field(repr=False, compare=False)
    rated_effort: Array = field(repr=False, compare=False)

    @property
    def nq(self) -> int:
        """How many entries `q` has."""
        return len(self.joint_names)

    def arm(self, side: Side) -> ArmChain:
        """The arm on this side."""
        return self.arms[side]

    def configuration(self, state: str, onto: Array | None = None) -> Array:
        """The named state of the SRDF, every group that has it, on top of `onto` (zeros without one).

        KeyError for a name that `states` lacks: names are checked against it before.
        """
        q = np.zeros(self.nq) if onto is None else onto.copy()
        for joint, value in self.states[state].items():
            q[self.joint_names.index(joint)] = value
        for arm in self.arms.values():
            first, second = arm.finger_indices
            q[second] = q[first]
        return q

    def with_opening(self, q: Array, side: Side, opening_m: float) -> Array:
        """A copy of `q` (..., nq) with the jaws `opening_m` apart: each finger travels half of it."""
        result = q.copy()
        result[..., self.arms[side].finger_indices] = opening_m / 2
        return result

    def max_opening_m(self, side: Side) -> float:
        """How far apart the jaws can be."""
        return 2.0 * float(self.upper[self.arms[side].finger_indices[0]])

    def in_limits(self, q: Array, tolerance: float = 1e-9) -> bool:
        """Whether all joints of `q` (nq,) are within the URDF's limits."""
        return bool(np.all(q >= self.lower - tolerance) and np.all(q <= self.upper + tolerance))

    def narrowed(self, limits: Mapping[str, JointLimit]) -> Robot:
        """This robot with the ranges of the joints in `limits`: inverse kinematics stays within them."""
        lower, upper = self.lower.copy(), self.upper.copy()
        for name, limit in limits.items():
            index = self.joint_names.index(name)
            lower[index], upper[index] = limit.lower, limit.upper
        return replace(self, lower=lower, upper=upper)

    def T_base_frame(self, q: Array, frame: str) -> Array:
        """Pose (4, 4) of a link or frame in base_link."""
        pin.forwardKinematics(self.model, self.data, q)
        return pin.updateFramePlacement(self.model, self.data, self._frame_id(frame)).homogeneous.copy()

    def jacobian(self, q: Array, frame: str) -> Array:
        """Jacobian (6, nq) of the frame's origin, axes of base_link: linear rows first, then angular."""
        reference = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        jacobian = pin.computeFrameJacobian(self.model, self.data, q, self._frame_id(frame), reference)
        return np.asarray(jacobian).copy()

    def torques(self, q: Array, v: Array, a: Array) -> Array:
        """Joint torques or forces (n, nq) for motions q, v, a (n, nq), by recursive Newton-Euler.

        Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 5; gravity along -z of base_link.
        """
        rows = (pin.rnea(self.model, self.data, *row) for row in zip(q, v, a, strict=True))
        return np.array([row.copy() for row in rows]).reshape(-1, self.nq)

    def with_payload(self, side: Side, mass_kg: float, com_tool_m: tuple[float, float, float]) -> Robot:
        """This robot with a point mass fixed in the arm's tool frame, for torques with a held object."""
        model = self.model.copy()
        frame = model.frames[self._frame_id(self.arms[side].tool_frame)]
        body = pin.Inertia(mass_kg, np.array(com_tool_m), np.zeros((3, 3)))
        model.appendBodyToJoint(frame.parentJoint, body, frame.placement)
        return _replaced_model(self, model)

    def _frame_id(self, frame: str) -> int:
        index = int(self.model.getFrameId(frame))
        if index >= int(self.model.nframes):
            raise KeyError(frame)
        return index


def _replaced_model(robot: Robot, model: Any) -> Robot:
    kept = {
        name: getattr(robot, name) for name in Robot.__dataclass_fields__ if name not in ("model", "data")
    }
    return Robot(model=model, data=model.createData(), **kept)


def load_robot(urdf_text: str, srdf_text: str) -> Robot:
    """Build the model from URDF and SRDF text.

    The SRDF's groups `left_arm`, `right_arm` and `slide` name the joints. ValueError where a group or a tool
    frame is missing: the profile's checks come before.
    """
    model = pin.buildModelFromXML(urdf_text)
    srdf = ElementTree.fromstring(srdf_text)
    names = tuple(str(name) for name in list(model.names)[1:])
    groups = {str(group.get("name")): _joints(group) for group in srdf.findall("group")}
    slide = groups["slide"][0] if groups.get("slide") else ""
    if slide not in names:
        raise ValueError("the SRDF has no group `slide` with a joint of the URDF")
    arms: dict[Side, ArmChain] = {
        side: _arm_chain(side, groups, names) for side in SIDES if f"{side}_arm" in groups
    }
    return Robot(
        model=model,
        data=model.createData(),
        urdf_text=urdf_text,
        srdf_text=srdf_text,
        joint_names=names,
        arms=MappingProxyType(arms),
        slide_index=names.index(slide),
        slide_axis=_prismatic_axis(model, names.index(slide)),
        states=_states(srdf),
        disabled_pairs=tuple(
            (str(p.get("link1")), str(p.get("link2"))) for p in srdf.findall("disable_collisions")
        ),
        lower=np.array(model.lowerPositionLimit),
        upper=np.array(model.upperPositionLimit),
        rated_velocity=np.array(model.velocityLimit),
        rated_effort=np.array(model.effortLimit),
    )


def _joints(group: ElementTree.Element) -> tuple[str, ...]:
    return tuple(str(joint.get("name")) for joint in group.findall("joint"))


def _arm_chain(side: Side, groups: Mapping[str, tuple[str, ...]], names: tuple[str, ...]) -> ArmChain:
    joints = groups[f"{side}_arm"]
    first = names.index(groups[f"{side}_gripper"][0])
    return ArmChain(
        side=side,
        joint_names=joints,
        q_indices=tuple(names.index(joint) for joint in joints),
        finger_indices=(first, first + 1),
        shoulder_frame=f"openarm_{side}_link2",
        tool_frame=f"openarm_{side}_grasp",
    )


def _prismatic_axis(model: Any, index: int) -> tuple[float, float, float]:
    """The direction in base_link that the joint moves along, read from the model's Jacobian at zero."""
    data = model.createData()
    pin.computeJointJacobians(model, data, np.zeros(model.nq))
    column = np.asarray(data.J)[:, index]
    return (float(column[0]), float(column[1]), float(column[2]))


def _states(srdf: ElementTree.Element) -> Mapping[str, Mapping[str, float]]:
    states: dict[str, dict[str, float]] = {}
    for state in srdf.findall("group_state"):
        joints = states.setdefault(str(state.get("name")), {})
        joints.update(
            {str(joint.get("name")): float(str(joint.get("value"))) for joint in state.findall("joint")}
        )
    return MappingProxyType({name: MappingProxyType(joints) for name, joints in states.items()})
