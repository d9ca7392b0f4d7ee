"""Goals that leave an object where no argument of the call says: a vessel where it stood (`object.stand`), a
cap on the mouth of its vessel (`object.mouth`).
"""

from __future__ import annotations

from dataclasses import replace

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Detach
from xei_lang.ir.skill_plan import PlaceRef, Side
from xei_lang.lower.draft import Draft, contacts
from xei_lang.lower.operations.caps import Cap
from xei_lang.lower.operations.steady import STEADY
from xei_lang.lower.seats import place_text
from xei_lang.lower.task import Task, refuse_template
from xei_lang.lower.walk import Scene, Standing
from xei_lang.profiles.model import TemplateStep

LEAVING = ("stand", "mouth")
"""What a `detach` may name of an object: where it stood before it was taken, where its cap closes it."""


def leave(task: Task, line: TemplateStep, arm: Side, argument: str) -> Draft:
    """The goal at which a hand lets go of its object there."""
    name, _, word = argument.partition(".")
    return _on_mouth(task, line, arm) if word == "mouth" else _where_it_stood(task, line, arm, name)


def _where_it_stood(task: Task, line: TemplateStep, arm: Side, argument: str) -> Draft:
    planned, held = task.plans.get((STEADY.name, argument, arm)), task.scene.held.get(arm)
    if planned is None or planned.stood is None or held is None:
        refuse_template(line, f"`{argument}` was not taken from where it stood", "expected `attach` before")
    since = Label(task.step.span, f"`{held.object}` is set down here")
    standing = replace(planned.stood, since=since)
    after = task.scene.detach(arm, standing)
    place = standing.place or standing.support
    action = Detach(held.object, arm, place, task.scene.in_base(standing.T_world_object))
    return _draft(task, arm, action, after)


def _on_mouth(task: Task, line: TemplateStep, arm: Side) -> Draft:
    """The cap is left on the thread, however far it is turned, and rides on its vessel."""
    held = task.scene.held.get(arm)
    known = task.profile.object(held.object) if held else None
    vessel = task.profile.object(known.thread.on_object) if known and known.thread else None
    if held is None or known is None or known.thread is None or vessel is None:
        refuse_template(line, "no cap is in the hand", "expected `attach` with it before")
    cap = Cap(known, known.thread, vessel)
    T_world_seat = task.scene.T_world_of(vessel.name) @ cap.T_vessel_seat
    # A cap is round: where its hand has turned it to does not matter, and its nominal pose never turns.
    T_world_cap = Pose(task.scene.T_world_of(known.name).position_m, T_world_seat.quaternion)
    mouth = place_text(PlaceRef(vessel.name, "spot", cap.thread.on_key))
    since = Label(task.step.span, f"`{known.name}` is left on its thread here")
    after = task.scene.fasten(arm, Standing(known.name, T_world_cap, mouth, vessel.name, since, True))
    action = Detach(known.name, arm, mouth, task.scene.in_base(T_world_cap), vessel.name)
    return _draft(task, arm, action, after)


def _draft(task: Task, arm: Side, action: Detach, after: Scene) -> Draft:
    return Draft("detach", action, (f"{arm}_gripper",), after, (), contacts(task.scene, after))
