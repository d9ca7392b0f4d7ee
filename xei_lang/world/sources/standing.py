"""Where every object stands, by what was seen and by priors: what stands in a thing that was seen moves with
it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from xei_lang.ir.geometry import IDENTITY, Pose, Vec3
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.profiles.grid import T_object_standing
from xei_lang.profiles.model import LabObject
from xei_lang.world.places import initial_place
from xei_lang.world.sources.belief import Belief
from xei_lang.world.sources.settle import HEIGHT_M, Host, floors_of, foot, is_host, settle


@dataclass(frozen=True, slots=True)
class Standing:
    """Where an object is: its pose in a frame that stays, what it stands in or on, and how far from where it
    was seen that is. `carried_by` names the object that was seen and took this one with it.
    """

    frame_id: str
    T_frame_object: Pose
    T_world_object: Pose
    place: PlaceRef | None = None
    moved_m: float = 0.0
    carried_by: str = ""


class Standings:
    """Finds where objects stand, each once, those that carry others before what they carry.

    `frames` maps each frame that stays where it is to its pose in `world`.
    """

    def __init__(self, beliefs: Mapping[str, Belief], frames: Mapping[str, Pose]) -> None:
        self._beliefs = beliefs
        self._frames = frames
        self._found: dict[str, Standing | None] = {}
        self._open: set[str] = set()
        self._hosts = [one for one in beliefs.values() if is_host(one.item) and one.absent is None]
        self._floors = {one.item.name: floors_of(one.item) for one in self._hosts}
        rough = ((one.item.name, self._rough_pose(one.item)) for one in self._hosts)
        self._T_rough_world = {name: pose.inverse() for name, pose in rough if pose is not None}

    def of(self, name: str) -> Standing | None:
        """Where this object stands; None where no source says, or the way there is a circle."""
        if name not in self._found:
            known = self._beliefs.get(name)
            if known is None or name in self._open:
                return None
            self._open.add(name)
            self._found[name] = self._find(known)
            self._open.discard(name)
        return self._found[name]

    def _find(self, known: Belief) -> Standing | None:
        if known.absent is not None:
            return None
        return self._by_sight(known) if known.seen else self._by_prior(known.item)

    def _by_prior(self, item: LabObject) -> Standing | None:
        prior = item.prior
        if prior is None:
            return None
        place = initial_place(item)
        if place is None:
            T_world_frame = self._frames.get(prior.frame)
            if T_world_frame is None:
                return None
            if item.system:
                return Standing(prior.frame, prior.T_frame_object, T_world_frame @ prior.T_frame_object)
            shift, carrier = self._shift(item, T_world_frame)
            T_world_object = shift @ T_world_frame @ prior.T_frame_object
            on_seen = self._on_seen(item, T_world_object)
            T_frame_object = T_world_frame.inverse() @ T_world_object if carrier else prior.T_frame_object
            return on_seen or Standing(prior.frame, T_frame_object, T_world_object, carried_by=carrier)
        holder, under = self.of(place.object), self._beliefs.get(place.object)
        T_holder = T_object_standing(under.item, place.kind, place.key) if under else None
        if holder is None or under is None or T_holder is None:
            return None
        carrier = under.item.name if under.seen else holder.carried_by
        return _on(holder, T_holder @ prior.T_frame_object, place, 0.0, carrier)

    def _shift(self, item: LabObject, T_world_frame: Pose) -> tuple[Pose, str]:
        """How the thing that the frame of this prior is named after has moved in `world` since it was
        calibrated, and its name; none and empty where it was not seen.
        """
        prior = item.prior
        named = self._beliefs.get(prior.frame) if prior else None
        if prior is None or named is None or named.seen is None or named.item is item:
            return IDENTITY, ""
        calibrated, T_world_seen = named.item.prior, self._T_world_seen(named)
        if calibrated is None or calibrated.frame != prior.frame or T_world_seen is None:
            return IDENTITY, ""
        return T_world_seen @ (T_world_frame @ calibrated.T_frame_object).inverse(), prior.frame

    def _T_world_seen(self, known: Belief) -> Pose | None:
        T_world_frame = self._frames.get(known.seen.frame_id) if known.seen else None
        return T_world_frame @ known.seen.T_frame_object if T_world_frame and known.seen else None

    def _on_seen(self, item: LabObject, T_world_object: Pose) -> Standing | None:
        """Where an object stands by its prior on something that was seen, which may be a little higher or
        lower than the prior says; None where it stands on nothing of the kind.
        """
        near = self._hosts_near(item.name, T_world_object.position_m)
        settled = settle(item, T_world_object, (one for one in near if self._beliefs[one.item.name].seen))
        host = self.of(settled.host.name) if settled else None
        if settled is None or host is None:
            return None
        return _on(host, settled.T_host_object, settled.place, 0.0, settled.host.name)

    def _by_sight(self, known: Belief) -> Standing | None:
        seen = known.seen
        assert seen is not None
        T_world_frame = self._frames.get(seen.frame_id)
        if T_world_frame is None:
            return None
        T_world_seen = T_world_frame @ seen.T_frame_object
        near = self._hosts_near(known.item.name, foot(known.item, T_world_seen))
        settled = settle(known.item, T_world_seen, near)
        if settled is None:
            return Standing(seen.frame_id, seen.T_frame_object, T_world_seen)
        host = self.of(settled.host.name)
        assert host is not None
        T_world_object = host.T_world_object @ settled.T_host_object
        moved_m = math.dist(T_world_object.position_m, T_world_seen.position_m)
        return _on(host, settled.T_host_object, settled.place, moved_m, "")

    def _hosts_near(self, name: str, seen_m: Vec3) -> Iterator[Host]:
        """The hosts within which, or on top of which, this point may be, with where they stand."""
        for one in self._hosts:
            rough = self._T_rough_world.get(one.item.name)
            if one.item.name == name or rough is None or not _may_hold(one.item, rough.apply(seen_m)):
                continue
            standing = self.of(one.item.name)
            if standing is not None:
                yield Host(one.item, standing.T_world_object, self._floors[one.item.name])

    def _rough_pose(self, item: LabObject) -> Pose | None:
        """Where a host is before anything is settled: as it was seen, or as priors chain."""
        pose, name, passed = IDENTITY, item.name, set[str]()
        while name not in passed:
            passed.add(name)
            known = self._beliefs.get(name)
            if known is None:
                return None
            prior, seen = known.item.prior, known.seen
            if seen is not None or (prior is not None and not prior.in_object):
                frame = seen.frame_id if seen else prior.frame if prior else ""
                own = seen.T_frame_object if seen else prior.T_frame_object if prior else IDENTITY
                T_world_frame = self._frames.get(frame)
                if T_world_frame is None:
                    return None
                shift = IDENTITY if seen or known.item.system else self._shift(known.item, T_world_frame)[0]
                return shift @ T_world_frame @ own @ pose
            if prior is None:
                return None
            under = self._beliefs.get(prior.in_object)
            T_holder = T_object_standing(under.item, prior.in_kind, prior.in_key) if under else None
            if T_holder is None:
                return None
            pose, name = T_holder @ prior.T_frame_object @ pose, prior.in_object
        return None


def _may_hold(host: LabObject, point_m: Vec3) -> bool:
    """Whether a point of the host's frame, which is roughly known, may be in or on it."""
    x, y, z = point_m
    width, depth, height = host.size_m
    radius_m = math.hypot(width, depth) / 2 + 2 * HEIGHT_M
    return math.hypot(x, y) <= radius_m and -2 * HEIGHT_M <= z <= height + 2 * HEIGHT_M


def _on(host: Standing, T_host_object: Pose, place: PlaceRef, moved_m: float, carried_by: str) -> Standing:
    """Standing on a host, told in the frame in which the host is told."""
    return Standing(
        host.frame_id,
        host.T_frame_object @ T_host_object,
        host.T_world_object @ T_host_object,
        place,
        moved_m,
        carried_by,
    )
