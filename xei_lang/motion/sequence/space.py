"""Snapshots as collision scenes, asked by targets, motions and transits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.motion.collision import AttachedBody, CollisionScene, StaticBody
from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Carried, Snapshot

Array = NDArray[np.float64]
Pair = tuple[str, str]
_GLANCE_RAD = 0.08


@dataclass(frozen=True, slots=True)
class Touch:
    """A member whose motions fail: the two bodies that meet, or nothing where a straight line leaves a
    joint's range.
    """

    member: int
    bodies: Pair | None


def scene_of(
    context: Context, snapshot: Snapshot, allowed: tuple[Pair, ...], aside: Side | None = None
) -> CollisionScene:
    """The scene of a snapshot in the base frame, pairs in `allowed` left out; without what the hand `aside`
    holds and what rides on it. What two hands hold is carried by one of them: between them nothing moves.

    Scenes of equal content are one scene: compiling one takes longer than asking it a hundred questions.
    """
    shown = {side: held for side, held in snapshot.held.items() if side != aside and held.member != UNCHOSEN}
    hands: dict[str, Carried] = {item.object: item for item in replace(snapshot, held=shown).carried()}
    carried: tuple[Carried, ...] = tuple(hands.values())
    present = {*snapshot.standing, *hands}
    named = tuple(
        sorted({pair for pair in allowed if all(_is_present(context, name, present) for name in pair)})
    )
    content = (snapshot.T_world_base, tuple(snapshot.standing.items()), carried, named)
    return context.scenes.scene(content, lambda: _compose(context, snapshot, carried, named))


def _is_present(context: Context, name: str, objects: set[str]) -> bool:
    """Whether a body is in the scene: an object that is there, or anything that is no object (a link)."""
    return name in objects or context.world.find(name) is None


def _compose(
    context: Context,
    snapshot: Snapshot,
    carried: tuple[Carried, ...],
    allowed: tuple[Pair, ...],
) -> CollisionScene:
    scene = context.bare
    for name in snapshot.standing:
        item = context.world.find(name)
        if item is not None and item.geometry:
            scene = scene.with_standing(StaticBody(name, item.geometry, snapshot.T_base_object(name)))
    for one in carried:
        item = context.world.find(one.object)
        if item is not None and item.geometry:
            rides_on = "" if one.object == one.holds else one.holds
            body = AttachedBody(one.object, item.geometry, one.side, one.T_tool_object, rides_on)
            scene = scene.with_attached(body)
    return scene.with_allowed(allowed)


def touching(scene: CollisionScene, q: Array) -> Pair | None:
    """The first two bodies that touch at a configuration (nq,), or None."""
    contact = scene.first_contact(q)
    return None if contact is None else (contact.body_a, contact.body_b)


def target_check(context: Context, rehearsal: Rehearsal) -> Callable[[int, Array], Bools]:
    """Which configurations (n, 8) touch something at a target of a chain, what its hand holds left aside."""
    scenes = [
        scene_of(context, moment.snapshot, moment.goal.allowed_contacts, rehearsal.chain.arm)
        for moment in rehearsal.moments
    ]

    def touches(target: int, q: Array) -> Bools:
        whole = context.lift(rehearsal.moments[target].snapshot.q, rehearsal.chain.arm, q)
        return scenes[target].in_collision_many(whole)

    return touches


def target_contact(context: Context, rehearsal: Rehearsal, q: Array) -> Pair | None:
    """The first two bodies that touch at a chain's targets with the configurations q (targets, 8)."""
    for moment, row in zip(rehearsal.moments, q, strict=True):
        scene = scene_of(context, moment.snapshot, moment.goal.allowed_contacts, rehearsal.chain.arm)
        pair = touching(scene, context.lift(moment.snapshot.q, rehearsal.chain.arm, row))
        if pair is not None:
            return pair
    return None


def motion_contact(context: Context, motion: Motion) -> Pair | None:
    """The first two bodies that touch along a motion, looked at where its path has its breaks."""
    if motion.path is None:
        return None
    names = context.robot.joint_names
    path = motion.path
    s = path.breaks if len(path.breaks) > 2 else np.linspace(0.0, path.length, 5)
    whole = np.tile(motion.before.q, (len(s), 1))
    columns = [names.index(joint) for joint in path.joints]
    whole[:, columns] = path.evaluate(s, 0)
    for arm in context.robot.arms.values():
        first, second = arm.finger_indices
        whole[:, second] = whole[:, first]
    scene = scene_of(context, motion.before, motion.goal.allowed_contacts)
    hits = np.flatnonzero(scene.in_collision_many(whole))
    return None if len(hits) == 0 else touching(scene, whole[hits[0]])


@dataclass(frozen=True, slots=True)
class SceneSpace:
    """Free space of some joints, the others at rest: what `plan_free_path` moves in."""

    joints: tuple[str, ...]
    lower: Array
    upper: Array
    speed: Array
    scene: CollisionScene
    rest: Array
    columns: tuple[int, ...]

    def narrowed(self, q: Array, moving: list[int]) -> SceneSpace:
        """The space of some of these joints, by index, the others at rest in `q` (n,)."""
        names = tuple(self.joints[index] for index in moving)
        columns = tuple(self.columns[index] for index in moving)
        return SceneSpace(
            names,
            self.lower[moving],
            self.upper[moving],
            self.speed[moving],
            self.scene,
            self._whole(q),
            columns,
        )

    def is_free(self, q: Array) -> bool:
        """See `FreeSpace`."""
        return not self.scene.in_collision(self._whole(q))

    def edge_is_free(self, q_start: Array, q_end: Array) -> bool:
        """See `FreeSpace`."""
        return self.scene.edge_is_free(self._whole(q_start), self._whole(q_end))

    def looks_clear(self, q_start: Array, q_end: Array) -> bool:
        """Whether samples of the straight line touch nothing: a cheap guess at `edge_is_free`."""
        return self.scene.edge_is_free_sampled(self._whole(q_start), self._whole(q_end), _GLANCE_RAD)

    def any_contact(self, q: Array) -> bool:
        """Whether any of the configurations (m, n) touches something."""
        whole = np.tile(self.rest, (len(q), 1))
        whole[:, list(self.columns)] = q
        return any(self.scene.in_collision(row) for row in whole)

    def contact(self, q: Array) -> Pair | None:
        """See `FreeSpace`."""
        return touching(self.scene, self._whole(q))

    def _whole(self, q: Array) -> Array:
        whole = self.rest.copy()
        whole[list(self.columns)] = q
        return whole


def space_for(
    context: Context, snapshot: Snapshot, joints: tuple[str, ...], allowed: tuple[Pair, ...]
) -> SceneSpace:
    """The free space of `joints` within their planning limits, everything else as in the snapshot."""
    limits = context.limits_of(joints)
    names = context.robot.joint_names
    return SceneSpace(
        joints,
        np.array([row.lower for row in limits]),
        np.array([row.upper for row in limits]),
        np.array([row.velocity for row in limits]),
        scene_of(context, snapshot, allowed),
        snapshot.q,
        tuple(names.index(joint) for joint in joints),
    )
