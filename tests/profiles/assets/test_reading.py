from __future__ import annotations

import itertools
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.profiles.assets.bodies import (
    CLOUD_WRITERS,
    MESH_WRITERS,
    beaker,
    box,
    cylinder,
    obj,
    pcd,
    ply,
    sampled,
    stl,
    stl_text,
    xyz,
)
from xei_lang.profiles.assets import structure
from xei_lang.profiles.assets.points import Points
from xei_lang.profiles.assets.read_cloud import read_cloud
from xei_lang.profiles.assets.read_mesh import read_mesh

CUP = beaker(60.0, 80.0, 2.0)


def bounds(found):
    assert isinstance(found, Points), found
    return found.points.min(axis=0), found.points.max(axis=0)


@pytest.mark.parametrize("name", MESH_WRITERS)
def test_all_kinds_of_meshes_hold_the_same_body(name):
    found = read_mesh(MESH_WRITERS[name](CUP), f"assets/{name}")
    lower, upper = bounds(found)
    np.testing.assert_allclose(lower, (-30, -30, 0), atol=1e-5)
    np.testing.assert_allclose(upper, (30, 30, 80), atol=1e-5)
    assert found.is_closed


@pytest.mark.parametrize("name", CLOUD_WRITERS)
def test_all_kinds_of_point_clouds_hold_the_same_points(name):
    points = sampled(CUP, 500, seed=3)
    found = read_cloud(CLOUD_WRITERS[name](points), name)
    assert isinstance(found, Points), found
    np.testing.assert_allclose(found.points, points, rtol=1e-6, atol=1e-5)


def test_the_ending_may_be_in_capitals_and_lines_may_end_in_crlf():
    assert isinstance(read_mesh(stl(CUP), "A.STL"), Points)
    for name, data in (("a.obj", obj(CUP)), ("a.stl", stl_text(CUP)), ("a.ply", ply(CUP))):
        assert isinstance(read_mesh(data.replace(b"\n", b"\r\n"), name), Points), name
    assert isinstance(read_cloud(xyz(CUP[0]).replace(b" ", b", ") + xyz(CUP[1]), "a.xyz"), str)


def test_a_binary_stl_whose_header_says_solid_is_binary():
    data = b"solid vertex facet endsolid".ljust(80) + stl(CUP)[80:]
    assert isinstance(read_mesh(data, "a.stl"), Points)


def test_an_obj_with_squares_textures_and_a_material_that_is_not_there():
    text = b"mtllib ../../etc/passwd.mtl\nusemtl steel\no cube\n" + b"vt 0 0\nvn 0 0 1\n"
    points = [f"v {x} {y} {z}" for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    squares = ["1 2 4 3", "5 6 8 7", "1 2 6 5", "3 4 8 7", "1 3 7 5", "2 4 8 6"]
    rows = points + ["f " + " ".join(f"{i}/1/1" for i in square.split()) for square in squares]
    lower, upper = bounds(read_mesh(text + "\n".join(rows).encode() + b"\n", "a.obj"))
    assert lower.tolist() == [0, 0, 0]
    assert upper.tolist() == [1, 1, 1]


def test_points_that_no_triangle_uses_do_not_count():
    for data, name in ((obj(CUP) + b"v 900 900 900\n", "a.obj"), (_with_a_stray(ply(CUP)), "a.ply")):
        assert bounds(read_mesh(data, name))[1].max() < 81


def _with_a_stray(data):
    """A PLY file with one more vertex after the others."""
    head, rows = data.split(b"end_header\n")
    count = int(head.split(b"element vertex ")[1].split()[0])
    rows = rows.splitlines(keepends=True)
    head = head.replace(b"vertex %d" % count, b"vertex %d" % (count + 1))
    return head + b"end_header\n" + b"".join([*rows[:count], b"900 900 900\n", *rows[count:]])


def test_a_hole_is_seen():
    assert read_mesh(stl(CUP[:-1]), "a.stl").is_closed is False


@pytest.mark.parametrize("name", ["a.stl", "b.stl", "c.obj", "d.ply", "e.ply", "f.ply"])
def test_a_cut_mesh_is_never_taken_for_a_smaller_one_that_is_whole(name):
    data = MESH_WRITERS[name](box(30.0, 20.0, 10.0))
    for end in range(len(data) - 12):
        found = read_mesh(data[:end], name)
        assert isinstance(found, str) or found.is_closed is False, (end, data[:end][-40:])


@pytest.mark.parametrize("name", CLOUD_WRITERS)
def test_a_cut_point_cloud_is_told_or_lacks_points_only(name):
    points = sampled(box(30.0, 20.0, 10.0), 40, seed=1)
    data = CLOUD_WRITERS[name](points)
    for end in range(len(data)):
        found = read_cloud(data[:end], name)
        assert isinstance(found, str) or len(found.points) >= 39 or name == "a.xyz", (end, found)


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.stl", b"", "is empty"),
        ("a.stl", b" \n", "is empty"),
        ("a.stl", b"no mesh at all", "is no STL file"),
        ("a.stl", b"this text is as long as a header of a mesh, " * 5, "is no STL file"),
        ("a.stl", b"solid tube\nendsolid\n", "holds no triangles"),
        ("a.stl", bytes(84), "holds no triangles"),
        ("a.stl", b"x" * 80 + bytes(4), "holds no triangles"),
        ("a.stl", stl(CUP)[:-1], "is cut or no STL file"),
        ("a.stl", stl_text(CUP)[:-20], "breaks off"),
        ("a.stl", stl_text(CUP).replace(b"vertex 30.0", b"vertex x30.0", 1), "is damaged"),
        ("a.obj", b"hello\n", "no line begins with `v`"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "holds no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "is damaged"),
        ("a.obj", b"v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "is damaged"),
        ("a.obj", stl(CUP), "it is not text"),
        ("a.ply", b"ply\n", "breaks off in its header"),
        ("a.ply", stl(CUP), "is no PLY file"),
        ("a.ply", ply(CUP).replace(b"ascii 1.0", b"ebcdic 1.0"), "of a kind of PLY"),
        ("a.ply", ply(CUP).replace(b"element face ", b"element face -"), "header that cannot be read"),
        ("a.dae", stl(CUP), "is no mesh that xei reads"),
        ("a", stl(CUP), "is no mesh that xei reads"),
    ],
)
def test_what_is_no_mesh_says_why(name, data, said):
    found = read_mesh(data, name)
    assert isinstance(found, str)
    assert said in found


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.xyz", b"", "is empty"),
        ("a.xyz", b"1 2\n", "has 2 numbers in line 1"),
        ("a.xyz", b"1 2 3\n4 5 6\n7 8\n", "has 2 numbers in line 3, expected 3"),
        ("a.xyz", b"a b c\n", "is no XYZ file"),
        ("a.xyz", b"\xff\xfe", "it is not text"),
        ("a.xyz", b"0 0 0\n1 0 0\n0 1 0\n", "3 points"),
        ("a.xyz", b"0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n", "is flat"),
        ("a.xyz", b"1 2 3\n" * 50, "is flat"),
        ("a.pcd", b"VERSION 0.7\n", "is no PCD file"),
        ("a.pcd", pcd(CUP[0]).replace(b"DATA ascii", b"DATA binary_compressed"), "is compressed"),
        ("a.pcd", pcd(CUP[0], "binary").replace(b"TYPE U", b"TYPE Q"), "a field of type Q"),
        ("a.pcd", pcd(CUP[0], "binary").replace(b"POINTS 3", b"POINTS 300"), "is cut"),
        ("a.pcd", pcd(CUP[0], "binary").replace(b"COUNT 1", b"COUNT 0"), "a `COUNT` that is none"),
        ("a.pcd", pcd(CUP[0]).replace(b"POINTS 3", b"POINTS 4"), "is cut or damaged"),
        ("a.las", b"LASF", "is no point cloud that xei reads"),
    ],
)
def test_what_is_no_point_cloud_says_why(name, data, said):
    found = read_cloud(data, name)
    assert isinstance(found, str)
    assert said in found


def test_vertices_that_are_no_numbers():
    data = bytearray(stl(CUP))
    data[84 + 12 : 84 + 16] = struct.pack("<f", float("nan"))
    assert "points that are no numbers" in read_mesh(bytes(data), "a.stl")
    assert "beyond any size" in read_mesh(stl(np.array(CUP) * 1e20), "a.stl")


def test_what_a_depth_camera_did_not_see_is_left_out():
    points = sampled(CUP, 100, seed=1)
    assert len(read_cloud(pcd([*points, (float("nan"),) * 3], "binary"), "a.pcd").points) == 100


@pytest.mark.parametrize("name", ["a.stl", "c.obj", "d.ply"])
def test_flat_meshes(name):
    flat = cylinder(40.0, 10.0) * (1, 1, 0)
    tilted = flat @ np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    for body in (flat, tilted, flat * 0 + 5.0):
        assert read_mesh(MESH_WRITERS[name](body), name) != ""
        assert isinstance(read_mesh(MESH_WRITERS[name](body), name), str)


def test_five_million_triangles_are_refused_before_they_are_read(monkeypatch):
    monkeypatch.setattr("xei_lang.profiles.assets.read_mesh._load", None)
    count, more = 5_000_000, structure.MAX_TRIANGLES + 1
    head = f"ply\nformat ascii 1.0\nelement vertex 9\nelement face {count}\nend_header\n".encode()
    for name, data, found in (
        ("a.stl", bytes(79) + b"x" + struct.pack("<I", count) + bytes(50 * count), count),
        ("a.obj", b"v 0 0 0\n" + b"f 1 2 3\n" * more, more),
        ("a.ply", head, count),
    ):
        assert read_mesh(data, name) == f"has {found} triangles, the limit is {structure.MAX_TRIANGLES}"
    assert "which is the limit" in read_cloud(b"0 0 0\n" * (structure.MAX_POINTS + 1), "a.xyz")
    assert "the limit is" in read_cloud(pcd(CUP[0]).replace(b"POINTS 3", b"POINTS 99999999"), "a.pcd")
    assert "the limit is" in read_cloud(head.replace(b"vertex 9", b"vertex 2999999"), "a.ply")


_SEEDS = [(name, make(box(30.0, 20.0, 10.0))) for name, make in MESH_WRITERS.items()]
_CLOUDS = [(name, make(sampled(CUP, 12, seed=1))) for name, make in CLOUD_WRITERS.items()]


@settings(max_examples=300)
@given(st.data())
def test_damaged_files_never_make_an_exception(data):
    reader, seeds = data.draw(st.sampled_from([(read_mesh, _SEEDS), (read_cloud, _CLOUDS)]))
    name, whole = data.draw(st.sampled_from(seeds))
    damaged = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(damaged)))
        width = data.draw(st.integers(0, 20))
        damaged[at : at + width] = data.draw(
            st.binary(max_size=8) | st.sampled_from([b"\n", b"-1", b"nan", b"1e9", b"f "])
        )
    found = reader(bytes(damaged), name)
    assert isinstance(found, str) or (len(found.points) >= 4 and np.isfinite(found.points).all())


@given(st.binary(max_size=300), st.sampled_from([*MESH_WRITERS, *CLOUD_WRITERS]))
def test_any_bytes_are_read_or_refused(data, name):
    for reader, start in itertools.product(
        (read_mesh, read_cloud), (b"", b"ply\n", b"solid facet\n", b"v 1 2 3\n")
    ):
        assert isinstance(reader(start + data, name), Points | str)


_RING = [(np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)) for k in range(6)]
_PRISM = "".join(f"v {x} {y} {z}\n" for z in (0, 2) for x, y in _RING)
_ENDS = ["6 5 4 3 2 1", "7 8 9 10 11 12"]
_SIDES = [f"{k} {k % 6 + 1} {k % 6 + 7} {k + 6}" for k in range(1, 7)]


@pytest.mark.parametrize(
    "faces",
    [
        "".join(f"f {face}\n" for face in (*_ENDS, *_SIDES)),
        "".join("f " + " ".join(str(int(i) - 13) for i in face.split()) + "\n" for face in (*_ENDS, *_SIDES)),
        "usemtl a\n" + "".join(f"f {face}\n" for face in _SIDES) + "usemtl b\nf " + "\nf ".join(_ENDS) + "\n",
        "g a\n" + "".join(f"f {face}\n" for face in _SIDES) + "o b\nf " + "\nf ".join(_ENDS) + "\n",
    ],
    ids=["polygons", "from the end", "materials", "groups"],
)
def test_polygons_indices_from_the_end_and_parts_of_an_obj(faces):
    found = read_mesh((_PRISM + faces).encode(), "prism.obj")
    assert found.is_closed
    np.testing.assert_allclose(bounds(found), [(-1, -np.sqrt(3) / 2, 0), (1, np.sqrt(3) / 2, 2)])


def test_thousands_of_parts_are_one_body_or_too_many():
    """Each would be a body of its own to the library, which takes minutes for that."""
    rows = "".join(f"g part_{n}\no body_{n}\nusemtl paint_{n}\n{row}" for n, row in enumerate(_triangles()))
    assert read_mesh((_PRISM + rows * 40).encode(), "prism.obj").points.shape == (12, 3)
    solid = stl_text(box(30.0, 20.0, 10.0))
    assert isinstance(read_mesh(solid * 20, "a.stl"), Points)
    many = read_mesh(solid * (structure.MAX_SOLIDS + 1), "a.stl")
    assert many == f"has more than {structure.MAX_SOLIDS} solids, which is the limit"


def _triangles():
    for n in range(200):
        yield f"f {n % 6 + 1} {(n + 1) % 6 + 1} {n % 6 + 7}\n"


def test_a_header_that_tells_of_anything_in_billions_is_refused():
    data = ply(CUP).replace(b"element face", b"element fringe 99999999999\nelement face")
    assert "99999999999 of `fringe`" in read_mesh(data, "a.ply")
    assert "99999999999 of `fringe`" in read_cloud(data, "a.ply")
