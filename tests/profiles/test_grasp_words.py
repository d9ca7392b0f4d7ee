"""`grasp:` of an object takes its own shorter words, each parameter once."""

from __future__ import annotations

from pathlib import Path

from tests.profiles.changed import changed_profile
from xei_lang.profiles.load import load_profile


def test_the_words_of_a_grasp_are_known(tmp_path: Path) -> None:
    grasp = "grasp: {approach: top, width: 17 mm, standoff: 80 mm}"
    edit = f"usage_profile.yaml\n- grasp: {{standoff: 80 mm}}\n+ {grasp}"
    profile, problems = load_profile(changed_profile(tmp_path, edit), None)
    assert profile is not None, problems
    told = {item.name: str(item.value) for one in profile.objects for item in one.grasp}
    assert told == {"approach": "top", "width": "17 mm", "standoff": "80 mm"}


def test_a_width_is_said_by_one_of_its_names(tmp_path: Path) -> None:
    edit = "usage_profile.yaml\n- grasp: {standoff: 80 mm}\n+ grasp: {width: 17 mm, grasp_width: 16 mm}"
    profile, (found,) = load_profile(changed_profile(tmp_path, edit), None)
    assert profile is None
    assert (found.code, found.message) == (
        "XEI0606",
        "`grasp_width` is stated twice: `width` is short for it",
    )
    assert found.span is not None
    assert [label.span.start < found.span.start for label in found.labels if label.span] == [True]


def test_the_words_of_a_grasp_are_no_parameters_of_a_template(tmp_path: Path) -> None:
    edit = "development_profile.yaml\n- width: grasp_width\n+ width: approach"
    profile, problems = load_profile(changed_profile(tmp_path, edit), None)
    assert profile is None
    assert [item.code for item in problems] == ["XEI0623"]
