"""Where slots and spots are on their object, and where priors put objects: the geometry that profiles state.

Kept apart from `world/places.py`, which offers it by place, because the checks of a profile need it first.
"""

from __future__ import annotations

from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import LabObject, Profile, SlotGrid, Tip

_SAME_LENGTH_M = 0.001


def slot_keys(grid: SlotGrid) -> tuple[str, ...]:
    """The names of all slots, row by row: A1 A2 ... B1 B2 ..."""
    return tuple(f"{row}{column}" for row in grid.rows for column in range(1, grid.columns + 1))


def slot_cell(grid: SlotGrid, key: str) -> tuple[int, int] | None:
    """Row and column, both from 0, of a key such as `A1`; None where the grid has no such slot."""
    for index, row in enumerate(grid.rows):
        if key.startswith(row):
            number = key[len(row) :]
            column = next((j for j in range(grid.columns) if str(j + 1) == number), None)
            if column is not None:
                return index, column
    return None


def T_object_slot(item: LabObject, key: str) -> Pose | None:
    """The mouth of a slot in its object's frame, z up along the slot's axis."""
    cell = slot_cell(item.slots, key) if item.slots else None
    if item.slots is None or cell is None:
        return None
    x, y, z = item.slots.origin_m
    pitch_x, pitch_y = item.slots.pitch_m
    return Pose((x + cell[1] * pitch_x - item.size_m[0] / 2, y + cell[0] * pitch_y - item.size_m[1] / 2, z))


def is_tip_grid(grid: SlotGrid, tip: Tip) -> bool:
    """Whether slots hold these tips: nothing else goes in, and they are as deep as the tips are long."""
    return not grid.accepts and abs(grid.depth_m - tip.length_m) <= _SAME_LENGTH_M


def T_object_spot(item: LabObject, key: str) -> Pose | None:
    """A named spot in its object's frame: where the bottom centre of what stands there is."""
    return next((spot.T_object_spot for spot in item.spots if spot.name == key), None)


def T_object_standing(item: LabObject, kind: str, key: str) -> Pose | None:
    """Where the bottom centre of an object in this slot or spot is: in a slot on its floor, `depth_m` under
    the mouth.
    """
    if kind != "slot" or item.slots is None:
        return T_object_spot(item, key)
    T_slot = T_object_slot(item, key)
    return T_slot @ Pose((0.0, 0.0, -item.slots.depth_m)) if T_slot else None


def prior_chain(profile: Profile, item: LabObject) -> tuple[LabObject, ...]:
    """The object, what it stands in, what that stands in, and so on; no object comes twice."""
    chain = [item]
    while chain[-1].prior is not None and chain[-1].prior.in_object:
        holder = profile.object(chain[-1].prior.in_object)
        if holder is None or holder in chain:
            break
        chain.append(holder)
    return tuple(chain)


def T_frame_object(profile: Profile, item: LabObject) -> tuple[str, Pose] | None:
    """The frame in which an object's prior ends and its pose there; None where the priors do not lead to a
    frame.
    """
    pose = Pose()
    for link in prior_chain(profile, item):
        if link.prior is None:
            return None
        if not link.prior.in_object:
            return link.prior.frame, link.prior.T_frame_object @ pose
        holder = profile.object(link.prior.in_object)
        T_holder = T_object_standing(holder, link.prior.in_kind, link.prior.in_key) if holder else None
        if T_holder is None:
            return None
        pose = T_holder @ link.prior.T_frame_object @ pose
    return None


def T_world_frame(profile: Profile, name: str) -> Pose | None:
    """A calibrated frame in `world`; None for one that the robot carries, or that hangs nowhere."""
    frames = {frame.name: frame for frame in profile.calibration.frames}
    pose = Pose()
    for _ in range(len(frames) + 1):
        if name == "world":
            return pose
        if name not in frames:
            return None
        pose = frames[name].T_parent_frame @ pose
        name = frames[name].parent
    return None
