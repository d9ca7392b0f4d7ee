"""Meshes (STL, OBJ, PLY) and the point clouds that PLY holds, read with trimesh."""

from __future__ import annotations

import importlib
import io
import logging
import re
import warnings
from pathlib import PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.profiles.assets.points import Array, Points, UnreadableError, require_body
from xei_lang.profiles.assets.structure import MAX_POINTS, claim

trimesh: Any = importlib.import_module("trimesh")  # its types are partial
logging.getLogger("trimesh").addHandler(logging.NullHandler())

MESHES = (".stl", ".obj", ".ply")
_PARTS = re.compile(rb"^[ \t]*(g|o|usemtl|mtllib)\b.*$", re.M)
_UNREAD = "string or file could not be read to its end"


def read_mesh(data: bytes, name: str) -> Points | str:
    """The vertices of the triangles of a mesh file (n x 3, in its own unit), or in words that follow its name
    why there are none.
    """
    try:
        return _mesh(data, PurePosixPath(name).suffix.lower())
    except UnreadableError as reason:
        return str(reason)


def ply_points(data: bytes) -> Array:
    """The vertices of a PLY file (n x 3), with or without faces. Raises UnreadableError."""
    claimed = claim(data, ".ply")
    if claimed.points > MAX_POINTS:
        raise UnreadableError(f"has {claimed.points} points, the limit is {MAX_POINTS}")
    points, _ = _load(data, ".ply")
    if len(points) < claimed.points:
        raise UnreadableError(f"is cut: it tells of {claimed.points} points, and it has {len(points)}")
    return points


def _mesh(data: bytes, suffix: str) -> Points:
    if suffix not in MESHES:
        raise UnreadableError("is no mesh that xei reads: expected `.stl`, `.obj` or `.ply`")
    claimed = claim(data, suffix)
    if not claimed.faces:
        raise UnreadableError("holds no triangles")
    vertices, faces = _load(data, suffix)
    if len(faces) < claimed.faces:
        raise UnreadableError(f"holds {len(faces)} triangles of {claimed.faces}: it is cut or damaged")
    used = np.zeros(len(vertices), dtype=np.bool_)
    used[faces.ravel()] = True
    require_body(vertices[used])
    return Points(vertices[used], bool(trimesh.Trimesh(vertices, faces, process=True).is_watertight))


def _load(data: bytes, suffix: str) -> tuple[Array, NDArray[np.int64]]:
    """All vertices (n x 3) and triangles (m x 3) of a file. Raises UnreadableError."""
    if suffix == ".obj":
        data = _PARTS.sub(b"", data)  # a body is all its parts; thousands of them would take minutes
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("error", message=_UNREAD)
            scene = trimesh.load_scene(
                io.BytesIO(data), file_type=suffix[1:], process=False, skip_materials=True
            )
        return _joined(list(scene.geometry.values()))
    except Exception as error:  # a damaged file makes a reader fail in any way
        said = str(error).split("\n", 1)[0].rstrip(".")[:120] or type(error).__name__
        raise UnreadableError(f"is damaged, or no {suffix[1:].upper()} file: {said}") from error


def _joined(bodies: list[Any]) -> tuple[Array, NDArray[np.int64]]:
    vertices: list[Array] = []
    faces: list[NDArray[np.int64]] = []
    offset = 0
    for body in bodies:
        points = np.asarray(body.vertices, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError("a vertex without three numbers")
        triangles = np.asarray(getattr(body, "faces", np.empty((0, 3))), dtype=np.int64).reshape(-1, 3)
        if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points):
            raise ValueError("a triangle names a vertex that is not there")
        vertices.append(points)
        faces.append(triangles + offset)
        offset += len(points)
    if not vertices:
        raise ValueError("nothing in it is a mesh")
    return np.concatenate(vertices), np.concatenate(faces)
