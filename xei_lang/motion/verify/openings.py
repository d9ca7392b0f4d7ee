"""What goes into an opening keeps clear of its wall and its bottom: an allowed contact does not excuse those.

To the distances between bodies a vessel or a rack is solid, so that a pair of which one goes into the other
has to be allowed. Here it is looked at again, with the openings that the world states: all of a shape that is
under the mouth has to be within the hole. A convex shape that overlaps the solid and is under the mouth is
either in the hole or in its wall, so that nothing else has to be looked at.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from xei_lang.ir.geometry import Pose, Primitive
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.world import Opening
from xei_lang.motion.verify.bodies import Bodies, to_frame
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.hollow import Frames, Inside, stands_in
from xei_lang.motion.verify.pairs import Pair, Pairs, Rows
from xei_lang.motion.verify.timeline import Phase

STEP_M = 0.0005
"""How far two bodies may move against each other between two looks."""
Key = tuple[str, str, int, int]
"""Two objects, and which shape of each."""


@dataclass(frozen=True, slots=True)
class _Entry:
    """How a shape of a guest stands in a host over the rows of a phase, and by how much (n,) that is too wide
    or too deep, m; 0 where it is not.
    """

    guest: str
    host: str
    opening: Opening
    inside: Inside
    excess_m: Array


class Openings:
    """Looks at phase after phase. `moved` are the objects that a hand has held: what stood a little off its
    hole before that comes out as it stands, which is the world's fault and not the plan's.
    """

    def __init__(self, context: Context, bodies: Bodies, pairs: Pairs) -> None:
        self.context, self.bodies, self.pairs = context, bodies, pairs
        self.objects = {item.name: item for item in context.world.objects}
        self.moved: set[str] = set()
        self.forgiven: dict[Key, float] = {}

    def check(self, phase: Phase) -> None:
        """Look at all pairs that are allowed to touch and of which one may be in the other."""
        for a, b in sorted(self.pairs.allowed(phase)):
            if (a, b) in self.pairs.row and a in self.objects and self._goes_in(phase, (a, b)):
                rows = self._looks(phase, self.pairs.row[a, b])
                few = replace(
                    phase, times=phase.times[rows], q=phase.q[rows], v=phase.v[rows], a=phase.a[rows]
                )
                self._check_pair(few, (a, b))
        self.moved.update(self.pairs.carriers)

    def _looks(self, phase: Phase, row: int) -> Rows:
        """The rows to look at, between which nothing of the two has moved against the other by more than
        `STEP_M`; the first and the last among them.
        """
        steps = np.abs(np.diff(phase.q, axis=0)) @ self.pairs.weights[row]
        moved = np.concatenate([[0.0], np.cumsum(steps)])
        wanted = np.searchsorted(moved, np.arange(0.0, float(moved[-1]), STEP_M))
        return np.unique([*wanted.tolist(), len(moved) - 1])

    def _goes_in(self, phase: Phase, pair: Pair) -> bool:
        """Whether a hand moves one of the pair against the other, and that one has openings. What is set down
        on a thing without any rests there.
        """
        carriers = self.pairs.carriers
        links = [None if (held := carriers.get(name)) is None else held.link for name in pair]
        entered = any(self.objects[host].openings and guest in carriers for host, guest in (pair, pair[::-1]))
        return entered and links[0] != links[1] and bool(phase.moving)

    def _check_pair(self, phase: Phase, pair: Pair) -> None:
        """Two shapes may overlap where one is in the other's opening: most often what the hand holds."""
        poses = {name: self._frames(phase, name) for name in pair}
        guest, host = sorted(pair, key=lambda name: name not in self.pairs.carriers)
        guests = self._entries(host, guest, poses)
        if all(entry is not None and not entry.excess_m.any() for entry in guests):
            return
        hosts = self._entries(guest, host, poses)
        for (i, one), (j, other) in product(enumerate(guests), enumerate(hosts)):
            entries = [entry for entry in (one, other) if entry is not None]
            if entries:
                self._check_shapes(phase, (guest, host), (i, j), entries)

    def _check_shapes(self, phase: Phase, pair: Pair, shapes: tuple[int, int], entries: list[_Entry]) -> None:
        excess = np.minimum.reduce([entry.excess_m for entry in entries])
        key = (*pair, *shapes)
        allowed = self._allowed(key, float(excess[0]))
        if float(excess[-1]) <= 0.0:
            self.forgiven.pop(key, None)
        for row in np.flatnonzero(excess > allowed).tolist():
            if self._overlaps(phase, pair, shapes, row):
                self._tell(phase, min(entries, key=lambda item: float(item.excess_m[row])), row)
                return

    def _allowed(self, key: Key, first_m: float) -> float:
        """The excess that is the world's own: as one of the two stood before any hand took it."""
        held = [name for name in key[:2] if name in self.pairs.carriers]
        if any(name not in self.moved for name in held) and first_m > 0.0:
            self.forgiven[key] = first_m + self.context.options.opening_margin_m
        return self.forgiven.get(key, 0.0)

    def _frames(self, phase: Phase, name: str) -> Frames:
        """Frames of an object in the base, one a row."""
        held = self.pairs.carriers.get(name)
        if held is None:
            rotation, origin = to_frame(phase.scene.objects[name])
            count = len(phase.q)
            return np.broadcast_to(rotation, (count, 3, 3)), np.broadcast_to(origin, (count, 3))
        rotation, origin = to_frame(held.T_link_object)
        rotations, origins = self.context.robot.frames(phase.q, (held.link,))[held.link]
        return rotations @ rotation, rotations @ origin + origins

    def _entries(self, host: str, guest: str, poses: dict[str, Frames]) -> list[_Entry | None]:
        """For each shape of the guest the opening of the host that it fits best; None where there is none."""
        found: list[_Entry | None] = []
        for shape in self.objects[guest].geometry:
            entries = [
                self._entry(host, guest, opening, shape, poses) for opening in self.objects[host].openings
            ]
            found.append(min(entries, key=lambda entry: float(entry.excess_m.max()), default=None))
        return found

    def _entry(
        self, host: str, guest: str, opening: Opening, shape: Primitive, poses: dict[str, Frames]
    ) -> _Entry:
        options, body = self.context.options, self.bodies.bodies[guest]
        rotation, origin = _seen_from(_at(poses[host], opening.T_object_mouth), poses[guest])
        under = (rotation @ body.center + origin)[:, 2] - body.radius < -options.opening_skin_m
        radius, depth = np.zeros(len(under)), np.zeros(len(under))
        if under.any():
            inside = stands_in(opening, shape, (rotation[under], origin[under]), options.opening_skin_m)
            radius[under], depth[under] = inside.radius_m, inside.depth_m
        wide = radius + options.opening_margin_m - opening.radius_m
        deep = depth - opening.depth_m - options.opening_skin_m
        excess = np.where(depth > 0.0, np.maximum(np.maximum(wide, deep), 0.0), 0.0)
        return _Entry(guest, host, opening, Inside(radius, depth), excess)

    def _overlaps(self, phase: Phase, pair: Pair, shapes: tuple[int, int], row: int) -> bool:
        """Whether the one shape is in the other, and not beside it or on it."""
        (a, b), (i, j) = pair, shapes
        if (a, b) not in self.pairs.row:
            (a, b), (i, j) = (b, a), (j, i)
        self.bodies.add_pair((a, b))
        self.bodies.move(phase.q[row])
        return (
            self.bodies.distance(self.bodies.shape_pairs((a, b))[i * len(self.objects[b].geometry) + j]) < 0.0
        )

    def _tell(self, phase: Phase, entry: _Entry, row: int) -> None:
        goal: TimedGoal = phase.moving[0]
        guest, host, opening = entry.guest, entry.host, entry.opening
        depth_m, radius_m = float(entry.inside.depth_m[row]), float(entry.inside.radius_m[row])
        under = f"{depth_m * 1000:.1f} mm under its mouth"
        deep = depth_m > opening.depth_m + self.context.options.opening_skin_m
        text = f"`{guest}` meets the {'bottom' if deep else 'wall'} of `{host}`, {under}"
        self.context.found(
            "opening", goal, float(phase.times[row]), f"{guest} / {host}", text, unit="m",
            value=depth_m if deep else radius_m, limit=opening.depth_m if deep else opening.radius_m,
        )  # fmt: skip


def _at(frames: Frames, pose: Pose) -> Frames:
    rotation, origin = to_frame(pose)
    return frames[0] @ rotation, frames[0] @ origin + frames[1]


def _seen_from(frames: Frames, others: Frames) -> Frames:
    """Frames `others` in the frames `frames`."""
    back = np.swapaxes(frames[0], 1, 2)
    return back @ others[0], np.einsum("nij,nj->ni", back, others[1] - frames[1])
