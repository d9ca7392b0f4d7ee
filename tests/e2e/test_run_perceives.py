"""`xei run --pose-service URL --perceived FILE`: a run that looks, with a service as a process."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, xei
from tests.world.perception.serving import process
from tests.world.perception.views import bench
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.geometry import Pose
from xei_lang.world.ground import ground
from xei_lang.world.perception.observe import ask_for
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.wire import request_json
from xei_lang.world.sources.identity import objects_sha256

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")

PROTOCOL = 'protocol look {\n  profile "openarm_bench"\n  look_at(target=rack_2)\n}\n'
AT = "frame: table, position: [{} mm, 135 mm, 0 mm], rpy: [0 deg, 0 deg, -90 deg]"
SCENE = f"  rack_2: {{{{{AT}, confidence: 1}}}}\n"
GONE = "http://127.0.0.1:1"
SECRET = "http://me:secret@127.0.0.1:1"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A protocol that looks at a rack; pictures and scenes of it, in its place and 25 mm beside."""
    here = tmp_path_factory.mktemp("bench")
    (here / "profiles").symlink_to(PROFILES)
    (here / "look.xei").write_text(PROTOCOL, encoding="utf-8")
    (here / "pose.token").write_text("a-long-enough-token\n", encoding="utf-8")
    lab = bench()
    world, said = ground(lab)
    assert world is not None, said
    head = f"version: 1\nprofile: openarm_bench\nobjects_sha256: {objects_sha256(lab)}\nobjects:\n"
    for name, push_m in (("there", 0.0), ("pushed", 0.025)):
        objects = tuple(
            replace(item, T_frame_object=Pose((push_m, 0.0, 0.0)) @ item.T_frame_object)
            if item.name == "rack_2"
            else item
            for item in world.objects
        )
        moved = replace(world, objects=objects)
        picture = mujoco_bench.take_picture(lab, moved, lab.calibration.cameras[0], stamp_ns=10**18)
        request = ask_for(picture, registry_of(lab), ("rack_2",), request_id="r1", session_id="s1")
        (here / f"{name}.json").write_text(dumps(request_json(request)), encoding="utf-8")
        (here / f"{name}.yaml").write_text(head + SCENE.format(120 + 1000 * push_m), encoding="utf-8")
    return here


def trace(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "trace.jsonl").read_text(encoding="utf-8").splitlines()]


def test_a_run_asks_the_service_and_goes_on_or_stops_by_what_it_sees(folder: Path) -> None:
    run = ("run", "look.xei", "--trace", "trace.jsonl", "--token-file", "pose.token")
    with process(folder, "--backend", "apriltag", "--token-file", "pose.token") as url:
        there = xei(*run, "--pose-service", url, "--perceived", "there.json", cwd=folder)
        kept = trace(folder)
        pushed = xei(*run, "--pose-service", url, "--perceived", "pushed.json", cwd=folder)
    assert there.code == 0, there.err
    (look,) = [
        line["representation"]["perception"] for line in kept if "perception" in line["representation"]
    ]
    assert look["source"] == f"pose_service {url}"
    assert look["grounded_by"] == {"table": "seen", "rack_2": "seen"}
    assert pushed.code == 3, pushed.err
    assert "error[XEI0941]: `rack_2` stands 25." in pushed.err
    assert "the object pose is to blame" in pushed.err
    assert "dry-run: failed at world_grounding after " in pushed.err
    end = trace(folder)[-1]
    assert (end["status"], end["failed_stage"]) == ("failed", "world_grounding")


def test_a_service_that_is_gone_stops_the_run_at_the_look(folder: Path) -> None:
    ran = xei("run", "look.xei", "--pose-service", GONE, "--perceived", "there.json", cwd=folder)
    assert ran.code == 3
    assert "error[XEI0690]: no pose service answers" in ran.err
    assert "dry-run: failed at world_grounding" in ran.err


def test_scene_files_are_sources_as_well(folder: Path) -> None:
    assert xei("run", "look.xei", "--perceived", "there.yaml", cwd=folder).code == 0
    ran = xei("run", "look.xei", "--perceived", "pushed.yaml", cwd=folder)
    assert ran.code == 3
    assert "error[XEI0941]: `rack_2` stands 25.0 mm" in ran.err


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("--pose-service", GONE), 2, "name one with `--perceived` for each look"),
        (("--perceived", "there.yaml") * 2, 1, "error[XEI0942]: the plan looks 1 time"),
        (("--perceived", "absent.yaml"), 2, "error[XEI0101]"),
        (("--pose-service", GONE, "--perceived", "there.yaml"), 1, "error[XEI0663]"),
        (("--pose-service", SECRET, "--perceived", "there.json"), 1, "error[XEI0663]"),
    ],
)  # fmt: skip
def test_what_cannot_be_asked_is_told_before_anything_runs(
    folder: Path, arguments: tuple[str, ...], code: int, said: str
) -> None:
    (folder / "trace.jsonl").unlink(missing_ok=True)
    ran = xei("run", "look.xei", "--trace", "trace.jsonl", *arguments, cwd=folder)
    assert (ran.code, said in ran.err) == (code, True), ran.err
    assert "secret" not in ran.err
    assert not (folder / "trace.jsonl").exists()
