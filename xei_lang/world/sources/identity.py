"""Which registry of objects a source speaks of: a digest of what the profile says that things are."""

from __future__ import annotations

import hashlib

from xei_lang.profiles.model import LabObject, Profile


def objects_sha256(profile: Profile) -> str:
    """The SHA-256, in hex, of all objects' names, shapes, places and states: what a pose is the pose of.

    Where things are believed to be, aliases, skills and comments are left out: to change them does not make
    an observation one of something else.
    """
    text = "\n".join(_identity(item) for item in profile.objects)
    return hashlib.sha256(text.encode()).hexdigest()


def _identity(item: LabObject) -> str:
    grid = item.slots
    slots = None
    if grid is not None:
        slots = (grid.rows, grid.columns, grid.pitch_m, grid.origin_m, grid.bore_m, grid.depth_m)
    spots = tuple((spot.name, spot.T_object_spot) for spot in item.spots)
    states = tuple((state.name, state.values) for state in item.states)
    return repr((item.name, item.roles, item.size_m, item.geometry, slots, spots, states))
