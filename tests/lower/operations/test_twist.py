"""Opening and closing a bottle in the air: what the cap goes through, over any sizes that the hands fit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, plan, with_object, with_skill
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, MotionGoalGraph, MoveTo, SlideMove, ToolTarget
from xei_lang.ir.skill_plan import Fact, Side, SkillPlan, Value
from xei_lang.ir.tool_paths import Turn
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.ir.world import World
from xei_lang.lower import lower
from xei_lang.lower.hand import hand_of
from xei_lang.profiles.model import LabObject, OperationDefault, Profile, TemplateStep
from xei_lang.quantity import quantity
from xei_lang.world.ground import ground

BOTTLE, CAP = "bottle_2", "bottle_2_cap"
ARMS = {"object": obj(BOTTLE), "hold": "left", "twist": "right"}
BOTH = plan(("twist_open", ARMS), ("twist_close", ARMS))


def known(profile: Profile, name: str) -> LabObject:
    found = profile.object(name)
    assert found is not None
    return found


def grounded(profile: Profile, stands: Pose | None = None) -> World:
    """The profile's world; with a pose, the closed bottle stands there (in `world`)."""
    world, problems = ground(profile)
    assert world is not None, problems
    if stands is None:
        return world
    T_bottle_cap = world.T_world_object(BOTTLE).inverse() @ world.T_world_object(CAP)
    poses = {BOTTLE: stands, CAP: stands @ T_bottle_cap}
    objects = tuple(
        replace(
            item,
            frame_id="world",
            T_frame_object=poses[item.name],
            place="" if item.name == BOTTLE else item.place,
        )
        if item.name in poses
        else item
        for item in world.objects
    )
    return replace(world, objects=objects)


def lowered(
    profile: Profile | None = None, stands: Pose | None = None, steps: SkillPlan = BOTH
) -> MotionGoalGraph:
    profile = profile or bench()[0]
    graph, problems = lower(steps, profile, grounded(profile, stands))
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def turns(graph: MotionGoalGraph, step: str) -> list[tuple[MotionGoal, Turn]]:
    found: list[tuple[MotionGoal, Turn]] = []
    for goal in graph.goals:
        if goal.step_id == step and isinstance(goal.action, MoveTo) and goal.action.path == "screw":
            assert isinstance(goal.action.along, Turn)
            found.append((goal, goal.action.along))
    return found


def reference(goal: MotionGoal) -> Pose:
    assert isinstance(goal.action, MoveTo)
    assert isinstance(goal.action.target, ToolTarget)
    return goal.action.target.T_base_reference


def goal_of(graph: MotionGoalGraph, name: str) -> MotionGoal:
    return next(goal for goal in graph.goals if goal.id == name)


def sized(cap_mm: int, body_mm: int, high_mm: int, lead_um: int, quarters: int) -> Profile:
    """The bench with another bottle and cap, the thread's turns in quarters."""
    profile = bench()[0]
    bottle, cap = known(profile, BOTTLE), known(profile, CAP)
    body, neck = body_mm / 2000, high_mm / 1000
    parts = (
        Primitive(Cylinder(body, neck), Pose((0.0, 0.0, neck / 2))),
        Primitive(Cylinder(cap_mm / 2200, 0.022), Pose((0.0, 0.0, neck + 0.011))),
    )
    mouth = replace(bottle.spots[0], T_object_spot=Pose((0.0, 0.0, neck + 0.002)))
    size = (2 * body, 2 * body, neck + 0.022)
    bottle = replace(
        bottle, shape=Cylinder(body, size[2]), geometry=parts, size_m=size, spots=(mouth,), grasp=()
    )
    shape = Cylinder(cap_mm / 2000, 0.025)
    assert cap.thread is not None
    thread = replace(cap.thread, lead_m=lead_um / 1e6, turns=quarters / 4)
    cap = replace(
        cap,
        shape=shape,
        geometry=(Primitive(shape, Pose((0.0, 0.0, 0.0125))),),
        size_m=(cap_mm / 1000, cap_mm / 1000, 0.025),
        thread=thread,
    )
    return with_object(with_object(profile, BOTTLE, bottle), CAP, cap)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(20, 60),
    st.integers(40, 80),
    st.integers(74, 140),
    st.integers(500, 8000),
    st.integers(1, 12),
)
def test_the_cap_turns_about_its_axis_and_ends_where_its_thread_does(
    cap_mm: int, body_mm: int, high_mm: int, lead_um: int, quarters: int
) -> None:
    profile = sized(cap_mm, body_mm, high_mm, lead_um, quarters)
    graph = lowered(profile)
    rise = lead_um / 1e6 * quarters / 4
    up, down = turns(graph, "twist_open#1"), turns(graph, "twist_close#1")
    assert len(up) == len(down) == math.ceil(quarters * 90 / 120)
    assert sum(turn.angle_rad for _, turn in up) == pytest.approx(quarters * math.pi / 2, abs=1e-4)
    assert sum(turn.angle_rad for _, turn in down) == pytest.approx(-quarters * math.pi / 2, abs=1e-4)
    seat = reference(goal_of(graph, "twist_open#1/11"))
    for goal, turn in (*up, *down):
        assert turn.direction == pytest.approx((0.0, 0.0, 1.0))
        assert turn.point_m[:2] == pytest.approx(seat.position_m[:2])
        assert reference(goal).position_m[:2] == pytest.approx(seat.position_m[:2])
        assert turn.lead_m == pytest.approx(lead_um / 1e6)
    assert reference(up[-1][0]).position_m[2] == pytest.approx(seat.position_m[2] + rise, abs=1e-6)
    assert reference(down[-1][0]).position_m == pytest.approx(seat.position_m, abs=1e-6)
    gap_m = hand_of(profile).max_gap_m
    for goal in graph.goals:
        if isinstance(goal.action, Grip):
            assert 0.0 < goal.action.opening_m <= gap_m
        if isinstance(goal.action, SlideMove):
            assert 0.0 <= goal.action.height_m <= 0.6


@settings(max_examples=10, deadline=None)
@given(st.integers(40, 80), st.integers(74, 140))
def test_the_holding_hand_stays_under_the_other_one_and_over_the_table(body_mm: int, high_mm: int) -> None:
    graph = lowered(sized(38, body_mm, high_mm, 4000, 4))
    family = next(item for item in graph.families if item.reference == BOTTLE)
    mouth = high_mm / 1000 + 0.002
    for member in family.members:
        _, _, z = member.T_reference_tool.position_m
        approach = member.T_reference_tool.rotate((0.0, 0.0, 1.0))
        assert 0.015 < z < mouth
        assert z < high_mm / 1000
        assert approach[2] > math.sin(math.radians(-16.0))


places = st.builds(
    lambda x, y, yaw: Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)),
    st.floats(0.50, 0.75), st.floats(-0.65, 0.65), st.floats(-math.pi, math.pi),
)  # fmt: skip
sizes = st.tuples(
    st.integers(20, 60),
    st.integers(40, 80),
    st.integers(74, 140),
    st.integers(500, 8000),
    st.integers(1, 12),
)


def both(hold: Side) -> SkillPlan:
    """Opening and closing, with this hand on the bottle."""
    args: dict[str, Value] = {"object": obj(BOTTLE), "hold": hold, "twist": other(hold)}
    return plan(("twist_open", args), ("twist_close", args))


def other(side: Side) -> Side:
    return "left" if side == "right" else "right"


@settings(max_examples=30, deadline=None)
@given(places, sizes, st.sampled_from(["left", "right"]))
def test_wherever_the_bottle_stands_its_cap_follows_its_thread_in_the_air(
    stands: Pose, drawn: tuple[int, int, int, int, int], hold: Side
) -> None:
    profile = sized(*drawn)
    graph = lowered(profile, stands, both(hold))
    assert {
        goal.action.arm for goal, _ in turns(graph, "twist_open#1") if isinstance(goal.action, MoveTo)
    } == {other(hold)}
    mouth = known(profile, BOTTLE).spots[0].T_object_spot
    for step, begins_m, sign in (("twist_open#1", 0.0, 1.0), ("twist_close#1", rise_m(drawn), -1.0)):
        height = begins_m
        T_base_seat = in_air(graph, step, hold) @ mouth
        for goal, turn in turns(graph, step):
            height += sign * abs(turn.travel_m)
            assert math.dist(turn.direction, T_base_seat.axes()[2]) < 1e-9
            assert math.dist(turn.point_m, T_base_seat.position_m) < 1e-9
            assert turn.travel_m * sign > 0.0
            wanted = T_base_seat @ Pose((0.0, 0.0, height))
            assert math.dist(reference(goal).position_m, wanted.position_m) < 1e-6
        assert height == pytest.approx(rise_m(drawn) if sign > 0.0 else 0.0, abs=1e-6)


@settings(max_examples=30, deadline=None)
@given(places, st.sampled_from(["left", "right"]))
def test_however_the_bottle_stands_its_hand_heads_inwards_in_the_air(stands: Pose, hold: Side) -> None:
    graph = lowered(None, stands, both(hold))
    inwards = -1.0 if hold == "left" else 1.0
    for step in ("twist_open#1", "twist_close#1"):
        T_base_air = in_air(graph, step, hold)
        assert math.dist(T_base_air.axes()[2], (0.0, 0.0, 1.0)) < 1e-9
        assert T_base_air.position_m[1] * inwards >= 0.0, "nearer to the turning arm"
        family = next(item for item in graph.families if item.id == f"{step}.{BOTTLE}")
        straight = next(
            item for item in family.members if item.name.startswith("low on the body, 0 deg down, 0 ")
        )
        heading = (T_base_air @ straight.T_reference_tool).axes()[2]
        assert math.degrees(math.atan2(heading[1], heading[0])) == pytest.approx(inwards * 70.0, abs=1e-6)


@settings(max_examples=20, deadline=None)
@given(places, sizes, st.sampled_from(["left", "right"]))
def test_wherever_the_bottle_stood_there_it_stands_again_with_its_cap(
    stands: Pose, drawn: tuple[int, int, int, int, int], hold: Side
) -> None:
    profile = sized(*drawn)
    world, graph = grounded(profile, stands), lowered(profile, stands, both(hold))
    T_base_world = world.robot.T_world_base.inverse()
    T_bottle_cap = stands.inverse() @ world.T_world_object(CAP)
    left = [goal.action for goal in graph.goals if isinstance(goal.action, Detach)]
    back = [item for item in left if item.object == BOTTLE]
    assert len(back) == 2
    for item in back:
        assert_same(item.T_base_object, T_base_world @ stands)
    on = [item for item in left if item.fastened_to][-1]
    assert_same(in_air(graph, "twist_close#1", hold) @ T_bottle_cap, on.T_base_object)


def assert_same(first: Pose, second: Pose) -> None:
    """To a micrometre, and a turn of a microradian or so: strokes are stated in thousandths of a degree."""
    assert math.dist(first.position_m, second.position_m) < 1e-6
    apart = first.inverse() @ second
    assert math.dist(apart.quaternion[:3], (0.0, 0.0, 0.0)) < 1e-6


def rise_m(drawn: tuple[int, int, int, int, int]) -> float:
    return drawn[3] / 1e6 * drawn[4] / 4


def in_air(graph: MotionGoalGraph, step: str, hold: Side) -> Pose:
    """Where the bottle is held in the air: the goal of the holding hand that follows the slide's."""
    index = next(
        k for k, goal in enumerate(graph.goals) if goal.step_id == step and isinstance(goal.action, SlideMove)
    )
    goal = graph.goals[index + 1]
    assert isinstance(goal.action, MoveTo)
    assert goal.action.arm == hold
    return reference(goal)


def test_the_cap_is_in_a_hand_or_rides_and_lies_on_its_rest_in_between() -> None:
    graph = lowered()
    told = [
        (goal.step_id, type(goal.action).__name__, goal.action.arm, getattr(goal.action, "fastened_to", None))
        for goal in graph.goals
        if isinstance(goal.action, (Attach, Detach)) and goal.action.object == CAP
    ]
    taken, left = ("Attach", "right", None), ("Detach", "right", BOTTLE)
    strokes = [taken, left] * 2
    assert [row[1:] for row in told if row[0] == "twist_open#1"] == [
        *strokes, taken, ("Detach", "right", "")
    ]  # fmt: skip
    assert [row[1:] for row in told if row[0] == "twist_close#1"] == [taken, left, *strokes]
    laid = next(
        goal.action
        for goal in graph.goals
        if isinstance(goal.action, Detach) and goal.action.object == CAP and not goal.action.fastened_to
    )
    assert laid.place == 'cap_rest_2.spot("cap")'


def test_the_vessel_stands_again_where_it_stood() -> None:
    graph = lowered()
    _, world = bench()
    stood = world.robot.T_world_base.inverse() @ world.T_world_object(BOTTLE)
    back = [
        goal.action
        for goal in graph.goals
        if isinstance(goal.action, Detach) and goal.action.object == BOTTLE
    ]
    assert [item.place for item in back] == ['table.spot("reagent")'] * 2
    for item in back:
        assert item.T_base_object.position_m == pytest.approx(stood.position_m)


def test_each_stroke_says_where_its_parameters_come_from() -> None:
    told = {item.name: item for item in turns(lowered(), "twist_open#1")[0][0].parameters}
    assert {name: told[name].source for name in ("stroke_angle", "lead", "twist_speed")} == {
        "stroke_angle": "computed",
        "lead": "usage_profile",
        "twist_speed": "skill",
    }
    assert told["stroke_angle"].rule == "`thread: turns` of 1 in 3 strokes of at most 120 deg"


def refused(
    *calls: tuple[str, dict[str, object]], profile: Profile | None = None, **state: str
) -> Diagnostic:
    profile = profile or bench()[0]
    steps = plan(*calls)  # type: ignore[arg-type]
    if state:
        facts = tuple(Fact("cap", name, value) for name, value in state.items())
        steps = replace(steps, steps=tuple(replace(step, state_before=facts) for step in steps.steps))
    graph, problems = lower(steps, profile, bench()[1])
    assert graph is None
    return problems[0]


def with_stroke(text: int) -> Profile:
    profile = bench()[0]
    skill = profile.bank.skill("twist_open")
    assert skill is not None
    defaults = tuple(
        OperationDefault(item.name, quantity(text, "deg"), item.span) if item.name == "stroke" else item
        for item in skill.parameters
    )
    return with_skill(profile, replace(skill, parameters=defaults))


def test_what_two_hands_cannot_open() -> None:
    said = refused(("twist_open", {**ARMS, "object": obj("bottle_1")}))
    assert (said.code, said.message) == ("XEI0728", "`bottle_1` has no cap that could be turned")
    said = refused(("twist_open", {**ARMS, "twist": "left"}))
    assert (said.code, said.message) == ("XEI0728", f"one hand cannot hold `{BOTTLE}` and turn its cap")
    assert said.help == ("say `twist=right`",)


def test_a_cap_is_where_the_vessel_s_state_says() -> None:
    said = refused(("twist_close", ARMS), **{BOTTLE: "open"})
    assert (said.code, said.message) == ("XEI0728", f"`{BOTTLE}` is said to be open, and its cap sits on it")
    said = refused(("twist_open", ARMS), ("twist_open", ARMS), **{BOTTLE: "closed"})
    assert said.message == f"`{BOTTLE}` is said to be closed, and its cap lies on `cap_rest_2`"


def test_a_cap_that_is_half_on_its_thread_contradicts_no_state() -> None:
    states = {"twist_open": "closed", "twist_close": "open"}
    told = tuple(
        replace(step, state_before=(Fact("cap", BOTTLE, states[step.skill]),)) for step in BOTH.steps
    )
    graph, problems = lower(replace(BOTH, steps=told), *bench())
    assert graph is not None, problems


def test_a_rest_that_is_taken_is_told() -> None:
    taken = plan(("pick", {"object": obj("weight_50g"), "arm": "right"}))
    assert taken.steps
    profile, world = bench()
    there = replace(
        next(item for item in world.objects if item.name == "weight_50g"),
        place='cap_rest_2.spot("cap")',
        frame_id="world",
        T_frame_object=world.T_world_object("cap_rest_2") @ Pose((0.0, 0.0, 0.06)),
    )
    world = replace(
        world, objects=tuple(there if item.name == "weight_50g" else item for item in world.objects)
    )
    graph, problems = lower(plan(("twist_open", ARMS)), profile, world)
    assert graph is None
    assert (problems[0].code, problems[0].label) == ("XEI0706", "expected a free place, found `weight_50g`")


@pytest.mark.parametrize("degrees", [0, 300])
def test_a_stroke_that_no_wrist_makes_is_told(degrees: int) -> None:
    said = refused(("twist_open", ARMS), profile=with_stroke(degrees))
    assert said.code == "XEI0702"
    assert said.label == "expected more than 0 deg and at most 270 deg"


@pytest.mark.parametrize(("stroke", "count"), [(270, 2), (180, 2), (120, 3), (90, 4)])
def test_strokes_are_as_many_as_the_thread_needs(stroke: int, count: int) -> None:
    profile, world = with_stroke(stroke), bench()[1]
    graph, problems = lower(plan(("twist_open", ARMS)), profile, world)
    assert graph is not None, problems
    assert len(turns(graph, "twist_open#1")) == count


def test_a_wide_cap_and_a_low_vessel_are_told() -> None:
    wide = sized(88, 80, 100, 4000, 4)
    assert refused(("twist_open", ARMS), profile=wide).code == "XEI0703"
    low = sized(38, 56, 50, 4000, 4)
    assert refused(("twist_open", ARMS), profile=low).code == "XEI0704"


def with_template(
    changed: Callable[[tuple[TemplateStep, ...]], tuple[TemplateStep, ...]], name: str
) -> Profile:
    profile = bench()[0]
    skill = profile.bank.skill(name)
    assert skill is not None
    return with_skill(profile, replace(skill, template=changed(skill.template)))


def no_more_strokes(lines: tuple[TemplateStep, ...]) -> tuple[TemplateStep, ...]:
    return tuple(line for line in lines if line.repeat is None)


def one_stroke_more(lines: tuple[TemplateStep, ...]) -> tuple[TemplateStep, ...]:
    """The repeated lines stand once more behind themselves."""
    last = max(k for k, line in enumerate(lines) if line.repeat is not None)
    again = tuple(replace(line, repeat=None) for line in lines if line.repeat is not None)
    return (*lines[: last + 1], *again, *lines[last + 1 :])


@pytest.mark.parametrize(
    ("name", "way", "wanted", "changed", "found"),
    [
        ("twist_open", "off", "360", no_more_strokes, "120"),
        ("twist_open", "off", "360", one_stroke_more, "480"),
        ("twist_close", "on", "-360", no_more_strokes, "-120"),
        ("twist_close", "on", "-360", one_stroke_more, "-480"),
    ],
)
def test_a_template_that_turns_a_cap_by_other_turns_than_its_thread_s_is_told(
    name: str,
    way: str,
    wanted: str,
    changed: Callable[[tuple[TemplateStep, ...]], tuple[TemplateStep, ...]],
    found: str,
) -> None:
    said = refused(("twist_open", ARMS), ("twist_close", ARMS), profile=with_template(changed, name))
    assert (said.code, said.message) == ("XEI0701", f"`{name}` does not turn `{CAP}` all the way {way}")
    assert said.label == f"expected {wanted} deg at a lead of 4 mm, found {found} deg"
    skill = bench()[0].bank.skill(name)
    assert skill is not None
    assert said.span in [line.span for line in skill.template]


@pytest.mark.parametrize("value", ["-4", "3"])
def test_a_template_that_turns_a_cap_at_another_lead_is_told(value: str) -> None:
    profile = bench()[0]
    skill = profile.bank.skill("twist_open")
    assert skill is not None
    lead = OperationDefault("other_lead", quantity(int(value), "mm"), skill.span)
    lines = tuple(
        replace(
            line, fields=tuple((key, "other_lead" if key == "lead" else text) for key, text in line.fields)
        )
        for line in skill.template
    )
    changed = replace(skill, template=lines, parameters=(*skill.parameters, lead))
    said = refused(("twist_open", ARMS), profile=with_skill(profile, changed))
    assert (said.code, said.label) == (
        "XEI0701",
        "expected 360 deg at a lead of 4 mm, found another lead",
    )
