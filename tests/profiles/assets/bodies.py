"""Bodies made of triangles, and their files, written here: reading is not checked by its own library."""

from __future__ import annotations

import itertools
import math
import struct

import numpy as np


def lathe(profile, sections=48):
    """The closed body that a profile of (radius, z) points, from axis to axis, sweeps around z."""
    rings = [
        [(r * math.cos(a), r * math.sin(a), z) for a in np.arange(sections) * math.tau / sections]
        if r > 0
        else [(0.0, 0.0, z)] * sections
        for r, z in profile
    ]
    triangles = []
    for low, high in itertools.pairwise(rings):
        for k in range(sections):
            n = (k + 1) % sections
            for triangle in ((low[k], low[n], high[n]), (low[k], high[n], high[k])):
                if len(set(triangle)) == 3:
                    triangles.append(triangle)
    return np.array(triangles)


def cylinder(diameter, height, sections=48):
    return lathe([(0, 0), (diameter / 2, 0), (diameter / 2, height), (0, height)], sections)


def beaker(diameter, height, wall):
    inner = diameter / 2 - wall
    return lathe(
        [(0, 0), (diameter / 2, 0), (diameter / 2, height), (inner, height), (inner, wall), (0, wall)]
    )


def ball(diameter, rings=24):
    angles = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    radii = [0.0, *(diameter / 2 * np.cos(angles[1:-1])), 0.0]
    return lathe(list(zip(radii, diameter / 2 * (1 + np.sin(angles)), strict=True)), 2 * rings)


def box(x, y, z):
    corners = {
        (i, j, k): ((i - 0.5) * x, (j - 0.5) * y, k * z) for i in (0, 1) for j in (0, 1) for k in (0, 1)
    }
    faces = [
        ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
        ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)), ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)),
        ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
    ]  # fmt: skip
    split = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return np.array([[corners[key] for key in triangle] for triangle in split])


def sampled(triangles, count, seed):
    """Points spread evenly over the surface."""
    random = np.random.default_rng(seed)
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = random.choice(len(triangles), count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]


def stl(triangles):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in triangles)
    return b"made by a test".ljust(80) + struct.pack("<I", len(triangles)) + body


def stl_text(triangles):
    rows = ["solid made"]
    for triangle in triangles:
        rows += ["facet normal 0 0 0", " outer loop", *(f"  vertex {_row(p)}" for p in triangle)]
        rows += [" endloop", "endfacet"]
    return "\n".join([*rows, "endsolid made", ""]).encode()


def _indexed(triangles):
    points: dict[tuple[float, ...], int] = {}
    faces = [[points.setdefault(tuple(p), len(points)) for p in t] for t in triangles.tolist()]
    return list(points), faces


def obj(triangles):
    points, faces = _indexed(triangles)
    rows = [f"v {_row(p)}" for p in points] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    return "\n".join([*rows, ""]).encode()


def ply(triangles, kind="ascii"):
    points, faces = _indexed(triangles)
    rows = [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    head = [*_ply_head(kind, len(points)), *rows]
    return _ply_body(head, kind, points, faces)


def ply_points(points, kind="ascii"):
    return _ply_body(_ply_head(kind, len(points)), kind, points, [])


def _ply_head(kind, count):
    return ["ply", f"format {kind} 1.0", f"element vertex {count}", *(f"property double {a}" for a in "xyz")]


def _ply_body(head, kind, points, faces):
    start = "\n".join([*head, "end_header", ""]).encode()
    if kind == "ascii":
        return start + "\n".join([*map(_row, points), *(f"3 {a} {b} {c}" for a, b, c in faces), ""]).encode()
    order = "<" if "little" in kind else ">"
    rows = [struct.pack(order + "3d", *p) for p in points] + [
        struct.pack(order + "B3i", 3, *f) for f in faces
    ]
    return start + b"".join(rows)


def xyz(points):
    return "\n".join(["# x y z", *map(_row, points), ""]).encode()


def pcd(points, kind="ascii"):
    """A PCD file with an intensity before the coordinates, to be passed over."""
    head = f"""# .PCD v0.7
VERSION 0.7
FIELDS intensity x y z
SIZE 2 4 4 4
TYPE U F F F
COUNT 1 1 1 1
WIDTH {len(points)}
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS {len(points)}
DATA {kind}
"""
    start = head.encode()
    if kind == "ascii":
        return start + "\n".join([*(f"7 {_row(p)}" for p in points), ""]).encode()
    return start + b"".join(struct.pack("<H3f", 7, *p) for p in points)


def _row(point):
    return " ".join(repr(float(value)) for value in point)


MESH_WRITERS = {
    "a.stl": stl,
    "b.stl": stl_text,
    "c.obj": obj,
    "d.ply": ply,
    "e.ply": lambda t: ply(t, "binary_little_endian"),
    "f.ply": lambda t: ply(t, "binary_big_endian"),
}
CLOUD_WRITERS = {
    "a.xyz": xyz,
    "b.ply": ply_points,
    "c.ply": lambda p: ply_points(p, "binary_little_endian"),
    "d.pcd": pcd,
    "e.pcd": lambda p: pcd(p, "binary"),
}
