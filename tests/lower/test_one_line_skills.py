"""New skills of one line and few arguments: whatever the line names is lowered or refused, and no crash."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from types import MappingProxyType

import pytest

from tests.lower.plans import bench, obj, plan, slot
from xei_lang.diagnostics import Diagnostics, Span
from xei_lang.ir.skill_plan import Value
from xei_lang.lower import lower
from xei_lang.lower.operations import OPERATIONS, Operation
from xei_lang.profiles.model import ArgSpec, OperationDefault, Profile, Repeat, SkillSpec, TemplateStep
from xei_lang.quantity import quantity

HERE = Span("bank", 0, 1)
Call = tuple[str, dict[str, Value]]
TURN = (
    OperationDefault("turn", quantity(30, "deg"), HERE),
    OperationDefault("lanes", quantity(9, "mm"), HERE),
)
PICK: Call = ("pick", {"object": obj("tube_1"), "arm": "left"})
ARGUMENTS = ("object", "object.cap", "object.rest", "place", "arm", "nobody")


def arg(name: str, type_: str, choices: tuple[str, ...] = ()) -> ArgSpec:
    return ArgSpec(name, type_, None, None, None, None, True, choices, HERE)


def with_line(*lines: Mapping[str, str], more: tuple[ArgSpec, ...] = ()) -> Profile:
    """The bench with the skill `foo` whose template these moves are."""
    profile, _ = bench()
    spec = profile.bank.skill("pick")
    assert spec is not None
    args = (arg("object", "object"), arg("place", "Place"), arg("arm", "Arm"), *more)
    template = tuple(
        TemplateStep("move_to", tuple({"tool": "arm", **fields}.items()), HERE, None, (index,))
        for index, fields in enumerate(lines)
    )
    foo = replace(spec, name="foo", args=args, requires=(), ensures=(), parameters=TURN, template=template)
    return with_new(profile, foo)


def with_new(profile: Profile, spec: SkillSpec) -> Profile:
    return replace(profile, bank=replace(profile.bank, skills=(*profile.bank.skills, spec)))


def lowered(
    profile: Profile,
    name: str = "tube_1",
    held: bool = False,
    more: Mapping[str, Value] = MappingProxyType({}),
) -> Diagnostics:
    call: Call = ("foo", {"object": obj(name), "place": slot("rack_2", "A1"), "arm": "left", **more})
    graph, problems = lower(plan(*((PICK,) if held else ()), call), profile, bench()[1])
    assert (graph is None) == bool(problems)
    for problem in problems:
        assert problem.span is not None, problem.message
    return problems


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda item: item.name)
@pytest.mark.parametrize(("name", "held"), [("tube_1", False), ("tube_1", True), ("bottle_2", False)])
def test_a_line_to_any_point_is_lowered_or_refused(operation: Operation, name: str, held: bool) -> None:
    for point, argument in product(operation.points, ARGUMENTS):
        lowered(with_line({"at": f"{argument}.{point}"}), name, held)


@pytest.mark.parametrize("operation", [item for item in OPERATIONS if item.axes or item.areas])
@pytest.mark.parametrize(("name", "held"), [("tube_1", True), ("bottle_2", False)])
def test_a_line_about_any_axis_or_area_is_lowered_or_refused(
    operation: Operation, name: str, held: bool
) -> None:
    at = "object.lift" if held else "object.pregrasp"
    for axis, argument in product(operation.axes, ARGUMENTS):
        lowered(
            with_line({"at": at, "path": "arc", "axis": f"{argument}.{axis}", "angle": "turn"}), name, held
        )
    for area, argument in product(operation.areas, ARGUMENTS):
        line = {"at": at, "path": "raster", "area": f"{argument}.{area}", "pitch": "lanes"}
        lowered(with_line(line), name, held)


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda item: item.name)
def test_what_an_operation_needs_is_named_at_the_line(operation: Operation) -> None:
    argument = {"cap": "object.cap", "Place": "place"}.get(operation.of, "object")
    for needed in (*operation.needs, *operation.called):
        (problem,) = lowered(with_line({"at": f"{argument}.{operation.points[0]}"}), "bottle_2")
        assert problem.code == "XEI0701"
        assert problem.span == HERE
        first = (*operation.called, *operation.needs)[0]
        assert f"needs `{first}`" in problem.message, needed


SWIPED = (arg("element", "String"), arg("distance", "Length"), arg("direction", "choice", ("left", "inward")))


@pytest.mark.parametrize("direction", ["inward", "left"])
def test_a_direction_that_no_swipe_has_is_refused(direction: str) -> None:
    given: dict[str, Value] = {"element": "start", "distance": quantity(5, "mm"), "direction": direction}
    problems = lowered(with_line({"at": "object.swipe_above"}, more=SWIPED), "incubator_screen", more=given)
    assert [item.code for item in problems] == (["XEI0720"] if direction == "inward" else [])


@pytest.mark.parametrize(
    ("skill", "name"),
    [
        (skill, name)
        for skill in ("twist_open", "twist_close")
        for name in ("stroke", "lift", "approach_height", "jaw_clearance", "cap_lift")
    ],
)
def test_a_parameter_that_is_taken_out_is_named(skill: str, name: str) -> None:
    profile, world = bench()
    spec = profile.bank.skill(skill)
    assert spec is not None
    left = tuple(item for item in spec.parameters if item.name != name)
    bank = replace(
        profile.bank,
        skills=tuple(
            replace(item, parameters=left) if item.name == skill else item for item in profile.bank.skills
        ),
    )
    args: dict[str, Value] = {"object": obj("bottle_2"), "hold": "left", "twist": "right"}
    graph, (problem,) = lower(plan((skill, args)), replace(profile, bank=bank), world)
    assert graph is None
    if skill == "twist_open":
        assert problem.code == "XEI0701"
        assert f"needs `{name}`" in problem.message


def test_a_setting_that_measures_something_else_is_refused_at_its_line() -> None:
    repeated = with_line({"at": "object.pregrasp"}, {"at": "object.grasp"})
    foo = repeated.bank.skills[-1]
    twice = replace(foo.template[1], repeat=Repeat("grasp_width", 1, HERE))
    often = replace(foo, template=(foo.template[0], twice))
    (problem,) = lowered(with_new(bench()[0], often))
    assert (problem.code, problem.span) == ("XEI0702", HERE)
    (problem,) = lowered(with_line({"at": "object.pregrasp", "speed": "grasp_width"}))
    assert (problem.code, problem.span) == ("XEI0702", HERE)
