"""A place as geometry for setting down: where it is on its host, along which axis one gets there, and its
slot.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.profiles.model import LabObject, SlotGrid
from xei_lang.world.places import T_object_place, has_place, place_text

__all__ = ["Seat", "place_text", "seat_of"]


@dataclass(frozen=True, slots=True)
class Seat:
    """`T_host_seat` is the slot's mouth, the spot, or the middle of the surface, in the host's frame; z
    leads out.

    `grid` is the slot's grid, None for a spot or a surface.
    """

    ref: PlaceRef
    T_host_seat: Pose
    grid: SlotGrid | None

    @property
    def text(self) -> str:
        """The place as a protocol writes it."""
        return place_text(self.ref)


def seat_of(ref: PlaceRef, host: LabObject) -> Seat | None:
    """The seat that a reference names on its host, or None where the host has no such place."""
    if not has_place(host, ref):
        return None
    pose = T_object_place(host, ref) or Pose((0.0, 0.0, host.size_m[2]))
    return Seat(ref, pose, host.slots if ref.kind == "slot" else None)
