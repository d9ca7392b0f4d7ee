"""A backend by its name, and what a token file must hold."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.service.apriltag import AprilTagBackend
from xei_lang.world.perception.service.backend import Backend
from xei_lang.world.perception.service.foundationpose import FoundationPoseBackend
from xei_lang.world.perception.service.mock import MockBackend

BACKENDS = ("mock", "apriltag", "foundationpose")
MIN_TOKEN = 16


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


def token_of(text: str) -> str | Diagnostic:
    """The token in the text of a token file: its only line, of printable ASCII without spaces."""
    token = text.strip()
    if len(token) < MIN_TOKEN or not all("!" <= letter <= "~" for letter in token):
        return Diagnostic(
            "XEI0698",
            f"a token has {MIN_TOKEN} letters or more, on one line, without spaces",
            help=("write a long random text: `openssl rand -hex 32 > pose.token`",),
        )
    return token
