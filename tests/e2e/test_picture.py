"""`--world http://... --picture FILE`: a service sees the bench, and that is the world."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, xei
from tests.world.perception.serving import process
from tests.world.perception.views import bench
from tests.world.sources.scenes import scene
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground
from xei_lang.world.perception.observe import ask_for
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.wire import request_json

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")

PUSHED = Pose((0.010, -0.006, 0.0))


@pytest.fixture(scope="module")
def lab() -> Profile:
    return bench()


@pytest.fixture(scope="module")
def folder(lab: Profile, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of the bench, with a picture of its second rack where it was pushed to."""
    world, said = ground(lab)
    assert world is not None, said
    objects = tuple(
        replace(item, T_frame_object=item.T_frame_object @ PUSHED) if item.name == "rack_2" else item
        for item in world.objects
    )
    truth = replace(world, objects=objects)
    picture = mujoco_bench.take_picture(lab, truth, lab.calibration.cameras[0], stamp_ns=10**18, seed=3)
    request = ask_for(picture, registry_of(lab), ("rack_1", "rack_2"), request_id="r1", session_id="s1")
    here = tmp_path_factory.mktemp("bench")
    (here / "profiles").symlink_to(PROFILES)
    (here / "picture.json").write_text(dumps(request_json(request)), encoding="utf-8")
    (here / "broken.json").write_text('{"request_id": 1}', encoding="utf-8")
    return here


def test_what_a_service_sees_in_a_picture_is_the_world(lab: Profile, folder: Path) -> None:
    with process(folder, "--backend", "apriltag") as url:
        shown = xei(
            "world", "show", "--format", "json", "--world", url, "--picture", "picture.json", cwd=folder
        )
        broken = xei("world", "show", "--world", url, "--picture", "broken.json", cwd=folder)
    assert shown.code == 0, shown.err
    world = json.loads(shown.out)
    assert world["sources"][-1] == f"pose_service {url}"
    (rack,) = [item for item in world["objects"] if item["name"] == "rack_2"]
    assert rack["provenance"]["pose"] == f"pose_service {url}"
    prior = lab.object("rack_2")
    assert prior is not None and prior.prior is not None
    pushed = (prior.prior.T_frame_object @ PUSHED).position_m
    assert math.dist(rack["T_frame_object"]["position_m"], pushed) < 0.001
    assert broken.code == 1
    assert "`broken.json` is not of the form `pose_request`: " in broken.err


def test_a_picture_of_another_lab_is_not_sent(folder: Path) -> None:
    request = json.loads((folder / "picture.json").read_text(encoding="utf-8"))
    (folder / "other.json").write_text(json.dumps({**request, "output_frame": "nowhere"}), encoding="utf-8")
    ran = xei("world", "show", "--world", "http://127.0.0.1:1", "--picture", "other.json", cwd=folder)
    assert (ran.code, ran.out) == (1, "")
    assert "`other.json` is no picture of this lab: it wants poses in `nowhere`" in ran.err


def test_a_password_in_an_address_is_neither_used_nor_shown(folder: Path) -> None:
    url = "http://me:secret@127.0.0.1:1"
    ran = xei("world", "show", "--world", url, "--picture", "picture.json", cwd=folder)
    assert (ran.code, "error[XEI0663]" in ran.err, "secret" in ran.err) == (1, True, False)
    assert "`--token-file FILE`" in ran.err


def test_a_scene_file_and_a_service_are_asked_one_after_the_other(lab: Profile, folder: Path) -> None:
    (folder / "before.yaml").write_text(
        scene(
            "rack_2: {frame: table, position: [130 mm, 150 mm, 0 mm], confidence: 0.6}\n"
            "beaker_1: {absent: true}"
        ),
        encoding="utf-8",
    )
    with process(folder, "--backend", "apriltag") as url:
        shown = xei("world", "show", "--format", "json", "--world", "before.yaml", "--world", url,
                    "--picture", "picture.json", cwd=folder)  # fmt: skip
    assert shown.code == 0, shown.err
    world = json.loads(shown.out)
    assert world["sources"][2:] == ["scene_file before.yaml", f"pose_service {url}"]
    (rack,) = [item for item in world["objects"] if item["name"] == "rack_2"]
    assert rack["provenance"]["pose"] == f"pose_service {url}"
    assert "beaker_1" not in {item["name"] for item in world["objects"]}


def test_a_service_that_is_gone_is_not_replaced_by_priors(folder: Path) -> None:
    ran = xei("world", "show", "--world", "http://127.0.0.1:1", "--picture", "picture.json", cwd=folder)
    assert (ran.code, ran.out) == (1, "")
    assert "error[XEI0690]" in ran.err
