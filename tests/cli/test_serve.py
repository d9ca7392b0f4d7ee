"""`xei perception serve` and `xei doctor --pose-service`, as a user calls them."""

from __future__ import annotations

import json
import socket
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, xei
from tests.world.perception.serving import process
from xei_lang.profiles.load import load_profile
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.service_fault import ServiceFault

TOKEN = "0123456789abcdef-token"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "pose.token").write_text(f"{TOKEN}\n", encoding="utf-8")
    return tmp_path


def blockers(lab: Path, *arguments: str) -> list[dict[str, str]]:
    ran = xei("doctor", "--format", "json", *arguments, cwd=lab)
    assert ran.code == 1, ran.err
    return [item for item in json.loads(ran.out)["blockers"] if item["item"] == "pose_service"]


def test_a_service_prints_its_address_answers_and_ends_cleanly(lab: Path) -> None:
    profile, _ = load_profile(PROFILES / "openarm_bench", None)
    assert profile is not None
    with process(lab) as url:
        health = PoseClient(url).health(registry_of(profile))
        assert not isinstance(health, ServiceFault)
        assert (health.backend, url.rpartition(":")[0]) == ("apriltag", "http://127.0.0.1")
        assert blockers(lab, "--pose-service", url) == []


def test_a_token_is_asked_for_and_given(lab: Path) -> None:
    with process(lab, "--backend", "mock", "--token-file", "pose.token", "--quiet") as url:
        (found,) = blockers(lab, "--pose-service", url)
        assert (found["code"], found["status"], found["blocks"]) == ("XEI0692", "rejected", "hardware")
        assert blockers(lab, "--pose-service", url, "--token-file", "pose.token") == []


def test_a_service_that_is_not_there_blocks_a_run(lab: Path) -> None:
    (found,) = blockers(lab, "--pose-service", "http://127.0.0.1:9")
    assert (found["code"], found["representation"]) == ("XEI0690", "world")
    assert found["status"] == "unreachable"
    assert blockers(lab) == []


def test_a_service_of_another_registry_blocks_a_run(lab: Path) -> None:
    other = lab / "other"
    (other / "profiles" / "lab").mkdir(parents=True)
    for path in (PROFILES / "openarm_bench").iterdir():
        (other / "profiles" / "lab" / path.name).symlink_to(path)
    usage = other / "profiles" / "lab" / "usage_profile.yaml"
    text = usage.read_text(encoding="utf-8")
    assert "height: 105 mm" in text
    usage.unlink()
    usage.write_text(text.replace("height: 105 mm", "height: 106 mm"), encoding="utf-8")
    with process(other, "--backend", "mock") as url:
        (found,) = blockers(lab, "--pose-service", url)
    assert (found["code"], found["status"]) == ("XEI0696", "other registry")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--host", "0.0.0.0"), "can be reached from elsewhere"),
        (("--host", "::"), "can be reached from elsewhere"),
        (("--host", "lab.example"), "can be reached from elsewhere"),
        (("--backend", "foundationpose"), "`--upstream`"),
        (("--backend", "mock", "--upstream", "http://127.0.0.1:1"), "`--upstream`"),
        (("--token-file", "short.token"), "16 letters"),
    ],
)
def test_what_cannot_be_served_so_is_told(lab: Path, arguments: tuple[str, ...], said: str) -> None:
    (lab / "short.token").write_text("secret", encoding="utf-8")
    ran = xei("perception", "serve", *arguments, cwd=lab, timeout=60)
    assert (ran.code, ran.out) == (1, "")
    assert "error[XEI0698]" in ran.err
    assert said in ran.err


def test_a_port_that_is_taken_is_told(lab: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        ran = xei("perception", "serve", "--port", str(taken.getsockname()[1]), cwd=lab, timeout=60)
    assert (ran.code, "error[XEI0698]" in ran.err) == (1, True)


@pytest.mark.parametrize(
    "arguments",
    [("--token-file", "absent"), ("--world", "absent.yaml"), ("--port", "70000"), ("--backend", "eyes")],
)
def test_what_is_missing_or_wrong_usage_is_told(lab: Path, arguments: tuple[str, ...]) -> None:
    ran = xei("perception", "serve", *arguments, cwd=lab, timeout=60)
    assert (ran.code, ran.out) == (2, "")
