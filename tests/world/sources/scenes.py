"""Scenes of the bench, and what is grounded with them."""

from __future__ import annotations

from tests.world.bench import bench
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.world.ground import ground
from xei_lang.world.sources import Observation, Observations
from xei_lang.world.sources.identity import objects_sha256
from xei_lang.world.sources.scene_file import SceneFileSource


def scene(objects: str) -> str:
    """A scene file of the bench with these objects, given as YAML below `objects`."""
    lines = "".join(f"  {line}\n" for line in objects.splitlines())
    head = f"version: 1\nprofile: openarm_bench\nobjects_sha256: {objects_sha256(bench())}\n"
    return f"{head}objects:\n{lines}" if objects else f"{head}objects: {{}}\n"


def read(text: str) -> tuple[Observations | None, Diagnostics]:
    return SceneFileSource(Source("scene.yaml", text)).observe(bench())


def seen(*items: Observation, source: str = "scene_file test.yaml") -> Observations:
    return Observations(source, items, "0" * 64)


def at(
    name: str, x: float, y: float, z: float = 0.0, *, yaw: float = 0.0, frame: str = "table"
) -> Observation:
    return Observation(name, Pose.from_rpy((x, y, z), (0.0, 0.0, yaw)), frame, 0.9)


def grounded(*observed: Observations) -> World:
    world, found = ground(bench(), observed)
    assert world is not None, found
    return world


def codes(*observed: Observations) -> list[str]:
    world, found = ground(bench(), observed)
    assert world is None
    return [item.code for item in found if item.severity == "error"]
