from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.runtime.small import handoffs, profile
from xei_lang.doctor import deployment_blockers
from xei_lang.doctor.forms import blocker_json
from xei_lang.export.bundle import Content, read_bundle, write_bundle
from xei_lang.export.manifest import Manifest
from xei_lang.export.rosbag import write_rosbag
from xei_lang.export.scene import to_json as scene_json
from xei_lang.ir.forms.canonical import dumps

MANIFEST = Manifest(
    protocol="small",
    profile="openarm_bench",
    xei_version="0.1.0",
    inputs={"protocols/small.xei": "1" * 64, "profiles/openarm_bench/usage_profile.yaml": "2" * 64},
    seed=7,
    tools={"rosbags": "0.11.9"},
    blockers=deployment_blockers(profile()),
)


def contents() -> dict[str, Content]:
    given = handoffs()
    return {
        "plan.json": b'{"version": 1}\n',
        "scene.json": dumps(scene_json(given.world, given.graph)).encode(),
        "robot.urdf": given.urdf.encode(),
        "rosbag": lambda path: write_rosbag(path, given.timed, '{"version": 1}\n'),
    }


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def small(text: str) -> Mapping[str, Content]:
    return {"plan.json": text.encode()}


def test_a_bundle_reads_back_with_every_hash_verified(tmp_path: Path) -> None:
    target = tmp_path / "build" / "small"
    assert write_bundle(target, contents(), MANIFEST) == ()
    bundle, found = read_bundle(target)
    assert found == ()
    assert bundle is not None
    assert bundle.files["plan.json"] == b'{"version": 1}\n'
    assert sorted(bundle.files) == [
        "plan.json",
        "robot.urdf",
        "rosbag/metadata.yaml",
        "rosbag/rosbag.mcap",
        "scene.json",
    ]
    assert os.listdir(target.parent) == ["small"]


def test_two_bundles_are_the_same_bytes_wherever_they_stand(tmp_path: Path) -> None:
    for name in ("one/small", "two/elsewhere"):
        assert write_bundle(tmp_path / name, contents(), MANIFEST) == ()
    one, two = tree(tmp_path / "one/small"), tree(tmp_path / "two/elsewhere")
    assert one == two
    assert str(tmp_path).encode() not in b"".join(one.values())


def test_the_manifest_says_what_went_in_and_what_blocks(tmp_path: Path) -> None:
    write_bundle(tmp_path / "small", small("{}\n"), MANIFEST)
    assert json.loads((tmp_path / "small/manifest.json").read_text()) == {
        "format": "xei-bundle",
        "version": 1,
        "xei_version": "0.1.0",
        "protocol": "small",
        "profile": "openarm_bench",
        "seed": 7,
        "tools": {"rosbags": "0.11.9"},
        "inputs": {"profiles/openarm_bench/usage_profile.yaml": "2" * 64, "protocols/small.xei": "1" * 64},
        "readiness": [
            {"stage": "simulate", "ready": False, "blockers": 1, "by_representation": {"usage_profile": 1}},
            {
                "stage": "strict",
                "ready": False,
                "blockers": 2,
                "by_representation": {"calibration_profile": 1, "usage_profile": 1},
            },
            {
                "stage": "hardware",
                "ready": False,
                "blockers": 8,
                "by_representation": {"calibration_profile": 5, "usage_profile": 3},
            },
        ],
        "blockers": [blocker_json(blocker) for blocker in deployment_blockers(profile())],
        "files": {"plan.json": "ca3d163bab055381827226140568f3bef7eaac187cebd76878e0b63e9e442356"},
    }


def test_an_older_bundle_is_replaced_as_a_whole(tmp_path: Path) -> None:
    target = tmp_path / "small"
    write_bundle(target, {"old.json": b"1", "plan.json": b"1"}, MANIFEST)
    assert write_bundle(target, small("2"), MANIFEST) == ()
    assert sorted(tree(target)) == ["manifest.json", "plan.json"]
    assert os.listdir(tmp_path) == ["small"]


def test_an_empty_folder_is_filled(tmp_path: Path) -> None:
    (tmp_path / "small").mkdir()
    assert write_bundle(tmp_path / "small", small("1"), MANIFEST) == ()


def test_a_link_to_a_bundle_stays_a_link(tmp_path: Path) -> None:
    write_bundle(tmp_path / "real", small("1"), MANIFEST)
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert write_bundle(tmp_path / "link", small("2"), MANIFEST) == ()
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real/plan.json").read_bytes() == b"2"


@pytest.mark.parametrize("kind", ["file", "folder", "folder with another manifest"])
def test_what_is_no_bundle_is_never_replaced(tmp_path: Path, kind: str) -> None:
    target = tmp_path / "thesis"
    if kind == "file":
        target.write_text("ten years of work")
    else:
        target.mkdir()
        (target / "notes.txt").write_text("ten years of work")
    if kind == "folder with another manifest":
        (target / "manifest.json").write_text('{"name": "a browser extension"}')
    before = target.read_bytes() if kind == "file" else tree(target)
    [found] = write_bundle(target, small("1"), MANIFEST)
    assert found.code == "XEI0951"
    assert "-o DIR" in found.help[0]
    assert (target.read_bytes() if kind == "file" else tree(target)) == before
    assert os.listdir(tmp_path) == ["thesis"]


def test_a_file_in_the_way_of_the_folder_is_a_diagnostic(tmp_path: Path) -> None:
    (tmp_path / "build").write_text("")
    [found] = write_bundle(tmp_path / "build" / "small", small("1"), MANIFEST)
    assert found.code == "XEI0950"


def full(path: Path) -> None:
    """Write where the system has no space left, as a full disk would answer."""
    path.write_bytes(b"1")
    with Path("/dev/full").open("wb", buffering=0) as disk:
        disk.write(b"1")


def interrupt(path: Path) -> None:
    path.mkdir()
    (path / "half.mcap").write_bytes(b"1")
    raise KeyboardInterrupt


@pytest.mark.parametrize("older", [True, False])
def test_a_full_disk_leaves_what_was_there(tmp_path: Path, older: bool) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    target = tmp_path / "small"
    if older:
        write_bundle(target, small("1"), MANIFEST)
    before = tree(tmp_path)
    [found] = write_bundle(target, {"plan.json": b"2", "rosbag": full}, MANIFEST)
    assert found.code == "XEI0950"
    assert "no space left" in found.message
    assert "free some space" in found.help[0]
    assert tree(tmp_path) == before


@pytest.mark.parametrize("older", [True, False])
def test_an_interrupt_leaves_no_trace(tmp_path: Path, older: bool) -> None:
    target = tmp_path / "small"
    if older:
        write_bundle(target, small("1"), MANIFEST)
    before, names = tree(tmp_path), os.listdir(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        write_bundle(target, {"plan.json": b"2", "rosbag": interrupt}, MANIFEST)
    assert (tree(tmp_path), os.listdir(tmp_path)) == (before, names)


SCRIPT = """
import os, resource, sys
from pathlib import Path
from tests.export.test_bundle import MANIFEST, write_bundle
if sys.argv[2] == "quota":
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
elif os.geteuid() == 0:
    os.setuid(65534)
for found in write_bundle(Path(sys.argv[1]), {"plan.json": b"1" * 200_000}, MANIFEST):
    print(found.code, found.message, found.help)
"""


def elsewhere(target: Path, mode: str) -> str:
    """The diagnostics of a bundle that another process writes."""
    done = subprocess.run(
        [sys.executable, "-B", "-c", SCRIPT, str(target), mode],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_quota_leaves_what_was_there(tmp_path: Path) -> None:
    write_bundle(tmp_path / "small", small("1"), MANIFEST)
    before = tree(tmp_path)
    assert elsewhere(tmp_path / "small", "quota").startswith("XEI0950")
    assert tree(tmp_path) == before


def test_a_read_only_folder_is_a_diagnostic() -> None:
    with tempfile.TemporaryDirectory() as name:
        locked = Path(name)
        locked.chmod(0o555)
        said = elsewhere(locked / "small", "read-only")
        assert said.startswith("XEI0950")
        assert "permission denied" in said
        assert os.listdir(locked) == []
        locked.chmod(0o755)


def test_a_process_that_was_killed_is_put_right_by_the_next(tmp_path: Path) -> None:
    target = tmp_path / "small"
    write_bundle(target, small("1"), MANIFEST)
    target.rename(tmp_path / ".small.xei-old")
    stale = tmp_path / ".small.xei-new.4194305"
    stale.mkdir()
    (stale / "half.json").write_bytes(b"1")
    with pytest.raises(KeyboardInterrupt):
        write_bundle(target, {"rosbag": interrupt}, MANIFEST)
    assert os.listdir(tmp_path) == ["small"]
    assert read_bundle(target)[1] == ()


def test_a_path_out_of_the_bundle_is_our_bug(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no path inside"):
        write_bundle(tmp_path / "small", {"../evil": b""}, MANIFEST)
    assert os.listdir(tmp_path) == []


def test_a_changed_or_missing_file_is_named(tmp_path: Path) -> None:
    write_bundle(tmp_path, {"plan.json": b"1", "goals.json": b"2"}, MANIFEST)
    (tmp_path / "plan.json").write_bytes(b"2")
    (tmp_path / "goals.json").unlink()
    bundle, found = read_bundle(tmp_path)
    assert bundle is None
    assert sorted((item.code, item.message.split("`")[1]) for item in found) == [
        ("XEI0953", "goals.json"),
        ("XEI0954", "plan.json"),
    ]


@pytest.mark.parametrize(
    "text",
    [None, "", "[]", "{", '{"format": "xei-bundle", "version": 2, "files": {}}',
     '{"format": "xei-bundle", "version": 1, "files": {"../../etc/passwd": "0"}}',
     '{"format": "xei-bundle", "version": 1, "files": {"/etc/passwd": "0"}}'],
)  # fmt: skip
def test_what_is_no_bundle_is_not_read(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / "manifest.json").write_text(text)
    bundle, found = read_bundle(tmp_path)
    assert bundle is None
    assert [item.code for item in found] == ["XEI0952"]


def test_blockers_are_named_once() -> None:
    assert len(set(MANIFEST.blockers)) == len(MANIFEST.blockers)
    assert ("table.height", "strict") in [(item.item, item.blocks) for item in MANIFEST.blockers]


def test_the_scene_holds_bodies_and_stands() -> None:
    given = handoffs()
    scene = json.loads(dumps(scene_json(given.world, given.graph)))
    [body] = scene["bodies"]
    assert (body["name"], body["movable"]) == ("tube_1", True)
    assert body["T_world_object"]["position_m"] == [0.7, 0.15, 0.75]
    assert body["primitives"][0]["shape"] == {"type": "cylinder", "radius_m": 0.0085, "height_m": 0.118}
    assert [epoch["station"] for epoch in scene["epochs"]] == ["bench_a", "bench_b"]
