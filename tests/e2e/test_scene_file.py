"""A rack that stands elsewhere than its prior says: a scene file moves it, and the tube ends in its slot."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, PROTOCOLS, xei
from tests.world.bench import bench, world
from tests.world.sources.scenes import read, scene
from xei_lang.ir.goals import Detach
from xei_lang.pipeline import ALL, Outcome, Request, compile_request
from xei_lang.profiles.grid import T_object_standing
from xei_lang.syntax.reading import read_source

MOVED = (
    "rack_2: {frame: table, position: [120 mm, 155 mm, 1 mm], "
    "rpy: [0 deg, 0.4 deg, -90 deg], confidence: 0.95}"
)
ELSEWHERE = f"""{MOVED}
tube_1: {{frame: table, position: [178 mm, -163 mm, 9 mm], confidence: 0.9, states: {{cap: open}}}}"""


@cache
def compiled(objects: str, last: str) -> Outcome:
    source, said = read_source(PROTOCOLS / "put_on_rack.xei", "put_on_rack.xei")
    assert source is not None, said
    observed, said = read(scene(objects))
    assert observed is not None, said
    passes = ALL[: [step.name for step in ALL].index(last) + 1]
    return compile_request(
        Request(source, profile_folder=PROFILES / "openarm_bench", observed=(observed,)), passes
    )


def test_the_tube_ends_in_the_slot_where_it_was_seen_to_be():
    outcome = compiled(MOVED, "verify")
    made = outcome.made
    assert outcome.stopped_at is None, outcome.diagnostics
    assert made.verified is not None
    assert made.world is not None
    assert made.graph is not None
    rack = bench().object("rack_2")
    assert rack is not None
    T_rack_floor = T_object_standing(rack, "slot", "A1")
    assert T_rack_floor is not None
    before, after = world().T_world_object("rack_2"), made.world.T_world_object("rack_2")
    assert math.dist(before.position_m, after.position_m) == pytest.approx(0.020)
    (released,) = [goal for goal in made.graph.goals if isinstance(goal.action, Detach)]
    assert isinstance(released.action, Detach)
    T_world_base = made.graph.epochs[released.epoch].T_world_base
    left = (T_world_base @ released.action.T_base_object).position_m
    assert left == pytest.approx((after @ T_rack_floor).position_m, abs=1e-6)
    assert math.dist(left, (before @ T_rack_floor).position_m) == pytest.approx(0.020)


def test_what_was_seen_is_what_the_plan_begins_with():
    outcome = compiled(ELSEWHERE, "lower")
    plan, found = outcome.made.plan, outcome.made.world
    assert outcome.stopped_at is None, outcome.diagnostics
    assert plan is not None
    assert found is not None
    tube = found.find("tube_1")
    assert tube is not None
    assert tube.place == 'rack_1.slot("C3")'
    facts = {(fact.variable, fact.subject): str(fact.value) for fact in plan.initial_state}
    assert facts["cap", "tube_1"] == "open"
    assert "C3" in facts["at", "tube_1"]


def test_a_bundle_and_a_run_keep_what_was_seen(tmp_path: Path):
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "monday.yaml").write_text(scene(MOVED), encoding="utf-8")
    protocol = str(PROTOCOLS / "put_on_rack.xei")
    made = xei("compile", protocol, "-o", "bundle", "--world", "monday.yaml", cwd=tmp_path)
    assert made.code == 0, made.err
    assert "seen by scene_file monday.yaml" in made.err
    manifest = json.loads((tmp_path / "bundle" / "manifest.json").read_text(encoding="utf-8"))
    assert "world/scene_file/monday.yaml" in manifest["inputs"]
    bodies = json.loads((tmp_path / "bundle" / "scene.json").read_text(encoding="utf-8"))["bodies"]
    (rack,) = [body for body in bodies if body["name"] == "rack_2"]
    x, y, z = world().T_world_object("rack_2").position_m
    assert rack["T_world_object"]["position_m"] == pytest.approx([x, y + 0.020, z])
    ran = xei("run", protocol, "--world", "monday.yaml", "--trace", "trace.jsonl", cwd=tmp_path)
    assert ran.code == 0, ran.err
    assert "scene_file monday.yaml" in (tmp_path / "trace.jsonl").read_text(encoding="utf-8")
