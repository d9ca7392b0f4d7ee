"""The members of a family are what their rows say, however they are read."""

from __future__ import annotations

import pickle

from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.families import Members, ToolPose
from xei_lang.ir.geometry import Pose

TURNED = [("from the side", (0.0, 0.0, 0.0, 1.0)), ("straight down", (1.0, 0.0, 0.0, 0.0))]
POINTS = [(", at the top", (0.0, 0.0, 0.1)), (", in the middle", (0.0, 0.0, 0.05))]
ROWS = st.lists(st.tuples(st.floats(0.0, 1.0), st.sampled_from(TURNED), st.sampled_from(POINTS)), max_size=6)
Row = tuple[float, tuple[str, tuple[float, float, float, float]], tuple[str, tuple[float, float, float]]]


def written_out(rows: list[Row]) -> tuple[ToolPose, ...]:
    return tuple(
        ToolPose(words + where, Pose(position_m, quaternion), cost)
        for cost, (words, quaternion), (where, position_m) in rows
    )


@given(ROWS, st.slices(6))
def test_members_read_as_if_written_out(rows: list[Row], some: slice) -> None:
    members, tools = Members(rows), written_out(rows)
    assert tuple(members) == tools
    assert len(members) == len(tools)
    assert [members[k] for k in range(-len(rows), len(rows))] == [*tools, *tools]
    assert tuple(members[some]) == tools[some]
    assert repr(members) == repr(tools)


@given(ROWS, ROWS)
def test_members_are_equal_to_equal_members(one: list[Row], other: list[Row]) -> None:
    assert (Members(one) == Members(other)) == (written_out(one) == written_out(other))
    assert Members(one) == written_out(one)
    assert written_out(one) == Members(one)
    assert hash(Members(one)) == hash(written_out(one))
    assert Members(one) != one
    assert pickle.loads(pickle.dumps(Members(one))) == Members(one)
