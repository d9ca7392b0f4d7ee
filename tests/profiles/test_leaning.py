"""Priors that turn objects: what then reaches below the table or into others, and what holds nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.profiles.changed import changed_profile
from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.load import load_profile

CUP = """usage_profile.yaml
- prior: {in: 'table.spot("cup")', confidence: 0.6}
+ PRIOR"""


def said(folder: Path, prior: str) -> list[Diagnostic]:
    change = CUP.replace("PRIOR", f"prior: {{frame: table, {prior}, confidence: 0.6}}")
    _, found = load_profile(changed_profile(folder, change), None)
    return [one for one in found if one.code in ("XEI0642", "XEI0643", "XEI0659")]


@pytest.mark.parametrize(("turn", "depth"), [("15 deg", "7.765"), ("180 deg", "80"), ("90 deg", "30")])
def test_what_leans_is_held_to_the_table_by_its_lowest_point(tmp_path, turn, depth):
    (one,) = said(tmp_path, f"position: [0.4 m, 0.3 m, 0 m], rpy: [{turn}, 0 deg, 0 deg]")
    assert one.code == "XEI0643"
    assert one.message.startswith(f"`cup` would stand {depth}")
    assert "x, y, z, w is" in one.notes[-1]


def test_what_lies_in_a_rack_stands_in_it(tmp_path):
    first, *_ = said(tmp_path, "position: [0.2 m, 0 m, 40 mm], rpy: [90 deg, 0 deg, 20 deg]")
    assert (first.code, first.message) == ("XEI0642", "`cup` and `rack` stand in each other")


def test_what_lies_on_the_table_beside_the_rack_is_apart(tmp_path):
    """Lying across the rack's corner, which a box around both would not part."""
    assert said(tmp_path, "position: [0.325 m, 0 m, 30 mm], rpy: [90 deg, 0 deg, 45 deg]") == []


def test_a_vessel_whose_prior_turns_it_over_is_warned_of(tmp_path):
    change = """usage_profile.yaml
- prior: {in: 'rack.slot("A1")', confidence: 0.6}
+ prior: {frame: table, position: [0.4 m, 0.3 m, 118 mm], rpy: [180 deg, 0 deg, 0 deg], confidence: 0.6}"""
    _, found = load_profile(changed_profile(tmp_path, change), None)
    (one,) = [item for item in found if item.code == "XEI0659"]
    assert (one.severity, one.message) == ("warning", "`tube_a` is upside down")
    assert one.notes[0] == "its z axis is 180 deg off the vertical: x, y, z, w is 1, 0, 0, 0"
