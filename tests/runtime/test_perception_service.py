"""Goals that perceive by a pose service, over real HTTP: the run goes on, or stops with what is to blame."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace

import numpy as np
import pytest

from tests.runtime.looking import AWAY, LOOK, Ran, compiled, looks, ran, truth
from tests.world.perception.pictures import STAMP_NS
from tests.world.perception.serving import Rogue, misbehaving, nobody, served
from tests.world.perception.test_pose_client import drop, never, pour, reply, trickle
from tests.world.perception.views import bench
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.runtime.expected import expected_world
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.state import RunState, initial_state
from xei_lang.world.perception.client import Limits, PoseClient
from xei_lang.world.perception.observe import ask_for
from xei_lang.world.perception.pose_request import PoseRequest
from xei_lang.world.perception.recorded import RecordedPictures
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.service.apriltag import AprilTagBackend
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.mock import MockBackend

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")

QUICK = Limits(call_s=5.0, tries=2, backoff_s=0.01)


def at_epoch(given: Handoffs, epoch: int, world: World) -> World:
    """The things of a world with the robot at a stand of the plan, the slide at that station's height."""
    station = given.graph.epochs[epoch].station
    slide_m = next(one.slide_m for one in bench().calibration.stations if one.name == station)
    start = initial_state(given)
    state = RunState({**start.joints, "slide_joint": slide_m}, {}, epoch=epoch)
    return replace(expected_world(given, state), objects=world.objects)


def picture(given: Handoffs, epoch: int, world: World, output_frame: str = "robot_base") -> PoseRequest:
    """What the head camera sees from there: depth and colour, and no more than the form asks for."""
    camera = bench().calibration.cameras[0]
    taken = mujoco_bench.take_picture(
        bench(), at_epoch(given, epoch, world), camera, output_frame, stamp_ns=STAMP_NS
    )
    name = "table" if epoch == 0 else "table_b"
    return ask_for(taken, registry_of(bench()), (name,), request_id="recorded", session_id="s1")


@pytest.fixture(scope="module")
def seen() -> PoseRequest:
    """The bench as the plan takes it to be."""
    return picture(compiled(LOOK), 0, truth())


def asked(url: str, given: Handoffs, *pictures: PoseRequest, limits: Limits = QUICK) -> Ran:
    by_goal = dict(zip(looks(given), pictures, strict=True))
    return ran(given, RecordedPictures(PoseClient(url, limits=limits), by_goal))


def stopped(done: Ran, goal: str, what: str, code: str) -> str:
    said = done.of(goal)
    assert done.result.status == "failed"
    (shown,) = done.result.diagnostics
    assert (shown.code, said["representation"], said["message"]) == (code, what, shown.message)
    assert shown.help == (said["help"],) and said["help"]
    assert said["failed_stage"] == done.result.failed_stage == "world_grounding"
    assert said["perception"]["grounded"] is False
    return shown.message


def test_the_run_goes_on_where_the_pixels_agree_with_the_plan(seen: PoseRequest) -> None:
    given = compiled(LOOK)
    with served(Desk(bench(), AprilTagBackend(bench()))) as url:
        done = asked(url, given, seen)
    assert done.result.status == "succeeded", done.result
    said = done.of(looks(given)[0])["perception"]
    assert said["source"] == f"pose_service {url}"
    assert said["grounded_by"] == {"table": "seen", "rack_1": "seen"}
    assert all(item["position_m"] < 1e-3 for item in said["seen"])
    assert {item["way"] for item in said["seen"]} == {"camera"}


def test_both_stands_of_a_plan_with_a_drive_are_asked_for() -> None:
    given = compiled(AWAY)
    view = picture(given, 1, truth())
    with served(Desk(bench(), AprilTagBackend(bench()))) as url:
        done = asked(url, given, view, view)
    # From the station's own height rack_3 is cut off by the picture's border; the table tells where it is.
    assert done.result.status == "succeeded", done.result
    by = [done.of(goal)["perception"]["grounded_by"] for goal in looks(given)]
    assert [item["table_b"] for item in by] == ["seen", "seen"]


def test_a_rack_that_was_pushed_stops_the_run() -> None:
    given = compiled(LOOK)
    push = Pose((0.02, 0.0, 0.0))
    world = truth(lambda name, pose: push @ pose if name == "rack_1" else pose)
    with served(Desk(bench(), AprilTagBackend(bench()))) as url:
        done = asked(url, given, picture(given, 0, world))
    message = stopped(done, looks(given)[0], "object pose", "XEI0941")
    assert message.startswith("`rack_1` stands 20.") and "from where the plan has it" in message


@contextmanager
def of_desk(desk: Desk) -> Iterator[str]:
    with served(desk) as url:
        yield url


@contextmanager
def rogue(behaviour: Callable[[object, Rogue], None]) -> Iterator[str]:
    """A service that is healthy, and misbehaves once it is asked for poses."""
    sha256 = registry_of(bench()).sha256
    health = {"status": "ready", "backend": "x", "registry_sha256": sha256, "detail": ""}

    def behave(handler, rogue: Rogue) -> None:
        if handler.path == "/health":
            reply(handler, json.dumps(health).encode())
        else:
            behaviour(handler, rogue)

    with misbehaving(behave) as made:
        yield made.url
        assert made.sent < 64_000_000


def answers(**changes: object) -> bytes:
    """A right answer's form, with changes, that places the rack and the table."""
    registry = registry_of(bench())
    objects = []
    for name in ("table", "rack_1"):
        known = registry.find(name)
        assert known is not None
        matrix = (truth().T_world_object(name)).matrix()
        objects.append({
            "name": name, "frame_id": "robot_base", "status": "ok", "T_output_object": matrix,
            "confidence": 0.9, "covariance": None, "roles": known.roles, "skills": known.skills,
            "mesh": {"sha256": known.mesh.sha256, "units": "m", "size_m": known.mesh.size_m},
        })  # fmt: skip
    goal = looks(compiled(LOOK))[0]
    value = {"request_id": goal, "stamp_ns": STAMP_NS, "model_version": "x", "processing_ms": 1.0}
    return json.dumps({**value, "objects": objects, **changes}).encode()


def moved(name: str, x_m: float) -> list[dict[str, object]]:
    """The objects of a right answer, one of them shifted along x."""
    objects = json.loads(answers())["objects"]
    for item in objects:
        if item["name"] == name:
            item["T_output_object"][0][3] += x_m
    return objects


def test_an_answer_like_these_is_believed_where_nothing_is_wrong_with_it(seen: PoseRequest) -> None:
    with rogue(lambda handler, _: reply(handler, answers())) as url:
        assert asked(url, compiled(LOOK), seen).result.status == "succeeded"


OTHER = replace(bench(), objects=tuple(item for item in bench().objects if item.name != "wipe_1"))


@pytest.mark.parametrize(
    ("service", "what", "code"),
    [
        (lambda: rogue(drop), "pose service", "XEI0690"),
        (lambda: rogue(lambda handler, _: reply(handler, b"<html>")), "pose service", "XEI0693"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(stray=1))), "pose service", "XEI0693"),
        (lambda: rogue(lambda handler, _: reply(handler, b"", 503)), "pose service", "XEI0692"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(request_id="other"))),
         "pose service", "XEI0695"),
        (lambda: rogue(pour), "pose service", "XEI0694"),
        (lambda: of_desk(Desk(OTHER, MockBackend(truth()))), "pose service", "XEI0696"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(objects=moved("rack_1", 2.0)))),
         "object pose", "XEI0697"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(objects=moved("table", 3.0)))),
         "frame", "XEI0697"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(objects=moved("rack_1", 0.05)))),
         "object pose", "XEI0697"),
        (lambda: rogue(lambda handler, _: reply(handler, answers(stamp_ns=STAMP_NS - 10**10))),
         "frame", "XEI0697"),
    ],
    ids=["dead while it is asked", "garbage", "a stray key", "broken", "another request", "2 GB",
         "another registry", "outside the workspace", "a table outside of it", "not in the picture",
         "an old picture"],
)  # fmt: skip
def test_what_is_wrong_with_a_service_stops_the_run_and_is_named(
    seen: PoseRequest, service: Callable[[], AbstractContextManager[str]], what: str, code: str
) -> None:
    given = compiled(LOOK)
    with service() as url:
        done = asked(url, given, seen)
    stopped(done, looks(given)[0], what, code)


@pytest.mark.parametrize("behaviour", [never, trickle])
def test_a_slow_service_is_not_waited_for(seen: PoseRequest, behaviour) -> None:
    given = compiled(LOOK)
    with rogue(behaviour) as url:
        done = asked(url, given, seen, limits=Limits(call_s=0.6, tries=2))
    stopped(done, looks(given)[0], "pose service", "XEI0691")


def test_a_dead_service_stops_the_run(seen: PoseRequest) -> None:
    given = compiled(LOOK)
    message = stopped(asked(nobody(), given, seen), looks(given)[0], "pose service", "XEI0690")
    assert message.startswith("no pose service answers at http://127.0.0.1:")


def test_a_picture_that_is_missing_or_placed_nowhere_stops_the_run(seen: PoseRequest) -> None:
    given = compiled(LOOK)
    done = ran(given, RecordedPictures(PoseClient(nobody()), {}))
    stopped(done, looks(given)[0], "pose service", "XEI0692")
    lost = replace(seen, picture=replace(seen.picture, output_frame="moon"))
    stopped(asked(nobody(), given, lost), looks(given)[0], "pose service", "XEI0692")


def test_a_blank_picture_tells_nothing(seen: PoseRequest) -> None:
    from xei_lang.world.perception.pictures import encode_png

    given = compiled(LOOK)
    blank = encode_png(np.full((720, 1280, 3), 90, np.uint8))
    picture_ = replace(seen, picture=replace(seen.picture, rgb_png=blank))
    with served(Desk(bench(), AprilTagBackend(bench()))) as url:
        done = asked(url, given, picture_)
    assert "nor what it stands on was seen" in stopped(done, looks(given)[0], "object pose", "XEI0942")
