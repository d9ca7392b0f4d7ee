"""What is decided while it runs is not lowered: one diagnostic for each place that leaves something open."""

from __future__ import annotations

import pytest

from tests.check.checking import BENCH, plan_of
from tests.lower.plans import bench
from xei_lang.lower import lower

MEASURE = "measure warmth: Temperature = read_temperature(device=incubator) in 20 degC .. 40 degC"


def refused(body: str) -> list[tuple[str, str]]:
    """The codes, each with the words of the protocol that it stands at."""
    text = f'protocol p {{\n  profile "openarm_bench"\n{body}\n}}\n'
    profile, world = bench()
    graph, found = lower(plan_of(text, BENCH), profile, world)
    assert graph is None
    return [(item.code, text[item.span.start : item.span.end]) for item in found if item.span]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (MEASURE, [MEASURE]),
        (f"{MEASURE}\nif warmth > 30 degC {{ wait 1 s }} else {{ wait 2 s }}", ["warmth > 30 degC"]),
        (
            f'repeat 3 times until warmth > 30 degC {{ {MEASURE} }} else {{ stop "x" }}',
            ["warmth > 30 degC"],
        ),
        (f"{MEASURE}\nlet t = (warmth - 10 degC) * 1 s / (1 K)\nwait t", ["t"]),
        (f"{MEASURE}\nrequire warmth > 30 degC", ["warmth > 30 degC"]),
        ("require volume(tube_1) > 1 mL", ["volume(tube_1) > 1 mL"]),
        ("keep temperature(tube_1) < 8 degC { wait 1 s  wait 2 s }", ["temperature(tube_1) < 8 degC"]),
        ('wait 1 s\nstop "done"', ['stop "done"']),
    ],
)  # fmt: skip
def test_each_place_is_told_once(body: str, words: list[str]) -> None:
    assert refused(body) == [("XEI0722", word) for word in words]


def test_a_condition_that_is_proved_leaves_nothing_open() -> None:
    text = 'protocol p {\n  profile "openarm_bench"\n  keep cap(tube_1) == closed { wait 1 s }\n}\n'
    profile, world = bench()
    graph, found = lower(plan_of(text, BENCH), profile, world)
    assert graph is not None
    assert found == ()
