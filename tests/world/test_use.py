"""What is known too little is not used: by confidence, and in strict mode by who said it."""

from __future__ import annotations

import dataclasses
import math

import pytest

from tests.lower.plans import obj, plan, put_on_rack, slot
from tests.world.bench import bench
from tests.world.sources.scenes import at, grounded, seen
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.profiles.model import Profile
from xei_lang.world.sources import Observation, Observations
from xei_lang.world.use import MIN_CONFIDENCE, check_use, needed_confidence, uses


def asking(skill: str, confidence: float) -> Profile:
    """The bench, with a skill that asks for this much."""
    skills = tuple(
        dataclasses.replace(item, min_confidence=confidence) if item.name == skill else item
        for item in bench().bank.skills
    )
    return dataclasses.replace(bench(), bank=dataclasses.replace(bench().bank, skills=skills))


def said(
    asked: SkillPlan, *observed: Observations, strict: bool = False, profile: Profile | None = None
) -> list[str]:
    found = check_use(asked, profile or bench(), grounded(*observed), observed, strict=strict)
    return [f"{item.code} {item.message}" for item in found]


def test_each_object_is_used_once_by_the_step_that_asks_for_most():
    profile = asking("insert", 0.7)
    found = {use.name: use for use in uses(put_on_rack(), profile)}
    assert list(found) == ["tube_1", "rack_2"]
    assert found["tube_1"].step.skill == "insert"
    assert found["tube_1"].needed == 0.7
    assert needed_confidence(profile, "pick") == MIN_CONFIDENCE


def test_the_bench_is_known_well_enough_for_what_it_can_do():
    assert said(put_on_rack()) == []


@pytest.mark.parametrize(("confidence", "codes"), [(MIN_CONFIDENCE, 0), (MIN_CONFIDENCE - 1e-6, 1)])
def test_below_the_default_nothing_is_used(confidence: float, codes: int):
    unsure = seen(Observation("tube_1", confidence=confidence))
    assert len(said(put_on_rack(), unsure)) == codes


def test_a_skill_may_ask_for_more():
    assert said(put_on_rack(), profile=asking("insert", 0.9)) == [
        "XEI0661 `tube_1` is not known surely enough to be used",
        "XEI0661 `rack_2` is not known surely enough to be used",
    ]
    assert said(put_on_rack(), profile=asking("pour", 0.99)) == []


def test_strict_takes_nothing_from_a_prior():
    assert said(put_on_rack(), strict=True) == [
        "XEI0662 nobody has seen `tube_1`",
        "XEI0662 nobody has seen `rack_2`",
    ]


def test_strict_names_those_who_did_not_see_it():
    racks = seen(at("rack_1", 0.12, -0.135, yaw=-1.5708), at("rack_2", 0.12, 0.135, yaw=-1.5708))
    (found,) = check_use(put_on_rack(), bench(), grounded(racks), (racks,), strict=True)
    assert found.message == "nobody has seen `tube_1`"
    assert found.notes == (
        "its place is from usage_profile prior, moved with rack_1",
        "not seen by scene_file test.yaml",
    )
    assert found.span == put_on_rack().steps[0].span


def test_strict_is_content_once_all_was_seen_and_asks_nothing_of_furniture():
    tube = grounded().T_world_object("tube_1").position_m
    everything = seen(
        at("rack_1", 0.12, -0.135, yaw=-1.5708), at("rack_2", 0.12, 0.135, yaw=-1.5708),
        at("tube_1", *tube, frame="world"),
    )  # fmt: skip
    assert said(put_on_rack(), everything, strict=True) == []
    onto_table = plan(("place", {"object": obj("tube_1"), "on": slot("table", "")}))
    assert said(onto_table, everything, strict=True) == []


def test_what_is_used_and_said_to_be_absent_is_told_with_who_said_so():
    for name in ("tube_1", "rack_1"):
        gone = seen(Observation(name, is_absent=True))
        (one,) = check_use(put_on_rack(), bench(), grounded(gone), (gone,), strict=False)
        assert (one.code, one.message) == ("XEI0710", "`tube_1` is not there, and `pick` uses it")
        assert one.notes[0] == f"scene_file test.yaml says that `{name}` is absent"
    back = seen(at("tube_1", 0.06, -0.3), source="scene_file later.yaml")
    gone = seen(Observation("tube_1", is_absent=True))
    assert check_use(put_on_rack(), bench(), grounded(), (gone, back), strict=False) == ()


def test_what_lies_is_not_handled():
    lying = Pose.from_rpy((0.06, 0.29, 0.0085), (0.0, math.pi / 2, 0.0))
    there = seen(Observation("tube_1", lying, "table", 0.9))
    assert said(put_on_rack(), there) == ["XEI0632 `tube_1` lies on its side, and `pick` takes it to stand"]
    look = plan(("look_at", {"target": obj("tube_1")}))
    assert said(look, there) == []
