"""No two bodies touch that may not, at any time: conservative advancement over the 1 kHz configurations.

Two bodies that are `d` apart cannot meet before their points have moved by `d` towards each other; how far points can have
moved is bounded by the joints' travel times their levers (`Robot.lever`). So each pair is measured, then left alone for as
long as that bound allows (Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996, ch. 2). Pairs that bounding
spheres keep apart through a whole phase are never measured. Between objects that nobody holds nothing is checked.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from itertools import combinations

import numpy as np

from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.bodies import Bodies, Body, group_links, to_frame
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.timeline import Phase, Scene

Pair = tuple[str, str]
_NODE_STRIDE = 16


@dataclass(slots=True)
class _Near:
    """A pair of bodies that spheres do not keep apart, with how far its points can have moved up to each time."""

    pair: Pair
    moved: Array


def check_clearance(context: Context) -> int:
    """Look at all phases; returns how many exact distances were measured."""
    return _Clearance(context).run()


class _Clearance:
    def __init__(self, context: Context) -> None:
        self.context, self.robot = context, context.robot
        self.bodies = Bodies(context.robot, context.about, context.world)
        self.groups = group_links(context.about.srdf_text, context.robot)
        self.links = tuple(body.name for body in self.bodies.bodies.values() if body.is_link)
        self.objects = tuple(body.name for body in self.bodies.bodies.values() if not body.is_link)
        self.goals = {goal.id: goal for goal in context.graph.goals}
        self.measured = 0
        self.bodies.add_pairs(self._possible())

    def _possible(self) -> list[Pair]:
        held = {h.object for phase in self.context.timeline.phases for h in phase.scene.held}
        pairs = [pair for pair in combinations(self.links, 2) if pair not in self.bodies.disabled]
        pairs += [(link, name) for link in self.links for name in self.objects]
        pairs += [(a, b) for a, b in combinations(self.objects, 2) if a in held or b in held]
        return pairs

    def run(self) -> int:
        for phase in self.context.timeline.phases:
            self._phase(phase)
        return self.measured

    def _phase(self, phase: Phase) -> None:
        if phase.new_scene:
            self.bodies.arrange(phase.scene)
        travel = np.zeros_like(phase.q)
        np.cumsum(np.abs(np.diff(phase.q, axis=0)), axis=0, out=travel[1:])
        active = travel[-1] > 0.0
        carriers = {held.object: held.link for held in phase.scene.held}
        if not active.any() and not (phase.new_scene and not carriers):
            return
        allowed = self._allowed(phase, carriers)
        pairs = [
            pair
            for pair in self._pairs(carriers)
            if pair not in allowed and self._relative(pair, carriers, active)
        ]
        near = self._sift(phase, pairs, carriers, travel)
        self._advance(phase, near)

    def _columns(self, name: str, carriers: dict[str, str]) -> tuple[int, ...]:
        link = name if self.bodies.bodies[name].is_link else carriers.get(name)
        return self.robot.columns(link) if link is not None else ()

    def _pairs(self, carriers: dict[str, str]) -> list[Pair]:
        pairs = [pair for pair in combinations(self.links, 2) if pair not in self.bodies.disabled]
        pairs += [(link, name) for link in self.links for name in self.objects]
        pairs += [(a, b) for a, b in combinations(self.objects, 2) if a in carriers or b in carriers]
        return pairs

    def _relative(self, pair: Pair, carriers: dict[str, str], active: Array) -> bool:
        between = self._between(pair, carriers)
        return any(active[column] for column in between) if active.any() else bool(between)

    def _between(self, pair: Pair, carriers: dict[str, str]) -> tuple[int, ...]:
        a, b = (self._columns(name, carriers) for name in pair)
        return tuple(column for column in (*a, *b) if (column in a) != (column in b))

    def _allowed(self, phase: Phase, carriers: dict[str, str]) -> frozenset[Pair]:
        """Contacts that both the plan and the graph allow to a goal that runs, and a held object with its own fingers."""
        pairs: list[Pair] = []
        for goal in phase.running:
            planned = self.goals.get(goal.id)
            granted = self._spread(planned.allowed_contacts) if planned is not None else frozenset()
            pairs += [pair for pair in self._spread(goal.allowed_contacts) if pair in granted]
        for name, link in carriers.items():
            pairs += [(finger, name) for finger in self.robot.fingers(link)]
        return frozenset([*pairs, *((b, a) for a, b in pairs)])

    def _spread(self, contacts: tuple[Pair, ...]) -> frozenset[Pair]:
        spread: list[Pair] = []
        for a, b in contacts:
            firsts, seconds = self.groups.get(a, (a,)), self.groups.get(b, (b,))
            spread += [(x, y) for x in firsts for y in seconds]
        return frozenset([*spread, *((b, a) for a, b in spread)])

    def _lever(self, name: str, scene: Scene, carriers: dict[str, str]) -> Array:
        body = self.bodies.bodies[name]
        reach = float(np.linalg.norm(body.center)) + body.radius
        if body.is_link:
            return self.robot.lever(name, reach)
        if name not in carriers:
            return np.zeros(self.robot.size)
        held = next(held for held in scene.held if held.object == name)
        return self.robot.lever(held.link, reach + float(np.linalg.norm(held.T_link_object.position_m)))

    def _sift(
        self, phase: Phase, pairs: list[Pair], carriers: dict[str, str], travel: Array
    ) -> list[_Near]:
        """The pairs that bounding spheres (boxes for what stands still) do not keep apart through the whole phase."""
        if not pairs:
            return []
        nodes = np.unique([*range(0, len(phase.times), _NODE_STRIDE), len(phase.times) - 1])
        names = tuple(dict.fromkeys(name for pair in pairs for name in pair))
        index = {name: k for k, name in enumerate(names)}
        centers = self._centers(phase, nodes, names, carriers)
        radii = np.array([self.bodies.bodies[name].radius for name in names])
        levers = np.array([self._lever(name, phase.scene, carriers) for name in names])
        a = np.array([index[pair[0]] for pair in pairs])
        b = np.array([index[pair[1]] for pair in pairs])
        gaps = np.linalg.norm(centers[:, a] - centers[:, b], axis=2) - radii[a] - radii[b]
        self._box_gaps(gaps, phase.scene, pairs, centers, radii, (a, b), carriers)
        weights = levers[a] + levers[b]
        for row, pair in enumerate(pairs):
            mask = np.zeros(self.robot.size)
            mask[list(self._between(pair, carriers))] = 1.0
            weights[row] *= mask
        steps = np.diff(travel[nodes], axis=0) @ weights.T
        contact = self.context.options.contact_m
        if len(nodes) > 1:
            apart = np.all(gaps[1:] + gaps[:-1] - 2.0 * contact > steps, axis=0) & np.all(
                gaps > contact, axis=0
            )
        else:
            apart = gaps[0] > contact
        return [_Near(pairs[row], travel @ weights[row]) for row in np.flatnonzero(~apart)]

    def _centers(
        self, phase: Phase, nodes: Array, names: tuple[str, ...], carriers: dict[str, str]
    ) -> Array:
        links = [carriers.get(name, name) for name in names]
        moving = tuple(dict.fromkeys(link for link in links if link in self.links or link in carriers.values()))
        frames = self.robot.frames(phase.q[nodes], moving)
        centers = np.zeros((len(nodes), len(names), 3))
        for k, (name, link) in enumerate(zip(names, links, strict=True)):
            center = self.bodies.bodies[name].center
            if name in carriers:
                held = next(held for held in phase.scene.held if held.object == name)
                rotation, origin = to_frame(held.T_link_object)
                center = rotation @ center + origin
            if link in frames:
                rotations, origins = frames[link]
                centers[:, k] = rotations @ center + origins
            else:
                rotation, origin = to_frame(phase.scene.objects[name])
                centers[:, k] = rotation @ center + origin
        return centers

    def _box_gaps(
        self,
        gaps: Array,
        scene: Scene,
        pairs: list[Pair],
        centers: Array,
        radii: Array,
        ends: tuple[Array, Array],
        carriers: dict[str, str],
    ) -> None:
        """Where the second body stands still, the gap from the first one's sphere to its box, if that is wider."""
        for name in dict.fromkeys(pair[1] for pair in pairs):
            body = self.bodies.bodies[name]
            if body.is_link or name in carriers:
                continue
            rows = np.flatnonzero([pair[1] == name for pair in pairs])
            rotation, origin = to_frame(scene.objects[name])
            local = (centers[:, ends[0][rows]] - origin) @ rotation
            outside = np.maximum(np.maximum(body.low - local, local - body.high), 0.0)
            wide = np.linalg.norm(outside, axis=2) - radii[ends[0][rows]]
            gaps[:, rows] = np.maximum(gaps[:, rows], wide)

    def _advance(self, phase: Phase, near: list[_Near]) -> None:
        contact = self.context.options.contact_m
        queue = [(0, k, shape) for k, item in enumerate(near) for shape in self.bodies.shape_pairs(item.pair)]
        heapify(queue)
        placed, last = -1, len(phase.times) - 1
        touched: set[int] = set()
        closest, where = np.inf, (0, 0)
        while queue:
            node, k, shape = heappop(queue)
            if k in touched:
                continue
            if node != placed:
                self.bodies.move(phase.q[node])
                placed = node
            distance = self.bodies.distance(shape)
            self.measured += 1
            if distance < closest:
                closest, where = distance, (node, k)
            if distance <= contact:
                touched.add(k)
                self._touch(phase, near[k].pair, node, distance)
                continue
            moved = near[k].moved
            after = int(np.searchsorted(moved, moved[node] + distance - contact)) - 1
            if max(after, node) < last:
                heappush(queue, (max(after, node + 1), k, shape))
        if near and np.isfinite(closest):
            goal = self._culprit(phase, near[where[1]].pair)
            if goal is not None:
                name = " / ".join(near[where[1]].pair)
                time = float(phase.times[where[0]])
                self.context.margin("clearance", float(closest), name, goal.id, time, smallest=True)

    def _touch(self, phase: Phase, pair: Pair, node: int, distance: float) -> None:
        goal = self._culprit(phase, pair)
        if goal is None:
            return
        text = f"`{pair[0]}` touches `{pair[1]}`"
        time = float(phase.times[node])
        limit = self.context.options.contact_m
        self.context.found("collision", goal, time, " / ".join(pair), text, distance, limit, "m")

    def _culprit(self, phase: Phase, pair: Pair) -> TimedGoal | None:
        carriers = {held.object: held.link for held in phase.scene.held}
        between = self._between(pair, carriers)
        for goal in phase.moving:
            if any(self.robot.column.get(joint, -1) in between for joint in goal.joints):
                return goal
        return next(iter((*phase.moving, *phase.running, *self.context.plan.goals)), None)


