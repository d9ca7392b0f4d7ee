"""A backend by its name."""

from __future__ import annotations

from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.service.apriltag import AprilTagBackend
from xei_lang.world.perception.service.backend import Backend
from xei_lang.world.perception.service.foundationpose import FoundationPoseBackend
from xei_lang.world.perception.service.mock import MockBackend

BACKENDS = ("mock", "apriltag", "foundationpose")


def backend_named(
    name: str, profile: Profile, world: World, seed: int, upstream: PoseClient | None
) -> Backend:
    """The backend; `foundationpose` asks `upstream`. Raises KeyError for a name not in `BACKENDS`."""
    if name == "mock":
        return MockBackend(world, seed)
    if name == "apriltag":
        return AprilTagBackend(profile)
    if name == "foundationpose" and upstream is not None:
        return FoundationPoseBackend(upstream)
    raise KeyError(name)
