"""Why an object cannot be carried: no way of holding it that serves at its carry pose, or no upright way
there; and objects that are tilted before a move that must keep them upright.
"""

from __future__ import annotations

import math

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.motion.sequence.blame_way import blame_transit
from xei_lang.motion.sequence.census import take_census
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import Failure, Unplaced
from xei_lang.motion.sequence.rehearse import rehearse
from xei_lang.motion.sequence.sections import Group
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.transit import keeps_upright
from xei_lang.motion.sequence.upright import tilt


def blame_carry(context: Context, failure: Failure) -> Diagnostic | None:
    """What keeps a held object from its carry pose; None where another move failed."""
    chain = (failure.rehearsal if isinstance(failure, Unplaced) else failure.layer).chain
    pose = next((item for item in chain.head.parameters if item.name == "carry_pose"), None)
    if pose is None:
        return None
    thing = chain.family.reference
    return Diagnostic(
        "XEI0808",
        f"the {chain.arm} arm cannot bring `{thing}` to its carry pose",
        chain.head.span,
        f"`{thing}` would be in the {chain.arm} hand here",
        (Label(pose.span, f"carry pose of the {chain.arm} arm"),) if pose.span is not None else (),
        notes=(
            *_counted(context, failure),
            "what a hand holds is carried upright: a named configuration would tilt it",
        ),
        help=(
            f"set `{thing}` down before this step,"
            f" or state another place under `carry: {chain.arm}:` in the calibration profile",
        ),
    )


def _counted(context: Context, failure: Failure) -> tuple[str, ...]:
    """Why each grasp fell, or what is met on the way of those that did not."""
    if not isinstance(failure, Unplaced):
        return blame_transit(context, failure).notes
    if failure.unfit is not None:
        return ("there, `{}` itself would touch `{}`, whichever way it is held".format(*failure.unfit),)
    census = take_census(context, failure)
    counts = [
        f"{count} {what}"
        for count, what in (
            (census.out_of_reach, "out of reach there"),
            (census.past_limits, "past a joint limit"),
            *((count, f"in contact with `{name}`") for name, count in census.bodies),
        )
        if count
    ]
    told = f": {', '.join(counts)}" if counts else ", though each chain by itself has some"
    return (f"of {census.total} grasps none serves where it is picked, carried and set down{told}",)


def refuse_tilted(context: Context, group: Group, now: Snapshot) -> Diagnostic | None:
    """A group whose first move must keep upright what is tilted already: no path could."""
    chain = group.chains[0]
    bound = context.profile.calibration.spill_tilt_rad
    if not keeps_upright(rehearse(context, chain, now)):
        return None
    columns = context.arm_indices(chain.arm)
    found = tilt(context, now, chain.arm, context.arm_joints(chain.arm), now.q[None, columns])
    if found <= bound:
        return None
    thing = now.held[chain.arm].object
    return Diagnostic(
        "XEI0809",
        f"`{thing}` is tilted before a move that must keep it upright",
        chain.head.span,
        f"expected at most {math.degrees(bound):.3g} deg, found {math.degrees(found):.3g} deg",
        notes=("bound: `spill_tilt` of the calibration profile",),
        help=("end the step before it with the object upright in the hand",),
    )
