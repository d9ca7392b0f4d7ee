"""Scenes of the bench, and what is grounded with them."""

from __future__ import annotations

import itertools
from functools import cache

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


@cache
def free(name: str) -> Observation:
    """The object on a free place of the table: the first of a grid where it contradicts nothing."""
    for x, y in itertools.product(range(60, 660, 40), range(-640, 660, 40)):
        there = at(name, x / 1000, y / 1000)
        world, _ = ground(bench(), (seen(there),))
        found = world.find(name) if world is not None else None
        if found is not None and not found.place:
            return there
    raise AssertionError(f"the table has no free place for {name}")


def grounded(*observed: Observations) -> World:
    world, found = ground(bench(), observed)
    assert world is not None, found
    return world


def codes(*observed: Observations) -> list[str]:
    world, found = ground(bench(), observed)
    assert world is None
    return [item.code for item in found if item.severity == "error"]
