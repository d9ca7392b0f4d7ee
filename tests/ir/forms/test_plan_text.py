from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

from xei_lang.diagnostics import Span
from xei_lang.ir.forms.plan_text import to_text, value_text
from xei_lang.ir.skill_plan import (
    Argument,
    Call,
    Condition,
    Fact,
    ObjectRef,
    PlaceRef,
    SafetyNote,
    SkillPlan,
    StationRef,
    Step,
    TimeConstraint,
    UnmappedRequest,
)
from xei_lang.quantity import parse_quantity, quantity

SPAN = Span("small.xei", 0, 1)
TUBE, SLOT = ObjectRef("tube_1"), PlaceRef("rack_1", "slot", "A1")
START = (Fact("at", "tube_1", SLOT), Fact("holding", "left", "nothing"))
HELD = (Fact("holding", "left", TUBE),)


def _plan() -> SkillPlan:
    steps = (
        Step(
            "grasp",
            "skill",
            SPAN,
            "pick",
            "arm",
            (
                Argument("object", TUBE, "object", "call", SPAN),
                Argument("arm", "left", "Arm", "default", SPAN),
            ),
            (2.0, 60.0),
            resources=("left_arm", "left_gripper"),
            state_before=START,
        ),
        Step(
            "cool.wait#1",
            "wait",
            SPAN,
            args=(Argument("duration", parse_quantity("1.5 min"), "Time", "call", SPAN),),
            duration_s=(90.0, 90.0),
            after=("grasp",),
            when=(Condition("od > 0.6", ("od",), SPAN),),
            state_before=HELD,
            origin=(Call("cool", SPAN),),
        ),
        Step(
            "ask",
            "confirm",
            SPAN,
            owner="person",
            args=(Argument("text", "Ice is in the bucket", "String", "call", SPAN),),
            duration_s=(0.0, math.inf),
            after=("cool.wait#1",),
            resources=("person",),
            state_before=HELD,
        ),
    )
    return SkillPlan(
        "small",
        "openarm_bench",
        steps,
        START,
        (
            TimeConstraint("grasp", "end", "cool.wait#1", "start", 0.0, 300.0, SPAN),
            TimeConstraint("grasp", "end", "ask", "start", 5.0, math.inf, SPAN),
        ),
        (
            UnmappedRequest("spin it", "no centrifuge", "grasp", SPAN),
            UnmappedRequest("weigh it", "", None, SPAN),
        ),
        (SafetyNote("The tube is open.", "cool.wait#1", SPAN),),
    )


def test_a_plan_in_words(golden: Callable[[str, str], None]) -> None:
    golden("ir/plan.txt", to_text(_plan()))


def test_a_plan_without_steps_is_one_line() -> None:
    assert to_text(SkillPlan("nothing", "bench", ())) == "protocol nothing for bench: 0 steps\n"


def test_values_are_written_as_a_protocol_writes_them() -> None:
    whole = (
        True,
        3,
        0.5,
        quantity(Fraction(5, 2), "mL"),
        SLOT,
        PlaceRef("table", "surface", ""),
        StationRef("b"),
    )
    assert value_text(whole) == '[true, 3, 0.5, 2.5 mL, rack_1.slot("A1"), table, b]'
