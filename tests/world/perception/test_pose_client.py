"""The client against services that are dead, slow, or lie: over real sockets, each its own diagnostic."""

from __future__ import annotations

import gzip
import json
import time
from dataclasses import replace

import pytest

from tests.world.perception.pictures import STAMP_NS, lab, small_request, truth
from tests.world.perception.serving import Rogue, misbehaving, nobody, served
from xei_lang.world.perception.client import Limits, PoseClient
from xei_lang.world.perception.observe import Seen, observe
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.mock import MockBackend
from xei_lang.world.perception.service_fault import ServiceFault

QUICK = Limits(call_s=5.0, tries=3, backoff_s=0.01)


def asked(url: str, limits: Limits = QUICK):
    return PoseClient(url, limits=limits).poses(small_request("bottle_1"))


def reply(handler, body: bytes, status: int = 200, **headers: str) -> None:
    handler.send_response(status)
    for name, value in headers.items():
        handler.send_header(name.replace("_", "-"), value)
    if "Content_Length" not in headers:
        handler.send_header("Content-Length", str(len(body)))
    handler.end_headers()
    handler.wfile.write(body)


def answer(**changes) -> bytes:
    """A right answer to the request, with changes."""
    with served(Desk(lab(), MockBackend(truth()))) as url:
        found = PoseClient(url).poses(small_request("bottle_1"))
    assert not isinstance(found, ServiceFault)
    item = found.objects[0]
    value = {
        "request_id": found.request_id, "stamp_ns": found.stamp_ns, "model_version": "x",
        "processing_ms": 1.0,
        "objects": [{
            "name": item.name, "frame_id": item.frame_id, "status": item.status,
            "T_output_object": item.T_output_object, "confidence": item.confidence, "covariance": None,
            "roles": item.roles, "skills": item.skills,
            "mesh": {"sha256": item.mesh.sha256, "units": "m", "size_m": item.mesh.size_m},
        }],
    }  # fmt: skip
    return json.dumps({**value, **changes}).encode()


def drop(handler, rogue: Rogue) -> None:
    handler.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n{")


def never(handler, rogue: Rogue) -> None:
    time.sleep(1.5)


def trickle(handler, rogue: Rogue) -> None:
    handler.send_response(200)
    handler.send_header("Content-Length", "1000")
    handler.end_headers()
    for _ in range(100):
        handler.wfile.write(b" ")
        time.sleep(0.05)


def trickle_of_head(handler, rogue: Rogue) -> None:
    handler.wfile.write(b"HTTP/1.1 200 OK\r\n")
    for index in range(100):
        handler.wfile.write(b"X-%d: 1\r\n" % index)
        time.sleep(0.05)


def interim(handler, rogue: Rogue) -> None:
    while True:
        handler.wfile.write(b"HTTP/1.1 100 Continue\r\n\r\n")
        time.sleep(0.01)


def pour(handler, rogue: Rogue) -> None:
    """Two gigabytes, if they are taken."""
    handler.wfile.write(b"HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n")
    block = b" " * (1 << 20)
    for _ in range(2000):
        handler.wfile.write(block)
        rogue.sent += len(block)


@pytest.mark.parametrize(
    ("behaviour", "reason", "code"),
    [
        (drop, "dropped", "XEI0690"),
        (lambda handler, rogue: None, "dropped", "XEI0690"),
        (lambda handler, rogue: handler.wfile.write(b"SSH-2.0-OpenSSH\r\n"), "dropped", "XEI0690"),
        (lambda handler, rogue: reply(handler, b"", 503), "failed", "XEI0692"),
        (lambda handler, rogue: reply(handler, b"", 429), "busy", "XEI0692"),
        (lambda handler, rogue: reply(handler, b'{"error": "no"}', 422), "rejected", "XEI0692"),
        (lambda handler, rogue: reply(handler, b"", 401), "rejected", "XEI0692"),
        (lambda handler, rogue: reply(handler, b"", 307, Location="http://127.0.0.1:1/"),
         "rejected", "XEI0692"),
        (lambda handler, rogue: reply(handler, b""), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, b"<html>"), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, b"\xff\xfe\x00"), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, b"[" * 100_000), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, answer(confidence=2)), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, answer(processing_ms=float("nan"))), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, answer(stray=1)), "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, gzip.compress(b" " * 10_000_000), Content_Encoding="gzip"),
         "garbage", "XEI0693"),
        (lambda handler, rogue: reply(handler, b"", Content_Length="2000000000"), "too_large", "XEI0694"),
        (pour, "too_large", "XEI0694"),
        (lambda handler, rogue: reply(handler, answer(request_id="another")), "other_request", "XEI0695"),
    ],
)  # fmt: skip
def test_what_misbehaves_is_told_as_such(behaviour, reason, code):
    with misbehaving(behaviour) as rogue:
        found = asked(rogue.url)
    assert isinstance(found, ServiceFault), found
    assert (found.reason, found.diagnostic().code) == (reason, code)
    assert rogue.url in found.message
    assert found.representation == "world_grounding"
    assert found.feedback("g1").failed_stage == "world_grounding"
    # What the socket's buffers hold may have been sent, and no more.
    assert rogue.sent < 64_000_000


@pytest.mark.parametrize("behaviour", [never, trickle, trickle_of_head, interim])
def test_what_is_slow_is_given_up_once_its_time_is_over(behaviour):
    with misbehaving(behaviour) as rogue:
        found = asked(rogue.url, Limits(call_s=0.4, tries=5))
    assert isinstance(found, ServiceFault)
    assert (found.reason, found.diagnostic().code) == ("slow", "XEI0691")
    assert len(rogue.asked) == 1


def test_what_is_dead_is_told():
    found = asked(nobody())
    assert isinstance(found, ServiceFault)
    assert (found.reason, found.diagnostic().code) == ("unreachable", "XEI0690")


@pytest.mark.parametrize(
    "url", ["fish", "http://", "http://[", "ftp://127.0.0.1", "http://127.0.0.1:99999", ""]
)
def test_what_is_no_address_is_told(url):
    found = asked(url)
    assert isinstance(found, ServiceFault)
    assert found.diagnostic().code == "XEI0690"


@pytest.mark.parametrize("trouble", [drop, lambda handler, rogue: reply(handler, b"", 429, Retry_After="0"),
                                     lambda handler, rogue: reply(handler, b"", 502)])  # fmt: skip
def test_trouble_that_passes_is_waited_out(trouble):
    right = answer()
    pauses: list[float] = []

    def behaviour(handler, rogue):
        trouble(handler, rogue) if len(rogue.asked) < 3 else reply(handler, right)

    with misbehaving(behaviour) as rogue:
        client = PoseClient(rogue.url, limits=QUICK, sleep=pauses.append)
        found = client.poses(small_request("bottle_1"))
    assert not isinstance(found, ServiceFault), found
    assert len(rogue.asked) == 3
    assert pauses == [0.01, 0.02]


def test_a_service_that_asks_for_a_pause_is_given_it_within_the_time_of_the_call():
    with misbehaving(lambda handler, rogue: reply(handler, b"", 429, Retry_After="4")) as rogue:
        found = asked(rogue.url, Limits(call_s=2.0, tries=5))
    assert isinstance(found, ServiceFault)
    assert found.reason == "busy"
    assert len(rogue.asked) == 1


def test_a_request_that_is_wrong_is_not_tried_again():
    with misbehaving(lambda handler, rogue: reply(handler, b"{}", 422)) as rogue:
        asked(rogue.url)
    assert len(rogue.asked) == 1


def test_words_of_a_service_are_passed_on_without_control_characters():
    said = json.dumps({"error": "no\u001b[31m tubes\u0007 here"}).encode()
    with misbehaving(lambda handler, rogue: reply(handler, said, 422)) as rogue:
        found = asked(rogue.url)
    assert isinstance(found, ServiceFault)
    assert "tubes" in found.message
    assert found.message.isprintable()


def test_a_service_of_another_registry_is_not_asked_for_poses():
    other = replace(lab(), objects=tuple(item for item in lab().objects if item.name != "tube_1"))
    with served(Desk(other, MockBackend(truth()))) as url:
        found = observe(PoseClient(url), lab(), small_request("bottle_1"), now_ns=STAMP_NS)
    assert isinstance(found, ServiceFault)
    assert (found.reason, found.diagnostic().code) == ("other_registry", "XEI0696")


def entry_with(**changes) -> dict:
    return {**json.loads(answer())["objects"][0], **changes}


STRAY = [
    ({"units": "mm"}, "says `units` as `mm`, which the contract does not have",
     "all lengths are in metres, and angles in a rotation matrix: send these, and no `units`"),
    ({"model_versoin": "2"}, "says `model_versoin` as `2`, which", "did you mean `model_version`?"),
    ({"a\u001b[31m`" * 99: {"x": 1}}, "says `a [31m a [31m ", "leave `a [31m "),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "words", "help"), STRAY)
def test_a_key_that_the_contract_does_not_have_is_named_with_the_mend(changes, words, help):
    given = answer(**changes)
    with misbehaving(lambda handler, rogue: reply(handler, given)) as rogue:
        found = asked(rogue.url)
    assert isinstance(found, ServiceFault)
    assert (found.reason, found.diagnostic().code) == ("garbage", "XEI0693")
    assert f"to POST /v1/poses {words}" in found.message
    assert found.help.startswith(help)
    assert found.message.isprintable() and len(found.message) < 400


@pytest.mark.parametrize(
    ("key", "where", "help"),
    [
        ("Units", "objects[0].Units", "all lengths are in metres"),
        ("confidense", "objects[0].confidense", "did you mean `confidence`?"),
        ("colour", "objects[0].colour", "leave `colour` out"),
    ],
)
def test_so_is_one_of_an_object_and_its_place(key, where, help):
    entry = entry_with(**{key: "mm"})
    # A key that was misspelt is missing as well; what is there tells more.
    entry.pop("confidence" if key == "confidense" else "none", None)
    given = answer(objects=[entry])
    with misbehaving(lambda handler, rogue: reply(handler, given)) as rogue:
        found = asked(rogue.url)
    assert isinstance(found, ServiceFault)
    assert f"says `{key}` as `mm` (`{where}`), which the contract does not have" in found.message
    assert found.help.startswith(help)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"units": "mm"}, "is for its shape in `mm`, and the registry has it in `m`"),
        ({"size_m": [80.0, 80.0, 90.0]}, "is for a shape of 90000 mm at most, and the registry has one of "),
        ({"size_m": [0.0, 0.0, 0.0]}, "is for a shape of 0 mm at most"),
    ],
)
def test_a_shape_that_was_read_in_another_unit_is_told_before_any_pixel_is_looked_at(changes, words):
    entry = entry_with()
    given = answer(objects=[{**entry, "mesh": {**entry["mesh"], **changes}}])
    with misbehaving(healthy_with(given)) as rogue:
        found = observe(PoseClient(rogue.url), lab(), small_request("bottle_1"), now_ns=STAMP_NS)
    assert isinstance(found, Seen)
    ((name, reason, message),) = [(item.name, item.reason, item.message) for item in found.refused]
    assert (name, reason) == ("bottle_1", "other_units")
    assert f"the pose of `bottle_1` {words}" in message
    assert found.observations.items == ()
    assert [item.code for item in found.diagnostics] == ["XEI0697"]


def healthy_with(given: bytes):
    """A service of this lab's registry that answers each request for poses so."""
    health = {"status": "ready", "backend": "x", "registry_sha256": registry_of(lab()).sha256, "detail": ""}
    return lambda handler, rogue: reply(
        handler, json.dumps(health).encode() if handler.path == "/health" else given
    )


def test_an_answer_of_another_shape_is_refused_even_where_the_registry_was_right():
    mesh = {"sha256": "0" * 64, "units": "m", "size_m": [0.1, 0.1, 0.1]}
    given = answer(objects=[entry_with(mesh=mesh)])
    with misbehaving(healthy_with(given)) as rogue:
        found = observe(PoseClient(rogue.url), lab(), small_request("bottle_1"), now_ns=STAMP_NS)
    assert isinstance(found, Seen)
    assert [(item.name, item.reason) for item in found.refused] == [("bottle_1", "other_mesh")]
    assert found.observations.items == ()
