"""What two hands cannot open or close, and templates that do not turn a cap as its thread asks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import pytest

from tests.lower.plans import bench, obj, plan, with_skill
from tests.lower.twisted import (
    ARMS,
    BOTH,
    BOTTLE,
    CAP,
    sized,
    with_stroke,
)
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach
from xei_lang.ir.skill_plan import Fact
from xei_lang.lower import lower
from xei_lang.profiles.model import OperationDefault, Profile, TemplateStep
from xei_lang.quantity import quantity


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


def test_what_two_hands_cannot_open() -> None:
    said = refused(("twist_open", {**ARMS, "object": obj("bottle_1")}))
    assert (said.code, said.message) == ("XEI0728", "`bottle_1` has no cap that could be turned")
    assert said.help[0] == f"with a screw cap: `{BOTTLE}`"
    said = refused(("twist_open", {**ARMS, "twist": "left"}))
    assert (said.code, said.message) == ("XEI0728", f"one hand cannot hold `{BOTTLE}` and turn its cap")
    assert said.help == ("say `twist=right`",)


@pytest.mark.parametrize(("either", "stated"), [("hold", "twist"), ("twist", "hold")])
@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_that_is_not_said_is_the_one_that_the_step_does_not_name(
    either: str, stated: str, side: str
) -> None:
    calls = plan(("twist_open", {"object": obj(BOTTLE), either: "either", stated: side}))
    graph, problems = lower(calls, bench()[0], bench()[1])
    assert graph is not None, problems
    taken = [(one.action.object, one.action.arm) for one in graph.goals if isinstance(one.action, Attach)]
    hands = dict(reversed(taken))
    other = "right" if side == "left" else "left"
    assert (hands[BOTTLE], hands[CAP]) == ((side, other) if stated == "hold" else (other, side))


def test_strokes_too_many_to_be_made_are_told_where_the_stroke_is_written() -> None:
    profile = with_stroke(Fraction(1, 1000))
    said = refused(("twist_open", ARMS), profile=profile)
    assert (said.code, said.message) == ("XEI0702", "`stroke` of 0.001 deg makes 360000 strokes of a thread")
    spec = profile.bank.skill("twist_open")
    assert spec is not None
    assert said.span == next(item.span for item in spec.parameters if item.name == "stroke")


def test_a_cap_is_where_the_vessel_s_state_says() -> None:
    said = refused(("twist_close", ARMS), **{BOTTLE: "open"})
    assert (said.code, said.message) == ("XEI0728", f"`{BOTTLE}` is said to be open, and its cap sits on it")
    said = refused(("twist_open", ARMS), ("twist_open", ARMS), **{BOTTLE: "closed"})
    assert said.message == f"`{BOTTLE}` is said to be closed, and its cap lies on `cap_rest_2`"


def test_what_is_open_is_not_opened_nor_what_is_closed_closed() -> None:
    said = refused(("twist_open", ARMS), ("twist_open", ARMS))
    assert (said.code, said.message) == (
        "XEI0728",
        f"`{BOTTLE}` is open already: its cap lies on `cap_rest_2`",
    )
    assert said.label == "`twist_open` requires cap(object) == closed"
    assert said.help == ("leave this step out",)
    said = refused(("twist_close", ARMS))
    assert said.message == f"`{BOTTLE}` is closed already: its cap sits on it"
    assert said.label == "`twist_close` requires cap(object) == open"


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
