"""A skill bank against itself: its contracts, templates and owners."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from tests.profiles.changed import changed_profile
from xei_lang.diagnostics import has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.sources import folder_sources

REQUIRES = 'requires: ["holding(arm) == nothing"]'
ENSURES = 'ensures: ["holding(arm) := object"]'


def test_every_mistake_of_a_skill_is_told_with_its_place(markdown, tmp_path, monkeypatch):
    count = itertools.count()

    def produce(edit: str) -> str:
        place = tmp_path / str(next(count))
        place.mkdir()
        monkeypatch.chdir(place)
        lab = changed_profile(place, edit)
        profile, diagnostics = load_profile(lab, None)
        assert diagnostics, f"nothing is said about {edit}"
        assert (profile is None) == has_errors(diagnostics)
        return render_full(diagnostics, folder_sources(lab))

    markdown(Path(__file__).parent / "skill_bank.md", produce)


@pytest.mark.parametrize(
    ("requires", "ensures"),
    [
        (["cap(object) == open"], ["cap(object) := closed"]),
        (["cap(object) == open or cap(object) == closed"], ["cap(object) := open", "cap(object) := open"]),
        (["volume(object) >= 1 mL", "volume(object) <= 3 mL"], ["volume(object) -= 1 mL"]),
        (["volume(object) <= 1 mL", "volume(object) >= 1 mL"], ["volume(object) -= 1 mL"]),
        (["volume(object) > 1 mL", "volume(object) * 2 < 5 mL"], []),
        (["temperature(object) < 37 degC"], ["temperature(object) -= 5 K"]),
        (["temperature(object) - 5 K < 37 degC"], ["temperature(object) := 4 degC"]),
        (["not (cap(object) == open)", "upright(object) == true", "age(object) < 3 h"], []),
        (
            ["holding(arm) == nothing or holding(arm) == object"],
            ["holding(arm) := object", "at(object) := arm"],
        ),
        (["at(object) != arm", "holding(arm) != object"], ["holding(arm) := object", "at(object) := arm"]),
        (["contents(object) == nothing"], ["contents(object) += contents(object)"]),
        (["max(volume(object), 1 mL) >= 1 mL"], []),
        (["holding(arm) == tube_b"], ["holding(arm) := nothing"]),
    ],
)
def test_what_may_hold_is_not_doubted(tmp_path, requires, ensures):
    new = [
        f"{key}: [{', '.join(f'{chr(34)}{rule}{chr(34)}' for rule in rules)}]"
        for key, rules in (("requires", requires), ("ensures", ensures))
    ]
    template = "- attach: {object: object, arm: arm}"
    lines = [("- " + REQUIRES, "+ " + new[0]), ("- " + ENSURES, "+ " + new[1])]
    lines.append(("- " + template, "+ - wait: {for: 1 s}"))
    edit = "\n".join(("development_profile.yaml", *(line for pair in lines for line in pair)))
    _, diagnostics = load_profile(changed_profile(tmp_path, edit), None)
    assert [found.code for found in diagnostics if found.code in CODES] == []


TAKE = "- attach: {object: object, arm: arm}"
LET_GO = "- detach: {object: object, arm: arm, at: back}"


@pytest.mark.parametrize(
    ("requires", "ensures", "lines"),
    [
        (["holding(arm) == nothing"], ["holding(arm) := nothing", "at(object) := back"], [TAKE, LET_GO]),
        (["holding(arm) == nothing"], ["at(object) := back"], [TAKE, LET_GO]),
        ([], ["holding(arm) := object", "at(object) := arm"], [TAKE]),
        ([], [], [TAKE, LET_GO]),
        (["holding(arm) == object"], ["holding(arm) := nothing"], [LET_GO]),
        (["holding(arm) == object"], ["holding(arm) := object"], []),
        (["holding(arm) == nothing"], ["holding(arm) := nothing"], []),
        (["holding(arm) == object"], [], []),
        (["holding(arm) == nothing"], ["holding(arm) := tube_b"], [TAKE]),
        (["holding(arm) == nothing or holding(arm) == object"], ["holding(arm) := object"], []),
        (["holding(arm) == nothing"], ["holding(arm) == object", "holding(arm) := object"], [TAKE]),
    ],
)
def test_what_a_template_may_leave_is_not_doubted(tmp_path, requires, ensures, lines):
    contract = [
        f"{key}: [{', '.join(f'{chr(34)}{rule}{chr(34)}' for rule in rules)}]"
        for key, rules in (("requires", requires), ("ensures", ensures))
    ]
    pairs = [
        ("- " + REQUIRES, "+ " + contract[0]),
        ("- " + ENSURES, "+ " + contract[1]),
        ("- " + TAKE, "+ " + "\\n      ".join(lines or ["- slide_move: {height: standoff}"])),
        ("- arm: {type: Arm", "+ back: {type: Place}\\n      arm: {type: Arm"),
    ]
    edit = "\n".join(("development_profile.yaml", *(line for pair in pairs for line in pair)))
    _, diagnostics = load_profile(changed_profile(tmp_path, edit), None)
    assert [found.message for found in diagnostics if found.code != "XEI0629"] == []


CODES = ("XEI0626", "XEI0627", "XEI0628", "XEI0629", "XEI0644", "XEI0645")
