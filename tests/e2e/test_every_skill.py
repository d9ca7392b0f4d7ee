"""Every skill of the bench's bank is used by a protocol that is compiled to verified motion and run dry."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from tests.e2e.made import PROTOCOLS, ROOT
from xei_lang.cli.deliver import Compiled
from xei_lang.pipeline import ALL, FRONT, Outcome, Pass, Request, compile_request
from xei_lang.profiles.load import load_profile
from xei_lang.quantity import TYPE_DIMENSIONS
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.run import run
from xei_lang.syntax.reading import read_source

DRY = tuple(sorted(Path(__file__).with_name("dry").glob("*.xei")))
READ = {"read", "read_temperature"}
"""Skills whose result only a run on the instrument knows: planned as steps, without motion (XEI0722)."""

RUN = tuple(path for path in DRY if path.stem != "readings")


def outcome_of(path: Path, passes: tuple[Pass, ...]) -> tuple[Request, Outcome]:
    source, said = read_source(path, str(path.relative_to(ROOT)))
    assert source is not None, said
    request = Request(source, profile_folder=ROOT / "profiles", allow_unmapped=True)
    return request, compile_request(request, passes)


@cache
def planned(path: Path) -> frozenset[str]:
    """The skills of a protocol's steps."""
    _, outcome = outcome_of(path, FRONT)
    assert outcome.made.plan is not None, outcome.diagnostics
    return frozenset(step.skill for step in outcome.made.plan.steps)


@pytest.mark.parametrize("path", RUN, ids=[path.stem for path in RUN])
def test_it_compiles_and_runs_dry(path: Path) -> None:
    request, outcome = outcome_of(path, ALL)
    assert outcome.stopped_at is None, outcome.diagnostics
    assert outcome.made.timed is not None and outcome.made.graph is not None
    assert [item.message for item in outcome.diagnostics if item.code == "XEI0810"] == []
    answers = Answers({"the lamp is on": True})
    given = Compiled.of(request.source, outcome.made).run_inputs()
    result = run(given, "dry-run", answers, lambda _event: None)
    assert (result.status, result.diagnostics) == ("succeeded", ())
    assert result.goals_done == len(outcome.made.graph.goals)


def test_no_skill_is_left_out() -> None:
    profile, said = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None, said
    bank = {skill.name for skill in profile.bank.skills}
    run_dry = frozenset().union(*(planned(path) for path in (*PROTOCOLS, *RUN)))
    assert bank >= READ
    assert bank - run_dry == READ
    assert planned(Path(__file__).with_name("dry") / "readings.xei") == READ


def test_every_skill_says_all_that_is_asked_of_one() -> None:
    profile, said = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None, said
    for skill in profile.bank.skills:
        shortest, longest = skill.duration_s
        assert 0 <= shortest < longest
        said_all = skill.exposed and skill.summary and skill.process and skill.phrases and skill.unsupported
        assert said_all and skill.template, skill.name
        for arg in skill.args:
            bounded = arg.min is not None and arg.max is not None
            assert bounded or arg.type not in (*TYPE_DIMENSIONS, "Int"), (skill.name, arg.name)
            assert arg.roles is not None or arg.type != "object" or skill.name == "look_at", skill.name
