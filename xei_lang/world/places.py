"""Places in and on objects: which there are, where they are, and what stands in them at the start.

Pure Python, because name checking needs it before anything heavy is loaded.
"""

from __future__ import annotations

from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.profiles import grid as grids
from xei_lang.profiles.model import LabObject, Profile, SlotGrid, Spot


def place_text(place: PlaceRef) -> str:
    """The place as the language writes it: `rack_1.slot("A1")`, `table.spot("bottle")`, `table`."""
    return f'{place.object}.{place.kind}("{place.key}")' if place.key else place.object


def slots(item: LabObject) -> tuple[PlaceRef, ...]:
    """All slots, row by row: A1 A2 ... B1 B2 ...; empty where the object has none."""
    return tuple(_slot(item, key) for key in grids.slot_keys(item.slots)) if item.slots else ()


def row(item: LabObject, name: str) -> tuple[PlaceRef, ...]:
    """The slots of a row by column; empty where the object has no such row."""
    grid = item.slots
    if grid is None or name not in grid.rows:
        return ()
    return tuple(_slot(item, f"{name}{j}") for j in range(1, grid.columns + 1))


def column(item: LabObject, number: int) -> tuple[PlaceRef, ...]:
    """The slots of a column, counted from 1, by row; empty where the object has no such column."""
    grid = item.slots
    if grid is None or not 1 <= number <= grid.columns:
        return ()
    return tuple(_slot(item, f"{name}{number}") for name in grid.rows)


def spots(item: LabObject) -> tuple[PlaceRef, ...]:
    """All named spots in the order of the profile."""
    return tuple(PlaceRef(item.name, "spot", spot.name) for spot in item.spots)


def has_place(item: LabObject, place: PlaceRef) -> bool:
    """Whether the object has this place; every object with the role `surface` or `place_target` has its
    surface.
    """
    if place.kind == "slot":
        return item.slots is not None and grids.slot_cell(item.slots, place.key) is not None
    if place.kind == "spot":
        return any(spot.name == place.key for spot in item.spots)
    return "surface" in item.roles or "place_target" in item.roles


def nearest_keys(item: LabObject, kind: str, key: str) -> tuple[str, ...]:
    """Names of slots or spots that a wrong key may have meant, best first."""
    known = slots(item) if kind == "slot" else spots(item)
    return did_you_mean(key, [place.key for place in known])


def T_object_place(item: LabObject, place: PlaceRef) -> Pose | None:
    """The place in its object's frame: a slot's mouth, or where a bottom stands on a spot.

    None for a whole surface, which is no single pose, and for a place that the object does not have.
    """
    if place.kind == "slot":
        return grids.T_object_slot(item, place.key)
    return grids.T_object_spot(item, place.key) if place.kind == "spot" else None


def T_object_standing(item: LabObject, place: PlaceRef) -> Pose | None:
    """Where the bottom centre of what stands in the place is, in the frame of the place's object.

    In a slot that is the floor of the slot, `depth_m` below its mouth on its axis.
    """
    return None if place.kind == "surface" else grids.T_object_standing(item, place.kind, place.key)


def initial_place(item: LabObject) -> PlaceRef | None:
    """The place in which the object's prior puts it, or None."""
    prior = item.prior
    if prior is None or not prior.in_object:
        return None
    return PlaceRef(prior.in_object, "slot" if prior.in_kind == "slot" else "spot", prior.in_key)


def initial_occupant(profile: Profile, place: PlaceRef) -> str | None:
    """The name of the object whose prior puts it in this place, or None."""
    return next((item.name for item in profile.objects if initial_place(item) == place), None)


def accepting(item: LabObject, place: PlaceRef) -> SlotGrid | Spot | None:
    """What states which roles a place takes: the grid of a slot, the spot; None for a whole surface."""
    if place.kind == "slot":
        return item.slots
    return next((spot for spot in item.spots if place.kind == "spot" and spot.name == place.key), None)


def accepts(item: LabObject, place: PlaceRef, roles: tuple[str, ...]) -> bool:
    """Whether a place takes an object of these roles: a slot asks for one of its `accepts`, and so does a
    spot that states any; a whole surface asks for nothing.
    """
    stated = accepting(item, place)
    if stated is None or (place.kind == "spot" and not stated.accepts):
        return True
    return any(role in stated.accepts for role in roles)


def _slot(item: LabObject, key: str) -> PlaceRef:
    return PlaceRef(item.name, "slot", key)
