"""The structural verifier says which goal is unsound and why, and nothing of a sound plan."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.motion.verify.scene import pick_and_place, tour
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.verify_timed import timed_problems, verify_timed_structure


def _changed(**changes: object) -> TimedPlan:
    plan = tour()[0]
    return replace(plan, goals=(replace(plan.goals[0], **changes), *plan.goals[1:]))


@pytest.mark.parametrize("make", [pick_and_place, tour])
def test_sound_plans_have_no_problems(make) -> None:
    assert timed_problems(make()[0]) == ()


@pytest.mark.parametrize(
    ("changes", "kind", "words"),
    [
        ({"start_s": math.nan}, "non_finite", "not finite"),
        ({"joints": ("slide_joint",)}, "structure", "rows of 1 joints"),
        ({"knots": None}, "structure", "given together"),
        ({"end_s": 0.5}, "structure", "knots cover"),
        ({"id": "g02"}, "structure", "stands twice"),
        ({"start_s": 1.0, "end_s": 0.2}, "schedule", "runs from"),
        ({"resource": "slide", "end_s": 3.0}, "schedule", "while `g01` has `slide`"),
    ],
)
def test_each_problem_is_told(changes: dict[str, object], kind: str, words: str) -> None:
    problems = timed_problems(_changed(**changes))
    assert any(problem.kind == kind and words in problem.message for problem in problems)


def test_problems_are_diagnostics_at_the_goal() -> None:
    _, graph, _, _ = tour()
    spans = {goal.id: goal.span for goal in graph.goals}
    said = verify_timed_structure(_changed(knots=None), spans)
    assert [(item.code, item.span) for item in said] == [("XEI0850", spans["g01"])]
