"""Rigid poses and primitive shapes, in plain numbers so that values stay cheap to read and to write.

Conventions: metres, radians, quaternions `(x, y, z, w)` of unit norm, fixed-axis roll-pitch-yaw as in URDF.
A pose named `T_a_b` maps coordinates of frame b into frame a: `T_a_c = T_a_b @ T_b_c`.
"""

from __future__ import annotations

import math

from xei_lang.record import Record, record

Vec3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


def _multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def _unit(q: Quaternion) -> Quaternion:
    """Of unit norm and with w >= 0, so that one rotation has one quaternion; `+ 0.0` leaves no -0.0."""
    x, y, z, w = q
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if w < 0.0:
        norm = -norm
    return (x / norm + 0.0, y / norm + 0.0, z / norm + 0.0, w / norm + 0.0)


@record
class Pose(Record):
    """A rigid transform: rotate by `quaternion`, then translate by `position_m`."""

    position_m: Vec3 = (0.0, 0.0, 0.0)
    quaternion: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @staticmethod
    def from_rpy(position_m: Vec3, rpy_rad: Vec3) -> Pose:
        """A pose from a translation and fixed-axis roll, pitch and yaw (`R = Rz(yaw) Ry(pitch) Rx(roll)`)."""
        cr, sr = math.cos(rpy_rad[0] / 2), math.sin(rpy_rad[0] / 2)
        cp, sp = math.cos(rpy_rad[1] / 2), math.sin(rpy_rad[1] / 2)
        cy, sy = math.cos(rpy_rad[2] / 2), math.sin(rpy_rad[2] / 2)
        quaternion = (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
        return Pose(position_m, _unit(quaternion))

    @staticmethod
    def from_axes(position_m: Vec3, x_axis: Vec3, y_axis: Vec3, z_axis: Vec3) -> Pose:
        """A pose whose axes, in the parent frame, are the given orthonormal right-handed columns."""
        (a, d, g), (b, e, h), (c, f, i) = x_axis, y_axis, z_axis
        trace = a + e + i
        if trace > 0.0:
            s = 2.0 * math.sqrt(trace + 1.0)
            quaternion = ((h - f) / s, (c - g) / s, (d - b) / s, s / 4)
        elif a >= e and a >= i:
            s = 2.0 * math.sqrt(1.0 + a - e - i)
            quaternion = (s / 4, (b + d) / s, (c + g) / s, (h - f) / s)
        elif e >= i:
            s = 2.0 * math.sqrt(1.0 + e - a - i)
            quaternion = ((b + d) / s, s / 4, (f + h) / s, (c - g) / s)
        else:
            s = 2.0 * math.sqrt(1.0 + i - a - e)
            quaternion = ((c + g) / s, (f + h) / s, s / 4, (d - b) / s)
        return Pose(position_m, _unit(quaternion))

    def rotate(self, vector: Vec3) -> Vec3:
        """The vector turned into the parent frame, without the translation."""
        x, y, z, w = self.quaternion
        vx, vy, vz = vector
        tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
        return (
            vx + w * tx + y * tz - z * ty,
            vy + w * ty + z * tx - x * tz,
            vz + w * tz + x * ty - y * tx,
        )

    def apply(self, point_m: Vec3) -> Vec3:
        """The point, given in this pose's frame, in the parent frame."""
        x, y, z = self.rotate(point_m)
        px, py, pz = self.position_m
        return (x + px, y + py, z + pz)

    def locate(self, point_m: Vec3) -> Vec3:
        """The point, given in the parent frame, in this pose's frame: `inverse().apply(point_m)`."""
        x, y, z, w = self.quaternion
        (ax, ay, az), (bx, by, bz) = point_m, self.position_m
        vx, vy, vz = ax - bx, ay - by, az - bz
        tx, ty, tz = 2 * (z * vy - y * vz), 2 * (x * vz - z * vx), 2 * (y * vx - x * vy)
        return (
            vx + w * tx + z * ty - y * tz,
            vy + w * ty + x * tz - z * tx,
            vz + w * tz + y * tx - x * ty,
        )

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.apply(other.position_m), _unit(_multiply(self.quaternion, other.quaternion)))

    def inverse(self) -> Pose:
        """The pose of the parent frame in this frame."""
        x, y, z, w = self.quaternion
        back = Pose((0.0, 0.0, 0.0), (-x, -y, -z, w))
        px, py, pz = back.rotate(self.position_m)
        return Pose((-px, -py, -pz), back.quaternion)

    def axes(self) -> tuple[Vec3, Vec3, Vec3]:
        """The x, y and z axes of this frame in the parent frame: the columns of the rotation matrix."""
        return self.rotate((1.0, 0.0, 0.0)), self.rotate((0.0, 1.0, 0.0)), self.rotate((0.0, 0.0, 1.0))

    def matrix(self) -> tuple[tuple[float, float, float, float], ...]:
        """The 4x4 homogeneous matrix, row by row."""
        x, y, z = self.axes()
        p = self.position_m
        return (*((x[k], y[k], z[k], p[k]) for k in range(3)), (0.0, 0.0, 0.0, 1.0))


IDENTITY = Pose()


@record
class Box(Record):
    """A box centred at its origin; full edge lengths in metres."""

    size_m: Vec3


@record
class Cylinder(Record):
    """A cylinder along z, centred at its origin; metres."""

    radius_m: float
    height_m: float


@record
class Sphere(Record):
    """A sphere around its origin; metres."""

    radius_m: float


@record
class Capsule(Record):
    """A cylinder along z of `height_m` with a half sphere at each end, centred at its origin; metres."""

    radius_m: float
    height_m: float


Shape = Box | Cylinder | Sphere | Capsule


@record
class Primitive(Record):
    """One collision primitive of an object, placed in the object's frame."""

    shape: Shape
    T_object_shape: Pose = IDENTITY
