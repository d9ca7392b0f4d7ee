"""A goal that perceives: ask where the bench and the things on it are, and hold that against the plan.

A plan is rigid, so it goes on only where what is seen does not speak against the poses that it was made for;
else the run stops and names the representation that is to be mended.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from xei_lang.diagnostics import Diagnostic, has_errors
from xei_lang.ir.goals import MotionGoal, Perceive
from xei_lang.ir.trace import FailedStage, RuntimeFeedback
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.runtime.expected import Needed, expected_world, holder, needed_here
from xei_lang.runtime.failure import Failure
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.perception import Perception
from xei_lang.runtime.seen_apart import Apart, docked, frame_apart, object_apart
from xei_lang.runtime.state import RunState
from xei_lang.runtime.unexpected import bystanders
from xei_lang.world.perception.seen import Seen
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.sources.faults import observation_faults

NOT_GROUNDED: Mapping[str, Any] = {"source": None, "grounded": False}
"""What a trace keeps of a perception that asked nobody."""

_ELSEWHERE, _UNTOLD = "XEI0941", "XEI0942"


@dataclass(frozen=True, slots=True)
class Grounded:
    """What came of a perception: for the trace, and why the run stops if it does."""

    record: Mapping[str, Any]
    feedback: RuntimeFeedback | None = None
    failure: Failure | None = None


@dataclass(slots=True)
class _Sight:
    """One perception while it is judged."""

    goal: MotionGoal
    frame: str
    expected: World
    profile: Profile
    needed: tuple[Needed, ...]
    source: str = ""
    apart: list[Apart] = field(default_factory=list[Apart])
    by: dict[str, str] = field(default_factory=dict[str, str])
    unseen: tuple[str, ...] = ()

    def record(self, *, grounded: bool) -> dict[str, Any]:
        return {
            "source": self.source or None,
            "grounded": grounded,
            "seen": [item.to_json() for item in self.apart],
            "grounded_by": dict(self.by),
            "not_found": list(self.unseen),
        }

    def stop(
        self, what: str, stage: FailedStage, code: str, message: str, help: str, note: str = ""
    ) -> Grounded:
        """The end of the run: `what` is the representation that is to blame."""
        notes = (f"the {what} is to blame, and nothing moves by a guess", *((note,) if note else ()))
        said = Diagnostic(code, message, self.goal.span, notes=notes, help=(help,))
        feedback = RuntimeFeedback(self.goal.id, "failed", message, stage, what, help)
        return Grounded(self.record(grounded=False), feedback, Failure(stage, said))


def ground_again(given: Handoffs, state: RunState, goal: MotionGoal, perception: Perception) -> Grounded:
    """Ask for the frame of a goal that perceives, and for what its stand goes on to handle."""
    assert isinstance(goal.action, Perceive)
    expected = expected_world(given, state)
    needed = needed_here(given, goal, goal.action.frame, expected)
    sight = _Sight(goal, goal.action.frame, expected, given.profile, needed)
    asked = tuple(dict.fromkeys((*_bodies(sight), *(item.name for item in needed))))
    found = perception.look(goal.id, asked, given.profile, expected)
    if isinstance(found, ServiceFault):
        code = found.diagnostic().code
        return sight.stop("pose service", found.representation, code, found.message, found.help)
    if isinstance(found, Diagnostic):
        return _unreadable(sight, found)
    sight.source = found.observations.source
    sight.unseen = tuple(item.name for item in found.refused)
    frames = sorted(("world", *(frame.name for frame in expected.frames)))
    faults = tuple(observation_faults(given.profile, found.observations, frames))
    if has_errors(faults):
        return _unreadable(sight, next(item for item in faults if item.severity == "error"))
    return (
        _frame_doubt(sight, found)
        or _object_doubt(sight, found)
        or _untold(sight, found)
        or _bystander_doubt(sight, found, given, state)
        or Grounded(sight.record(grounded=True))
    )


def _bodies(sight: _Sight) -> tuple[str, ...]:
    """The object that a frame is told by: the table that stands in the frame of its name."""
    body = sight.expected.find(sight.frame)
    return (sight.frame,) if body is not None and body.frame_id == sight.frame else ()


def _unreadable(sight: _Sight, said: Diagnostic) -> Grounded:
    help_ = said.help[0] if said.help else "record it again"
    what = "pose service" if sight.source.startswith("pose_service") else "scene file"
    return sight.stop(what, "world_grounding", said.code, said.message, help_)


def _frame_doubt(sight: _Sight, found: Seen) -> Grounded | None:
    """Where the frame that was looked for is not where the plan has it before the base."""
    for name in _bodies(sight):
        seen = found.observations.find(name)
        doubt = next((item for item in found.refused if item.name == name), None)
        if doubt is not None and doubt.diagnostic().severity == "error":
            code = doubt.diagnostic().code
            return sight.stop("frame", doubt.representation, code, doubt.message, doubt.help)
        if seen is None or seen.T_frame_object is None:
            continue
        apart = frame_apart(sight.expected, sight.profile, sight.frame, seen, found.camera)
        sight.apart.append(apart)
        if apart.within:
            sight.by[sight.frame] = "seen"
            continue
        way = docked(sight.expected, sight.frame)
        message = f"`{sight.frame}` stands {apart.text}"
        station = sight.expected.robot.station
        if apart.position_m <= way.position_tolerance_m and apart.rotation_rad <= way.rotation_tolerance_rad:
            help_ = f"dock at `{station}` again, or compile again with what is seen: `--world`"
            note = "the base may stop so far from its station: the table is where it was, and the base is not"
            return sight.stop("frame", "scene_origin", _ELSEWHERE, message, help_, note)
        help_ = (
            f"look whether the base stands at `{station}`; if so, measure `frames.{sight.frame}` and the "
            "camera again: `xei perception detect`, `xei calibrate`"
        )
        note = "no docking explains it"
        return sight.stop("calibration", "scene_origin", _ELSEWHERE, message, help_, note)
    return None


def _object_doubt(sight: _Sight, found: Seen) -> Grounded | None:
    """Where an object that is handled from here on is not where the plan has it, or known too little."""
    refused = {item.name: item for item in found.refused}
    for need in sight.needed:
        doubt, seen = refused.get(need.name), found.observations.find(need.name)
        if doubt is not None and doubt.diagnostic().severity == "error":
            code = doubt.diagnostic().code
            return sight.stop("object pose", doubt.representation, code, doubt.message, doubt.help)
        if seen is not None and seen.is_absent:
            message = f"`{need.name}` is not there any more, and steps to come handle it"
            return _stop_object(sight, _UNTOLD, message, "put it back, or compile again without it")
        if seen is None or seen.T_frame_object is None:
            continue
        apart = object_apart(sight.expected, sight.profile, seen, found.camera)
        sight.apart.append(apart)
        if not apart.within:
            help_ = "put it back, or compile again with what is seen: `--world`"
            return _stop_object(sight, _ELSEWHERE, f"`{need.name}` stands {apart.text}", help_)
        if seen.confidence is not None and seen.confidence < need.confidence:
            message = f"`{need.name}` is seen with confidence {seen.confidence:g} only"
            help_ = f"look from nearer by: what steps to come do with it needs {need.confidence:g}"
            return _stop_object(sight, _UNTOLD, message, help_)
        sight.by[need.name] = "seen"
    return None


def _bystander_doubt(sight: _Sight, found: Seen, given: Handoffs, state: RunState) -> Grounded | None:
    """Where something that no goal to come handles is in another place than motion was planned around."""
    judged = frozenset((*_bodies(sight), *(need.name for need in sight.needed)))
    from_s = next(timed.start_s for timed in given.timed.goals if timed.id == sight.goal.id)
    for one in bystanders(given, state, sight.expected, found, judged, from_s):
        if one.apart is not None:
            sight.apart.append(one.apart)
        if one.message:
            return sight.stop("object pose", "world_grounding", one.code, one.message, one.help, one.note)
    return None


def _stop_object(sight: _Sight, code: str, message: str, help: str) -> Grounded:
    return sight.stop("object pose", "world_grounding", code, message, help)


def _untold(sight: _Sight, found: Seen) -> Grounded | None:
    """Where neither an object was seen that is handled from here on, nor what it stands in or on; and where
    nothing at all was seen.
    """
    refused = {item.name: item for item in found.refused}
    for need in sight.needed:
        if need.name in sight.by:
            continue
        stands_in, item = holder(sight.expected, need.name), sight.expected.find(need.name)
        on_frame = item is not None and item.frame_id in (sight.frame, "world")
        if sight.by.get(stands_in) == "seen":
            sight.by[need.name] = f"stands in {stands_in}"
        elif on_frame and sight.frame in sight.by:
            sight.by[need.name] = f"stands on {sight.frame}"
        else:
            doubt = refused.get(need.name)
            help_ = doubt.help if doubt is not None else f"record `{need.name}`, or `{sight.frame}`, too"
            message = f"neither `{need.name}` nor what it stands on was seen"
            return _stop_object(sight, _UNTOLD, message, help_)
    if not sight.by:
        message = f"nothing that tells where `{sight.frame}` is was seen"
        return sight.stop("frame", "world_grounding", _UNTOLD, message, _where_to_look(sight))
    return None


def _where_to_look(sight: _Sight) -> str:
    """What makes a source tell where the frame is: tags in a picture, a line in a scene file."""
    bodies = _bodies(sight)
    if not sight.source.startswith("scene_file") or not bodies:
        return "look whether its tags are in view"
    body = sight.expected.find(bodies[0])
    assert body is not None
    at = ", ".join(f"{round(value, 4) + 0.0:g} m" for value in body.T_frame_object.position_m)
    line = f"{body.name}: {{frame: {body.frame_id}, position: [{at}], confidence: 0.9}}"
    return f"add to the scene file where `{body.name}` was seen, which is `{line}` if it is in its place"
