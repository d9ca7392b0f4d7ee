"""Scene files: every fault at its place, and a world that is written reads back as it was."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import jsonschema
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.world.bench import bench, world
from tests.world.sources.scenes import at, free, grounded, read, scene, seen
from xei_lang.diagnostics import Source, has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.schema.scene_file import SceneFile
from xei_lang.world.ground import ground
from xei_lang.world.sources.scene_text import scene_text

ROOT = Path(__file__).parents[3]
SCHEMA = ROOT / "xei_lang" / "world" / "sources" / "scene_file.schema.json"


def test_the_schema_is_the_models(update_golden):
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **SceneFile.model_json_schema()}
    text = json.dumps(schema, indent=2) + "\n"
    if update_golden:
        SCHEMA.write_text(text, encoding="utf-8")
    assert SCHEMA.read_text(encoding="utf-8") == text
    jsonschema.Draft202012Validator(schema).validate(yaml.safe_load(scene_text(world(), bench())))


def test_faults_are_told_where_they_stand(markdown):
    def produce(objects: str) -> str:
        whole = "version:" in objects
        text = objects if whole else scene(objects.rstrip("\n"))
        observed, said = read(text)
        if observed is not None:
            _, said = ground(bench(), (observed,))
        return render_full(said, {"scene.yaml": Source("scene.yaml", text)}, color=False)

    markdown(Path(__file__).with_name("scene_faults.md"), produce)


@pytest.mark.parametrize(
    "pose",
    [
        "position: [300 mm, 50 mm, 0 mm], rpy: [0 deg, 0 deg, 90 deg]",
        "position: [0.3 m, 0.05 m, 0 m], quaternion: [0, 0, 0.70711, 0.70711]",
        "matrix: [[0, -1, 0, 0.3], [1, 0, 0, 0.05], [0, 0, 1, 0], [0, 0, 0, 1]]",
    ],
)
def test_a_pose_can_be_written_in_three_ways(pose):
    observed, said = read(scene(f"wipe_1: {{frame: table, {pose}, confidence: 1}}"))
    assert observed is not None, said
    (one,) = observed.items
    assert one.T_frame_object is not None
    assert one.T_frame_object.position_m == pytest.approx((0.3, 0.05, 0.0))
    assert one.T_frame_object.quaternion == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))


def test_json_is_read_as_well():
    document = yaml.safe_load(scene_text(world(), bench()))
    from_json, _ = read(json.dumps(document, indent=2))
    from_yaml, _ = read(scene_text(world(), bench()))
    assert from_json is not None
    assert from_yaml is not None
    assert [(item.name, item.T_frame_object) for item in from_json.items] == [
        (item.name, item.T_frame_object) for item in from_yaml.items
    ]


def same_place(first: World, second: World) -> None:
    assert [item.name for item in first.objects] == [item.name for item in second.objects]
    for a, b in zip(first.objects, second.objects, strict=True):
        assert (a.place, a.frame_id, a.states, a.confidence) == (b.place, b.frame_id, b.states, b.confidence)
        assert a.T_frame_object.position_m == pytest.approx(b.T_frame_object.position_m, abs=1e-9)
        turn = a.T_frame_object.inverse() @ b.T_frame_object
        assert turn.quaternion[3] == pytest.approx(1.0, abs=1e-12)


shift = st.floats(-0.015, 0.015)


@given(shift, shift, st.floats(-0.05, 0.05), st.sampled_from(["open", "closed"]), st.booleans())
@settings(max_examples=25, deadline=None)
def test_a_world_that_is_written_reads_back_as_it_was(dx, dy, yaw, cap, is_gone):
    text = scene(
        f"rack_1: {{frame: table, position: [{0.13 + dx:.6f} m, {-0.135 + dy:.6f} m, 0.001 m], "
        f"rpy: [0 deg, 0 deg, {-90 + math.degrees(yaw):.6f} deg], confidence: 0.9}}\n"
        f"tube_1: {{states: {{cap: {cap}}}}}" + ("\nbeaker_1: {absent: true}" if is_gone else "")
    )
    observed, said = read(text)
    assert observed is not None, said
    first = grounded(observed)
    again, said = read(scene_text(first, bench()))
    assert again is not None, said
    same_place(first, grounded(again))


@given(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-0.3, 0.3), st.floats(-3.0, 3.0))
@settings(max_examples=25, deadline=None)
def test_a_rigid_motion_of_the_table_moves_all_that_is_on_it(dx, dy, dz, yaw):
    """What is told in the frame of the table, and what stands in such things, goes with the table."""
    import dataclasses

    T_world_motion = Pose.from_rpy((dx, dy, dz), (0.0, 0.0, yaw))
    frames = tuple(
        dataclasses.replace(frame, T_parent_frame=T_world_motion @ frame.T_parent_frame)
        if frame.parent == "world" and frame.name == "table"
        else frame
        for frame in bench().calibration.frames
    )
    calibration = dataclasses.replace(
        bench().calibration, frames=frames, workspace_bounds_m=((-9.0, -9.0, -9.0), (9.0, 9.0, 9.0))
    )
    moved = dataclasses.replace(bench(), calibration=calibration)
    observed = seen(at("rack_1", 0.13, -0.135, 0.003, yaw=-1.55), free("tube_6"))
    before = grounded(observed)
    after, _ = ground(moved, (observed,))
    assert after is not None
    on_table = [item.name for item in before.objects if item.frame_id == "table"]
    assert {"rack_1", "rack_2", "tube_1", "tube_6", "table"} <= set(on_table)
    for name in on_table:
        expected = T_world_motion @ before.T_world_object(name)
        actual = after.T_world_object(name)
        assert actual.position_m == pytest.approx(expected.position_m, abs=1e-9)
        assert abs((expected.inverse() @ actual).quaternion[3]) == pytest.approx(1.0, abs=1e-12)


PIECES = [
    "null", "-1", "1e999", "1e400 m", "0 mm", "200 m", "[]", "{}", "true", '""', "'a b'", ".inf", "[1, 2, 3]",
    "&a 1", "*a", "!!float 1", "9" * 400, "0.1 m", "table", "world", "rack_1", "tube_1", "\x00", "é",
]  # fmt: skip


SOUND = """rack_1: {frame: table, position: [120 mm, -135 mm, 0 m], rpy: [0 rad, 0 rad, 0 rad], confidence: 1}
tube_1: {frame: world, position: [0.56 m, -0.045 m, 0.755 m], quaternion: [0, 0, 0, 1], confidence: 1}
wipe_1: {frame: table, matrix: [[1, 0, 0, 0.08], [0, 1, 0, 0.44], [0, 0, 1, 0], [0, 0, 0, 1]], confidence: 1}
tube_2: {states: {cap: open}, size: [17 mm, 17 mm, 118 mm], stamp: 2026-11-02T10:15:00Z}
beaker_1: {absent: true}"""


@given(st.data())
@settings(max_examples=150, deadline=None)
def test_no_scene_file_is_too_broken_for_a_diagnostic(data):
    """Values of a sound file exchanged for others, characters dropped: a world, or errors, never a bug."""
    words = scene_words()
    for _ in range(data.draw(st.integers(1, 4))):
        index = data.draw(st.integers(0, len(words) - 1))
        words[index] = data.draw(st.sampled_from([*PIECES, words[index][1:], words[index] + words[index]]))
    observed, said = read("".join(words))
    if observed is None:
        assert has_errors(said)
        return
    found, said = ground(bench(), (observed,))
    assert (found is None) == has_errors(said)


def scene_words() -> list[str]:
    text = scene(SOUND)
    return re.findall(r"[\w.\-]+(?: mm| m| deg)?|\W", text)


@pytest.mark.parametrize(
    "numbers",
    [
        {0: -1e-4},
        {35: -0.01},
        {1: 0.5},
    ],
)
def test_a_covariance_is_symmetric_and_has_no_negative_variance(numbers):
    values = [numbers.get(index, 0.0) for index in range(36)]
    line = "beaker_1: {frame: table, position: [80 mm, -330 mm, 0 mm], confidence: 1, covariance: COVARIANCE}"
    observed, said = read(scene(line.replace("COVARIANCE", str(values))))
    assert observed is None
    assert [one.code for one in said] == ["XEI0652"]
    assert "variances of zero or above" in f"{said[0].message} {said[0].label}"
