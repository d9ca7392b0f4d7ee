"""Place and insert: down along the slot's axis to where the object rests, release, back off along the
approach.
"""

from __future__ import annotations

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Box, Pose
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.lower.hand import hand_of
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.held import in_hand
from xei_lang.lower.operations.lift import along, clear_travel
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.operations.surface import free_room
from xei_lang.lower.parameters import ROUNDING_M, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.seats import Seat, place_text, seat_of
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject, SlotGrid
from xei_lang.quantity.lengths import exact_mm
from xei_lang.world.places import accepting, accepts

_DEFAULT_CLEARANCE_M = 0.004
_MOST_FALL_M = 0.005
"""How far over the bottom of its slot a thing may be let go: benches are known to a few millimetres, and who
fears to press on the bottom may stay so much above it.
"""


def plan(work: Work) -> Planned:
    """The aims `above`, `place` and `retreat` of the held object at a place, and where the object then
    stands.
    """
    assert isinstance(work.subject, PlaceRef)
    held = _held(work)
    known = work.profile.object(held.object)
    seat = _seat(work, work.subject)
    assert known is not None
    _refuse_occupied(work, seat, held)
    _refuse_stranger(work, seat, known)
    if seat.grid is not None:
        _refuse_unfit(work, seat, seat.grid, known)
    depth = _insertion_depth(work, seat)
    T_world_seat = _world_seat(work, seat, known)
    T_world_placed = T_world_seat @ Pose((0.0, 0.0, -depth.si("Length") if depth else 0.0))
    return _aims(work, held, T_world_placed, depth)


def _aims(work: Work, held: Held, T_world_placed: Pose, depth: Setting | None) -> Planned:
    T_base_placed = work.scene.in_base(T_world_placed)
    sunk_m = depth.si("Length") if depth else 0.0
    height = clear_travel(work, "approach_height", sunk_m, "above the slot's mouth")
    standoff = work.layers.merge(
        "standoff", computed_length("standoff", held.standoff_m, f"as when `{held.object}` was grasped")
    )
    release = release_width(work, held)
    assert standoff is not None
    family, turn = held.family.id, held.family.symmetric
    up = along(T_base_placed.axes()[2], height.si("Length"))
    above = ToolTarget(family, T_base_placed, up, turn_reference=turn)
    place = ToolTarget(family, T_base_placed, turn_reference=turn)
    settings = (height, standoff, *release, *((depth,) if depth else ()))
    assert isinstance(work.subject, PlaceRef)
    return Planned(
        {item.name: item for item in settings},
        {
            "above": Aim(above, ("approach_height",)),
            "place": Aim(place, ("insertion_depth",), support=work.subject.object),
            "retreat": Aim(back_off(family, T_base_placed, standoff.si("Length"), turn), ("standoff",)),
        },
        held.family,
        T_world_placed,
        sunk_m,
    )


def _held(work: Work) -> Held:
    return in_hand(work, work.object, "when it is set down")


def _seat(work: Work, ref: PlaceRef) -> Seat:
    host = work.profile.object(ref.object)
    seat = seat_of(ref, host) if host else None
    if host is None or seat is None:
        refuse("XEI0711", f"there is no place `{place_text(ref)}`", work.span, "not a place of this profile")
    standing_object(work, ref.object)
    return seat


def _refuse_occupied(work: Work, seat: Seat, held: Held) -> None:
    occupant = work.scene.occupant(seat.text) if seat.ref.kind != "surface" else None
    if occupant is not None:
        refuse(
            "XEI0706",
            f"`{held.object}` cannot be set down in `{seat.text}`: `{occupant.object}` stands there",
            work.span,
            f"expected a free place, found `{occupant.object}`",
            (occupant.since,) if occupant.since else (),
        )


def _refuse_stranger(work: Work, seat: Seat, known: LabObject) -> None:
    host = work.profile.object(seat.ref.object)
    stated = accepting(host, seat.ref) if host else None
    if host is None or stated is None or accepts(host, seat.ref, known.roles):
        return
    where = f"the {seat.ref.kind}{'s are' if seat.ref.kind == 'slot' else ' is'} stated here"
    refuse(
        "XEI0705",
        f"`{seat.text}` does not accept `{known.name}`",
        work.span,
        f"accepts {' or '.join(stated.accepts)}; `{known.name}` is {', '.join(known.roles)}",
        (Label(stated.span, where), Label(known.span, "the object is stated here")),
    )


def _refuse_unfit(work: Work, seat: Seat, grid: SlotGrid, known: LabObject) -> None:
    label = (Label(grid.span, "the slots are stated here"), Label(known.span, "the object is stated here"))
    width = max(known.size_m[0], known.size_m[1])
    if isinstance(known.shape, Box):
        width = (known.size_m[0] ** 2 + known.size_m[1] ** 2) ** 0.5
    if width > grid.bore_m:
        refuse(
            "XEI0714",
            f"`{known.name}` is too wide for `{seat.text}`",
            work.span,
            f"{exact_mm(width)} across, the bore is {exact_mm(grid.bore_m)}",
            label,
        )


def _insertion_depth(work: Work, seat: Seat) -> Setting | None:
    """How deep a slot takes the object: to its bottom unless something written says less; None beside
    slots.
    """
    if seat.grid is None:
        return None
    computed = computed_length("insertion_depth", seat.grid.depth_m, f"depth of `{seat.text}`")
    setting = work.layers.merge("insertion_depth", computed)
    assert setting is not None
    if not 0.0 < setting.si("Length") <= seat.grid.depth_m + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`insertion_depth` of {setting.text} does not fit `{seat.text}`",
            setting.span or work.span,
            f"expected up to {exact_mm(seat.grid.depth_m)}",
            (Label(seat.grid.span, "the slots are stated here"),),
        )
    _refuse_drop(work, seat, seat.grid, setting)
    return setting


def _refuse_drop(work: Work, seat: Seat, grid: SlotGrid, depth: Setting) -> None:
    fall_m = grid.depth_m - depth.si("Length")
    if fall_m > _MOST_FALL_M + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`{depth.name}` of {depth.text} lets `{work.object}` fall {exact_mm(fall_m)} in `{seat.text}`",
            depth.span or work.span,
            f"expected {exact_mm(grid.depth_m - _MOST_FALL_M)} .. {exact_mm(grid.depth_m)}",
            (Label(grid.span, "the slots are stated here"),),
            notes=("jaws let go of an object where something carries it, or just above",),
            help=(f"leave `{depth.name}` out: it is the depth of the slot then",),
        )


def _world_seat(work: Work, seat: Seat, known: LabObject) -> Pose:
    host = work.scene.standing[seat.ref.object]
    if seat.ref.kind != "surface":
        return host.T_world_object @ seat.T_host_seat
    room = free_room(work.profile, work.scene, work.arm, seat.ref.object, known)
    if room is None:
        refuse(
            "XEI0713",
            f"there is no free room for `{known.name}` on `{seat.ref.object}`",
            work.span,
            "every place is taken, too near to something, or over the edge",
        )
    return host.T_world_object @ room


def release_width(work: Work, held: Held) -> tuple[Setting, Setting]:
    """The settings `jaw_clearance` and `release_width` of the jaws that let go of what a hand holds."""
    gap_m = hand_of(work.profile).max_gap_m
    room_m = (gap_m - held.grasp_width_m) / 2
    default = work.layers.merge("jaw_clearance", None)
    wanted_m = default.si("Length") if default else _DEFAULT_CLEARANCE_M
    if default is None or wanted_m > room_m:
        rule = f"what {exact_mm(gap_m)} leaves beside {exact_mm(held.grasp_width_m)}"
        default = computed_length("jaw_clearance", min(wanted_m, room_m), rule)
    width_m = held.grasp_width_m + 2 * default.si("Length")
    rule = f"{exact_mm(held.grasp_width_m)} and {default.text} on each side"
    setting = work.layers.merge("release_width", computed_length("release_width", width_m, rule))
    assert setting is not None
    if not held.grasp_width_m < setting.si("Length") <= gap_m + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`release_width` of {setting.text} does not release `{held.object}`",
            setting.span or work.span,
            f"expected more than {exact_mm(held.grasp_width_m)} and at most {exact_mm(gap_m)}",
        )
    return default, setting


PLACE = Operation(
    "place",
    ("above", "place", "retreat"),
    ("approach_height", "insertion_depth", "standoff", "jaw_clearance", "release_width"),
    plan,
    of="Place",
)
