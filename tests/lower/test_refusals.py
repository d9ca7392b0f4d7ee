"""What lowering refuses: one diagnostic a mistake, at the user's words, with the earlier step or the prior as
label.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.plans import bench, moved, obj, plan, put_on_rack, slot, surface, with_object, with_skill
from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.ir.geometry import Box, Cylinder, Pose
from xei_lang.ir.skill_plan import Argument, PoseIn, SkillPlan
from xei_lang.ir.world import World
from xei_lang.lower import lower
from xei_lang.profiles.model import LabObject, OperationDefault, Profile, SkillSpec, TemplateStep
from xei_lang.quantity import parse_quantity, quantity


def refused(of: SkillPlan, profile: Profile | None = None, world: World | None = None) -> Diagnostic:
    default_profile, default_world = bench()
    graph, problems = lower(of, profile or default_profile, world or default_world)
    assert graph is None
    assert len(problems) == 1, [item.message for item in problems]
    return problems[0]


def known(name: str) -> LabObject:
    found = bench()[0].object(name)
    assert found is not None
    return found


def skill(name: str) -> SkillSpec:
    found = bench()[0].bank.skill(name)
    assert found is not None
    return found


def shaped(name: str, shape: Box | Cylinder, **changes: object) -> Profile:
    size = (
        shape.size_m if isinstance(shape, Box) else (2 * shape.radius_m, 2 * shape.radius_m, shape.height_m)
    )
    changed = replace(known(name), shape=shape, size_m=size, **changes)
    return with_object(bench()[0], name, changed)


def pick(name: str, arm: str = "either") -> tuple[str, dict[str, object]]:
    return ("pick", {"object": obj(name), "arm": arm})


def test_an_object_wider_than_the_jaws_in_each_direction() -> None:
    profile = shaped("beaker_1", Box((0.10, 0.09, 0.05)))
    found = refused(plan(pick("beaker_1")), profile)
    assert found.code == "XEI0703"
    assert found.span == Span("test.xei", 10, 18)
    assert "90 mm wide where it is narrowest, the jaws open 88 mm at most" in found.label
    assert found.labels[0].span == known("beaker_1").span


def test_a_box_narrow_in_one_direction_is_graspable() -> None:
    profile, world = shaped("beaker_1", Box((0.20, 0.06, 0.05))), bench()[1]
    graph, problems = lower(plan(pick("beaker_1")), profile, world)
    assert graph is not None, problems
    assert all(abs(member.T_reference_tool.axes()[1][0]) < 1e-9 for member in graph.families[0].members)


def test_an_object_that_stands_too_deep_in_its_slot() -> None:
    found = refused(plan(pick("tube_1")), shaped("tube_1", Cylinder(0.0085, 0.066)))
    assert found.code == "XEI0704"
    assert 'rack_1.slot("A1")' in found.message


def test_an_object_that_would_stand_too_deep_where_it_goes() -> None:
    profile = shaped("wipe_1", Cylinder(0.008, 0.080), roles=("movable", "insert_object"))
    into = ("insert", {"object": obj("wipe_1"), "into": slot("rack_2", "A1"), "arm": "either"})
    lower_alone, problems = lower(plan(pick("wipe_1")), profile, bench()[1])
    assert lower_alone is not None, problems
    found = refused(plan(pick("wipe_1"), into), profile)
    assert found.code == "XEI0704"
    assert 'rack_2.slot("A1")' in found.message


def test_a_slot_that_does_not_accept_the_object() -> None:
    found = refused(
        plan(
            pick("wipe_1"), ("place", {"object": obj("wipe_1"), "on": slot("rack_2", "A1"), "arm": "either"})
        )
    )
    assert found.code == "XEI0705"
    assert found.span == Span("test.xei", 120, 128)


def test_an_object_wider_than_the_bore() -> None:
    profile = shaped("tube_1", Cylinder(0.0095, 0.118))
    found = refused(put_on_rack(), profile)
    assert found.code == "XEI0714"
    assert "19 mm across, the bore is 18 mm" in found.label


def test_a_slot_that_is_occupied_from_the_start() -> None:
    found = refused(
        plan(
            pick("tube_1"),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_1", "A2"), "arm": "either"}),
        )
    )
    prior = known("tube_2").prior
    assert prior is not None
    assert (found.code, found.labels[0].span) == ("XEI0706", prior.span)
    assert "`tube_2`" in found.message


def test_a_slot_that_an_earlier_step_filled() -> None:
    def into(name: str) -> tuple[str, dict[str, object]]:
        return ("insert", {"object": obj(name), "into": slot("rack_2", "A1"), "arm": "either"})

    found = refused(plan(pick("tube_1"), into("tube_1"), pick("tube_2"), into("tube_2")))
    assert (found.code, found.labels[0].span) == ("XEI0706", Span("test.xei", 100, 190))


def test_setting_down_what_no_hand_holds() -> None:
    found = refused(
        plan(("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "either"}))
    )
    assert (found.code, found.span) == ("XEI0707", Span("test.xei", 10, 18))
    assert found.help == ("pick `tube_1` up before this step",)


def test_setting_down_from_the_wrong_hand() -> None:
    found = refused(
        plan(
            pick("tube_1", "left"),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "right"}),
        )
    )
    assert found.code == "XEI0707"
    assert "the right hand" in found.message


def test_picking_with_a_full_hand_and_picking_twice() -> None:
    full = refused(plan(pick("tube_1", "left"), pick("tube_2", "left")))
    assert (full.code, full.labels[0].span) == ("XEI0708", Span("test.xei", 0, 90))
    twice = refused(plan(pick("tube_1", "left"), pick("tube_1", "right")))
    assert twice.code == "XEI0708"
    assert "the left hand holds it" in twice.message


@pytest.mark.parametrize("which", ["open_gripper", "close_gripper"])
def test_jaws_that_move_around_what_they_hold(which: str) -> None:
    args: dict[str, object] = {"arm": "left"}
    if which == "open_gripper":
        args["width"] = parse_quantity("50 mm")
    found = refused(plan(pick("tube_1", "left"), (which, args)))
    assert (found.code, found.labels[0].span) == ("XEI0709", Span("test.xei", 0, 90))


def test_an_object_that_is_not_in_the_world() -> None:
    world = bench()[1]
    world = replace(world, objects=tuple(item for item in world.objects if item.name != "tube_1"))
    assert refused(plan(pick("tube_1")), world=world).code == "XEI0710"


def test_a_place_that_does_not_exist() -> None:
    found = refused(
        plan(
            pick("tube_1"),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "Z9"), "arm": "either"}),
        )
    )
    assert found.code == "XEI0711"


def test_an_object_that_carries_another() -> None:
    x, y, z = bench()[1].T_world_object("wipe_1").position_m
    world = moved(bench()[1], "tube_1", Pose((x, y, z + known("wipe_1").size_m[2])))
    found = refused(plan(pick("wipe_1")), world=world)
    assert found.code == "XEI0712"
    assert "`tube_1` stands on it" in found.message


def test_a_surface_without_room() -> None:
    profile = shaped("waste_bin", Cylinder(0.01, 0.15))
    call = ("move_object", {"object": obj("beaker_1"), "to": surface("waste_bin"), "arm": "either"})
    assert refused(plan(call), profile).code == "XEI0713"


def test_a_robot_that_starts_nowhere() -> None:
    world = bench()[1]
    world = replace(world, robot=replace(world.robot, station="kitchen"))
    assert refused(put_on_rack(), world=world).code == "XEI0715"


def test_a_statement_that_is_not_compiled_yet() -> None:
    assert refused(plan(("fly_to", {}))).code == "XEI0105"


def test_one_mistake_is_reported_once_and_two_twice() -> None:
    profile, world = bench()
    bad = plan(
        ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "left"}),
        ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A2"), "arm": "left"}),
        ("insert", {"object": obj("tube_2"), "into": slot("rack_2", "A1"), "arm": "left"}),
    )
    graph, problems = lower(bad, profile, world)
    assert graph is None
    assert [item.code for item in problems] == ["XEI0707", "XEI0707"]


BAD_LINES = (
    (TemplateStep("move_to", (("tool", "arm"), ("at", "object.pregrap")), Span("p", 1, 2)), "object.pregrap"),
    (TemplateStep("move_to", (("tool", "arm"), ("at", "arm.grasp")), Span("p", 1, 2)), "`arm`"),
    (TemplateStep("move_to", (("tool", "hand"), ("at", "object.grasp")), Span("p", 1, 2)), "`hand`"),
    (TemplateStep("move_to", (("configuration", "redy"),), Span("p", 1, 2)), "`redy`"),
    (TemplateStep("move_to", (("configuration", "ready"), ("keep", "level")), Span("p", 1, 2)), "`level`"),
    (TemplateStep("move_to", (("configuration", "ready"), ("path", "bent")), Span("p", 1, 2)), "`bent`"),
    (TemplateStep("move_to", (("configuration", "ready"), ("sped", 1)), Span("p", 1, 2)), "`sped`"),
    (TemplateStep("open_gripper", (("arm", "arm"), ("width", "gap")), Span("p", 1, 2)), "`gap`"),
    (TemplateStep("open_gripper", (("arm", "arm"),), Span("p", 1, 2)), "`width`"),
    (TemplateStep("attach", (("object", "object"), ("arm", "arm")), Span("p", 1, 2)), "`object`"),
    (TemplateStep("nav_to_pose", (("station", "object"),), Span("p", 1, 2)), "`object`"),
    (TemplateStep("set_do", (("output", "object"), ("value", 3)), Span("p", 1, 2)), "`set_do`"),
    (TemplateStep("detach", (("object", "object"), ("arm", "arm"), ("at", "up")), Span("p", 1, 2)), "`up`"),
)  # fmt: skip


@pytest.mark.parametrize(("line", "named"), BAD_LINES)
def test_a_template_that_names_something_missing_is_shown_in_the_profile(
    line: TemplateStep, named: str
) -> None:
    profile = with_skill(bench()[0], replace(skill("pick"), template=(line,)))
    found = refused(plan(pick("tube_1")), profile)
    assert (found.code, found.span) == ("XEI0701", Span("p", 1, 2))
    assert named in found.message


BAD_PARAMETERS = (
    ("pick", "approach_speed", "30 mm"),
    ("pick", "approach_speed", "0 %"),
    ("pick", "approach_speed", "150 %"),
    ("insert", "approach_speed", "150 %"),
)


@pytest.mark.parametrize(("name", "parameter", "value"), BAD_PARAMETERS)
def test_a_skill_parameter_that_does_not_fit(name: str, parameter: str, value: str) -> None:
    spec, span = skill(name), Span("development.yaml", 5, 9)
    bad = OperationDefault(parameter, parse_quantity(value), span)
    kept = tuple(item for item in spec.parameters if item.name != parameter)
    profile = with_skill(bench()[0], replace(spec, parameters=(*kept, bad)))
    found = refused(put_on_rack(), profile)
    assert (found.code, found.span) == ("XEI0702", span)


BAD_GRASPS = (
    ("approach", "sideways", "XEI0702"),
    ("open_width", "120 mm", "XEI0702"),
    ("jaw_clearance", "80 mm", "XEI0702"),
    ("insertion_depth", "70 mm", "XEI0702"),
    ("insertion_depth", "-1 mm", "XEI0702"),
    ("insertion_depth", "5 mm", "XEI0702"),
    ("insertion_depth", "59 mm", "XEI0702"),
    ("approach_height", "60 mm", "XEI0702"),
    ("lift", "60 mm", "XEI0702"),
    ("release_width", "17 mm", "XEI0702"),
    ("standoff", "20 mm", "XEI0702"),
    ("grasp_depth", "60 mm", "XEI0702"),
)


@pytest.mark.parametrize(("name", "value", "code"), BAD_GRASPS)
def test_a_usage_profile_parameter_that_does_not_fit(name: str, value: str, code: str) -> None:
    written = value if name == "approach" else parse_quantity(value)
    span = Span("usage.yaml", 5, 9)
    tube = replace(known("tube_1"), grasp=(OperationDefault(name, written, span),))
    found = refused(put_on_rack(), with_object(bench()[0], "tube_1", tube))
    assert found.code == code
    if code == "XEI0702":
        assert found.span in (span, Span("test.xei", 10, 18))


def test_a_tube_is_not_dropped_into_its_slot() -> None:
    span = Span("usage.yaml", 5, 9)
    tube = replace(
        known("tube_1"), grasp=(OperationDefault("insertion_depth", parse_quantity("5 mm"), span),)
    )
    found = refused(put_on_rack(), with_object(bench()[0], "tube_1", tube))
    assert found.message == '`insertion_depth` of 5 mm lets `tube_1` fall 60 mm in `rack_2.slot("A1")`'
    assert found.label == "expected 60 mm .. 65 mm"
    slots = bench()[0].object("rack_2")
    assert slots is not None
    assert slots.slots is not None
    assert [label.span for label in found.labels] == [slots.slots.span]


def test_a_usage_profile_outranks_what_is_computed() -> None:
    span = Span("usage.yaml", 5, 9)
    written = (
        OperationDefault("approach", "top", span),
        OperationDefault("width", parse_quantity("16 mm"), span),
        OperationDefault("standoff", parse_quantity("120 mm"), span),
    )
    profile = with_object(bench()[0], "tube_1", replace(known("tube_1"), grasp=written))
    graph, problems = lower(put_on_rack(), profile, bench()[1])
    assert graph is not None, problems
    told = {item.name: (item.value, item.source) for goal in graph.goals[:6] for item in goal.parameters}
    assert told["grasp_width"] == ("16 mm", "usage_profile")
    assert told["standoff"] == ("120 mm", "usage_profile")
    kinds = {member.name.partition(",")[0] for member in graph.families[0].members}
    assert kinds == {"60 deg down", "straight down"}


def test_a_pose_in_an_argument_is_refused_by_name() -> None:
    zero, turn = quantity(0, "m"), quantity(0, "deg")
    pose = PoseIn("table", (zero, zero, zero), (turn, turn, turn))
    fetch = plan(("pick", {"object": obj("tube_1"), "arm": "left"}))
    (step,) = fetch.steps
    there = Argument("there", (pose,), "List[Pose]", "call", Span("p.xei", 3, 7))
    said = refused(replace(fetch, steps=(replace(step, args=(*step.args, there)),)))
    assert said.code == "XEI0105"
    assert said.message == "`there` of `pick`, a pose, is not compiled to motion yet"
    assert said.span == Span("p.xei", 3, 7)
