"""From pixels to a plan: a picture, a pose service as a process, a grounded world, a compilation."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest

from tests.cli.xei import PROFILES, ROOT
from tests.world.perception.serving import process
from tests.world.perception.views import bench
from xei_lang.diagnostics import Source, has_errors
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Detach
from xei_lang.ir.world import World
from xei_lang.pipeline import ALL, Request, compile_request
from xei_lang.profiles.grid import T_object_standing
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.observe import Seen, ask_for, observe
from xei_lang.world.perception.pose_request import Picture
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.wire import request_json

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")

PUSHED = Pose.from_rpy((0.012, -0.008, 0.0), (0.0, 0.0, math.radians(2.0)))
"""How the second rack stands apart from its prior: a third of what its slots' pitch would bear."""
STAMP_NS = 1_790_000_000_000_000_000
TOLERANCE_M = 0.001
TOLERANCE_RAD = math.radians(0.1)


@pytest.fixture(scope="module")
def lab() -> Profile:
    return bench()


@pytest.fixture(scope="module")
def truth(lab: Profile) -> World:
    world, said = ground(lab)
    assert world is not None, said
    return replace(world, objects=tuple(
        replace(item, T_frame_object=item.T_frame_object @ PUSHED) if item.name == "rack_2" else item
        for item in world.objects
    ))  # fmt: skip


@pytest.fixture(scope="module")
def picture(lab: Profile, truth: World) -> Picture:
    return mujoco_bench.take_picture(lab, truth, lab.calibration.cameras[0], stamp_ns=STAMP_NS, seed=7)


@pytest.fixture(scope="module")
def seen(lab: Profile, picture: Picture, tmp_path_factory: pytest.TempPathFactory) -> Seen:
    """What the service finds of the table, both racks and a bottle that has no tags."""
    names = ("table", "rack_1", "rack_2", "bottle_1")
    request = ask_for(picture, registry_of(lab), names, request_id="r1", session_id="s1")
    schema = json.loads(
        (ROOT / "xei_lang/world/perception/pose_request.schema.json").read_text(encoding="utf-8")
    )
    jsonschema.Draft202012Validator(schema).validate(request_json(request))
    folder = tmp_path_factory.mktemp("service")
    (folder / "profiles").symlink_to(PROFILES)
    with process(folder, "--backend", "apriltag") as url:
        found = observe(PoseClient(url), lab, request, now_ns=STAMP_NS + 300_000_000)
    assert isinstance(found, Seen), found
    return found


def test_tables_and_racks_are_found_where_they_stand(truth: World, seen: Seen) -> None:
    assert [item.name for item in seen.observations.items] == ["rack_1", "rack_2", "table"], seen.refused
    for item in seen.observations.items:
        assert item.T_frame_object is not None and item.frame_id == "world"
        apart = truth.T_world_object(item.name).inverse() @ item.T_frame_object
        # The body of a table hangs 0.75 m below its tags: a tilt of 0.05 degrees moves its bottom by 0.65 mm.
        lever_m = 0.75 if item.name == "table" else 0.0
        assert math.hypot(*apart.position_m) < TOLERANCE_M + lever_m * TOLERANCE_RAD
        assert 2.0 * math.hypot(*apart.quaternion[:3]) < TOLERANCE_RAD
        assert len(item.covariance) == 36


def test_what_has_no_tags_is_not_found_and_says_so(seen: Seen) -> None:
    assert [(item.name, item.reason) for item in seen.refused] == [("bottle_1", "no_object")]
    assert [item.code for item in seen.diagnostics] == ["XEI0699"]
    assert {item.representation for item in seen.refused} == {"world_grounding"}


def test_the_world_is_grounded_from_pixels_with_its_provenance(
    lab: Profile, truth: World, seen: Seen
) -> None:
    world, said = ground(lab, (seen.observations,))
    assert world is not None, said
    rack = world.find("rack_2")
    assert rack is not None and dict(rack.provenance)["pose"].startswith("pose_service http://127.0.0.1:")
    for name in ("rack_1", "rack_2", "table", "tube_1"):
        apart = truth.T_world_object(name).inverse() @ world.T_world_object(name)
        assert math.hypot(*apart.position_m) < 2.0 * TOLERANCE_M, name


PROTOCOL = """protocol moved {
  profile "openarm_bench"
  pick(object=tube_1)
  insert(object=tube_1, into=rack_2.slot("A1"))
}
"""


def test_a_protocol_compiles_with_that_world_and_puts_the_tube_where_the_rack_was_seen(
    lab: Profile, truth: World, seen: Seen
) -> None:
    source = Source("moved.xei", PROTOCOL)
    request = Request(source, profile_folder=Path(lab.folder), observed=(seen.observations,))
    made = compile_request(request, ALL)
    assert not has_errors(made.diagnostics), made.diagnostics
    assert made.made.verified is not None
    world, graph = made.made.world, made.made.graph
    assert world is not None and graph is not None
    assert world.sources[-1] == seen.observations.source
    (left,) = (goal.action for goal in graph.goals if isinstance(goal.action, Detach))
    rack = lab.object("rack_2")
    assert rack is not None
    T_rack_tube = T_object_standing(rack, "slot", "A1")
    assert T_rack_tube is not None
    apart = (
        (truth.T_world_object("rack_2") @ T_rack_tube).inverse()
        @ world.robot.T_world_base
        @ left.T_base_object
    )
    # A millimetre of chamfer and half a millimetre of gap lead the tube in.
    assert math.hypot(*apart.position_m[:2]) < 0.0015
