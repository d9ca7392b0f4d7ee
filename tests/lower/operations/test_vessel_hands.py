"""What is said where a step's hand does not hold what it should: which vessel is meant, and by which hand."""

from __future__ import annotations

from dataclasses import replace

from tests.lower.plans import bench, obj, plan, with_skill
from tests.lower.test_refusals import refused, skill
from xei_lang.diagnostics import Span
from xei_lang.profiles.model import TemplateStep
from xei_lang.quantity import parse_quantity


def test_a_vessel_is_not_poured_into_itself() -> None:
    pour = {"source": obj("beaker_3"), "target": obj("beaker_3"), "volume": parse_quantity("60 mL")}
    found = refused(plan(("pick", {"object": obj("beaker_3"), "arm": "right"}), ("pour", pour)))
    assert (found.code, found.message) == ("XEI0718", "`beaker_3` cannot be poured into itself")
    assert found.span == Span("test.xei", 120, 128)
    assert [label.span for label in found.labels] == [Span("test.xei", 110, 118)]


def test_points_of_pouring_where_nothing_is_held_to_pour_from() -> None:
    lines = (TemplateStep("move_to", (("tool", "arm"), ("at", "object.pour_above")), Span("p", 1, 2)),)
    profile = with_skill(bench()[0], replace(skill("pick"), template=lines))
    found = refused(plan(("pick", {"object": obj("beaker_3"), "arm": "right"})), profile)
    assert (found.code, found.span) == ("XEI0707", Span("test.xei", 10, 18))
    assert found.message == (
        "`pick` names no object but `beaker_3` that the right hand could hold when it is poured"
    )
    assert found.label == "expected another object in the right hand, found nothing"


def test_an_object_in_a_hand_is_not_looked_at() -> None:
    held = ("pick", {"object": obj("beaker_4"), "arm": "right"})
    found = refused(plan(held, ("look_at", {"target": obj("beaker_4")})))
    assert (found.code, found.message) == (
        "XEI0710",
        "`beaker_4` cannot be looked at: it is in the right hand",
    )
    assert found.span == Span("test.xei", 110, 118)
    assert [label.span for label in found.labels] == [Span("test.xei", 0, 90)]
    assert found.help == ("set `beaker_4` down first",)
