"""What a look says of things that no goal to come handles: motion was planned around them where they were."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.world import World
from xei_lang.profiles.checks.convex import TOUCH_M
from xei_lang.profiles.checks.overlap import overlap_m, solids_at
from xei_lang.profiles.model import Profile
from xei_lang.runtime.expected import stood
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.seen_apart import Apart, object_apart
from xei_lang.runtime.state import RunState
from xei_lang.world.ground import ground
from xei_lang.world.perception.seen import Seen
from xei_lang.world.sources import Observation
from xei_lang.world.sources.believed import as_believed

_ELSEWHERE = "XEI0941"
_COMPILE = "put it back, or compile again with what is seen: `--world`"


@dataclass(frozen=True, slots=True)
class Bystander:
    """A thing that was seen: how far from the plan's pose, if there is one, and why the run stops."""

    name: str
    apart: Apart | None = None
    code: str = ""
    message: str = ""
    note: str = ""
    help: str = ""


def bystanders(
    given: Handoffs, state: RunState, expected: World, found: Seen, judged: frozenset[str], from_s: float
) -> Iterator[Bystander]:
    """Everything that was seen somewhere and is not of those already `judged`, in the order of the source;
    `from_s` is when the goal that looks starts.
    """
    for seen in found.observations.items:
        if seen.name in judged or seen.T_frame_object is None:
            continue
        if seen.name in state.carried():
            yield from _left_behind(given, state, expected, seen, found.camera)
        elif expected.find(seen.name) is None:
            yield Bystander(
                seen.name,
                None,
                _ELSEWHERE,
                f"`{seen.name}` is there, and the plan was made for a world without it",
                _note(given, expected, seen, from_s),
                _COMPILE.replace("put it back", "take it away"),
            )
        else:
            apart = object_apart(expected, given.profile, seen, found.camera)
            yield (
                Bystander(seen.name, apart)
                if apart.within
                else _elsewhere(given, expected, found, seen, apart, from_s)
            )


def _elsewhere(
    given: Handoffs, expected: World, found: Seen, seen: Observation, apart: Apart, from_s: float
) -> Bystander:
    wrong = _contradiction(given.profile, expected, found, seen)
    if wrong is not None:
        return Bystander(seen.name, apart, wrong.code, wrong.message, wrong.notes[0], wrong.help[0])
    message = f"`{seen.name}` stands {apart.text}"
    return Bystander(seen.name, apart, _ELSEWHERE, message, _note(given, expected, seen, from_s), _COMPILE)


def _contradiction(profile: Profile, expected: World, found: Seen, seen: Observation) -> Diagnostic | None:
    """Why the thing cannot be there at all, beside all others as the run believes them to be."""
    gone = tuple(one for one in found.observations.items if one.is_absent)
    alone = replace(found.observations, items=(*gone, replace(seen, span=None)))
    _, said = ground(as_believed(profile, expected), (alone,))
    return next((one for one in said if one.severity == "error"), None)


def _note(given: Handoffs, expected: World, seen: Observation, from_s: float) -> str:
    """What will be set down where the thing is, or that it may be in the way."""
    item, pose = given.profile.object(seen.name), seen.T_frame_object
    assert item is not None
    assert pose is not None
    there = solids_at(item, expected.T_world_frame(seen.frame_id) @ pose)
    T_world_base = {epoch.index: epoch.T_world_base for epoch in given.graph.epochs}
    for timed in _to_come(given, from_s):
        for put in timed.placed:
            other = given.profile.object(put.object)
            if other is None or other is item:
                continue
            set_down = solids_at(other, T_world_base[timed.epoch] @ put.T_base_object)
            if any(overlap_m(a, b) > TOUCH_M for a in there for b in set_down):
                return f"step `{timed.step_id}` will set `{put.object}` down there"
    return "motion was planned around it where it was"


def _to_come(given: Handoffs, from_s: float) -> list[TimedGoal]:
    return sorted(
        (goal for goal in given.timed.goals if goal.start_s >= from_s), key=lambda goal: goal.start_s
    )


def _left_behind(
    given: Handoffs, state: RunState, expected: World, seen: Observation, camera: str
) -> Iterator[Bystander]:
    """A thing that a hand should have, seen where that hand took it from. Elsewhere it may be in the hand."""
    before = stood(given, state, seen.name)
    if before is None:
        return
    world = replace(expected, objects=(*expected.objects, before))
    if not object_apart(world, given.profile, seen, camera).within:
        return
    held = state.carried()[seen.name]
    hand = next(arm for arm, name in state.holding.items() if name == held)
    message = f"`{seen.name}` stands where it was taken from, and the run has it in the {hand} hand"
    yield Bystander(
        seen.name, None, _ELSEWHERE, message, "the hand is empty, or what was seen is from before", _COMPILE
    )
