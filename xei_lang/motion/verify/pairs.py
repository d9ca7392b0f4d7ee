"""Which pairs of bodies to look at, which of them may touch, and how far each can move: as arrays, one row a
pair."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.motion.verify.bodies import Bodies, group_links, to_frame
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.timeline import Held, Phase, Scene

Pair = tuple[str, str]
Rows = NDArray[np.int64]
Mask = NDArray[np.bool_]


class Pairs:
    """All pairs that any phase may need: link and link (but for SRDF's disabled ones), link and object, and
    objects of which one is held at some time. `first` and `second` index `names`; links come before objects.

    `arrange` makes what depends on the scene: `between` (pairs, joints) says which joints move the two
    against each other, `weights` bounds by how much a point moves per unit of each of these joints,
    `eligible` leaves out what nobody holds.
    """

    def __init__(self, bodies: Bodies, graph: MotionGoalGraph, held: frozenset[str], srdf_text: str) -> None:
        self.bodies, self.robot = bodies, bodies.robot
        every = bodies.bodies.values()
        links = [body.name for body in every if body.is_link]
        objects = [body.name for body in every if not body.is_link]
        self.names = (*links, *objects)
        self.pairs: list[Pair] = [pair for pair in combinations(links, 2) if pair not in bodies.disabled]
        self.pairs += [(link, name) for link in links for name in objects]
        self.pairs += [(a, b) for a, b in combinations(objects, 2) if a in held or b in held]
        self.row = {pair: row for row, pair in enumerate(self.pairs)}
        index = {name: k for k, name in enumerate(self.names)}
        self.first = np.array([index[a] for a, _ in self.pairs], dtype=np.int64)
        self.second = np.array([index[b] for _, b in self.pairs], dtype=np.int64)
        self.radii = np.array([bodies.bodies[name].radius for name in self.names])
        self._index = index
        self._links = len(links)
        self._groups = group_links(srdf_text, self.robot)
        self._granted = {goal.id: self._spread(goal.allowed_contacts) for goal in graph.goals}
        self._fixed_levers = np.array([self._link_lever(name) for name in links])
        self.carriers: dict[str, Held] = {}
        self.between: Mask = np.zeros((0, 0), dtype=np.bool_)
        self.weights: Array = np.zeros((0, 0))
        self.eligible: Mask = np.zeros(0, dtype=np.bool_)

    def arrange(self, scene: Scene) -> None:
        """Take over who holds what."""
        self.carriers = {held.object: held for held in scene.held}
        levers = np.zeros((len(self.names), self.robot.size))
        chains = np.zeros((len(self.names), self.robot.size), dtype=np.bool_)
        levers[: self._links] = self._fixed_levers
        for k, name in enumerate(self.names):
            held = self.carriers.get(name)
            link = name if k < self._links else held.link if held is not None else None
            if link is not None:
                chains[k, list(self.robot.columns(link))] = True
            if held is not None:
                body = self.bodies.bodies[name]
                reach = float(np.linalg.norm(body.center)) + body.radius
                reach += float(np.linalg.norm(held.T_link_object.position_m))
                levers[k] = self.robot.lever(held.link, reach)
        carried = np.array([name in self.carriers for name in self.names])
        self.between = chains[self.first] ^ chains[self.second]
        self.weights = (levers[self.first] + levers[self.second]) * self.between
        loose = (self.first >= self._links) & ~carried[self.first] & ~carried[self.second]
        self.eligible = ~loose

    def _link_lever(self, name: str) -> Array:
        body = self.bodies.bodies[name]
        return self.robot.lever(name, float(np.linalg.norm(body.center)) + body.radius)

    def forbidden(self, phase: Phase, active: Mask) -> Rows:
        """Rows of the pairs that a phase must keep apart: those that its joints move against each other and
        that nothing allows to touch. At a single instant, where no joint moves: all, the base against what
        stands around it too."""
        wanted = self.eligible.copy()
        if len(phase.times) > 1:
            wanted &= (self.between & active).any(axis=1)
        for pair in self.allowed(phase):
            if pair in self.row:
                wanted[self.row[pair]] = False
        return np.flatnonzero(wanted)

    def allowed(self, phase: Phase) -> frozenset[Pair]:
        """Contacts that both the plan and the graph allow to a goal that runs, a held object with its own
        fingers, and with what rides on it."""
        pairs: list[Pair] = []
        for goal in phase.running:
            granted = self._granted.get(goal.id, frozenset[Pair]())
            pairs += [pair for pair in self._spread(goal.allowed_contacts) if pair in granted]
        for held in phase.scene.held:
            if held.rides_on:
                together = (
                    other for other in phase.scene.held if held.rides_on in (other.object, other.rides_on)
                )
                pairs += [(held.object, other.object) for other in together]
            else:
                pairs += [(finger, held.object) for finger in self.robot.fingers(held.link)]
        return frozenset([*pairs, *((b, a) for a, b in pairs)])

    def _spread(self, contacts: tuple[Pair, ...]) -> frozenset[Pair]:
        spread: list[Pair] = []
        for a, b in contacts:
            firsts, seconds = self._groups.get(a, (a,)), self._groups.get(b, (b,))
            spread += [(x, y) for x in firsts for y in seconds]
        return frozenset([*spread, *((b, a) for a, b in spread)])

    def centers(self, q: Array, scene: Scene) -> Array:
        """Centres of all bounding spheres in the base (configurations, bodies, 3)."""
        carriers = tuple(dict.fromkeys(held.link for held in self.carriers.values()))
        links = self.names[: self._links]
        frames = self.robot.frames(q, tuple(dict.fromkeys((*links, *carriers))))
        centers = np.zeros((len(q), len(self.names), 3))
        for k, name in enumerate(self.names):
            center = self.bodies.bodies[name].center
            if k >= self._links and name not in self.carriers:
                rotation, origin = to_frame(scene.objects[name])
                centers[:, k] = rotation @ center + origin
                continue
            if name in self.carriers:
                rotation, origin = to_frame(self.carriers[name].T_link_object)
                center = rotation @ center + origin
            link = name if k < self._links else self.carriers[name].link
            rotations, origins = frames[link]
            centers[:, k] = rotations @ center + origins
        return centers

    def gaps(self, centers: Array, rows: Rows, scene: Scene) -> Array:
        """Lower bounds on the distances (configurations, rows): sphere to sphere, or sphere to the box of
        what stands."""
        a, b = self.first[rows], self.second[rows]
        difference = centers[:, a] - centers[:, b]
        gaps = np.sqrt(np.einsum("nij,nij->ni", difference, difference)) - self.radii[a] - self.radii[b]
        for name in dict.fromkeys(self.pairs[int(row)][1] for row in rows.tolist()):
            body = self.bodies.bodies[name]
            if name in self.carriers or body.is_link:
                continue
            places = np.flatnonzero(b == self._index[name])
            rotation, origin = to_frame(scene.objects[name])
            local = (centers[:, a[places]] - origin) @ rotation
            outside = np.maximum(np.maximum(body.low - local, local - body.high), 0.0)
            wide = np.sqrt(np.einsum("nij,nij->ni", outside, outside)) - self.radii[a[places]]
            gaps[:, places] = np.maximum(gaps[:, places], wide)
        return gaps
