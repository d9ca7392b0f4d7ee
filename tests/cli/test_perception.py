"""`xei perception detect`: images to poses and verdicts, bad files to diagnostics."""

from __future__ import annotations

import json
import re
from pathlib import Path

import cv2
import jsonschema
import numpy as np
import pytest

from tests.cli.pictures import image_of_the_table
from tests.cli.xei import PROFILES, ROOT, xei
from tests.world.perception.two_cameras import write_two_cameras
from xei_lang.ir.geometry import Pose

SCHEMA = ROOT / "xei_lang" / "world" / "perception" / "tags.schema.json"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    return tmp_path


def test_the_table_is_found_where_it_stands(lab: Path) -> None:
    image_of_the_table(lab / "bench.png")
    ran = xei("perception", "detect", "bench.png", cwd=lab)
    assert ran.code == 0, ran.err
    assert "within the tolerance of 3 mm and 0.5 deg, from bench_a" in ran.out
    assert "looking through `head`" in ran.err
    ran = xei("perception", "detect", "bench.png", "--format", "json", "--quiet", cwd=lab)
    found = json.loads(ran.out)
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(found)
    assert ran.err == ""
    (frame,) = found["frames"]
    assert frame["verdict"] == "within_tolerance"
    assert np.allclose(frame["T_base_frame"], frame["expected_T_base_frame"], atol=2e-3)
    assert [tag["id"] for tag in found["tags"]] == [4, 5, 6, 7]


def test_a_table_that_was_pushed_is_told_with_its_new_place(lab: Path) -> None:
    image_of_the_table(lab / "bench.png", Pose((0.02, -0.01, 0.0)))
    ran = xei("perception", "detect", "bench.png", "--format", "json", cwd=lab)
    assert ran.code == 1
    assert "error[XEI0683]: `table` stands 22." in ran.err
    (frame,) = json.loads(ran.out)["frames"]
    assert frame["verdict"] == "out_of_tolerance"
    assert np.allclose(np.array(frame["T_parent_frame"])[:3, 3], (0.52, -0.01, 0.75), atol=1e-3)
    written = re.search(r"position: \[(\S+) m, (\S+) m, (\S+) m\]", ran.err)
    assert written is not None
    assert np.allclose([float(value) for value in written.groups()], (0.52, -0.01, 0.75), atol=1e-3)


def test_tags_of_another_size_are_refused(lab: Path) -> None:
    image_of_the_table(lab / "bench.png", scale=0.9)
    ran = xei("perception", "detect", "bench.png", "--format", "json", cwd=lab)
    assert ran.code == 1
    assert "error[XEI0682]" in ran.err
    found = json.loads(ran.out)
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(found)
    assert found["frames"][0]["refused"]["reason"] == "wrong_tag_size"


@pytest.mark.parametrize(
    ("name", "content", "code", "said"),
    [
        ("absent.png", None, 2, "XEI0101"),
        ("empty.png", b"", 1, "XEI0680"),
        ("text.png", b"not an image", 1, "XEI0680"),
        ("cut.png", "cut", 1, "XEI0680"),
        ("blank.png", np.zeros((720, 1280), np.uint8), 1, "XEI0680"),
        ("small.png", np.zeros((48, 64), np.uint8), 1, "XEI0680"),
        ("noise.png", np.random.default_rng(1).integers(0, 255, (720, 1280), np.uint8), 1, "XEI0681"),
    ],
)
def test_bad_images_are_diagnostics(lab: Path, name: str, content, code: int, said: str) -> None:
    if isinstance(content, np.ndarray):
        cv2.imwrite(str(lab / name), content)
    elif content == "cut":
        whole = image_of_the_table(lab / "whole.png").read_bytes()
        (lab / name).write_bytes(whole[:60])
    elif content is not None:
        (lab / name).write_bytes(content)
    ran = xei("perception", "detect", name, cwd=lab)
    assert (ran.code, said in ran.err) == (code, True), ran.err


def test_a_folder_is_no_image(lab: Path) -> None:
    (lab / "folder").mkdir()
    assert xei("perception", "detect", "folder", cwd=lab).code == 2


def test_a_missing_library_is_told(lab: Path) -> None:
    (lab / "hidden").mkdir()
    (lab / "hidden" / "cv2.py").write_text(
        "raise ModuleNotFoundError(\"No module named 'cv2'\", name='cv2')\n", encoding="utf-8"
    )
    ran = xei("perception", "detect", "x.png", cwd=lab, env={"PYTHONPATH": f"{lab / 'hidden'}:{ROOT}"})
    assert ran.code == 1
    assert "error[XEI0688]: this needs `cv2`, which is not installed" in ran.err
    assert "pip install 'xei-lang[perception]'" in ran.err


def test_of_several_cameras_one_is_named(tmp_path: Path) -> None:
    write_two_cameras(tmp_path)
    image_of_the_table(tmp_path / "bench.png")
    ran = xei("perception", "detect", "bench.png", cwd=tmp_path)
    assert ran.code == 1
    assert "error[XEI0680]: `openarm_bench` has 2 cameras, and it is not said whose image this is" in ran.err
    assert "name one of `head`, `ceiling` with `--camera`" in ran.err
    ran = xei("perception", "detect", "bench.png", "--camera", "head", cwd=tmp_path)
    assert (ran.code, "looking through `head`" in ran.err) == (0, True), ran.err


def test_an_unknown_profile_is_told(lab: Path) -> None:
    ran = xei("perception", "detect", "x.png", "--profile", "openarm_bensh", cwd=lab)
    assert ran.code == 1
    assert "XEI0601" in ran.err
