"""The giver's grasp and the taker's, chosen together: how an object is held out counts only if the other hand
finds a grasp on it there that serves in all that this hand does with it later.

It is asked of one candidate of the giver at a time, cheapest first. Most fall by a look at the two arms
alone, at the same slide height; of the others a few of the taker's candidates are gone through as a whole,
with how the giver parts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from xei_lang.ir.goals import Action, Attach, Detach, MotionGoal
from xei_lang.ir.skill_plan import Side
from xei_lang.motion.sequence.candidates import Effort, enumerate_layer, slide_heights
from xei_lang.motion.sequence.choose import Array, Bools
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.parting import Parting
from xei_lang.motion.sequence.poses import Ints, orbits
from xei_lang.motion.sequence.rehearse import Rehearsal, rehearse_group
from xei_lang.motion.sequence.sections import Chain, Group, Part
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Snapshot
from xei_lang.motion.sequence.sound import first_touch
from xei_lang.motion.sequence.space import Pair, scene_of

WIDE = Effort(5, 10_000, 5, 0)
"""All grasps, at few heights and in few postures."""
LOOKS = 6
"""How many of the taker's candidates are gone through as a whole for one of the giver's."""
MAX_LOOKS = 120
"""How many in a whole search: after that nothing is taken for possible any more."""
_BLOCK = 16


@dataclass(frozen=True, slots=True)
class Encounter:
    """What follows when an object has been held out: the group that begins with its taking by the other hand,
    the state before it as far as that is known, how the giver then parts, and the chains after the group in
    which the taker still holds it.
    """

    giver: Side
    group: Group
    before: Snapshot
    parting: Parting | None
    later: tuple[Rehearsal, ...]


def takes_over(part: Part, giver: Side, thing: str) -> bool:
    """Whether a part begins with the other hand's taking of what the giver holds."""
    if not isinstance(part, Group) or part.arm == giver:
        return False
    attach = part.chains[0].attach
    return attach is not None and attach.object == thing


class Meeting:
    """An encounter with the taker's candidates at each slide height; made anew for each search."""

    def __init__(self, context: Context, encounter: Encounter) -> None:
        self.context, self.encounter = context, encounter
        self.taker: Side = encounter.group.arm
        self.chain = encounter.group.chains[0]
        self._apart = _giver_aside(context, encounter)
        self._serving: Bools | None = None
        self._layers: dict[float, Layer] = {}
        self._looks = 0

    def allows(self, held_out: Layer, index: int) -> bool:
        """Whether the taker finds a grasp when the giver stands as this candidate does at its last target."""
        giver, q = held_out.chain.arm, held_out.q[index, -1]
        before = self.encounter.before.moved(self.context.lift(self.encounter.before.q, giver, q))
        layer = self._layer(float(q[0]))
        picked = self._clear(layer, _held_by(before, giver, UNCHOSEN))
        if not picked or self._looks >= MAX_LOOKS:
            return False
        before = _held_by(before, giver, int(held_out.member[index]))
        rehearsal = rehearse_group(self.context, self.encounter.group, before)[0]
        for row in picked[: MAX_LOOKS - self._looks]:
            self._looks += 1
            if first_touch(self.context, rehearsal, layer, row, self.encounter.parting) is None:
                return True
        return False

    def _clear(self, layer: Layer, before: Snapshot) -> list[int]:
        """The cheapest rows of different grasps in which the arms touch nothing, the object left aside."""
        moments = rehearse_group(self.context, self.encounter.group, before)[0].moments
        order = np.argsort(layer.cost, kind="stable")
        found: list[int] = []
        members: set[int] = set()
        for first in range(0, len(order), _BLOCK):
            rows = order[first : first + _BLOCK]
            for target in _key_first(len(moments)):
                moment = moments[target]
                scene = scene_of(self.context, moment.snapshot, moment.goal.allowed_contacts, self.taker)
                whole = self.context.lift(moment.snapshot.q, self.taker, layer.q[rows, target])
                rows = rows[~scene.in_collision_many(whole)]
            for row in rows.tolist():
                if int(layer.member[row]) not in members:
                    members.add(int(layer.member[row]))
                    found.append(row)
            if len(found) >= LOOKS:
                break
        return found[:LOOKS]

    def _layer(self, height_m: float) -> Layer:
        """The taker's candidates at a slide height, the giver's arm left aside."""
        if height_m not in self._layers:
            heights = np.array([height_m])
            self._layers[height_m] = self._enumerate(self._rehearsals()[0], heights, self._serve())
        return self._layers[height_m]

    def _rehearsals(self) -> tuple[Rehearsal, ...]:
        return rehearse_group(self.context, self.encounter.group, self.encounter.before)

    def _serve(self) -> Bools:
        """The members with which the taker can do all that it does with the object afterwards."""
        if self._serving is None:
            self._serving = np.ones(len(self.chain.family.members), dtype=np.bool_)
            for rehearsal in (*self._rehearsals()[1:], *self.encounter.later):
                if rehearsal.chain.family.id != self.chain.family.id or not self._serving.any():
                    continue
                heights = slide_heights(
                    self.context, float(rehearsal.before.q[self.context.robot.slide_index]), WIDE
                )
                layer = self._enumerate(
                    rehearsal, heights if rehearsal.chain.slide_free else heights[:1], self._serving
                )
                self._serving &= shown(rehearsal.chain, layer.member)
        return self._serving

    def _enumerate(self, rehearsal: Rehearsal, heights: Array, allowed: Bools) -> Layer:
        scenes = [
            scene_of(self.context, moment.snapshot, (*moment.goal.allowed_contacts, *self._apart), self.taker)
            for moment in rehearsal.moments
        ]

        def touches(target: int, q: Array) -> Bools:
            whole = self.context.lift(rehearsal.moments[target].snapshot.q, self.taker, q)
            return scenes[target].in_collision_many(whole)

        return enumerate_layer(self.context, rehearsal.chain, heights, allowed, touches, WIDE)


def taken_from(parts: tuple[Part, ...], index: int) -> int | None:
    """The part in which the other hand took in hand what the part of this index takes from it, or None."""
    part = parts[index]
    attach = part.chains[0].attach if isinstance(part, Group) else None
    if attach is None:
        return None
    held: dict[Side, tuple[str, int]] = {}
    for number, earlier in enumerate(parts[:index]):
        for action in _actions(earlier):
            if isinstance(action, Attach):
                held[action.arm] = (action.object, number)
            elif isinstance(action, Detach):
                held.pop(action.arm, None)
    return next(
        (where for side, (name, where) in held.items() if name == attach.object and side != attach.arm), None
    )


def _actions(part: Part) -> list[Action]:
    if isinstance(part, MotionGoal):
        return [part.action]
    goals = ((item,) if isinstance(item, MotionGoal) else item.goals for item in part.items)
    return [goal.action for some in goals for goal in some]


def _held_by(before: Snapshot, giver: Side, member: int) -> Snapshot:
    """The state with the giver's grasp chosen; one that is not leaves the object out of what may touch."""
    return before.attached(giver, replace(before.held[giver], member=member))


def shown(chain: Chain, members: Ints) -> Bools:
    """The members of a chain's family that show a grasp which one of these shows: no other may go with it."""
    names = orbits(chain.family) if chain.turns else np.arange(len(chain.family.members))
    return np.isin(names, names[members])


def _key_first(count: int) -> list[int]:
    """The targets in the order in which most fall: the grasp first."""
    return sorted(range(count), key=lambda target: (target != 1, target))


def _giver_aside(context: Context, encounter: Encounter) -> tuple[Pair, ...]:
    """Contacts of the giver's arm with the taker's: where the giver will stand is not known yet."""
    names = sorted({str(frame.name) for frame in context.robot.model.frames})
    arms = {
        side: [name for name in names if name.startswith(f"openarm_{side}_")] for side in context.robot.arms
    }
    return tuple((a, b) for a in arms[encounter.giver] for b in arms[encounter.group.arm])
