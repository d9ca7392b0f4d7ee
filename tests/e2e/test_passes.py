"""What each pass makes of each protocol, as `--print-after` shows it, and that it is sound.

Texts are golden up to the goals: they hold what was written and what the profile says, lengths rounded to a
tenth of a millimetre. Motion is not: its times and joint values come out of optimisers, whose last digits
depend on the CPU and on how libraries were built, and a golden that differs elsewhere is worth nothing. Of
motion the golden has what no optimiser may change: which goals there are and what they use, which of them
move, and what is held and set down meanwhile. Whether the numbers are good is for the verifier to say.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.e2e.made import PROTOCOLS, SMALL, passes
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.ir.verify_timed import timed_problems
from xei_lang.pipeline import ALL, Handoffs

NAMES = [step.name for step in ALL]
WRITTEN = ("parse", "profile", "check", "lower")
"""Passes whose text is golden for each protocol: `admit` changes nothing, and the world is the profile's."""

protocols = pytest.mark.parametrize("path", PROTOCOLS, ids=lambda path: path.stem)
everything = pytest.mark.parametrize("path", [*PROTOCOLS, *SMALL], ids=lambda path: path.stem)


def of_motion(timed: TimedPlan, graph: MotionGoalGraph) -> str:
    """The plan without its numbers: a line a goal, in the order of the graph."""
    found = {goal.id: goal for goal in timed.goals}
    assert len(found) == len(timed.goals)
    return "".join(_line(found[goal.id]) for goal in graph.goals)


def _line(goal: TimedGoal) -> str:
    held = [f"{item.object} on {item.link}" for item in goal.attached]
    set_down = [f"sets down {item.object}" for item in goal.placed]
    moves = ["moves" if goal.knots is not None else "moves nothing"]
    words = ", ".join((goal.resource, f"epoch {goal.epoch}", *moves, *held, *set_down))
    return f"{goal.id}: {goal.kind}, {words}\n"


def sound(made: Handoffs) -> list[str]:
    """What is wrong with the representations made so far."""
    found: list[str] = []
    if made.plan is not None:
        found.extend(verify_plan(made.plan))
    if made.graph is not None:
        found.extend(verify_goals(made.graph))
    if made.timed is not None:
        found.extend(problem.message for problem in timed_problems(made.timed))
    return found


@everything
def test_it_passes(path: Path) -> None:
    made = passes(path)
    assert made.outcome.stopped_at is None, made.outcome.diagnostics
    assert list(made.texts) == NAMES[: len(made.texts)]
    assert len(made.texts) == (len(NAMES) if path in PROTOCOLS else NAMES.index("lower") + 1)


@everything
@pytest.mark.parametrize("name", NAMES)
def test_every_representation_is_sound_after_every_pass(path: Path, name: str) -> None:
    """And so before the next one, which has nothing else to begin with."""
    result = passes(path).results.get(name)
    if result is None:
        assert path in SMALL and NAMES.index(name) > NAMES.index("lower")
        return
    assert sound(result.made) == []


@everything
@pytest.mark.parametrize("name", WRITTEN)
def test_what_a_pass_makes(path: Path, name: str, golden: Callable[[str, str], None]) -> None:
    golden(f"passes/{path.stem}.{name}.txt", passes(path).texts[name])


@everything
def test_what_is_admitted_is_the_plan_as_it_was(path: Path) -> None:
    texts = passes(path).texts
    assert texts["admit"] == texts["check"]


@everything
def test_the_world_is_the_profiles(path: Path, golden: Callable[[str, str], None]) -> None:
    golden("world/openarm_bench.txt", passes(path).texts["ground"])


@protocols
def test_what_motion_is_made_of(path: Path, golden: Callable[[str, str], None]) -> None:
    made = passes(path).results["motion"].made
    assert made.timed is not None and made.graph is not None
    golden(f"passes/{path.stem}.motion.txt", of_motion(made.timed, made.graph))


@protocols
def test_the_text_of_motion_shows_every_goal(path: Path) -> None:
    made = passes(path).results["motion"].made
    assert made.timed is not None
    for name in ("motion", "verify"):
        text = passes(path).texts[name]
        assert all(goal.id in text for goal in made.timed.goals)


@protocols
def test_the_verifier_adds_margins_and_changes_no_motion(path: Path) -> None:
    before, after = (passes(path).results[name].made.timed for name in ("motion", "verify"))
    assert before is not None and after is not None
    assert after.goals == before.goals
    assert {item.name for item in after.margins} >= {item.name for item in before.margins}
