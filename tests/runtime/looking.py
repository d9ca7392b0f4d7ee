"""Plans that look, compiled for the bench, and scenes and pictures of what is there when they do."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from tests.world.perception.views import ROOT, bench
from xei_lang.diagnostics import Source, has_errors
from xei_lang.ir.geometry import Pose
from xei_lang.ir.trace import TraceEvent
from xei_lang.ir.world import World
from xei_lang.pipeline import ALL, Request, compile_request
from xei_lang.profiles.open import robot_texts
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.perception import Perception, RecordedScenes
from xei_lang.runtime.run import RunResult, run
from xei_lang.world.ground import ground
from xei_lang.world.sources import Observation, Observations
from xei_lang.world.sources.identity import objects_sha256
from xei_lang.world.sources.scene_file import SceneFileSource

LOOK = """protocol look {
  profile "openarm_bench"
  look_at(target=rack_1)
}
"""
AWAY = """protocol away {
  profile "openarm_bench"
  nav_to(station=bench_b)
  look_at(target=rack_3)
}
"""
CARRIED = """protocol carried {
  profile "openarm_bench"
  pick(object=tube_3, arm=right)
  insert(object=tube_3, into=rack_1.slot("C3"))
  look_at(target=tube_3)
}
"""


@cache
def compiled(text: str) -> Handoffs:
    """What a run is handed."""
    request = Request(Source("look.xei", text), profile_folder=ROOT / "profiles" / "openarm_bench")
    outcome = compile_request(request, ALL)
    assert not has_errors(outcome.diagnostics), outcome.diagnostics
    made = outcome.made
    assert made.plan is not None
    assert made.graph is not None
    assert made.timed is not None
    assert made.world is not None
    assert made.profile is not None
    names = ("plan.json", "goals.json", "timed.json")
    sha256 = {name: hashlib.sha256(name.encode()).hexdigest() for name in names}
    urdf, _ = robot_texts(made.profile)
    return Handoffs(made.plan, made.graph, made.timed, made.world, made.profile, urdf, sha256)


def looks(given: Handoffs) -> list[str]:
    """The goals that perceive, in their order."""
    found = [goal for goal in given.timed.goals if goal.kind == "perceive"]
    return [goal.id for goal in sorted(found, key=lambda goal: goal.start_s)]


@dataclass(frozen=True)
class Ran:
    result: RunResult
    events: list[TraceEvent]

    def of(self, goal_id: str) -> dict[str, Any]:
        """What the trace says of a goal in the end."""
        (found,) = [event for event in self.events if (event.stage, event.goal_id) == ("feedback", goal_id)]
        return found.representation


def ran(given: Handoffs, perception: Perception | None) -> Ran:
    events: list[TraceEvent] = []
    return Ran(run(given, "dry-run", Answers(), events.append, perception=perception), events)


def truth(moved: Callable[[str, Pose], Pose] | None = None) -> World:
    """The bench as its priors have it, with things moved in their frames."""
    world, said = ground(bench())
    assert world is not None, said
    if moved is None:
        return world
    return replace(world, objects=tuple(
        replace(item, T_frame_object=moved(item.name, item.T_frame_object)) for item in world.objects
    ))  # fmt: skip


def scene(*lines: str) -> SceneFileSource:
    """A scene file of the bench."""
    head = f"version: 1\nprofile: openarm_bench\nobjects_sha256: {objects_sha256(bench())}\nobjects:\n"
    return SceneFileSource(Source("seen.yaml", head + "".join(f"  {line}\n" for line in lines)))


@dataclass(frozen=True)
class Said:
    """A source that says what a test wants said."""

    items: tuple[Observation, ...]
    name: str = "test"

    def observe(self, profile: object, /) -> tuple[Observations, tuple[()]]:
        return Observations(self.name, self.items, "0" * 64), ()


def scenes(given: Handoffs, *sources: SceneFileSource | Said) -> RecordedScenes:
    return RecordedScenes(dict(zip(looks(given), sources, strict=False)))
