"""Why motion planning failed, told at the step that asked for it: which object, which arm, what is in the
way, what would help.
"""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic
from xei_lang.motion.sequence.assemble import Untimed
from xei_lang.motion.sequence.blame_way import blame_transit, mm, who
from xei_lang.motion.sequence.census import Census, take_census
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import BlockedTransit, Failure, Unplaced
from xei_lang.motion.sequence.reach import nearest_reach, reach_help
from xei_lang.motion.sequence.sections import Chain
from xei_lang.motion.sequence.winnow import MAX_STRIKES

_SHOWN_BODIES = 4
_GIVEN_UP = (f"the search ended when {MAX_STRIKES} candidates had failed on their whole way",)


def blame_group(context: Context, failure: Failure) -> Diagnostic:
    """A chain that found no candidate, or a transit that found no path."""
    if isinstance(failure, BlockedTransit):
        return blame_transit(context, failure)
    if failure.unfit is not None:
        return _unfit(context, failure, *failure.unfit)
    census = take_census(context, failure)
    if census.within_limits == 0:
        return _unreachable(context, failure, census)
    return _crowded(failure, census)


def _unreachable(context: Context, failure: Unplaced, census: Census) -> Diagnostic:
    chain = failure.rehearsal.chain
    reach = nearest_reach(context, failure.rehearsal)
    notes = [_counted(census)]
    if reach.shortfall_m > 0.0:
        notes.append(
            f"the nearest grasp is {mm(reach.shortfall_m)} out of reach,"
            f" with the slide at {mm(reach.slide_m)}"
        )
    else:
        notes.append("the place is near enough, but every posture of the arm passes a joint limit")
    return Diagnostic(
        "XEI0801",
        f"the {chain.arm} arm cannot reach {_subject(chain)}",
        chain.head.span,
        "no grasp of it is in reach",
        notes=tuple(notes),
        help=reach_help(context, failure.rehearsal),
    )


def _unfit(context: Context, failure: Unplaced, thing: str, other: str) -> Diagnostic:
    chain, item = failure.rehearsal.chain, context.world.find(other)
    away = item is not None and item.movable
    return Diagnostic(
        "XEI0802",
        f"no grasp brings the {chain.arm} hand to {_subject(chain)}: `{thing}` itself would touch `{other}`",
        chain.head.span,
        f"`{thing}` is not free of contact on the way in, or there",
        notes=(
            "whichever way it is held: measured on the profile's collision shapes, with the clearance of the"
            " calibration profile",
        ),
        help=(f"choose a place farther from `{other}`, or move `{other}` away first",)
        if away
        else (f"choose a place farther from `{other}`",),
    )


def _crowded(failure: Unplaced, census: Census) -> Diagnostic:
    chain = failure.rehearsal.chain
    hit = [f"`{name}`" for name, _ in census.bodies[:_SHOWN_BODIES]]
    between = f": every grasp in reach touches {_listed(hit, 'or')}" if hit else ""
    return Diagnostic(
        "XEI0802",
        f"no grasp brings the {chain.arm} hand to {_subject(chain)}{between}",
        chain.head.span,
        "no grasp is free of contact on the whole way in and out",
        notes=(
            _counted(census),
            "a grasp must be in reach and free of contact on the way in, at the place and on the way out,"
            " at one slide height",
            *(_GIVEN_UP if failure.given_up else ()),
        ),
        help=_room_help(chain, census),
    )


def _room_help(chain: Chain, census: Census) -> tuple[str, ...]:
    if not census.neighbours:
        return ()
    name = census.neighbours[0]
    if chain.detach is not None:
        return (f"choose a place farther from `{name}`, or move `{name}` away first",)
    return (f"move `{name}` away first",)


def _counted(census: Census) -> str:
    parts: list[str] = []
    if census.out_of_reach:
        parts.append(f"{census.out_of_reach} {_are(census.out_of_reach)} out of reach")
    if census.past_limits:
        parts.append(f"{census.past_limits} would pass a joint limit")
    parts.extend(
        f"{count} touch `{name}`" if count > 1 else f"1 touches `{name}`" for name, count in census.bodies
    )
    if census.off_line:
        leave = "leaves" if census.off_line == 1 else "leave"
        parts.append(f"{census.off_line} {leave} a joint's range on the way")
    if census.untaken:
        parts.append(
            f"{census.untaken} would do here alone, but not where the object is taken or handled next"
        )
    if not parts:
        return f"of {census.total} grasps none is left"
    return f"of {census.total} grasps {_listed(parts, 'and')}"


def _are(count: int) -> str:
    return "is" if count == 1 else "are"


def blame_timing(context: Context, failed: Untimed) -> Diagnostic:
    """A path that no speed makes feasible."""
    goal, failure = failed.goal, failed.failure
    if not failure.joint:
        return Diagnostic(
            "XEI0804",
            f"no timing of {who(goal)} keeps its limits",
            goal.span,
            failure.reason,
            notes=("limits: planning limits of the calibration profile",),
        )
    unit = "N" if failure.joint == context.slide_joint else "N m"
    return Diagnostic(
        "XEI0804",
        f"`{failure.joint}` is not strong enough for this move",
        goal.span,
        f"expected at most {failure.limit:.1f} {unit}, found {failure.value:.1f} {unit} only to hold still",
        notes=(failure.reason, "limits: planning limits of the calibration profile"),
        help=("carry less, or keep the load nearer to the body",),
    )


def _subject(chain: Chain) -> str:
    """What a chain is about: the object that it takes, or the place that it sets one down in."""
    if chain.detach is not None:
        return f"`{chain.detach.place}` with `{chain.detach.object}`"
    if chain.attach is not None:
        return f"`{chain.attach.object}`"
    return f"`{chain.family.reference}`"


def _listed(parts: list[str], word: str) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {word} {parts[-1]}"
