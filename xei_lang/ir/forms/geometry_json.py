"""Poses and shapes as JSON: metres, radians, quaternions `(x, y, z, w)`, as in `ir/geometry.py`."""

from __future__ import annotations

from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive, Shape, Sphere


def pose(value: Pose) -> dict[str, Json]:
    """`{"position_m": [x, y, z], "quaternion": [x, y, z, w]}`."""
    return {"position_m": list(value.position_m), "quaternion": list(value.quaternion)}


def shape(value: Shape) -> dict[str, Json]:
    """`{"type": "box", "size_m": [...]}`, or a cylinder, capsule or sphere with radius and height."""
    if isinstance(value, Box):
        return {"type": "box", "size_m": list(value.size_m)}
    if isinstance(value, Sphere):
        return {"type": "sphere", "radius_m": value.radius_m}
    name = "cylinder" if isinstance(value, Cylinder) else "capsule"
    return {"type": name, "radius_m": value.radius_m, "height_m": value.height_m}


def primitive(value: Primitive) -> dict[str, Json]:
    """A shape with its pose in the frame of the object that it belongs to."""
    return {"shape": shape(value.shape), "T_object_shape": pose(value.T_object_shape)}
