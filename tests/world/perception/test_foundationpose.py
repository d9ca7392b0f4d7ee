"""The adapter for a separate estimator: a service that asks another process over HTTP, with masks."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.cli.xei import PROFILES
from tests.world.perception.pictures import STAMP_NS, lab, rendered, small_request, truth
from tests.world.perception.serving import Rogue, misbehaving, nobody, process, served
from xei_lang.world.perception.client import Limits, PoseClient
from xei_lang.world.perception.observe import Seen, observe
from xei_lang.world.perception.pictures import encode_mask
from xei_lang.world.perception.pose_request import MeshInfo
from xei_lang.world.perception.registry import RegisteredObject, registry_of
from xei_lang.world.perception.service.foundationpose import FoundationPoseBackend
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.mock import MockBackend
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.perception.wire import response_model
from xei_lang.world.sources.identity import objects_sha256

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
QUICK = Limits(call_s=5.0, tries=2, backoff_s=0.01)


def adapter(url: str) -> Desk:
    return Desk(lab(), FoundationPoseBackend(PoseClient(url, limits=QUICK)))


@pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")
def test_poses_come_from_the_other_process_with_masks_that_were_proposed(tmp_path: Path) -> None:
    (tmp_path / "profiles").symlink_to(PROFILES)
    scene = tmp_path / "scene.yaml"
    scene.write_text(
        f"version: 1\nprofile: openarm_bench\nobjects_sha256: {objects_sha256(lab())}\nobjects:\n"
        "  wipe_1: {frame: table, position: [0.08 m, 0.44 m, 0 m], confidence: 0.9}\n",
        encoding="utf-8",
    )
    request = rendered().request("wipe_1", "rack_1", "rack_2")
    arguments = ("--backend", "mock", "--world", "scene.yaml")
    with process(tmp_path, *arguments) as upstream, served(adapter(upstream)) as url:
        seen = observe(PoseClient(url), lab(), request, now_ns=STAMP_NS)
    assert isinstance(seen, Seen), seen
    assert [item.name for item in seen.observations.items] == ["wipe_1"], seen.refused
    # The two racks are of one size, so that no mask is proposed for either, and nothing is guessed.
    assert [(item.name, item.reason) for item in seen.refused] == [
        ("rack_1", "no_object"),
        ("rack_2", "no_object"),
    ]


def test_the_adapter_is_ready_only_with_the_other_process():
    with served(Desk(lab(), MockBackend(truth()))) as upstream, served(adapter(upstream)) as url:
        assert not isinstance(PoseClient(url).health(registry_of(lab())), ServiceFault)
        item = RegisteredObject("jar_1", (), (), MeshInfo("ab" * 32, "m", (0.1, 0.1, 0.2)))
        put = PoseClient(url).put_object(item)
        assert put == PoseClient(upstream).objects()
        assert not isinstance(put, ServiceFault)
        assert not isinstance(PoseClient(url).health(put), ServiceFault)
    with served(adapter(nobody())) as url:
        fault = PoseClient(url).health(registry_of(lab()))
        assert isinstance(fault, ServiceFault)
        assert (fault.reason, "no pose service answers" in fault.message) == ("failed", True)


def test_what_is_wrong_behind_the_adapter_is_passed_on():
    def garbage(handler, rogue: Rogue) -> None:
        body = b"<html>"
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    with misbehaving(garbage) as rogue, served(adapter(rogue.url)) as url:
        request = small_request("bottle_1")
        mask = encode_mask(np.ones((48, 64), dtype=bool))
        request = replace(request, queries=(replace(request.queries[0], mask_png=mask),))
        found = PoseClient(url, limits=QUICK).poses(request)
    assert isinstance(found, ServiceFault)
    assert found.reason == "failed"
    assert "not of its form" in found.message


def test_a_shape_that_the_other_process_reads_in_another_unit_is_not_passed_on_as_ours():
    request = small_request("bottle_1")
    mask = encode_mask(np.ones((48, 64), dtype=bool))
    request = replace(request, queries=(replace(request.queries[0], mask_png=mask),))
    with served(Desk(lab(), MockBackend(truth()))) as upstream:
        with served(adapter(upstream)) as url:
            right = PoseClient(url, limits=QUICK).poses(request)
        other = PoseClient(upstream).poses(request)
    assert not isinstance(right, ServiceFault) and not isinstance(other, ServiceFault)
    assert [item.status for item in right.objects] == ["ok"]
    said = response_model(other).model_dump(mode="json")
    said["objects"][0]["mesh"]["units"] = "mm"
    body = json.dumps(said).encode()

    def in_mm(handler, rogue: Rogue) -> None:
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    with misbehaving(in_mm) as rogue, served(adapter(rogue.url)) as url:
        wrong = PoseClient(url, limits=QUICK).poses(request)
    assert not isinstance(wrong, ServiceFault)
    assert [(item.status, item.T_output_object) for item in wrong.objects] == [("error", None)]
