"""Predicates over a goal and the current state that must hold before the goal may run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from xei_lang.ir.goals import Attach, Detach, MotionGoal, MotionGoalGraph, NavToPose, SetDo, in_hand
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import TimedGoal
from xei_lang.profiles.model import Profile
from xei_lang.runtime.failure import Failure, failure
from xei_lang.runtime.state import RunState

START_TOLERANCE = 1e-4
"""How far (rad, m) a joint may be from where its trajectory starts; a rigid plan starts exactly there."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A goal about to start: the state it meets, the goals that are still running, and all goals."""

    goal: MotionGoal
    timed: TimedGoal
    state: RunState
    running: tuple[TimedGoal, ...]
    profile: Profile
    graph: MotionGoalGraph


def _epoch(now: Moment) -> Failure | None:
    if now.goal.epoch == now.state.epoch:
        return None
    return _fail(
        "XEI0910",
        f"goal `{now.goal.id}` belongs to stand {now.goal.epoch} of the base, "
        f"which is at stand {now.state.epoch}",
        now,
    )


def _resources_free(now: Moment) -> Failure | None:
    for other in now.running:
        shared = [name for name in now.timed.resources if name in other.resources]
        if shared:
            return _fail(
                "XEI0910", f"goal `{now.goal.id}` needs `{shared[0]}`, which `{other.id}` still uses", now
            )
        if isinstance(now.goal.action, NavToPose) and other.joints:
            return _fail("XEI0910", f"the base may not drive while `{other.id}` moves joints", now)
    return None


def _start_position(now: Moment) -> Failure | None:
    if now.timed.samples is None or not now.timed.samples.positions:
        return None
    for joint, start in zip(now.timed.joints, now.timed.samples.positions[0], strict=True):
        current = now.state.joints.get(joint)
        if current is None:
            return _fail("XEI0910", f"the position of `{joint}` is not known", now)
        if abs(current - start) > START_TOLERANCE:
            return _fail(
                "XEI0910",
                f"`{joint}` is at {current:.4f} and goal `{now.goal.id}` starts at {start:.4f}",
                now,
            )
    return None


def _limits_at_start(now: Moment) -> Failure | None:
    limits = {limit.joint: limit for limit in now.profile.calibration.limits}
    for joint in now.timed.joints:
        limit, current = limits.get(joint), now.state.joints.get(joint)
        if limit and current is not None and not limit.lower - 1e-6 <= current <= limit.upper + 1e-6:
            return _fail(
                "XEI0910",
                f"`{joint}` is at {current:.4f}, outside its limits {limit.lower:.4f} .. {limit.upper:.4f}",
                now,
            )
    return None


def _hand(now: Moment) -> Failure | None:
    match now.goal.action:
        case Attach(object=name, arm=arm):
            holder = next((side for side, held in now.state.holding.items() if held == name), None)
            if arm in now.state.holding:
                return _fail("XEI0911", f"the {arm} hand already holds `{now.state.holding[arm]}`", now)
            if holder and not _leaves(now, holder, arm):
                return _fail("XEI0911", f"`{name}` is in the {holder} hand", now)
            if arm not in now.state.closed:
                return _fail("XEI0911", f"the {arm} gripper is open where it should hold `{name}`", now)
        case Detach(object=name, arm=arm):
            held = now.state.holding.get(arm)
            if held != name:
                return _fail(
                    "XEI0911", f"the {arm} hand holds {f'`{held}`' if held else 'nothing'}, not `{name}`", now
                )
        case _:
            return _attached_is_held(now)
    return None


def _leaves(now: Moment, giver: str, taker: Side) -> bool:
    """Whether the hand that holds the object leaves it, next of all goals that let go of it, to the one that
    takes it.
    """
    assert isinstance(now.goal.action, Attach)
    name, found = now.goal.action.object, False
    for goal in now.graph.goals:
        if found and isinstance(goal.action, Detach) and goal.action.object == name:
            return goal.action.arm == giver and goal.action.place == in_hand(taker)
        found = found or goal.id == now.goal.id
    return False


def _attached_is_held(now: Moment) -> Failure | None:
    attached = [item.object for item in now.timed.attached]
    carried = now.state.carried()
    for name in attached:
        if name not in carried:
            return _fail(
                "XEI0911",
                f"goal `{now.goal.id}` was planned with `{name}` in the hand, and no hand holds it",
                now,
            )
    held = now.state.holding.get(now.timed.arm or "")
    if held and held not in attached and now.goal.kind == "move_to":
        return _fail(
            "XEI0911", f"goal `{now.goal.id}` was planned without `{held}`, which the hand holds", now
        )
    for rider, name in carried.items():
        if name in attached and rider not in attached:
            return _fail(
                "XEI0911", f"goal `{now.goal.id}` was planned without `{rider}`, which rides on `{name}`", now
            )
    return None


def _not_provisional(now: Moment) -> Failure | None:
    if now.goal.provisional and now.state.epoch not in now.state.perceived:
        return _fail(
            "XEI0912",
            f"goal `{now.goal.id}` was planned from a docking estimate and no perception has run "
            "since the drive",
            now,
        )
    return None


def _output_known(now: Moment) -> Failure | None:
    known = outputs(now.profile)
    if isinstance(now.goal.action, SetDo) and known and now.goal.action.output not in known:
        return _fail("XEI0915", f"`{now.goal.action.output}` is no output of this robot", now)
    return None


PRECHECKS: tuple[tuple[str, Callable[[Moment], Failure | None]], ...] = (
    ("epoch", _epoch),
    ("resources_free", _resources_free),
    ("limits_at_start", _limits_at_start),
    ("start_position", _start_position),
    ("hand", _hand),
    ("not_provisional", _not_provisional),
    ("output_known", _output_known),
)


def first_failure(now: Moment) -> tuple[list[str], Failure | None]:
    """The names of the prechecks that hold, in order, up to the first that does not."""
    passed: list[str] = []
    for name, check in PRECHECKS:
        found = check(now)
        if found:
            return passed, found
        passed.append(name)
    return passed, None


def outputs(profile: Profile) -> tuple[str, ...]:
    """The digital outputs that the skill bank offers as choices of an `output` argument; empty: any name."""
    named = (spec.arg("output") for spec in profile.bank.skills)
    return tuple(choice for spec in named if spec for choice in spec.choices)


def _fail(code: str, message: str, now: Moment) -> Failure:
    return failure("runtime_precheck", code, message, now.goal.span)
