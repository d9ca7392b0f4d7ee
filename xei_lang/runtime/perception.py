"""Who is asked where things are when a goal of a run perceives, and what the answer must be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from xei_lang.diagnostics import Diagnostic, has_errors
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.perception.seen import Seen
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.sources import WorldSource


class Perception(Protocol):
    """A source that is asked during a run. Asking may open a connection; it never raises for what a service
    or a file is at fault of.
    """

    def look(
        self, goal_id: str, asked: tuple[str, ...], profile: Profile, world: World
    ) -> Seen | ServiceFault | Diagnostic:
        """What is seen of these objects now. `world` has the frames where the run takes them to be."""
        ...


@dataclass(frozen=True, slots=True)
class RecordedScenes:
    """A perception whose answers were recorded: for each goal that perceives a source, as a scene file is."""

    by_goal: Mapping[str, WorldSource]

    def look(
        self, goal_id: str, asked: tuple[str, ...], profile: Profile, world: World
    ) -> Seen | ServiceFault | Diagnostic:
        """What was recorded for the goal."""
        source = self.by_goal.get(goal_id)
        if source is None:
            return unrecorded(goal_id)
        seen, said = source.observe(profile)
        if seen is None or has_errors(said):
            return next(item for item in said if item.severity == "error")
        return Seen(seen)


def unrecorded(goal_id: str) -> Diagnostic:
    """A goal that perceives, and for which nothing was recorded."""
    return Diagnostic(
        "XEI0942",
        f"nothing says what is seen at goal `{goal_id}`",
        help=("give one `--perceived` for each goal that perceives, in their order",),
    )
