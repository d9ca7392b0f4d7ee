"""Objects whose files are named: the size that they get, and what is said of files that are wrong."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.profiles.assets.bodies import ball, beaker, box, cylinder, ply_points, sampled, stl
from tests.profiles.changed import changed_profile
from xei_lang.diagnostics import has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.doctor import deployment_blockers
from xei_lang.ir.geometry import Box, Cylinder, Pose, Sphere
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.sources import folder_sources
from xei_lang.world.ground import ground
from xei_lang.world.perception.registry import registry_of

SHAPE = "    shape: {cylinder: {diameter: 60 mm, height: 80 mm}}"
CUP = beaker(60.0, 80.0, 2.0)
NOT_CLOSED = CUP[:-1]
HALF = CUP[: len(CUP) // 2]
_NAN = bytearray(stl(CUP))
_NAN[96:100] = b"\xff\xff\xff\xff"
FILES = {
    "cup.stl": stl(CUP),
    "cup_in_metres.stl": stl(CUP / 1000.0),
    "tube.stl": stl(cylinder(17.0, 118.0)),
    "wide.stl": stl(beaker(66.0, 80.0, 2.0)),
    "high.stl": stl(CUP - np.array((0.0, 0.0, 40.0))),
    "aside.stl": stl(CUP + np.array((100.0, 0.0, 0.0))),
    "y_up.stl": stl(CUP @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])),
    "flat.stl": stl(CUP * (1, 1, 0)),
    "nan.stl": bytes(_NAN),
    "open.stl": stl(NOT_CLOSED),
    "cut.stl": stl(CUP)[:-1000],
    "empty.stl": b"",
    "text.stl": b"This is where the mesh will be.\n" * 9,
    "cup.step": b"ISO-10303-21;\n",
    "cup.ply": ply_points(sampled(CUP, 6000, seed=4)),
}


def lab_with(folder, cup, **files):
    """The small profile in which `cup` stands for the lines of the cup's shape, with the named files."""
    lab = changed_profile(folder, f"usage_profile.yaml\n- {SHAPE}\n+ {cup}")
    (lab / "assets").mkdir()
    for name, data in (files or FILES).items():
        (lab / "assets" / name).write_bytes(data)
    return lab


def loaded(lab, cache=None):
    profile, said = load_profile(lab, cache)
    assert profile is not None, render_full(said, folder_sources(lab))
    return profile, said


def cup_of(lab):
    return loaded(lab)[0].object("cup")


def test_every_wrong_file_is_told_with_its_place(markdown, tmp_path, monkeypatch):
    count = itertools.count()

    def produce(cup):
        place = tmp_path / str(next(count))
        place.mkdir()
        monkeypatch.chdir(place)
        lab = lab_with(place, cup.rstrip("\n").replace("\n", "\\n"))
        profile, said = load_profile(lab, None)
        assert (profile is None) == has_errors(said)
        told = render_full(said, folder_sources(lab))
        found = profile.object("cup") if profile else None
        return told + (f"size {found.size_m}, {found.computed_from or 'stated'}\n" if found else "")

    markdown(Path(__file__).parent / "files.md", produce)


@pytest.mark.parametrize(
    ("body", "shape"),
    [
        (cylinder(17.0, 118.0), Cylinder(0.0085, 0.118)),
        (beaker(60.0, 80.0, 2.0), Cylinder(0.03, 0.08)),
        (box(127.0, 85.0, 14.0), Box((0.127, 0.085, 0.014))),
        (ball(40.0), Sphere(0.02)),
    ],
)
def test_the_shape_that_fits_best_is_taken_and_stands_on_the_frame(tmp_path, body, shape):
    cup = cup_of(
        lab_with(tmp_path, "    shape: {mesh: {file: assets/a.stl, units: mm}}", **{"a.stl": stl(body)})
    )
    assert cup.shape == shape
    (part,) = cup.geometry
    assert part.shape == shape
    assert part.T_object_shape == Pose((0.0, 0.0, cup.size_m[2] / 2))
    assert cup.models[0].T_object_file == Pose()


def test_stated_collision_primitives_stay(tmp_path):
    cup = cup_of(
        lab_with(
            tmp_path,
            "    shape: {mesh: {file: assets/cup.stl, units: mm}}\\n"
            "    collision: [{box: [60 mm, 60 mm, 80 mm], position: [0 mm, 0 mm, 40 mm]}]",
        )
    )
    assert [part.shape for part in cup.geometry] == [Box((0.06, 0.06, 0.08))]
    assert cup.size_m == (0.06, 0.06, 0.08)


def test_the_computed_size_is_used_by_other_checks_of_the_profile(tmp_path):
    lab = lab_with(
        tmp_path,
        "    shape: {mesh: {file: assets/cup.stl, units: mm}}\\n"
        "    liquid: {capacity: 200 mL, dead_volume: 1 mL, inner_diameter: 61 mm}",
    )
    assert {found.code for found in load_profile(lab, None)[1]} == {"XEI0640"}


def test_elements_are_held_against_the_face_of_a_computed_size(tmp_path):
    lab = lab_with(
        tmp_path,
        "    shape: {mesh: {file: assets/cup.stl, units: mm, as: box}}\\n"
        "    elements: {start: {center: [55 mm, 40 mm], size: [15 mm, 10 mm]}}",
    )
    (found,) = load_profile(lab, None)[1]
    assert (found.code, found.label) == ("XEI0640", "47.5 mm .. 62.5 mm to the right, 35 mm .. 45 mm up")


def test_the_world_says_what_a_size_was_computed_from(tmp_path):
    profile, _ = loaded(lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}"))
    world, _ = ground(profile)
    said = dict(world.find("cup").provenance)
    source = "usage_profile, computed from mesh assets/cup.stl in millimetres, as a cylinder around it"
    assert said["size"] == said["geometry"] == source
    assert said["roles"] == "usage_profile"
    assert dict(world.find("tube_a").provenance)["size"] == "usage_profile"


def test_the_registry_names_a_mesh_by_its_files_hash_and_unit(tmp_path):
    profile, _ = loaded(lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}"))
    mesh = registry_of(profile).find("cup").mesh
    assert (mesh.sha256, mesh.units, mesh.size_m) == (
        dict(profile.files)["assets/cup.stl"], "mm", (0.06, 0.06, 0.08)
    )  # fmt: skip
    assert registry_of(profile).find("tube_a").mesh.units == "m"


def test_doctor_asks_for_what_is_not_there(tmp_path):
    cup = (
        f"{SHAPE}\\n    assets: {{mesh: {{file: assets/cup.stl, units: mm}}, point_cloud: assets/later.xyz}}"
    )
    profile, said = loaded(lab_with(tmp_path, cup))
    assert [found.code for found in said] == ["XEI0672"]
    items = {blocker.item: blocker.measure for blocker in deployment_blockers(profile)}
    assert "objects.cup.assets.mesh" not in items
    assert items["objects.cup.assets.point_cloud"].endswith("there is no `assets/later.xyz`")
    assert "STL, OBJ or PLY) with its unit" in items["objects.tube_a.assets.mesh"]


def test_a_compiled_profile_knows_its_files(tmp_path, monkeypatch):
    cup = "    shape: {mesh: {file: assets/cup.stl, units: mm}}"
    lab, cache = lab_with(tmp_path, cup, **{"cup.stl": stl(CUP)}), tmp_path / "cache"
    built, _ = loaded(lab, cache)
    with monkeypatch.context() as patched:
        patched.setattr("xei_lang.profiles.build.build_profile", None)
        assert loaded(lab, cache)[0].object("cup") == built.object("cup")
    (lab / "assets" / "cup.stl").write_bytes(stl(CUP * 1.5))
    assert loaded(lab, cache)[0].object("cup").size_m == (0.09, 0.09, 0.12)
    (lab / "assets" / "cup.stl").unlink()
    profile, (found,) = load_profile(lab, cache)
    assert profile is None
    assert (found.code, found.message) == ("XEI0602", "the profile has no `assets/cup.stl`")
    (lab / "assets" / "cup.stl").write_bytes(stl(CUP))
    with monkeypatch.context() as patched:
        patched.setattr("xei_lang.profiles.build.build_profile", None)
        assert loaded(lab, cache)[0].object("cup").size_m == (0.06, 0.06, 0.08)


def test_an_unchanged_profile_with_a_mesh_imports_nothing_heavy(tmp_path):
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}")
    program = (
        "import sys; from pathlib import Path; from xei_lang.profiles.load import load_profile\n"
        f"profile, _ = load_profile(Path({str(lab)!r}), Path({str(tmp_path / 'cache')!r}))\n"
        "print(profile.object('cup').size_m, *[m for m in ('trimesh', 'numpy', 'scipy') if m in sys.modules])"
    )
    runs = [
        subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
        for _ in range(2)
    ]
    assert runs == ["(0.06, 0.06, 0.08) trimesh numpy scipy\n", "(0.06, 0.06, 0.08)\n"]


def test_a_profile_that_names_no_file_needs_no_library(tmp_path):
    lab = changed_profile(tmp_path, "usage_profile.yaml")
    program = (
        "import sys; from pathlib import Path; from xei_lang.profiles.load import load_profile\n"
        f"assert load_profile(Path({str(lab)!r}), None)[0]; assert 'trimesh' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_without_the_library_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)
    monkeypatch.delitem(sys.modules, "xei_lang.profiles.assets.read_mesh", raising=False)
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}")
    profile, (found,) = load_profile(lab, tmp_path / "cache")
    assert profile is None
    assert (found.code, found.help) == ("XEI0688", ("pip install 'xei-lang[meshes]'",))


def test_a_link_inside_of_the_profile_is_followed_and_one_that_leads_out_is_not(tmp_path):
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/link.stl, units: mm}}")
    link = lab / "assets" / "link.stl"
    link.symlink_to("cup.stl")
    assert cup_of(lab).size_m == (0.06, 0.06, 0.08)
    for target, said in (
        (tmp_path / "out.stl", "`assets/link.stl` is a link that leads out of the profile's folder"),
        (lab / "assets" / "gone.stl", "`assets/link.stl` is a link to nothing"),
        (lab / "assets", "`assets/link.stl` is no file"),
    ):
        (tmp_path / "out.stl").write_bytes(stl(CUP))
        link.unlink()
        link.symlink_to(target)
        assert [(found.code, found.message) for found in load_profile(lab, None)[1]] == [("XEI0602", said)]


def test_a_pipe_is_not_waited_for(tmp_path):
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/pipe.stl, units: mm}}")
    os.mkfifo(lab / "assets" / "pipe.stl")
    assert [found.message for found in load_profile(lab, None)[1]] == ["`assets/pipe.stl` is no file"]


@pytest.mark.parametrize("path", ["assets/./cup.stl", "assets//cup.stl", "assets/.cup.stl"])
def test_a_file_that_is_in_no_cache_key_is_not_read(tmp_path, path):
    lab = lab_with(tmp_path, f"    shape: {{mesh: {{file: {path}, units: mm}}}}")
    (lab / "assets" / ".cup.stl").write_bytes(stl(CUP))
    (found,) = load_profile(lab, None)[1]
    assert found.message == f"`{path}` is hidden, or is no plain path"


def test_a_file_over_the_limit_is_not_read(tmp_path, monkeypatch):
    monkeypatch.setattr("xei_lang.profiles.assets.locate.MAX_ASSET_BYTES", 1000)
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}")
    (found,) = load_profile(lab, None)[1]
    assert re.search(r"has \d+ MB, the limit is", found.message)


def test_a_file_that_changes_while_it_is_read_is_not_believed(tmp_path):
    from xei_lang.diagnostics import Span
    from xei_lang.profiles.assets.locate import read_asset
    from xei_lang.profiles.files import read_folder

    lab = lab_with(tmp_path, SHAPE)
    files = read_folder(lab)
    place = Span("lab/usage_profile.yaml", 0, 1)
    assert read_asset(files, "assets/cup.stl", place) == FILES["cup.stl"]
    (lab / "assets" / "cup.stl").write_bytes(b"something else")
    assert read_asset(files, "assets/cup.stl", place).message == "`assets/cup.stl` changed while it was read"


def test_a_file_that_several_objects_name_is_read_once(tmp_path, monkeypatch):
    from xei_lang.profiles.assets import read_mesh

    calls = []
    whole = read_mesh.read_mesh
    monkeypatch.setattr(read_mesh, "read_mesh", lambda *given: calls.append(given) or whole(*given))
    lab = lab_with(tmp_path, "    shape: {mesh: {file: assets/cup.stl, units: mm}}")
    usage = lab / "usage_profile.yaml"
    jug = """  jug:
    roles: [movable]
    shape: {mesh: {file: assets/cup.stl, units: mm}}
    prior: {frame: table, position: [0.5 m, -0.3 m, 0 m], confidence: 0.5}
liquids:"""
    text = usage.read_text(encoding="utf-8")
    usage.write_text(text.replace("liquids:", jug), encoding="utf-8")
    profile, _ = loaded(lab)
    assert profile.object("jug").size_m == profile.object("cup").size_m
    assert len(calls) == 1
