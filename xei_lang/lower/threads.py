"""What a step does to threads: a cap that comes off, or on, is turned by all the turns of its thread."""

from __future__ import annotations

import math
from collections.abc import Iterable

from xei_lang.diagnostics import Label
from xei_lang.ir.goals import MoveTo
from xei_lang.ir.tool_paths import Turn
from xei_lang.lower.draft import Draft
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import LabObject, Thread
from xei_lang.quantity.lengths import exact_mm

_SAME_RAD = math.radians(0.1)
"""Strokes are stated in thousandths of a degree."""
_SAME_M = 1e-6


def refuse_half_turned(task: Task, before: Scene, drafts: Iterable[Draft]) -> None:
    """Give up a step whose template leaves a cap on its thread, or takes it off, with other turns than the
    thread has (XEI0701). Which way a cap was turned is told by where it was `before` and is now.
    """
    for known in task.profile.objects:
        if known.thread is None:
            continue
        was_on, is_on = (bool(scene.carrier_of(known.name)) for scene in (before, task.scene))
        if was_on != is_on:
            _refuse_other_turns(task, known, known.thread, -1.0 if is_on else 1.0, tuple(drafts))


def _refuse_other_turns(
    task: Task, known: LabObject, thread: Thread, sign: float, drafts: tuple[Draft, ...]
) -> None:
    screws = [turn for turn in map(_screw, drafts) if turn is not None]
    turned_rad = sum(turn.angle_rad for turn in screws)
    wanted_rad = sign * thread.turns * math.tau
    leads = all(abs(turn.lead_m - thread.lead_m) <= _SAME_M for turn in screws)
    if leads and abs(turned_rad - wanted_rad) <= _SAME_RAD:
        return
    what = "off" if sign > 0.0 else "on"
    found = f"{math.degrees(turned_rad):g} deg" if leads else "another lead"
    refuse(
        "XEI0701",
        f"`{task.spec.name}` does not turn `{known.name}` all the way {what}",
        next((line.span for line in task.spec.template if line.field("path") == "screw"), task.spec.span),
        f"expected {math.degrees(wanted_rad):g} deg at a lead of {exact_mm(thread.lead_m)}, found {found}",
        (Label(thread.span, "its thread is stated here"),),
        notes=("seen from above a cap is turned to the left to come off, to the right to go on",),
    )


def _screw(draft: Draft) -> Turn | None:
    action = draft.action
    if not isinstance(action, MoveTo) or action.path != "screw":
        return None
    return action.along if isinstance(action.along, Turn) else None
