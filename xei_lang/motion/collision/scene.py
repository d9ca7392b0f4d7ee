"""What touches what at a configuration, and whether a straight line in joint space is free."""

from __future__ import annotations

import importlib
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.collision.bodies import AttachedBody, Geometry, StaticBody, robot_links, scene_geometry
from xei_lang.motion.collision.edges import MARGINS_M, MotionBound, edge_is_free, motion_bound
from xei_lang.motion.collision.reach import Reach, reach_of
from xei_lang.motion.robot import Array, Robot

pin: Any = importlib.import_module("pinocchio")  # ships no type information


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies that touch, by name: an object's name or a link's name of the URDF."""

    body_a: str
    body_b: str


@dataclass(frozen=True, slots=True)
class _Engine:
    """The compiled scene. Placements, margins and results are overwritten by every query: one thread at a
    time. The bound is made when an edge is first asked for: many scenes are asked for configurations only.
    """

    geometry: Geometry
    data: Any
    joints: Any
    broad_phase: Any
    padding: Array
    checked: NDArray[np.bool_]
    bounds: list[MotionBound] = field(default_factory=list[MotionBound])

    def bound(self, robot: Robot) -> MotionBound:
        """How far the bodies of checked pairs move against each other."""
        if not self.bounds:
            self.bounds.append(motion_bound(robot, self.geometry, self.checked))
        return self.bounds[0]


@dataclass(frozen=True, slots=True)
class CollisionScene:
    """A robot among bodies. Make one with `collision_scene`; variants share what they can and compile when
    first asked.

    Configurations `q` (nq,) are whole ones, fingers included: a hand's opening stands in `q`. Pairs in
    `allowed` may touch, as may the SRDF's disabled pairs, a held object and its fingers, what rides on a held
    object and that, and what no joint moves against each other. `padding_m` is kept between what stands and
    what moves.
    """

    robot: Robot
    standing: tuple[StaticBody, ...]
    attached: tuple[AttachedBody, ...]
    allowed: tuple[tuple[str, str], ...]
    padding_m: float
    _links: Any = field(repr=False, compare=False)
    _reach: Reach = field(repr=False, compare=False)
    _compiled: list[_Engine] = field(default_factory=list[_Engine], repr=False, compare=False)

    def with_attached(self, body: AttachedBody) -> CollisionScene:
        """The scene with an object in a hand; one that stood under the same name stands no more."""
        standing = tuple(other for other in self.standing if other.name != body.name)
        return self._changed(standing=standing, attached=(*self.attached, body))

    def with_standing(self, body: StaticBody) -> CollisionScene:
        """The scene with an object standing; one that a hand held under the same name is held no more."""
        attached = tuple(other for other in self.attached if other.name != body.name)
        return self._changed(standing=(*self.standing, body), attached=attached)

    def without(self, name: str) -> CollisionScene:
        """The scene without the object of this name, standing or held."""
        return self._changed(
            standing=tuple(body for body in self.standing if body.name != name),
            attached=tuple(body for body in self.attached if body.name != name),
        )

    def with_allowed(self, pairs: tuple[tuple[str, str], ...]) -> CollisionScene:
        """The scene in which these pairs of bodies may touch as well."""
        return self._changed(allowed=(*self.allowed, *pairs))

    def in_collision(self, q: Array) -> bool:
        """Whether any pair that may not touch does, padding included."""
        engine = self._engine()
        return bool(pin.computeCollisions(self.robot.model, engine.joints, engine.broad_phase, q, True))

    def in_collision_many(self, q: Array) -> NDArray[np.bool_]:
        """`in_collision` for rows (n, nq)."""
        return np.fromiter((self.in_collision(row) for row in q), dtype=np.bool_, count=len(q))

    def first_contact(self, q: Array) -> Contact | None:
        """The first pair in collision, in the order robot, standing, held; None where the configuration is
        free.
        """
        if not self.in_collision(q):
            return None
        engine = self._engine()
        pin.computeCollisions(self.robot.model, engine.joints, engine.geometry.model, engine.data, q, True)
        pairs = zip(engine.geometry.model.collisionPairs, engine.data.collisionResults, strict=True)
        return next((self._contact(engine, pair) for pair, result in pairs if result.isCollision()), None)

    def distance(self, q: Array) -> tuple[float, str, str]:
        """The least distance in metres between bodies that may not touch, padding left aside, and which they
        are.

        Negative where they overlap; infinite, without names, where there is no pair. Pairs that never come
        near each other are left aside.
        """
        engine = self._engine()
        if len(engine.geometry.model.collisionPairs) == 0:
            return float("inf"), "", ""
        index = pin.computeDistances(self.robot.model, engine.joints, engine.geometry.model, engine.data, q)
        contact = self._contact(engine, engine.geometry.model.collisionPairs[index])
        return float(engine.data.distanceResults[index].min_distance), contact.body_a, contact.body_b

    def edge_is_free(self, q_start: Array, q_end: Array) -> bool:
        """Whether the straight line between two configurations is free; see `edges.py` for what that
        certifies.
        """
        engine = self._engine()
        return edge_is_free(engine.bound(self.robot), q_start, q_end, self._is_clear)

    def edge_is_free_sampled(self, q_start: Array, q_end: Array, step_rad: float) -> bool:
        """Whether samples at most `step_rad` apart in any joint are free: cheap, and blind between them."""
        count = max(1, int(np.ceil(np.abs(q_end - q_start).max() / step_rad)))
        return not any(self.in_collision(q_start + k / count * (q_end - q_start)) for k in range(count + 1))

    def _is_clear(self, q: Array, margin_m: float) -> bool:
        """Whether nothing is nearer than its padding and `margin_m`."""
        engine = self._engine()
        if margin_m == 0.0:
            return not self.in_collision(q)
        engine.data.setSecurityMargins(engine.geometry.model, engine.padding + margin_m, True, True)
        clear = not self.in_collision(q)
        engine.data.setSecurityMargins(engine.geometry.model, engine.padding, True, True)
        return clear

    def _changed(self, **fields: Any) -> CollisionScene:
        return replace(self, **fields, _compiled=[])

    def _contact(self, engine: _Engine, pair: Any) -> Contact:
        names = engine.geometry.names
        return Contact(names[int(pair.first)], names[int(pair.second)])

    def _engine(self) -> _Engine:
        if not self._compiled:
            self._compiled.append(self._compile())
        return self._compiled[0]

    def _compile(self) -> _Engine:
        geometry = scene_geometry(self.robot, self._links, self.standing, self.attached)
        checked = self._checked_pairs(geometry)
        asked = checked & self._reach.may_meet(geometry, self.padding_m + max(MARGINS_M))
        geometry.model.setCollisionPairs(asked, True)
        data = pin.GeometryData(geometry.model)
        still = geometry.joint == 0
        padding = self.padding_m * (still[:, None] ^ still[None, :])
        data.setSecurityMargins(geometry.model, padding, True, True)
        broad_phase = pin.BroadPhaseManager_DynamicAABBTreeCollisionManager(
            self.robot.model, geometry.model, data
        )
        return _Engine(geometry, data, self.robot.model.createData(), broad_phase, padding, checked)

    def _checked_pairs(self, geometry: Geometry) -> NDArray[np.bool_]:
        """Upper triangle (g, g) of pairs that may not touch."""
        ignored = {frozenset(pair) for pair in (*self.robot.disabled_pairs, *self.allowed)}
        for body in self.attached:
            ignored |= self._own_contacts(body)
        order = {name: index for index, name in enumerate(dict.fromkeys(geometry.names))}
        may_not_touch = np.ones((len(order), len(order)), dtype=np.bool_)
        for pair in ignored:
            known = [order[name] for name in pair if name in order]
            if len(known) == 2:
                may_not_touch[known[0], known[1]] = may_not_touch[known[1], known[0]] = False
        np.fill_diagonal(may_not_touch, False)
        body = np.array([order[name] for name in geometry.names])
        apart = (
            (geometry.joint[:, None] != geometry.joint[None, :])
            | geometry.held[:, None]
            | geometry.held[None, :]
        )
        return np.triu(may_not_touch[body[:, None], body[None, :]] & apart, 1)

    def _own_contacts(self, body: AttachedBody) -> set[frozenset[str]]:
        """What may touch an attached body because of how it is attached."""
        if not body.rides_on:
            fingers = (f"openarm_{body.side}_{finger}_finger" for finger in ("left", "right"))
            return {frozenset((body.name, finger)) for finger in fingers}
        together = (item.name for item in self.attached if body.rides_on in (item.name, item.rides_on))
        return {frozenset((body.name, name)) for name in together if name != body.name}


def collision_scene(
    robot: Robot,
    standing: tuple[StaticBody, ...] = (),
    attached: tuple[AttachedBody, ...] = (),
    allowed: tuple[tuple[str, str], ...] = (),
    padding_m: float = 0.0,
) -> CollisionScene:
    """A scene around the robot; `padding_m` is the distance to keep between what moves and what stands."""
    links = robot_links(robot)
    return CollisionScene(robot, standing, attached, allowed, padding_m, links, reach_of(robot, links))
