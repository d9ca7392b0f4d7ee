"""The pose service over HTTP: its contract, and what it does with those who break it."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import replace
from pathlib import Path

import httpx
import jsonschema
import numpy as np
import pytest

from tests.world.perception.pictures import STAMP_NS, lab, small_picture, small_request, truth
from tests.world.perception.serving import served
from xei_lang.ir.geometry import Pose
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.contract import PoseRequestModel, PoseResponseModel, encoded
from xei_lang.world.perception.pose_request import MeshInfo
from xei_lang.world.perception.registry import RegisteredObject, registry_of
from xei_lang.world.perception.service.apriltag import AprilTagBackend
from xei_lang.world.perception.service.gate import Bucket, GateLimits
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.mock import MockBackend
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.perception.wire import request_json

ROOM = Path(__file__).parents[3] / "xei_lang" / "world" / "perception"
MODELS = {"pose_request": PoseRequestModel, "pose_response": PoseResponseModel}


@pytest.fixture(scope="module")
def url():
    with served(Desk(lab(), MockBackend(truth(), seed=3))) as url:
        yield url


def schema(name: str) -> dict:
    return json.loads((ROOM / f"{name}.schema.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", MODELS)
def test_the_schemas_are_those_of_the_models(name, update_golden):
    made = {"$schema": "https://json-schema.org/draft/2020-12/schema", **MODELS[name].model_json_schema()}
    if update_golden:
        text = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
        (ROOM / f"{name}.schema.json").write_text(text, encoding="utf-8")
    assert schema(name) == made


def test_the_keys_of_the_contract_are_these():
    assert list(PoseRequestModel.model_fields) == [
        "request_id", "stamp_ns", "camera_frame", "output_frame", "T_output_camera", "intrinsics", "rgb_png",
        "depth_png16", "depth_scale_m", "queries", "session_id",
    ]  # fmt: skip
    assert list(PoseResponseModel.model_fields) == [
        "request_id", "stamp_ns", "objects", "model_version", "processing_ms"
    ]  # fmt: skip


def test_health_models_and_objects_are_told(url):
    client, registry = PoseClient(url), registry_of(lab())
    health = client.health(registry)
    assert not isinstance(health, ServiceFault)
    assert (health.status, health.backend) == ("ready", "mock")
    assert client.objects() == registry
    models = client.models()
    assert not isinstance(models, ServiceFault)
    assert [entry.name for entry in models.models] == ["mock"]


def test_a_request_and_its_answer_are_of_the_schemas(url):
    body = request_json(small_request("bottle_1", "incubator", "table_b"))
    jsonschema.Draft202012Validator(schema("pose_request")).validate(body)
    answer = httpx.post(f"{url}/v1/poses", json=body, trust_env=False)
    assert answer.status_code == 200
    found = answer.json()
    jsonschema.Draft202012Validator(schema("pose_response")).validate(found)
    assert (found["request_id"], found["stamp_ns"]) == ("r1", STAMP_NS)
    assert [(item["name"], item["status"]) for item in found["objects"]] == [
        ("bottle_1", "ok"), ("incubator", "ok"), ("table_b", "no_object"),
    ]  # fmt: skip


def test_the_mock_tells_the_truth_with_noise_that_the_request_decides(url):
    client = PoseClient(url)
    first, again, other = (client.poses(small_request("bottle_1", request_id=name)) for name in "aab")
    assert not any(isinstance(found, ServiceFault) for found in (first, again, other))
    assert first.objects == again.objects
    assert first.objects != other.objects
    found = np.array(first.objects[0].T_output_object)
    apart = np.linalg.inv(np.array(truth().T_world_object("bottle_1").matrix())) @ found
    assert 0.0 < np.linalg.norm(apart[:3, 3]) < 0.003
    assert np.allclose(found[:3, :3] @ found[:3, :3].T, np.eye(3), atol=1e-12)


def test_an_output_frame_that_moves_things_is_heeded(url):
    request = small_request("bottle_1")
    T_table_camera = truth().T_world_frame("table").inverse() @ request.picture.T_output_camera
    moved = replace(
        request, picture=replace(request.picture, output_frame="table", T_output_camera=T_table_camera)
    )
    in_world, in_table = PoseClient(url).poses(request), PoseClient(url).poses(moved)
    assert not isinstance(in_world, ServiceFault) and not isinstance(in_table, ServiceFault)
    T = np.array(truth().T_world_frame("table").matrix())
    assert np.allclose(
        T @ in_table.objects[0].T_output_object, in_world.objects[0].T_output_object, atol=1e-9
    )
    assert in_table.objects[0].frame_id == "table"


def test_an_object_that_is_put_changes_the_registry():
    with served(Desk(lab(), MockBackend(truth()))) as url:
        client = PoseClient(url)
        item = RegisteredObject("jar_1", ("movable",), ("pick",), MeshInfo("ab" * 32, "mm", (0.1, 0.1, 0.2)))
        put = client.put_object(item)
        assert put == registry_of(lab()).put(item)
        fault = client.health(registry_of(lab()))
        assert isinstance(fault, ServiceFault)
        assert fault.reason == "other_registry"


def broken(**changes):
    return {**request_json(small_request("bottle_1")), **changes}


def png_that_claims(width: int, height: int) -> bytes:
    """A small PNG that says it is large."""
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = b"IHDR" + header
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + body + struct.pack(">I", zlib.crc32(body))


BOMB, LARGE = encoded(png_that_claims(60_000, 60_000)), encoded(png_that_claims(8000, 8000))
GHOST = {"object_id": "ghost", "mesh_sha256": "0" * 64, "mask_png": None, "mode": "register"}
LENS = request_json(small_request("bottle_1"))["intrinsics"]


@pytest.mark.parametrize(
    ("body", "status", "said"),
    [
        (b"", 422, "JSON"),
        (b"{", 422, "JSON"),
        (b"[" * 1_000_000, 422, "recursion"),
        (b'{"request_id": NaN}', 422, ""),
        (broken(stray=1), 422, "stray"),
        (broken(queries=[]), 422, "queries"),
        (broken(request_id=7), 422, "request_id"),
        (broken(stamp_ns=-1), 422, "stamp_ns"),
        (broken(depth_scale_m=0.0), 422, "depth_scale_m"),
        (broken(T_output_camera=[[2.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]), 422, "rigid"),
        (broken(intrinsics={**LENS, "distortion": [0.0, 0.0]}), 422, "distortion"),
        (broken(intrinsics={**LENS, "width": 65}), 422, "65"),
        (broken(intrinsics={**LENS, "width": 60_000, "height": 60_000}), 422, "intrinsics"),
        (broken(intrinsics={**LENS, "width": 8000, "height": 8000}, rgb_png=LARGE), 422, "million pixels"),
        (broken(rgb_png=BOMB), 422, "60000 x 60000"),
        (broken(rgb_png="not base64!"), 422, "base64"),
        (broken(rgb_png=encoded(b"GIF89a")), 422, "no PNG"),
        (broken(rgb_png=encoded(small_picture().rgb_png[:60])), 422, "damaged"),
        (broken(depth_png16=encoded(small_picture().rgb_png)), 422, "16 are needed"),
        (broken(output_frame="nowhere"), 422, "nowhere"),
        (broken(queries=[GHOST]), 404, "ghost"),
        (broken(queries=[{**GHOST, "object_id": "tube_1"}]), 409, "another shape"),
        (broken(queries=request_json(small_request("bottle_1"))["queries"] * 2), 422, "twice"),
    ],
)  # fmt: skip
def test_a_bad_request_is_refused_with_a_reason(url, body, status, said):
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    answer = httpx.post(f"{url}/v1/poses", content=content, trust_env=False)
    assert answer.status_code == status, answer.text[:300]
    assert said in answer.json()["error"]
    assert len(answer.content) < 2000


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [("GET", "/nothing", 404), ("DELETE", "/objects/x", 405), ("PUT", "/objects/a%20b", 422)],
)
def test_what_the_contract_does_not_have_is_refused(url, method, path, status):
    answer = httpx.request(method, url + path, trust_env=False)
    assert answer.status_code == status
    assert answer.json()["error"]


def test_a_body_without_end_is_cut_off_while_it_comes():
    sent = 0

    def without_end():
        nonlocal sent
        while sent < 500_000_000:
            sent += 100_000
            yield b" " * 100_000

    with served(Desk(lab(), MockBackend(truth())), limits=GateLimits(body_bytes=1_000_000)) as url:
        try:
            answer = httpx.post(f"{url}/v1/poses", content=without_end(), trust_env=False)
            assert answer.status_code == 413
        except httpx.HTTPError:
            pass  # The connection was closed before all was sent; that is a refusal, too.
        assert sent < 50_000_000
        stated = httpx.post(f"{url}/v1/poses", content=b" " * 1_000_001, trust_env=False)
        assert stated.status_code == 413
        assert not isinstance(PoseClient(url).health(registry_of(lab())), ServiceFault)


def test_a_token_is_asked_for_on_every_route():
    with served(Desk(lab(), MockBackend(truth())), token="a-long-enough-token") as url:
        for method, path in (
            ("GET", "/health"),
            ("GET", "/objects"),
            ("POST", "/v1/poses"),
            ("GET", "/openapi.json"),
        ):
            for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": "a-long-enough-token"}):
                answer = httpx.request(method, url + path, headers=headers, trust_env=False)
                assert answer.status_code == 401
        assert not isinstance(PoseClient(url, "a-long-enough-token").health(registry_of(lab())), ServiceFault)
        fault = PoseClient(url).health(registry_of(lab()))
        assert isinstance(fault, ServiceFault)
        assert (fault.reason, "token" in fault.message) == ("rejected", True)


def test_a_page_that_was_led_to_this_machine_is_refused(url):
    answer = httpx.get(f"{url}/objects", headers={"Host": "evil.example:80"}, trust_env=False)
    assert answer.status_code == 403


def test_too_many_requests_are_told_when_to_come_again():
    limits = GateLimits(burst=3, rate_hz=0.5)
    with served(Desk(lab(), MockBackend(truth())), limits=limits) as url:
        answers = [httpx.get(f"{url}/health", trust_env=False) for _ in range(5)]
    assert [answer.status_code for answer in answers[:3]] == [200, 200, 200]
    assert {answer.status_code for answer in answers[3:]} == {429}
    assert 1 <= int(answers[-1].headers["retry-after"]) <= 2


def test_a_bucket_fills_again_at_its_rate():
    now = 0.0
    bucket = Bucket(2, 4.0, clock=lambda: now)
    assert [bucket.wait_s() for _ in range(3)] == [0.0, 0.0, 0.25]
    now = 0.25
    assert [bucket.wait_s() for _ in range(2)] == [0.0, 0.25]
    now = 100.0
    assert [bucket.wait_s() > 0 for _ in range(3)] == [False, False, True]


def test_tags_are_needed_for_their_backend():
    layout = replace(lab().calibration.apriltags, tags=())
    bare = replace(lab(), calibration=replace(lab().calibration, apriltags=layout))
    with served(Desk(bare, AprilTagBackend(bare))) as url:
        fault = PoseClient(url).health(registry_of(bare))
    assert isinstance(fault, ServiceFault)
    assert (fault.reason, "AprilTags" in fault.message) == ("failed", True)


def test_the_tags_of_a_blank_picture_are_uncertain():
    with served(Desk(lab(), AprilTagBackend(lab()))) as url:
        found = PoseClient(url).poses(small_request("rack_1"))
    assert not isinstance(found, ServiceFault)
    assert [item.status for item in found.objects] == ["low_quality"]


def test_the_registry_knows_shapes_roles_and_skills_but_not_places():
    registry = registry_of(lab())
    tube = lab().object("tube_1")
    assert tube is not None and tube.prior is not None
    others = tuple(item for item in lab().objects if item is not tube)
    moved = replace(tube, prior=replace(tube.prior, confidence=0.1, T_frame_object=Pose((1.0, 0.0, 0.0))))
    assert registry_of(replace(lab(), objects=(*others, moved))).sha256 == registry.sha256
    for changed in (replace(tube, roles=("movable",)), replace(tube, skills=()), replace(tube, geometry=()),
                    replace(tube, size_m=(0.1, 0.1, 0.1)), replace(tube, name="tube_9")):  # fmt: skip
        assert registry_of(replace(lab(), objects=(*others, changed))).sha256 != registry.sha256
