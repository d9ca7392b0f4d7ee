"""Families: the alternative poses of the tool about one reference, and the targets that name them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import overload

from xei_lang.ir.geometry import Pose, Quaternion, Vec3
from xei_lang.record import Record, record


@record
class ToolPose(Record):
    """One member of a family: the grasp frame of the gripper in the reference frame (z approaches, y opens).

    `name` tells people what it is: `from the side, 45 deg down, azimuth 30 deg, 35 mm under the top`.
    `cost` ranks members that are otherwise alike (smaller is better).
    """

    name: str
    T_reference_tool: Pose
    cost: float = 0.0


Turned = tuple[str, Quaternion]
"""An orientation of the tool, and the first words of a member's name."""

Point = tuple[str, Vec3]
"""A position of the tool, metres, and the last words of a member's name."""


class Members(Sequence[ToolPose]):
    """Members as rows of a cost, an orientation and a position. Rows share their orientations and positions;
    a member becomes a `ToolPose` where it is read. Equal to any sequence of equal members.

    A grasp family is a product of orientations and positions with hundreds of members, and one is made for
    each object that is grasped.
    """

    __slots__ = ("_rows",)

    def __init__(self, rows: Sequence[tuple[float, Turned, Point]]) -> None:
        self._rows = rows

    def __len__(self) -> int:
        return len(self._rows)

    @overload
    def __getitem__(self, index: int) -> ToolPose: ...
    @overload
    def __getitem__(self, index: slice) -> Members: ...
    def __getitem__(self, index: int | slice) -> ToolPose | Members:
        return Members(self._rows[index]) if isinstance(index, slice) else _tool_pose(*self._rows[index])

    def __iter__(self) -> Iterator[ToolPose]:
        return (_tool_pose(*row) for row in self._rows)

    def __eq__(self, other: object) -> bool:
        return tuple(self) == (tuple(other) if isinstance(other, Members) else other)

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return repr(tuple(self))


def _tool_pose(cost: float, turned: Turned, point: Point) -> ToolPose:
    return ToolPose(turned[0] + point[0], Pose(point[1], turned[1]), cost)


@record
class Family(Record):
    """Alternative tool poses about one reference, usually the grasps of one object.

    `symmetric` says that the reference may be turned about its z axis without any difference (a round tube
    in a round slot), which a planner may use where it sets the object down.
    """

    id: str
    reference: str
    members: tuple[ToolPose, ...] | Members
    symmetric: bool = False


@record
class ToolTarget(Record):
    """A pose of the tool, up to the choice of a member of the family:

    `translate(offset_base_m) @ T_base_reference @ T_reference_tool @ translate(offset_tool_m)`.

    `offset_base_m` lifts or lowers in the base frame, `offset_tool_m` backs off along the approach (negative
    z). With `turn_reference`, and a symmetric family, the reference may also be turned about its own z axis.
    """

    family: str
    T_base_reference: Pose
    offset_base_m: Vec3 = (0.0, 0.0, 0.0)
    offset_tool_m: Vec3 = (0.0, 0.0, 0.0)
    turn_reference: bool = False
    position_tolerance_m: float = 0.001
    rotation_tolerance_rad: float = 0.01
