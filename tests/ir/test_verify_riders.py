"""What rides on other objects in a MotionGoalGraph: on something else, on no circle, not in a hand, and left
where its hand is.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import (
    Action,
    Attach,
    Detach,
    Epoch,
    GoalKind,
    Grip,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    in_hand,
)
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.ir.verify_riders import rider_problems

MOUTH = 'bottle.spot("mouth")'


def graph(*actions: Attach | Detach) -> MotionGoalGraph:
    goals = tuple(_goal(str(number), action) for number, action in enumerate(actions))
    return MotionGoalGraph(
        goals, (), (Family("f", "cap", (ToolPose("m", Pose()),)),), (Epoch(0, "a", Pose()),)
    )


def _goal(name: str, action: Action) -> MotionGoal:
    kind: GoalKind = "attach" if isinstance(action, Attach) else "detach"
    return MotionGoal(name, "s", kind, action, 0, (), Span("a.xei", 0, 1))


def screwed(name: str, on: str) -> tuple[Attach, Detach]:
    return Attach(name, "left", "f"), Detach(name, "left", MOUTH, Pose(), on)


def test_a_cap_screwed_on_in_strokes_taken_off_and_screwed_on_elsewhere() -> None:
    sound = graph(*screwed("cap", "bottle"), *screwed("cap", "bottle"), *screwed("cap", "jar"))
    assert verify_goals(sound) == ()


def test_a_cap_taken_off_may_carry_what_carried_it() -> None:
    assert not list(rider_problems(graph(*screwed("a", "b"), *screwed("a", ""), *screwed("b", "a"))))


@pytest.mark.parametrize(
    "unsound",
    [
        graph(*screwed("cap", "cap")),
        graph(*screwed("a", "b"), *screwed("b", "a")),
        graph(*screwed("a", "b"), *screwed("b", "c"), *screwed("c", "a")),
    ],
    ids=["itself", "a pair", "three"],
)
def test_nothing_rides_on_itself(unsound: MotionGoalGraph) -> None:
    assert [text for text in verify_goals(unsound) if "is fastened on itself" in text]


def test_what_is_left_to_a_hand_is_not_fastened() -> None:
    unsound = graph(
        Attach("cap", "left", "f"),
        Attach("cap", "right", "f"),
        Detach("cap", "left", in_hand("right"), Pose(), "bottle"),
    )
    assert [text for text in verify_goals(unsound) if "left to a hand, and fastened" in text]


def over(height_m: float, offset_m: float = 0.0) -> MotionGoalGraph:
    """A hand brings its cap to the origin, and leaves it fastened this much higher."""
    aim = MoveTo(ToolTarget("f", Pose(), (0.0, 0.0, offset_m)), "left")
    taken, left = screwed("cap", "bottle")
    made = graph(taken, replace(left, T_base_object=Pose((0.0, 0.0, height_m))))
    brought = MotionGoal("m", "s", "move_to", aim, 0, (), Span("a.xei", 0, 1))
    return replace(made, goals=(made.goals[0], brought, made.goals[1]))


def test_what_is_fastened_is_where_its_hand_is() -> None:
    assert verify_goals(over(0.0)) == ()
    assert verify_goals(over(0.002, 0.002)) == ()
    told = ("goal `1`: `cap` is fastened elsewhere than where its hand is",)
    assert verify_goals(over(0.002)) == told
    assert verify_goals(over(0.0, 0.002)) == told


def test_a_hand_that_opened_about_what_it_holds_lets_go_before_it_moves() -> None:
    made = over(0.0)
    taken, brought, left = made.goals
    opens = MotionGoal("o", "s", "open_gripper", Grip("left", 0.05), 0, (), Span("a.xei", 0, 1))
    closes = replace(opens, id="c", kind="close_gripper", action=Grip("left", 0.03))
    told = ("goal `m`: the left hand moves with open jaws, and still holds `cap`",)
    assert verify_goals(replace(made, goals=(taken, opens, brought, left))) == told
    assert verify_goals(replace(made, goals=(taken, opens, closes, brought, left))) == ()
    assert verify_goals(replace(made, goals=(taken, brought, opens, left))) == ()
    other = replace(opens, action=Grip("right", 0.05))
    assert verify_goals(replace(made, goals=(taken, other, brought, left))) == ()
