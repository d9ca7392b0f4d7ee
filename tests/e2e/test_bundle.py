"""Bundles through the program: complete, readable by others, and the same bytes every time."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from tests.cli.xei import PROTOCOLS, xei

PROTOCOL = str(PROTOCOLS / "put_on_rack.xei")


def hashes(folder: Path) -> dict[str, str]:
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bundle")
    ran = xei("compile", PROTOCOL, "-o", "once", cwd=folder, env={"PYTHONHASHSEED": "1"})
    assert ran.code == 0, ran.err
    return folder / "once"


def test_one_line_for_each_handoff(bundle: Path) -> None:
    ran = xei("compile", PROTOCOL, "-o", str(bundle), cwd=bundle.parent)
    assert ran.code == 0, ran.err
    assert ran.out == ""
    warnings = [line for line in ran.err.splitlines() if line.startswith("warning[")]
    assert [line[8:15] for line in warnings] == ["XEI0717"]
    stages = [line.split()[0] for line in ran.err.splitlines() if line[:1].isalpha() and line not in warnings]
    assert stages == ["parse", "profile", "check", "ground", "lower", "motion", "verify", "bundle"]


def test_a_bundle_holds_every_representation(bundle: Path) -> None:
    names = {str(path.relative_to(bundle)) for path in bundle.rglob("*") if path.is_file()}
    assert names >= {
        "manifest.json", "protocol.xei", "plan.json", "goals.json", "timed.json", "scene.json", "robot.urdf",
        "rosbag/metadata.yaml",
    }  # fmt: skip
    manifest = json.loads((bundle / "manifest.json").read_text(encoding="utf-8"))
    assert {name for name in names if name != "manifest.json"} == set(manifest["files"])
    assert any(blocker["item"] == "frames.table" for blocker in manifest["blockers"])
    assert str(bundle.parent) not in (bundle / "manifest.json").read_text(encoding="utf-8")


def test_two_compilations_give_the_same_bytes(bundle: Path) -> None:
    first = hashes(bundle)
    ran = xei("compile", PROTOCOL, "-o", "twice", cwd=bundle.parent, env={"PYTHONHASHSEED": "77"})
    assert ran.code == 0, ran.err
    assert hashes(bundle.parent / "twice") == first


def test_another_tool_reads_the_recording(bundle: Path) -> None:
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    timed = json.loads((bundle / "timed.json").read_text(encoding="utf-8"))
    [recording] = (bundle / "rosbag").glob("*.mcap")
    with recording.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        messages = [(channel.topic, message) for _, channel, _, message in reader.iter_decoded_messages()]
    states = [message for topic, message in messages if topic == "/joint_states"]
    assert len(states) == pytest.approx(timed["duration_s"] * 100, abs=2)
    assert {topic for topic, _ in messages if topic.endswith("joint_trajectory")}
    last = dict(zip(states[-1].name, states[-1].position, strict=True))
    final = next(goal for goal in reversed(timed["goals"]) if goal["positions"])
    for joint, position in zip(final["joints"], final["positions"][-1], strict=True):
        assert last[joint] == pytest.approx(position, abs=1e-9)


def test_only_the_form_goes_to_standard_output(tmp_path: Path) -> None:
    ran = xei("compile", PROTOCOL, "--emit", "plan", cwd=tmp_path)
    assert ran.code == 0
    plan = json.loads(ran.out)
    assert [call["skill"] for call in plan["skill_calls"]] == ["pick", "insert"]
    assert not list(tmp_path.glob("build"))


def test_every_file_that_was_read_is_an_input(tmp_path: Path) -> None:
    (tmp_path / "profiles").symlink_to(PROTOCOLS.parent / "profiles")
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "rest.xei").write_text("procedure rest(t: Time) {\n  wait t\n}\n")
    (tmp_path / "times.csv").write_text("pause [s]\n2\n")
    (tmp_path / "main.xei").write_text(
        'import "lib/rest.xei"\nimport table "times.csv" as times\n\n'
        'protocol rests {\n  profile "openarm_bench"\n  for t in times.pause {\n    rest(t=t)\n  }\n}\n'
    )
    ran = xei("compile", "main.xei", "-o", "out", cwd=tmp_path)
    assert ran.code == 0, ran.err
    inputs = json.loads((tmp_path / "out" / "manifest.json").read_text(encoding="utf-8"))["inputs"]
    rest = hashlib.sha256((tmp_path / "lib" / "rest.xei").read_bytes()).hexdigest()
    assert inputs["import/lib/rest.xei"] == rest
    assert "import/times.csv" in inputs


def test_the_syntax_tree_can_be_printed_without_a_profile(tmp_path: Path) -> None:
    (tmp_path / "alone.xei").write_text('protocol alone {\n  profile "nowhere"\n  wait 1 s\n}\n')
    ran = xei("compile", "alone.xei", "--emit", "ast", cwd=tmp_path)
    assert ran.code == 0, ran.err
    assert "Wait" in ran.out
