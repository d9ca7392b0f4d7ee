"""The robot as the verifier reads it from the URDF: its joints, vectorised forward kinematics, and reach
bounds.

Written apart from pinocchio (which serves for torque and distances), so that each can be tested against the
other.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.motion.verify.evaluate import Array

pin: Any = importlib.import_module("pinocchio")  # ships no type information

Frames = tuple[Array, Array]
"""Rotations (times, 3, 3) and origins (times, 3) of one frame in the base."""


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint of the URDF; `column` is its place in a configuration, -1 where it is fixed."""

    name: str
    kind: str
    parent: str
    child: str
    rotation: Array
    origin: Array
    axis: Array
    lower: float
    upper: float
    velocity: float
    effort: float
    mimic: tuple[str, float, float] | None
    column: int


class Robot:
    """Joints in pinocchio's order, kinematics by link, and the pinocchio model for torque and geometry."""

    def __init__(self, urdf_text: str) -> None:
        self.urdf_text = urdf_text
        self.model = pin.buildModelFromXML(urdf_text)
        names = [str(name) for name in self.model.names][1:]
        self.joint_names: tuple[str, ...] = tuple(names)
        self.column = {name: int(self.model.joints[k + 1].idx_q) for k, name in enumerate(names)}
        root = ElementTree.fromstring(urdf_text)
        joints = [_read_joint(element, self.column) for element in root.findall("joint")]
        self.joints = {joint.name: joint for joint in joints}
        self._above = {joint.child: joint for joint in joints}
        self.links = tuple(str(link.get("name")) for link in root.findall("link"))
        self.mimics = tuple(joint for joint in joints if joint.mimic is not None)
        self._chains = {link: self._walk(link) for link in self.links}

    @property
    def size(self) -> int:
        """Number of joint positions in a configuration."""
        return len(self.joint_names)

    def _walk(self, link: str) -> tuple[Joint, ...]:
        chain: list[Joint] = []
        while link in self._above:
            chain.append(self._above[link])
            link = chain[-1].parent
        return tuple(reversed(chain))

    def chain(self, link: str) -> tuple[Joint, ...]:
        """Joints from the root to the link, fixed ones included."""
        return self._chains[link]

    def columns(self, link: str) -> tuple[int, ...]:
        """Columns of the joints that move the link."""
        return tuple(joint.column for joint in self._chains[link] if joint.column >= 0)

    def fingers(self, link: str) -> tuple[str, ...]:
        """Links that hang, by moving joints, on what is rigid with this link: the fingers of a hand."""
        own = self.columns(link)
        return tuple(
            other
            for other in self.links
            if self.columns(other)[: len(own)] == own and self.columns(other) != own
        )

    def follow(self, q: Array) -> None:
        """Set the columns of mimic joints from those that they follow, in place; rows are configurations."""
        for joint in self.mimics:
            assert joint.mimic is not None
            leader, multiplier, offset = joint.mimic
            q[..., joint.column] = multiplier * q[..., self.column[leader]] + offset

    def follow_rates(self, rates: Array) -> None:
        """As `follow`, for velocities and accelerations."""
        for joint in self.mimics:
            assert joint.mimic is not None
            leader, multiplier, _ = joint.mimic
            rates[..., joint.column] = multiplier * rates[..., self.column[leader]]

    def frames(self, q: Array, links: tuple[str, ...]) -> dict[str, Frames]:
        """Frames of the links in the base for configurations q (times, joints)."""
        count = len(q)
        root = (np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3)))
        done: dict[str, Frames] = {}
        for link in links:
            current = root
            for joint in self._chains[link]:
                if joint.child not in done:
                    done[joint.child] = _step(current, joint, q)
                current = done[joint.child]
            done.setdefault(link, current)
        return {link: done[link] for link in links}

    def pose(self, q: Array, link: str) -> Pose:
        """Pose of a link in the base at one configuration."""
        rotation, origin = self.frames(q[None, :], (link,))[link]
        x, y, z = (_vec(rotation[0, :, k]) for k in range(3))
        return Pose.from_axes(_vec(origin[0]), x, y, z)

    def lever(self, link: str, radius_m: float) -> Array:
        """Bound, by column, on how far a point within `radius_m` of the link's origin moves per unit of that
        joint.

        For a revolute joint: the farthest that the point can be from the joint's origin, whatever the joints
        between.
        """
        levers = np.zeros(self.size)
        distance = radius_m
        for joint in reversed(self._chains[link]):
            if joint.column >= 0:
                levers[joint.column] = 1.0 if joint.kind == "prismatic" else distance
                if joint.kind == "prismatic":
                    distance += max(abs(joint.lower), abs(joint.upper)) + 0.1
            distance += float(np.linalg.norm(joint.origin))
        return levers


def _vec(values: Array) -> tuple[float, float, float]:
    return (float(values[0]), float(values[1]), float(values[2]))


def _step(frame: Frames, joint: Joint, q: Array) -> Frames:
    rotation, origin = frame
    origin = origin + rotation @ joint.origin
    rotation = rotation @ joint.rotation
    if joint.kind == "prismatic":
        origin = origin + (rotation @ joint.axis) * q[:, joint.column, None]
    elif joint.column >= 0:
        rotation = rotation @ turn(joint.axis, q[:, joint.column])
    return rotation, origin


def turn(axis: Array, angles: Array) -> Array:
    """Rotation matrices (n, 3, 3) about a unit axis by n angles (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, versine = np.sin(angles)[:, None, None], (1.0 - np.cos(angles))[:, None, None]
    return np.eye(3) + sine * cross + versine * (cross @ cross)


def _numbers(text: str | None, default: str) -> Array:
    return np.array([float(word) for word in (text or default).split()])


def _rpy(rpy: Array) -> Array:
    one = np.eye(3)
    roll, pitch, yaw = (turn(one[k], rpy[k : k + 1])[0] for k in range(3))
    return yaw @ pitch @ roll


def _read_joint(element: ElementTree.Element, columns: dict[str, int]) -> Joint:
    name, kind = str(element.get("name")), str(element.get("type"))
    parent, child = element.find("parent"), element.find("child")
    origin, axis, limit = element.find("origin"), element.find("axis"), element.find("limit")
    mimic = element.find("mimic")
    assert parent is not None
    assert child is not None
    direction = _numbers(axis.get("xyz") if axis is not None else None, "1 0 0")

    def bound(key: str, default: float) -> float:
        return float(limit.get(key, default)) if limit is not None else default

    follow = None
    if mimic is not None:
        follow = (
            str(mimic.get("joint")),
            float(mimic.get("multiplier", 1.0)),
            float(mimic.get("offset", 0.0)),
        )
    return Joint(
        name, kind, str(parent.get("link")), str(child.get("link")),
        _rpy(_numbers(origin.get("rpy") if origin is not None else None, "0 0 0")),
        _numbers(origin.get("xyz") if origin is not None else None, "0 0 0"),
        direction / np.linalg.norm(direction),
        bound("lower", -np.inf), bound("upper", np.inf), bound("velocity", np.inf), bound("effort", np.inf),
        follow, columns.get(name, -1),
    )  # fmt: skip
