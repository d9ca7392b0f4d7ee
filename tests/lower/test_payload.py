"""What a hand takes weighs no more than the payload: the object, what rides on it, and what is in it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.plans import bench, obj, plan, put_on_rack, with_object
from tests.lower.test_refusals import known, refused
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Fact, SkillPlan
from xei_lang.lower import lower
from xei_lang.profiles.model import Profile
from xei_lang.quantity import parse_quantity


def weighing(profile: Profile, name: str, mass_kg: float) -> Profile:
    found = profile.object(name)
    assert found is not None
    return with_object(profile, name, replace(found, mass_kg=mass_kg))


def picked(name: str, volume: str = "") -> SkillPlan:
    """A pick of the object, with this volume in it."""
    made = plan(("pick", {"object": obj(name), "arm": "either"}))
    facts = (Fact("volume", name, parse_quantity(volume)),) if volume else ()
    return replace(made, steps=tuple(replace(step, state_before=facts) for step in made.steps))


def test_an_object_heavier_than_the_payload() -> None:
    found = refused(put_on_rack(), weighing(bench()[0], "tube_1", 1.5))
    assert (found.code, found.span) == ("XEI0730", Span("test.xei", 10, 18))
    assert found.label == "weighs 1.5 kg, expected at most 1 kg"
    payload = bench()[0].calibration.payload_span
    assert [label.span for label in found.labels] == [known("tube_1").mass_span, payload]
    assert None not in (payload, known("tube_1").mass_span)


def test_an_object_as_heavy_as_the_payload() -> None:
    graph, problems = lower(put_on_rack(), weighing(bench()[0], "tube_1", 1.0), bench()[1])
    assert graph is not None, problems


def test_what_rides_on_it_weighs_too() -> None:
    profile = weighing(weighing(bench()[0], "bottle_2", 0.6), "bottle_2_cap", 0.5)
    found = refused(picked("bottle_2"), profile)
    assert (found.code, found.message) == ("XEI0730", "`bottle_2` is too heavy for a hand")
    assert found.notes == ("in the hand: 600 g of `bottle_2` and 500 g of `bottle_2_cap`",)


@pytest.mark.parametrize(("volume", "fits"), [("200 mL", True), ("200.1 mL", False)])
def test_what_is_known_to_be_in_it_weighs_too(volume: str, fits: bool) -> None:
    profile, world = weighing(bench()[0], "beaker_1", 0.8), bench()[1]
    if fits:
        graph, problems = lower(picked("beaker_1", volume), profile, world)
        assert graph is not None, problems
    else:
        found = refused(picked("beaker_1", volume), profile)
        assert (found.code, found.label) == ("XEI0730", "weighs 1.0001 kg, expected at most 1 kg")


def test_both_hands_of_a_step_are_asked() -> None:
    opened = plan(("twist_open", {"object": obj("bottle_2"), "hold": "left", "twist": "right"}))
    found = refused(opened, weighing(bench()[0], "bottle_2", 1.2))
    assert (found.code, found.message) == ("XEI0730", "`bottle_2` is too heavy for a hand")
