"""The bench with a tube and a beaker whose sizes come from files, as somebody with scans would write it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.cli.xei import PROFILES, PROTOCOLS, xei
from tests.profiles.assets.bodies import beaker, cylinder, pcd, sampled, stl
from xei_lang.ir.forms.goals_json import to_json
from xei_lang.pipeline import ALL, Outcome, Request, compile_request
from xei_lang.syntax.reading import read_source

TUBE = "    shape: {cylinder: {diameter: 17 mm, height: 118 mm}}\n    mass: 6.5 g\n"
BEAKER = "    shape: {cylinder: {diameter: 70 mm, height: 95 mm}}\n    mass: 110 g\n"
FROM_MESH = (
    "    shape: {mesh: {file: assets/tube.stl, units: in, T_object_mesh: {position: [0 mm, 0 mm, 59 mm]}}}\n"
)
FROM_CLOUD = "    shape: {point_cloud: {file: assets/beaker.pcd, units: m}}\n"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """The bench, `tube_1` from a mesh in inches about its middle, and `beaker_1` from a noisy scan."""
    folder = tmp_path / "profiles" / "openarm_bench"
    shutil.copytree(PROFILES / "openarm_bench", folder, ignore=shutil.ignore_patterns("__pycache__"))
    usage = folder / "usage_profile.yaml"
    text = usage.read_text(encoding="utf-8")
    for old, shape in ((TUBE, FROM_MESH), (BEAKER, FROM_CLOUD)):
        assert old in text
        text = text.replace(old, shape + old.splitlines(keepends=True)[1], 1)
    usage.write_text(text, encoding="utf-8")
    (folder / "assets").mkdir()
    tube = (cylinder(17.0, 118.0, 64) - np.array((0.0, 0.0, 59.0))) / 25.4
    (folder / "assets" / "tube.stl").write_bytes(stl(tube))
    scan = sampled(beaker(70.0, 95.0, 2.0), 8000, seed=5)
    scan += np.random.default_rng(6).normal(0.0, 0.2, scan.shape)
    (folder / "assets" / "beaker.pcd").write_bytes(pcd(scan / 1000.0, "binary"))
    return folder


def lowered(profile: Path) -> Outcome:
    source, said = read_source(PROTOCOLS / "put_on_rack.xei", "put_on_rack.xei")
    assert source is not None, said
    passes = ALL[: [step.adds for step in ALL].index("graph") + 1]
    return compile_request(Request(source, profile_folder=profile), passes)


def test_goals_are_those_of_the_stated_size_and_say_where_it_comes_from(lab: Path) -> None:
    computed, stated = lowered(lab).made.graph, lowered(PROFILES / "openarm_bench").made.graph
    assert computed is not None
    assert stated is not None
    goals, wanted = _without_spans(to_json(computed)["goals"]), _without_spans(to_json(stated)["goals"])
    origin = ", computed from mesh assets/tube.stl in inches, as a cylinder around it"
    assert str(goals).count(f"width of the object between the jaws{origin}") == 1
    assert str(goals).replace(origin, "") == str(wanted)


def _without_spans(value: object) -> object:
    if isinstance(value, dict):
        return {key: _without_spans(item) for key, item in value.items() if key != "span"}
    return [_without_spans(item) for item in value] if isinstance(value, list) else value


def test_the_world_shows_where_sizes_come_from(lab: Path, tmp_path: Path) -> None:
    ran = xei("world", "where", "beaker_1", "--profile", str(lab), cwd=tmp_path)
    assert ran.code == 0, ran.err
    said = "usage_profile, computed from point cloud assets/beaker.pcd in metres, as a cylinder around it"
    lines = [line.split(maxsplit=1) for line in ran.out.splitlines() if said in line]
    assert lines == [["size", said], ["geometry", said]]
    shown = xei("world", "show", "--profile", str(lab), "--format", "json", cwd=tmp_path)
    assert '"asset.point_cloud": "assets/beaker.pcd"' in shown.out
    doctor = xei("doctor", "--profile", str(lab), "--format", "json", cwd=tmp_path)
    items = {blocker["item"]: blocker["status"] for blocker in json.loads(doctor.out)["blockers"]}
    assert "objects.tube_1.assets.mesh" not in items
    assert items["objects.tube_1.assets.point_cloud"] == "missing"
