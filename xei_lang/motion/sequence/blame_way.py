"""Why a way is blocked: what meets on it, and what was found to help by trying it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.goals import Attach, Detach, JointTarget, MotionGoal, MoveTo, SlideMove
from xei_lang.ir.world import WorldObject
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import BlockedTransit
from xei_lang.motion.sequence.fixed import plan_fixed
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.transit import plan_transit, worst_tilt

Again = Callable[[Snapshot], Motion | PathBlocked]
"""Plans the blocked move from another snapshot: what a help promises is tried first."""

_WHERE = {
    "start": "they touch before the move begins",
    "goal": "they would touch where the move ends",
    "between": "they meet on the straight way, and no way around them was found",
}


def blame_path(context: Context, goal: MotionGoal, blocked: PathBlocked, before: Snapshot) -> Diagnostic:
    """A move to a named configuration, or of the slide, whose way is blocked."""
    return _blocked(context, goal, blocked, before, lambda other: plan_fixed(context, goal, other))


def blame_transit(context: Context, failure: BlockedTransit) -> Diagnostic:
    """A move to a family whose way is blocked; where the hand must stay upright, how far it would tilt on a
    free way.
    """

    def again(other: Snapshot, upright: bool = True) -> Motion | PathBlocked:
        return plan_transit(context, failure.layer, failure.index, other, upright)

    said = _blocked(context, failure.goal, failure.blocked, failure.before, again)
    action = failure.goal.action
    held = failure.before.held.get(failure.layer.chain.arm)
    if not isinstance(action, MoveTo) or not action.keep_upright or held is None:
        return said
    bound = math.degrees(context.profile.calibration.spill_tilt_rad)
    notes = (f"`{held.object}` may tilt by {bound:.3g} deg: `spill_tilt` of the calibration profile",)
    tilted = again(failure.before, upright=False)
    if isinstance(tilted, Motion):
        worst = math.degrees(worst_tilt(context, tilted))
        notes += (f"without that bound there is a way, which tilts it by {worst:.0f} deg",)
    return replace(said, notes=(*said.notes, *notes))


def _blocked(
    context: Context, goal: MotionGoal, blocked: PathBlocked, before: Snapshot, again: Again
) -> Diagnostic:
    if blocked.bodies is None:
        message, notes = f"{who(goal)} finds no way to {_whither(goal)}", (
            "the straight way leaves the range of the joints, and no other was found",
        )  # fmt: skip
    else:
        first, second = blocked.bodies
        message, notes = f"the way of {who(goal)} is blocked: `{first}` would touch `{second}`", (
            _WHERE[blocked.where],
            "bodies touch where the goal does not allow it, measured on the profile's collision shapes",
        )  # fmt: skip
    return Diagnostic(
        "XEI0803",
        message,
        goal.span,
        f"no free path to {_whither(goal)}",
        notes=notes,
        help=_help(context, blocked.bodies or (), before, again),
    )


def _help(context: Context, bodies: tuple[str, ...], before: Snapshot, again: Again) -> tuple[str, ...]:
    """What opens the way, tried: one of the bodies gone, or the arm that it belongs to at `ready`."""
    found: list[str] = []
    for name in bodies:
        item = context.world.find(name)
        if item is None or name not in before.standing:
            continue
        if isinstance(again(before.without(name)), Motion):
            found.append(f"without `{name}` there is a way: {_mend(item, before)} first")
    for side, arm in context.robot.arms.items():
        if any(name.startswith(f"openarm_{side}") for name in bodies) and side not in before.held:
            q, ready = before.q.copy(), context.robot.configuration("ready")
            q[list(arm.q_indices)] = ready[list(arm.q_indices)]
            if (q != before.q).any() and isinstance(again(before.moved(q)), Motion):
                found.append(f"with the {side} arm at `ready` there is a way: move that arm away first")
    return tuple(found)


def _mend(item: WorldObject, before: Snapshot) -> str:
    if item.name in before.riding:
        return f"unscrew it from `{before.riding[item.name].carrier}`"
    return "move it away" if item.movable else "check where the usage profile says it stands"


def who(goal: MotionGoal) -> str:
    """What moves in a goal, in words."""
    action = goal.action
    if isinstance(action, MoveTo) and action.arm is not None:
        return f"the {action.arm} arm"
    if isinstance(action, SlideMove):
        return "the slide"
    if isinstance(action, (Attach, Detach)):
        return f"the {action.arm} arm"
    return "the arms"


def _whither(goal: MotionGoal) -> str:
    action = goal.action
    if isinstance(action, MoveTo):
        target = action.target
        return f"`{target.name}`" if isinstance(target, JointTarget) else f"`{target.family}`"
    if isinstance(action, SlideMove):
        return mm(action.height_m)
    return "its goal"


def mm(metres: float) -> str:
    """A length as people read it."""
    return f"{metres * 1000:.0f} mm"
