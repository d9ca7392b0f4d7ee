"""The forward walk: what is known before each step, and what a place stands for."""

from __future__ import annotations

from tests.check.checking import codes, plan_of, protocol
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Value


def before(body: str, step: int) -> dict[tuple[str, str], Value]:
    facts = plan_of(protocol(body)).steps[step].state_before
    return {(fact.variable, fact.subject): fact.value for fact in facts}


def test_hands_are_empty_and_objects_stand_where_the_profile_has_them() -> None:
    facts = before("wait 1 s", 0)
    assert facts["holding", "left"] == facts["holding", "right"] == "nothing"
    assert facts["at", "tube_1"] == PlaceRef("rack_1", "slot", "A1")
    assert facts["at", "cup_1"] == PlaceRef("table", "spot", "cup")
    assert facts["at", "rack_1"] == PlaceRef("table", "surface", "")
    assert facts["cap", "tube_1"] == "closed"


def test_given_facts_replace_what_the_profile_believes() -> None:
    given = (
        'given cap(tube_1) == open\ngiven at(tube_1) == rack_2.slot("B2")\ngiven holding(left) == tube_2\n'
        'given cup_1 contains 50 mL of "PBS"\n'
    )
    facts = before(given + 'pick(object=rack_2.slot("B2"))', 0)
    assert facts["cap", "tube_1"] == "open"
    assert facts["at", "tube_1"] == PlaceRef("rack_2", "slot", "B2")
    assert facts["holding", "left"] == ObjectRef("tube_2")
    assert facts["at", "tube_2"] == "left"
    assert facts["contents", "cup_1"] == ("PBS",)


def test_picking_and_placing_move_the_object() -> None:
    body = 'pick(object=tube_1, arm=left)\nplace(object=tube_1, on=rack_2.slot("A1"), arm=left)\nwait 1 s'
    held = before(body, 1)
    assert held["holding", "left"] == ObjectRef("tube_1")
    assert held["at", "tube_1"] == "left"
    placed = before(body, 2)
    assert placed["holding", "left"] == "nothing"
    assert placed["at", "tube_1"] == PlaceRef("rack_2", "slot", "A1")


def test_with_either_arm_it_is_not_known_which_holds() -> None:
    facts = before("pick(object=tube_1)\nwait 1 s", 1)
    assert facts["holding", "either"] == ObjectRef("tube_1")
    assert ("holding", "left") not in facts
    after = before("pick(object=tube_1)\nplace(object=tube_1, on=table)\nwait 1 s", 2)
    assert after["holding", "left"] == after["holding", "right"] == "nothing"


def test_with_one_arm_full_either_is_the_other() -> None:
    facts = before("pick(object=tube_1, arm=left)\npick(object=tube_2)\nwait 1 s", 2)
    assert (facts["holding", "left"], facts["holding", "right"]) == (ObjectRef("tube_1"), ObjectRef("tube_2"))


def test_two_objects_in_unknown_hands() -> None:
    plan = plan_of(
        protocol("pick(object=tube_1)\npick(object=tube_2)\nplace(object=tube_1, on=table)\nwait 1 s")
    )
    held = [fact.value for fact in plan.steps[2].state_before if fact.variable == "holding"]
    assert held == [ObjectRef("tube_1"), ObjectRef("tube_2")]
    held = [fact.value for fact in plan.steps[3].state_before if fact.variable == "holding"]
    assert held == [ObjectRef("tube_2")]


def test_a_place_means_what_stands_in_it_at_that_point() -> None:
    body = """
      for spot, target in zip(rack_1.row("A")[1 .. 2], rack_2.row("B")[1 .. 2]) {
        pick(object=spot)
        insert(object=spot, into=target)
      }
      pick(object=rack_2.slot("B2"))
    """
    plan = plan_of(protocol(body))
    assert [step.arg("object") for step in plan.steps] == [
        ObjectRef(name) for name in ("tube_1", "tube_1", "tube_2", "tube_2", "tube_2")
    ]


def test_an_emptied_place_means_nothing_any_more() -> None:
    move = 'pick(object=tube_1)\ninsert(object=tube_1, into=rack_2.slot("A1"))\n'
    assert codes(move + 'pick(object=rack_1.slot("A1"))') == ["XEI0311"]
