"""The outline of the base on the floor, from the robot's description.

The collision shapes of all links that fixed joints hang on the base are laid on the floor; the outline is
their convex hull. What moves on the base (slide, arms) is not of it: it is higher than a planar map sees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from xml.etree import ElementTree

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.profiles.model import Profile, RobotDescription
from xei_lang.world.frames import T_base_link

Point = tuple[float, float]
_SIDES = 32


@dataclass(frozen=True, slots=True)
class Footprint:
    """A convex polygon in the base's frame, counter-clockwise, m; its origin is where the base turns."""

    corners: tuple[Point, ...]

    @property
    def circumscribed_m(self) -> float:
        """The distance of the farthest corner from the point about which the base turns."""
        return max(math.hypot(*corner) for corner in self.corners)

    @property
    def inscribed_m(self) -> float:
        """The radius of the largest circle about that point inside the outline; 0 where it lies outside."""
        sides = zip(self.corners, (*self.corners[1:], self.corners[0]), strict=True)
        return max(0.0, min(_distance_to_side(a, b) for a, b in sides))

    def at(self, x: float, y: float, yaw: float, scale: float = 1.0) -> tuple[Point, ...]:
        """The corners where the base stands at (x, y, yaw); `scale` enlarges the outline about its origin."""
        c, s = scale * math.cos(yaw), scale * math.sin(yaw)
        return tuple((x + c * px - s * py, y + s * px + c * py) for px, py in self.corners)


def base_footprint(profile: Profile, urdf: str) -> Footprint | str:
    """The outline in `robot_base`, or why it cannot be had. `urdf` is the text of the robot's description."""
    base = dict(profile.calibration.robot_frames).get("robot_base", profile.robot.root)
    links = fixed_links(profile.robot, base)
    T_base_root = T_base_link(profile.robot, base, {}).inverse()
    points: list[Point] = []
    for link in ElementTree.fromstring(urdf).findall("link"):
        name = link.get("name", "")
        for shape in link.findall("collision") if name in links else ():
            T_base_shape = T_base_root @ T_base_link(profile.robot, name, {}) @ _origin(shape)
            found = _points(shape, T_base_shape)
            if found is None:
                return f"the collision shape of `{name}` is no box, cylinder or sphere"
            points += found
    hull = convex_hull(points)
    return Footprint(hull) if len(hull) > 2 else f"`{base}` has no collision shape"


def convex_hull(points: list[Point]) -> tuple[Point, ...]:
    """The corners of the hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(dict.fromkeys(points))
    if len(ordered) < 3:
        return tuple(ordered)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return (*lower[:-1], *upper[:-1])


def _chain(points: list[Point]) -> list[Point]:
    chain: list[Point] = []
    for point in points:
        while len(chain) > 1 and _cross(chain[-2], chain[-1], point) <= 1e-12:
            chain.pop()
        chain.append(point)
    return chain


def _cross(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _distance_to_side(a: Point, b: Point) -> float:
    """How far left of the side from a to b the origin lies; negative on its right."""
    return _cross(a, b, (0.0, 0.0)) / math.dist(a, b)


def fixed_links(robot: RobotDescription, base: str) -> frozenset[str]:
    """The base and all links that hang on it through fixed joints, up and down the tree."""
    found, before = {base}, 0
    while len(found) > before:
        before = len(found)
        for joint in robot.joints:
            if joint.kind == "fixed" and (joint.parent in found or joint.child in found):
                found |= {joint.parent, joint.child}
    return frozenset(found)


def _points(shape: ElementTree.Element, T_base_shape: Pose) -> list[Point] | None:
    """Points of the floor whose hull holds the shape; None for a shape of another kind."""
    box, cylinder = shape.find("geometry/box"), shape.find("geometry/cylinder")
    sphere = shape.find("geometry/sphere")
    corners: list[Vec3] = []
    if box is not None:
        x, y, z = (float(word) / 2.0 for word in box.get("size", "").split())
        corners = [(sx * x, sy * y, sz * z) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    elif cylinder is not None:
        radius, half = float(cylinder.get("radius", "0")), float(cylinder.get("length", "0")) / 2.0
        corners = [(x, y, z) for x, y in _circle(radius) for z in (-half, half)]
    elif sphere is not None:
        px, py, _ = T_base_shape.position_m
        return [(px + x, py + y) for x, y in _circle(float(sphere.get("radius", "0")))]
    else:
        return None
    return [T_base_shape.apply(corner)[:2] for corner in corners]


def _circle(radius_m: float) -> list[Point]:
    """The corners of a regular polygon about a circle."""
    outer, turn = radius_m / math.cos(math.pi / _SIDES), 2.0 * math.pi / _SIDES
    return [(outer * math.cos(k * turn), outer * math.sin(k * turn)) for k in range(_SIDES)]


def _origin(shape: ElementTree.Element) -> Pose:
    origin = shape.find("origin")
    xyz, rpy = (
        ("0 0 0", "0 0 0") if origin is None else (origin.get("xyz", "0 0 0"), origin.get("rpy", "0 0 0"))
    )
    return Pose.from_rpy(_vector(xyz), _vector(rpy))


def _vector(words: str) -> Vec3:
    x, y, z = (float(word) for word in words.split())
    return (x, y, z)
