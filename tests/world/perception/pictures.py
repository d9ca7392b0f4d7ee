"""A picture of the bench for tests of the pose service, rendered once, with the world that it shows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from tests.world.perception.views import bench
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground
from xei_lang.world.perception.observe import ask_for
from xei_lang.world.perception.pictures import encode_depth, encode_png
from xei_lang.world.perception.pose_request import Intrinsics, Picture, PoseRequest
from xei_lang.world.perception.registry import registry_of

STAMP_NS = 1_790_000_000_000_000_000


@dataclass(frozen=True)
class Scene:
    """A lab, the truth, and what its head camera sees of it."""

    lab: Profile
    truth: World
    picture: Picture

    def request(self, *names: str, request_id: str = "r1") -> PoseRequest:
        return ask_for(self.picture, registry_of(self.lab), names, request_id=request_id, session_id="s1")


def lab() -> Profile:
    """The bench, whose racks have tags on them."""
    return bench()


@cache
def rendered() -> Scene:
    """The truth, rendered by MuJoCo."""
    from tests.world.perception.mujoco_bench import take_picture

    world = truth()
    return Scene(lab(), world, take_picture(lab(), world, lab().calibration.cameras[0], stamp_ns=STAMP_NS))


@cache
def truth() -> World:
    """The bench as its priors have it."""
    world, said = ground(lab())
    assert world is not None, said
    return world


def small_picture(size_px: tuple[int, int] = (64, 48)) -> Picture:
    """A grey picture of nothing, from above the table: quick to send."""
    width, height = size_px
    image = np.full((height, width, 3), 120, np.uint8)
    T = Pose.from_rpy((0.6, 0.0, 1.6), (0.0, np.pi / 2, 0.0))
    lens = Intrinsics(50.0, 50.0, (width - 1) / 2, (height - 1) / 2, width, height)
    depth = encode_depth(np.full((height, width), 0.85), 1e-4)
    return Picture(STAMP_NS, "camera", "world", T, lens, encode_png(image), depth, 1e-4)


def small_request(*names: str, request_id: str = "r1") -> PoseRequest:
    """A request with a small picture for objects of the tagged lab."""
    return ask_for(small_picture(), registry_of(lab()), names, request_id=request_id, session_id="s1")
