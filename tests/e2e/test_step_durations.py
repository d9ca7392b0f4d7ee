"""What the steps of a timed plan take, against the `duration` of their skills (XEI0810)."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from tests.cli.xei import xei
from tests.e2e.made import PROTOCOLS, ROOT, compiled
from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.goals import Instrument
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.verify import check_durations
from xei_lang.pipeline import Handoffs
from xei_lang.profiles.model import SkillBank

BENCH = ROOT / "profiles" / "openarm_bench"
PROTOCOL = """protocol short {
  profile "openarm_bench"
  given power(incubator) == on_state
  rise: slide_to(height=300 mm)
  run_by_output(device=incubator, output="incubator_start", time=5 min)
}
"""


def made_of(name: str) -> Handoffs:
    _, outcome = compiled(next(path for path in PROTOCOLS if path.stem == name))
    assert outcome.stopped_at is None, outcome.diagnostics
    return outcome.made


def bounded(made: Handoffs, bounds: Mapping[str, tuple[float, float]]) -> SkillBank:
    """The bank with other durations of some skills."""
    assert made.profile is not None
    bank = made.profile.bank
    skills = (replace(skill, duration_s=bounds.get(skill.name, skill.duration_s)) for skill in bank.skills)
    return replace(bank, skills=tuple(skills))


def said_of(made: Handoffs, bounds: Mapping[str, tuple[float, float]]) -> Diagnostics:
    assert made.plan and made.graph and made.timed
    return check_durations(made.plan, made.graph, made.timed, bounded(made, bounds))


def lasts_s(timed: TimedPlan, step_id: str) -> float:
    own = [goal for goal in timed.goals if goal.step_id == step_id]
    return max(goal.end_s for goal in own) - min(goal.start_s for goal in own)


def test_a_step_is_held_to_its_skill_as_a_whole() -> None:
    made = made_of("put_on_rack")
    assert made.plan and made.timed
    taken_s = lasts_s(made.timed, "grasp")
    longest = max(goal.end_s - goal.start_s for goal in made.timed.goals if goal.step_id == "grasp")
    assert longest < taken_s - 1.0
    (said,) = said_of(made, {"pick": (1.0, taken_s - 0.5)})
    step = next(step for step in made.plan.steps if step.step_id == "grasp")
    assert (said.code, said.severity, said.span) == ("XEI0810", "warning", step.span)
    assert "`pick` takes longer" in said.message and f"expected at most {taken_s - 0.5:g} s" in said.label
    assert [Path(label.span.file).name for label in said.labels] == ["development_profile.yaml"]
    assert "`approach_speed`" in said.help[0]


def test_a_step_may_be_too_short_as_well() -> None:
    made = made_of("put_on_rack")
    (said,) = said_of(made, {"insert": (50.0, 60.0)})
    assert "`insert` takes less" in said.message and "expected at least 50 s" in said.label


def test_bounds_belong_to_what_they_hold() -> None:
    made = made_of("put_on_rack")
    assert made.timed is not None
    taken_s = lasts_s(made.timed, "grasp")
    assert said_of(made, {}) == ()
    assert said_of(made, {"pick": (taken_s, taken_s)}) == ()


def test_the_steps_of_one_call_are_told_once() -> None:
    made = made_of("rack_six_tubes")
    assert made.plan is not None and made.timed is not None
    timed = made.timed
    picks = [step for step in made.plan.steps if step.skill == "pick"]
    (said,) = said_of(made, {"pick": (0.1, 1.0)})
    longest = max(picks, key=lambda step: lasts_s(timed, step.step_id))
    assert len({step.step_id for step in picks}) == 6 and {step.span for step in picks} == {said.span}
    assert said.notes[0].startswith(f"step `{longest.step_id}`")
    assert said.notes[1] == "so do 5 more of this call, by less"


def test_work_that_was_started_lasts_as_long_as_it_works() -> None:
    made = made_of("warm_tubes")
    assert made.plan is not None and made.graph is not None
    start = next(step for step in made.plan.steps if step.kind == "start")
    (work_s,) = {
        goal.action.work_s
        for goal in made.graph.goals
        if goal.step_id == start.step_id and isinstance(goal.action, Instrument)
    }
    assert said_of(made, {"heat": (work_s, work_s)}) == ()
    (said,) = said_of(made, {"heat": (1.0, work_s - 60.0)})
    assert said.span == start.span and "`for`" in said.help[0]
    (said,) = said_of(made, {"heat": (work_s + 60.0, work_s + 90.0)})
    assert "takes less" in said.message


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A folder with a copy of the bench and a protocol whose motion is planned quickly."""
    shutil.copytree(BENCH, tmp_path / "profiles" / BENCH.name, ignore=shutil.ignore_patterns("*.py"))
    (tmp_path / "short.xei").write_text(PROTOCOL, encoding="utf-8")
    return tmp_path


def test_compile_tells_and_goes_on(lab: Path) -> None:
    bank = lab / "profiles" / BENCH.name / "development_profile.yaml"
    text = bank.read_text(encoding="utf-8")
    for skill, bounds in (("slide_to", "20 s .. 30 s"), ("run_by_output", "1 s .. 10 s")):
        head, _, rest = text.partition(f"  {skill}:\n")
        before, _, after = rest.partition("    duration: ")
        text = f"{head}  {skill}:\n{before}    duration: {bounds}\n{after.partition(chr(10))[2]}"
    bank.write_text(text, encoding="utf-8")
    ran = xei("compile", "short.xei", "-o", "out", cwd=lab)
    assert ran.code == 0, ran.err
    assert [line for line in ran.err.splitlines() if line.startswith("warning")] == [
        "warning[XEI0810]: `slide_to` takes less than its `duration`",
        "warning[XEI0810]: `run_by_output` takes longer than its `duration`",
    ]
    assert "takes 300 s, expected at most 10 s" in ran.err
    assert "duration: 1 s .. 10 s" in ran.err and "`run_by_output` may take 1 s .. 10 s" in ran.err
    assert "or change what it depends on: `time`" in ran.err
    assert (lab / "out" / "timed.json").is_file()
