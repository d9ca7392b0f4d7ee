"""World grounding from what is written down: usage-profile priors first, then system objects.

Each field of each object says which source gave it. What the robot sees later replaces priors; nothing here
does.
"""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.grid import T_frame_object
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.places import initial_place, place_text

SOURCES = ("usage_profile", "object_registry")


def ground(profile: Profile) -> tuple[World | None, Diagnostics]:
    """The world as the profile knows it. Objects that no source places are left out, each with a note."""
    state = start_state(profile)
    found: list[Diagnostic] = []
    objects: list[WorldObject] = []
    for item in profile.objects:
        placed = T_frame_object(profile, item)
        if placed is None:
            found.append(_unplaced(item))
        else:
            objects.append(_grounded(item, *placed))
    objects.sort(key=lambda item: item.name)
    return World(frame_tree(profile, state), tuple(objects), state, SOURCES), tuple(found)


def _grounded(item: LabObject, frame: str, pose: Pose) -> WorldObject:
    place = initial_place(item)
    source = SOURCES[1] if item.system else SOURCES[0]
    fields = ("pose", "confidence", "roles", "size", "geometry", "mass", "states")
    return WorldObject(
        name=item.name,
        T_frame_object=pose,
        frame_id=frame,
        confidence=item.prior.confidence if item.prior else 0.0,
        roles=item.roles,
        skills=item.skills,
        size_m=item.size_m,
        geometry=item.geometry,
        mass_kg=item.mass_kg,
        place=place_text(place) if place else "",
        movable="movable" in item.roles,
        states=tuple((state.name, state.initial) for state in item.states),
        metadata=tuple((f"asset.{name}", path or "missing") for name, path in item.assets),
        provenance=tuple(
            (name, f"{source} prior" if name in ("pose", "confidence") else source) for name in fields
        ),
    )


def _unplaced(item: LabObject) -> Diagnostic:
    return Diagnostic(
        "XEI0660",
        f"no source says where `{item.name}` is",
        item.span,
        label="has no `prior`",
        notes=("a protocol that uses it needs a source that places it",),
        help=("add a `prior`, such as `{frame: table, position: [0.1 m, 0 m, 0 m], confidence: 0.6}`",),
    )
