"""`require`: proved, refuted, or a step of the run."""

from __future__ import annotations

import pytest

from tests.check.checking import codes, ids, plan_of, protocol
from xei_lang.ir.verify_plan import verify_plan


@pytest.mark.parametrize(
    "condition",
    [
        "cap(tube_1) == closed",
        "cap(tube_1) != open",
        'at(tube_1) == rack_1.slot("A1")',
        "holding(left) == nothing and holding(right) == nothing",
        "1 mL < 2 mL",
    ],
)
def test_what_is_known_is_proved_and_leaves_no_step(condition: str) -> None:
    assert ids(f"require {condition}\nwait 1 s") == ["wait#1"]
    assert codes(f"require not ({condition})\nwait 1 s") == ["XEI0331"]


def test_what_is_not_known_is_left_for_the_run() -> None:
    body = """
      given tube_1 contains 2 mL of "water"
      require volume(tube_1) >= 1 mL
      pick(object=tube_1)
      for t in [tube_1, tube_2] { require volume(t) < 5 mL }
      require holding(left) == tube_1
      wait 1 s
    """
    plan = plan_of(protocol(body))
    assert verify_plan(plan) == ()
    assert [step.step_id for step in plan.steps] == [
        "require#1", "pick#1", "require#2[1]", "require#2[2]", "require#3", "wait#1",
    ]  # fmt: skip
    assert plan.steps[0].kind == "require"
    assert plan.steps[0].arg("condition") == "volume(tube_1) >= 1 mL"
    assert plan.steps[1].after == ("require#1",)


def test_in_a_branch_others_may_change_what_is_asked() -> None:
    picks = "{ pick(object=tube_1, arm=left) }"
    body = f"parallel {{ {picks} {{ require holding(left) == nothing  wait 1 s }} }}"
    assert ids(body) == ["pick#1", "require#1", "wait#1"]


def test_a_requirement_follows_what_steps_do() -> None:
    body = "pick(object=tube_1, arm=left)\nrequire holding(left) == tube_1\nrequire at(tube_1) == left"
    assert ids(body) == ["pick#1"]
    assert ids("place(object=tube_1, on=table)\nrequire at(tube_1) == table") == ["place#1"]
    assert codes("require holding(left) == tube_1\nwait 1 s") == ["XEI0331"]


def _pose(x: str = "0.3 m", z: str = "10 cm", frame: str = "world") -> str:
    return f'pose(x={x}, y=0 m, z={z}, frame="{frame}")'


COUNT = "param n: Int = 2 in 1 .. 3"
HEIGHT = "param z: Length = 10 cm in 5 cm .. 20 cm"


@pytest.mark.parametrize(
    ("condition", "checked", "compiled"),
    [
        (f"{_pose(z='z')} == {_pose()}", None, True),
        (f"{_pose(z='z')} != {_pose()}", None, False),
        (f"[{_pose(z='z')}] == [{_pose()}]", None, True),
        (f"{_pose(z='z')} == {_pose(z='12 cm')}", None, False),
        (f"{_pose(z='z')} == {_pose(z='30 cm')}", False, False),
        (f"{_pose(z='z')} == {_pose(x='0.4 m')}", False, False),
        (f"{_pose(z='z')} == {_pose(z='z')}", True, True),
        (f"{_pose(z='z + 1 cm')} == {_pose(z='z')}", False, False),
        ("[n, 1] == [2, 1]", None, True),
        ("[n, 1] == [2, 2]", False, False),
        ("[n] == [n]", True, True),
    ],
)
def test_what_a_parameter_leaves_open_is_not_decided(
    condition: str, checked: bool | None, compiled: bool
) -> None:
    """The default of a parameter stands for it where a plan is compiled, and only there."""
    body = f"{COUNT if '[n' in condition else HEIGHT}\nrequire {condition}\nwait 1 s"
    left_open = codes(body, open_bindings=True)
    assert left_open == (["XEI0331"] if checked is False else [])
    assert checked is False or len(ids(body, open_bindings=True)) == (2 if checked is None else 1)
    assert codes(body) == ([] if compiled else ["XEI0331"])


def test_an_open_pose_is_its_nominal_one_in_the_plan() -> None:
    body = f"{HEIGHT}\npick(object=tube_1)\nhover(object=tube_1, at={_pose(z='z')})"
    checked, compiled = (plan_of(protocol(body), open_bindings=is_open) for is_open in (True, False))
    assert checked.steps[1].arg("at") == compiled.steps[1].arg("at")
    assert checked.steps[1].arg("at") is not None
