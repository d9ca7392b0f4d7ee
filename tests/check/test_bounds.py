"""What a check does at most, however little text asks for more."""

from __future__ import annotations

import pytest

from tests.check.checking import check, protocol
from xei_lang.check.report import MAX_ERRORS
from xei_lang.diagnostics import did_you_mean

CALLS = "".join(f"procedure p{i}() {{ p{i + 1}() p{i + 1}() }}\n" for i in range(38))


@pytest.mark.parametrize(
    "text",
    [
        protocol("repeat 9999 times { repeat 9999 times { let x = 1 } } wait 1 s"),
        protocol("let x = [[[a for a in 1 .. 999] for b in 1 .. 999] for c in 1 .. 999] wait 1 s"),
        protocol("for i in 1 .. 99999 { let x = 1" + " + 1" * 100 + " } wait 1 s"),
        protocol("p0()") + CALLS + "procedure p38() { wait 1 s }\n",
        protocol("p0()") + CALLS + "procedure p38() { }\n",
        protocol("let a = [x for x in 1 .. 9000] let b = [a for x in 1 .. 9000] require b == b wait 1 s"),
        "procedure p(x: List[List[Int]]) { wait 1 s }\n"
        + protocol("let a = [x for x in 1 .. 9000] let b = [a for x in 1 .. 9000] p(x=b)"),
        protocol(
            "let a0 = [1, 1] "
            + " ".join(f"let a{i + 1} = [a{i}, a{i}]" for i in range(60))
            + " require a60 == a60"
        ),
    ],
)
def test_work_without_steps_has_a_bound(text: str) -> None:
    plan, found = check(text)
    assert plan is None
    assert "XEI0316" in {item.code for item in found}
    assert "XEI0501" not in {item.code for item in found}, "what was not reached is not unused"


def test_work_that_makes_steps_is_bounded_by_the_steps() -> None:
    lines = "wait 1 s wait 1 s wait 1 s let x = i + i require x > 0 wait 1 s "
    plan, found = check(protocol(f"for i in 1 .. 20000 {{ {lines} }}"))
    assert plan is not None, found
    assert len(plan.steps) >= 80_000


def test_more_errors_than_anyone_reads_are_not_shown() -> None:
    plan, found = check(protocol("".join(f"wait unknown_{i}\n" for i in range(1_000))))
    assert plan is None
    assert [item.code for item in found] == ["XEI0202"] * MAX_ERRORS + ["XEI0109"]


@pytest.mark.parametrize(
    ("name", "meant"),
    [("step_17a", ("step_17",)), ("stepp_17", ("step_17",)), ("tsep_17", ("step_17",)), ("quite_other", ())],
)
def test_among_many_names_one_slip_is_still_guessed(name: str, meant: tuple[str, ...]) -> None:
    known = [f"step_{i}" for i in range(10, 2_000)]
    assert did_you_mean(name, known)[:1] == meant


def test_endless_names_get_no_guess() -> None:
    assert did_you_mean("a" * 100_000, ["a" * 100_001]) == ()


def test_lists_of_any_depth_are_shown() -> None:
    deep = "let a0 = [1, 1] " + " ".join(f"let a{i + 1} = [a{i}, a{i}]" for i in range(60))
    _, found = check(protocol(f"{deep} let b = [[1, 2], [3]] wait a60  wait b  wait 1 s"))
    shown = [item.message.partition(" is")[0] for item in found]
    assert shown == ["`[[...], [...]]`", "`[[1, 2], [3]]`"]
