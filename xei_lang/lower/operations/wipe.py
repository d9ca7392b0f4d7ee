"""Wipe: a held tool goes to and fro over a rectangle of a surface, its bottom on it.

The tool keeps its orientation, along the surface's own axes, and stays inside the rectangle with its whole
outline: the path of its middle is the rectangle less the tool's own size.
"""

from __future__ import annotations

import math

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.ir.tool_paths import Raster
from xei_lang.lower.operations.base import Aim, Area, Operation, Planned, Work
from xei_lang.lower.operations.held import in_hand
from xei_lang.lower.operations.lift import along
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.parameters import ROUNDING_M, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.seats import Seat, seat_of
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject

_HEIGHT_M = 0.06
_OVERLAP = 0.8
_BESIDE_M = 0.02


def plan(work: Work) -> Planned:
    """The aims `wipe_above`, `wipe_start`, `wipe_end` and `wipe_away` of the held tool, and `wipe_area`."""
    assert isinstance(work.subject, PlaceRef)
    held, tool = _held(work)
    seat, host = _seat(work, work.subject)
    length, width = (_edge(work, name) for name in ("length", "width"))
    region = (length.si("Length"), width.si("Length"))
    _refuse_outside(work, seat, host, region)
    T_base_seat = work.scene.in_base(work.scene.standing[host.name].T_world_object) @ Pose(
        seat.T_host_seat.position_m
    )
    turn = _turn(held, T_base_seat)
    size = tool.size_m[:2] if turn % 2 == 0 else tool.size_m[1::-1]
    room = (region[0] - size[0], region[1] - size[1])
    if min(room) < -ROUNDING_M or max(room) <= ROUNDING_M:
        refuse(
            "XEI0721",
            f"the area to wipe is not larger than `{tool.name}`",
            length.span or work.span,
            f"the tool itself covers {size[0] * 1000:g} x {size[1] * 1000:g} mm",
        )
    pitch = work.layers.merge(
        "lane_pitch", computed_length("lane_pitch", _OVERLAP * min(size), f"lanes of `{tool.name}` overlap")
    )
    height = work.layers.merge("wipe_height", computed_length("wipe_height", _HEIGHT_M, "above the surface"))
    assert pitch is not None
    assert height is not None
    area = _area(T_base_seat, (max(0.0, room[0]), max(0.0, room[1])))
    yaw = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, turn * math.pi / 2))
    T_base_start = Pose(area.corner_m, T_base_seat.quaternion) @ yaw
    return _planned(work, held, host, area, T_base_start, (pitch, height))


def _planned(
    work: Work, held: Held, host: LabObject, area: Area, start: Pose, settings: tuple[Setting, Setting]
) -> Planned:
    pitch, height = settings
    moved = Raster(area.corner_m, area.along_m, area.across_m, pitch.si("Length")).end()
    end = Pose(moved.apply(start.position_m), start.quaternion)
    up = along(start.axes()[2], height.si("Length"))
    family = held.family.id
    return Planned(
        {item.name: item for item in settings},
        {
            "wipe_above": Aim(ToolTarget(family, start, up), (height.name,)),
            "wipe_start": Aim(ToolTarget(family, start), (), host.name),
            "wipe_end": Aim(ToolTarget(family, end), (), host.name),
            "wipe_away": Aim(ToolTarget(family, end, up), (height.name,)),
        },
        held.family,
        areas={"wipe_area": area},
    )


def _held(work: Work) -> tuple[Held, LabObject]:
    held, known = in_hand(work, work.object, "when it wipes"), work.profile.object(work.object)
    assert known is not None
    return held, known


def _seat(work: Work, ref: PlaceRef) -> tuple[Seat, LabObject]:
    host = work.profile.object(ref.object)
    seat = seat_of(ref, host) if host else None
    if host is None or seat is None:
        refuse(
            "XEI0711", f"there is no place `{ref.object}` to wipe", work.span, "not a place of this profile"
        )
    return seat, standing_object(work, host.name)


def _edge(work: Work, name: str) -> Setting:
    return work.layers.call[name]


def _refuse_outside(work: Work, seat: Seat, host: LabObject, region: tuple[float, float]) -> None:
    """The rectangle lies on the surface, and nothing stands on it or close to it."""
    x, y, z = seat.T_host_seat.position_m
    half = (region[0] / 2, region[1] / 2)
    if abs(x) + half[0] > host.size_m[0] / 2 + 1e-9 or abs(y) + half[1] > host.size_m[1] / 2 + 1e-9:
        refuse(
            "XEI0721",
            f"the area to wipe lies beside `{host.name}`",
            work.span,
            f"{region[0] * 1000:g} x {region[1] * 1000:g} mm about `{seat.text}` pass its edge",
            (Label(host.span, "its shape is stated here"),),
        )
    T_world_host = work.scene.standing[host.name].T_world_object
    for name, other in work.scene.standing.items():
        thing = work.profile.object(name)
        if thing is None or name == host.name:
            continue
        ox, oy, oz = T_world_host.locate(other.T_world_object.position_m)
        most = (thing.size_m[0] + thing.size_m[1]) / 2 + _BESIDE_M
        if abs(ox - x) >= half[0] + most or abs(oy - y) >= half[1] + most:
            continue
        reach = _reach(T_world_host.inverse() @ other.T_world_object, thing)
        beside = abs(ox - x) >= half[0] + reach[0] or abs(oy - y) >= half[1] + reach[1]
        if -thing.size_m[2] < oz - z < _HEIGHT_M and not beside:
            since = (other.since,) if other.since else ()
            refuse(
                "XEI0721",
                f"`{name}` stands in the area to wipe",
                work.span,
                f"expected {region[0] * 1000:g} x {region[1] * 1000:g} mm of free surface",
                since,
                help=(f"move `{name}` away first",),
            )


def _reach(T_host_other: Pose, thing: LabObject) -> tuple[float, float]:
    """How far an object reaches from its middle along the surface's axes, and the room to keep beside it."""
    x, y, _ = T_host_other.axes()
    length, width, _ = thing.size_m
    return (
        (abs(x[0]) * length + abs(y[0]) * width) / 2 + _BESIDE_M,
        (abs(x[1]) * length + abs(y[1]) * width) / 2 + _BESIDE_M,
    )


def _turn(held: Held, T_base_seat: Pose) -> int:
    """By how many quarter turns the tool is turned against the surface's axes: nearest to how it was
    grasped.
    """
    x, y, _ = (T_base_seat.inverse() @ held.T_base_grasped).axes()[0]
    return round(math.atan2(y, x) / (math.pi / 2)) % 4


def _area(T_base_seat: Pose, room: tuple[float, float]) -> Area:
    """The rectangle of the tool's middle; lanes run along its longer edge."""
    x, y, _ = T_base_seat.axes()
    corner = T_base_seat.apply((-room[0] / 2, -room[1] / 2, 0.0))
    edges = (along(x, room[0]), along(y, room[1]))
    return Area(corner, *(edges if room[0] >= room[1] else edges[::-1]))


WIPE = Operation(
    "wipe",
    ("wipe_above", "wipe_start", "wipe_end", "wipe_away"),
    ("lane_pitch", "wipe_height"),
    plan,
    areas=("wipe_area",),
    of="Place",
    called=("length", "width"),
)
