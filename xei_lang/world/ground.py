"""World grounding: what priors and system objects say, and over that what sources saw, in their order.

Each field of each object says which source gave it. Nothing is placed that no source places, and what cannot
be is an error rather than a guess.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.diagnostics import Diagnostic, Diagnostics, has_errors
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.grid import T_world_frame
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.openings import openings_of
from xei_lang.world.places import place_text
from xei_lang.world.sources.belief import (
    OBJECT_REGISTRY,
    PRIOR,
    USAGE_PROFILE,
    Belief,
    beliefs,
    profile_source,
)
from xei_lang.world.sources.contradictions import Known, contradictions
from xei_lang.world.sources.faults import observation_faults
from xei_lang.world.sources.observation import Observations
from xei_lang.world.sources.standing import Standings
from xei_lang.world.sources.turned import turned

SOURCES = (USAGE_PROFILE, OBJECT_REGISTRY)
"""The sources that every profile has; what is observed overrides them."""


def ground(profile: Profile, observed: tuple[Observations, ...] = ()) -> tuple[World | None, Diagnostics]:
    """The world as the profile and then the observations have it, later sources overriding earlier ones.

    Objects that no source places are left out, each with a note; None where observations contradict the
    profile or each other.
    """
    frames = static_frames(profile)
    found = [fault for source in observed for fault in observation_faults(profile, source, sorted(frames))]
    if has_errors(tuple(found)):
        return None, tuple(found)
    believed = beliefs(profile.objects, observed)
    standings = Standings(believed, frames)
    known: list[Known] = []
    for item in profile.objects:
        standing = standings.of(item.name)
        if standing is None:
            found.append(_unplaced(item, believed, observed))
        else:
            known.append(Known(believed[item.name], standing))
    found.extend(contradictions(profile, tuple(known), frames) if observed else ())
    if has_errors(tuple(found)):
        return None, tuple(found)
    found.extend(turned(tuple(known)))
    state = start_state(profile)
    objects = sorted((_grounded(one, profile) for one in known), key=lambda item: item.name)
    sources = (*SOURCES, *(source.source for source in observed))
    return World(frame_tree(profile, state), tuple(objects), state, sources), tuple(found)


def static_frames(profile: Profile) -> Mapping[str, Pose]:
    """The frames that stay where they are whatever the robot does, with their poses in `world`."""
    names = ("world", *(frame.name for frame in profile.calibration.frames))
    found = ((name, T_world_frame(profile, name)) for name in names)
    return {name: pose for name, pose in found if pose is not None}


def _grounded(one: Known, profile: Profile) -> WorldObject:
    known, standing, item = one.belief, one.standing, one.belief.item
    moved_mm = f"{standing.moved_m * 1000:.1f}"
    moved = () if moved_mm == "0.0" else (("seen.moved_mm", moved_mm),)
    return WorldObject(
        name=item.name,
        T_frame_object=standing.T_frame_object,
        frame_id=standing.frame_id,
        confidence=known.confidence,
        roles=item.roles,
        skills=item.skills,
        size_m=item.size_m,
        geometry=item.geometry,
        mass_kg=item.mass_kg,
        place=place_text(standing.place) if standing.place is not None and standing.place.key else "",
        movable="movable" in item.roles,
        states=known.states,
        metadata=(*known.metadata, *moved),
        provenance=tuple(_provenance(one)),
        fastened_to=_carrier(one),
        openings=openings_of(item, profile),
    )


def _carrier(one: Known) -> str:
    """The object on whose thread this one is screwed, or empty."""
    thread, place = one.belief.item.thread, one.standing.place
    if thread is None or place is None:
        return ""
    return thread.on_object if (thread.on_object, thread.on_key) == (place.object, place.key) else ""


def _provenance(one: Known) -> Iterator[tuple[str, str]]:
    known, own = one.belief, profile_source(one.belief.item)
    yield "pose", known.seen.source if known.seen else f"{own} {PRIOR}{_carried(one)}"
    yield "confidence", known.confidence_from
    declared = ("roles", "size", "geometry", "mass", "states")
    yield from ((field, _declared(one, field, own)) for field in declared)
    yield from ((f"states.{name}", source) for name, source in known.states_from)


def _declared(one: Known, field: str, own: str) -> str:
    """Who said a field that the profile declares: a size may come from a file that it names."""
    item = one.belief.item
    around = len(item.geometry) == 1 and item.geometry[0].shape == item.shape
    is_computed = field == "size" or (field == "geometry" and around)
    return f"{own}, {item.computed_from}" if item.computed_from and is_computed else own


def _carried(one: Known) -> str:
    carrier = one.standing.carried_by
    return f", moved with {carrier}" if carrier else ""


def observers(world: World) -> tuple[str, ...]:
    """The sources that were asked besides the profile."""
    return tuple(source for source in world.sources if source not in SOURCES)


def is_prior(item: WorldObject) -> bool:
    """Whether only a prior of the usage profile says where the object is (or where in a thing it is)."""
    return dict(item.provenance).get("pose", "").startswith(f"{USAGE_PROFILE} {PRIOR}")


def _unplaced(
    item: LabObject, believed: Mapping[str, Belief], observed: tuple[Observations, ...]
) -> Diagnostic:
    gone = _gone(item, believed)
    if gone is not None:
        return gone
    asked = ", ".join(source.source for source in observed)
    return Diagnostic(
        "XEI0660",
        f"no source says where `{item.name}` is",
        item.span,
        label="has no `prior`" if item.prior is None else "is not where its `prior` has it, or leads nowhere",
        notes=(
            "a protocol that uses it needs a source that places it",
            *((f"asked besides the profile: {asked}",) if asked else ()),
        ),
        help=("add a `prior`, such as `{frame: table, position: [0.1 m, 0 m, 0 m], confidence: 0.6}`",),
    )


def _gone(item: LabObject, believed: Mapping[str, Belief]) -> Diagnostic | None:
    """What is said of an object that a source has absent, or whose prior has it in one that is."""
    name, passed = item.name, set[str]()
    while name in believed and name not in passed:
        passed.add(name)
        one = believed[name]
        if one.absent is not None:
            within = () if name == item.name else (f"its prior has it in `{name}`",)
            return Diagnostic(
                "XEI0660",
                f"`{item.name}` is not there: {one.absent.source} says that `{name}` is absent",
                one.absent.span or item.span,
                label="said here" if one.absent.span else "is this object",
                notes=(*within, "a later source that sees it brings it back"),
                help=(f"put `{name}` back and record the scene again, if a protocol is to use it",),
            )
        name = one.item.prior.in_object if one.seen is None and one.item.prior is not None else ""
    return None
