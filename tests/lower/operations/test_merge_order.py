"""Skill default < computed < usage profile < call, for every parameter of every operation, and what a goal
keeps of it: which source won, by which rule, and where it is written.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, slot, spot
from tests.lower.works import Args, holding, step_of, work_of
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef
from xei_lang.lower.operations import OPERATIONS, Work
from xei_lang.lower.parameters import Layers, Setting, Source
from xei_lang.lower.walk import Scene
from xei_lang.quantity import parse_quantity


def scene() -> Scene:
    profile, world = bench()
    return Scene.of(world, profile)


def on(
    skill: str, args: Args, subject: ObjectRef | PlaceRef, about: str, hand: str = "left"
) -> Callable[[], Work]:
    """How to make the work of an operation; `hand` holds what the step is about, or none does."""
    start = scene()
    if hand:
        start = holding(about, start, "left" if hand == "left" else "right")
    step = step_of(skill, {**args, "arm": "left"})
    return lambda: work_of(step, subject, about, start)


TUBE, BEAKER, PIPETTE, SCREEN = (
    obj(name) for name in ("tube_1", "beaker_1", "pipette_1", "incubator_screen")
)
SOURCE, HOLE, FRONT = obj("beaker_3"), slot("rack_2", "A1"), spot("table", "front")
BOTTLE, CAP = obj("bottle_2"), obj("bottle_2_cap")
TIP = slot("tip_box_1", "B2")
DRAW: Args = {"pipette": PIPETTE, "volume": parse_quantity("200 uL")}
AREA: Args = {"length": parse_quantity("100 mm"), "width": parse_quantity("180 mm")}
POURED: Args = {"source": SOURCE, "target": BEAKER, "volume": parse_quantity("60 mL")}
TOUCH: Args = {"screen": SCREEN, "element": "start", "direction": "right", "distance": parse_quantity("9 mm")}

WORKS: dict[str, Callable[[], Work]] = {
    "grasp": on("pick", {"object": TUBE}, TUBE, "tube_1", hand=""),
    "lift": on("pick", {"object": TUBE}, TUBE, "tube_1"),
    "place": on("insert", {"object": TUBE, "into": HOLE}, HOLE, "tube_1"),
    "pour": on("pour", POURED, BEAKER, "beaker_3"),
    "tap": on("tap", TOUCH, SCREEN, "incubator_screen", hand=""),
    "swipe": on("swipe", TOUCH, SCREEN, "incubator_screen", hand=""),
    "wipe": on("wipe", {"object": obj("wipe_1"), "on": FRONT, **AREA}, FRONT, "wipe_1"),
    "invert": on("invert", {"object": TUBE, "angle": parse_quantity("90 deg")}, TUBE, "tube_1"),
    "shake": on("shake", {"object": TUBE, "amplitude": parse_quantity("9 deg")}, TUBE, "tube_1"),
    "give": on("handover", {"object": PIPETTE, "to": "right"}, PIPETTE, "pipette_1"),
    "take": on("handover", {"object": PIPETTE, "to": "left"}, PIPETTE, "pipette_1", hand="right"),
    "tip": on("attach_tip", {"pipette": PIPETTE, "tip": TIP}, TIP, "pipette_1"),
    "aspirate": on("aspirate", {**DRAW, "source": SOURCE}, SOURCE, "pipette_1"),
    "dispense": on("dispense", {**DRAW, "target": BEAKER}, BEAKER, "pipette_1"),
    "steady": on("twist_open", {"object": BOTTLE}, BOTTLE, "bottle_2", hand=""),
    "cap": on("twist_open", {"object": BOTTLE}, CAP, "bottle_2_cap", hand=""),
    "thread": on("twist_open", {"object": BOTTLE}, CAP, "bottle_2_cap", hand=""),
    "eject": on("eject_tip", {"pipette": PIPETTE, "waste": obj("waste_bin")}, obj("waste_bin"), "pipette_1"),
}

RANGES: dict[str, tuple[int, int, str]] = {
    "standoff": (90, 120, "mm"),
    "jaw_clearance": (1, 3, "mm"),
    "open_width": (40, 80, "mm"),
    "grasp_width": (5, 17, "mm"),
    "grasp_depth": (20, 30, "mm"),
    "lift": (100, 150, "mm"),
    "approach_height": (100, 150, "mm"),
    "insertion_depth": (60, 65, "mm"),
    "release_width": (40, 80, "mm"),
    "pour_clearance": (5, 40, "mm"),
    "pour_height": (120, 200, "mm"),
    "fill": (70, 200, "mL"),
    "pour_angle": (20, 120, "deg"),
    "pour_time": (1, 60, "s"),
    "tap_standoff": (10, 80, "mm"),
    "swipe_standoff": (10, 80, "mm"),
    "lane_pitch": (10, 40, "mm"),
    "wipe_height": (10, 90, "mm"),
    "air_ahead": (200, 400, "mm"),
    "air_clearance": (50, 200, "mm"),
    "press_force": (1, 9, "N"),
    "alignment_tolerance": (1, 3, "mm"),
    "tip_height": (80, 150, "mm"),
    "tip_depth": (1, 20, "mm"),
    "rim_clearance": (10, 60, "mm"),
    "aspirate_time": (1, 60, "s"),
    "dispense_time": (1, 60, "s"),
    "eject_height": (5, 60, "mm"),
    "hold_width": (40, 56, "mm"),
    "hold_open_width": (60, 80, "mm"),
    "twist_slide": (0, 600, "mm"),
    "cap_width": (20, 38, "mm"),
    "cap_open_width": (40, 80, "mm"),
    "cap_depth": (3, 20, "mm"),
}  # fmt: skip
"""Values that every operation with the parameter takes."""

FACTS = {"tool_point", "shake_swing", "lead", "stroke_angle", "more_strokes"}
"""What nobody may write: it follows from the profile of a pipette or a cap, or from another parameter."""

PARAMETERS = [
    (item.name, name)
    for item in OPERATIONS
    if item.name in WORKS
    for name in item.parameters
    if name not in FACTS
]


def said(name: str, source: Source, value: int, unit: str) -> Setting:
    """A written setting, each source at a place of its own."""
    start = {"skill": 0, "usage_profile": 10, "call": 20, "computed": 30}[source]
    return Setting(
        name, parse_quantity(f"{value} {unit}"), source, source, Span("made.yaml", start, start + 9)
    )


def layered(work: Work, name: str, written: dict[Source, Setting]) -> Work:
    """The work with just these sources for one parameter; what the sources say of others stays."""
    own = work.layers

    def layer(source: Source, others) -> dict[str, Setting]:
        kept = {key: item for key, item in others.items() if key != name}
        return {**kept, **({name: written[source]} if source in written else {})}

    layers = Layers(layer("skill", own.skill), layer("usage_profile", own.usage), layer("call", own.call))
    return replace(work, layers=layers)


def test_every_operation_is_in_the_table() -> None:
    """An operation that is added is held to the order too."""
    assert {item.name for item in OPERATIONS} <= set(WORKS)


@pytest.mark.parametrize(("operation", "name"), PARAMETERS)
@given(sources=st.sets(st.sampled_from(["skill", "usage_profile", "call"])), data=st.data())
@settings(max_examples=12, deadline=None)
def test_the_call_outranks_the_profile_and_that_the_rest(
    operation: str, name: str, sources: set[Source], data: st.DataObject
) -> None:
    low, high, unit = RANGES[name]
    written: dict[Source, Setting] = {
        source: said(name, source, data.draw(st.integers(low, high)), unit) for source in sorted(sources)
    }
    plan = next(item.plan for item in OPERATIONS if item.name == operation)
    settings_ = plan(layered(WORKS[operation](), name, written)).settings
    if name not in settings_:
        assert name == "grasp_depth", "only this one is nothing unless it is written"
        assert not sources & {"usage_profile", "call"}
        return
    told = settings_[name].provenance()
    winner = next((source for source in ("call", "usage_profile") if source in sources), None)
    if winner is not None:
        assert settings_[name] == written[winner]
        assert (told.source, told.span) == (winner, written[winner].span)
        return
    assert told.source in ("computed", *sources)
    if told.source == "computed":
        assert told.span is None
        assert told.rule
        bare = plan(layered(WORKS[operation](), name, {})).settings[name]
        assert bare == settings_[name], "the skill's default does not change what is computed"


FOR_WANT = {
    *((operation, "standoff") for operation in ("grasp", "take")),
    *((operation, "jaw_clearance") for operation in ("grasp", "take", "place", "give")),
    *(
        (operation, name)
        for operation in ("invert", "shake", "give")
        for name in ("air_ahead", "air_clearance")
    ),
    ("lift", "lift"),
    ("place", "approach_height"),
    ("tap", "tap_standoff"),
    ("swipe", "swipe_standoff"),
    ("tip", "press_force"),
    ("tip", "alignment_tolerance"),
}
"""Computed only where the skill states nothing, or too little."""


@pytest.mark.parametrize(("operation", "name"), PARAMETERS)
def test_what_is_computed_outranks_the_skills_default(operation: str, name: str) -> None:
    low, high, unit = RANGES[name]
    plan = next(item.plan for item in OPERATIONS if item.name == operation)
    work = layered(WORKS[operation](), name, {"skill": said(name, "skill", (low + high) // 2, unit)})
    found = plan(work).settings.get(name)
    if name == "grasp_depth":
        assert found is None
        return
    assert found is not None
    assert found.source == ("skill" if (operation, name) in FOR_WANT else "computed")


@pytest.mark.parametrize(
    ("operation", "name", "default"),
    [("grasp", "standoff", "5 mm"), ("lift", "lift", "30 mm"), ("place", "approach_height", "30 mm")],
)
def test_a_default_that_is_too_little_is_not_taken(operation: str, name: str, default: str) -> None:
    plan = next(item.plan for item in OPERATIONS if item.name == operation)
    magnitude, unit = default.split()
    work = layered(WORKS[operation](), name, {"skill": said(name, "skill", int(magnitude), unit)})
    found = plan(work).settings[name]
    assert found.source == "computed"
    assert found.si("Length") > parse_quantity(default).si
