"""The profile as the sources see the world: for those who ask a profile where things are at the start."""

from __future__ import annotations

import re
from dataclasses import replace

from xei_lang.ir.geometry import IDENTITY, Pose
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.grid import T_object_standing
from xei_lang.profiles.model import FiniteState, LabObject, Prior, Profile

_PLACE = re.compile(r"([a-z][a-z0-9_]*)\.(slot|spot)\(\"(.+)\"\)")


def as_believed(profile: Profile, world: World) -> Profile:
    """The profile with the priors and initial states of its objects made those of a world that was grounded
    with it. Spans stay those of the profile.
    """
    return replace(profile, objects=tuple(_object(item, world, profile) for item in profile.objects))


def _object(item: LabObject, world: World, profile: Profile) -> LabObject:
    found = world.find(item.name)
    if found is None:
        return replace(item, prior=None)
    now = dict(found.states)
    states = tuple(_state(state, now) for state in item.states)
    return replace(item, states=states, prior=_prior(item, found, world, profile))


def _state(state: FiniteState, now: dict[str, str]) -> FiniteState:
    return replace(state, initial=now.get(state.name, state.initial))


def _prior(item: LabObject, found: WorldObject, world: World, profile: Profile) -> Prior:
    span = item.prior.span if item.prior else item.span
    match = _PLACE.fullmatch(found.place)
    holder = profile.object(match[1]) if match else None
    if match is None or holder is None:
        return Prior("", "", found.frame_id, found.T_frame_object, found.confidence, span)
    kind = "slot" if match[2] == "slot" else "spot"
    T_holder_seat = T_object_standing(holder, kind, match[3]) or IDENTITY
    T_world_seat: Pose = world.T_world_object(holder.name) @ T_holder_seat
    T_seat_object = T_world_seat.inverse() @ world.T_world_object(item.name)
    return Prior(match[1], match[3], "", T_seat_object, found.confidence, span, kind)
