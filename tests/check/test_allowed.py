"""What may be done with an object is what its profile lists, and anything where it lists nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.check.checking import BENCH, parser, profile, protocol
from xei_lang.check import CheckOptions, check_module
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.profiles.model import LabObject, Profile

POUR = "pick(object=beaker_3, arm=left)\n  pour(source=beaker_3, target=tube_1, volume=5 mL, arm=left)"


def listing(**skills: tuple[str, ...] | None) -> Profile:
    """The bench where objects list these skills, or none at all."""
    lab = profile(BENCH)

    def listed(item: LabObject) -> LabObject:
        found = skills.get(item.name, item.skills)
        return replace(item, skills=found or (), skills_span=None if found is None else item.span)

    return replace(lab, objects=tuple(listed(item) for item in lab.objects))


def said(lab: Profile, body: str, **options: object) -> list[Diagnostic]:
    source = Source("t.xei", protocol(body))
    module, problems = parser().module(source)
    assert module is not None, problems
    found = check_module(module, source, lab, CheckOptions(**options))[1]  # type: ignore[arg-type]
    return [item for item in found if item.code == "XEI0326"]


@pytest.mark.parametrize(
    ("listed", "codes"), [(("place",), 1), ((), 1), (("place", "pick"), 0), (None, 0)], ids=str
)
def test_an_object_is_taken_only_for_what_it_lists(listed: tuple[str, ...] | None, codes: int) -> None:
    assert len(said(listing(tube_1=listed), "pick(object=tube_1)")) == codes


def test_the_message_names_the_list_and_who_would_do() -> None:
    lab = listing(bottle_1=("pick",), beaker_3=("place",), beaker_4=("place",))
    (found,) = said(
        lab, "pick(object=bottle_1, arm=left)\n  pour(source=bottle_1, target=tube_1, volume=5 mL)"
    )
    assert found.message == "`bottle_1` does not allow `pour`"
    assert found.label == "its `skills` are `pick`"
    assert found.notes == ("rule: " + lab.objects[0].span.file.replace("object_registry", "usage_profile"),)
    assert found.help == (
        "registered objects that would do: `beaker_1`, `beaker_2`, `bottle_2`",
        "add `pour` to the `skills` of `bottle_1`, if that may be done with it",
    )


def test_only_the_object_that_a_skill_acts_on_is_asked() -> None:
    assert said(listing(tube_1=("pick",)), POUR) == []
    assert len(said(listing(beaker_3=("pick",)), POUR)) == 1


def test_an_object_is_asked_by_its_place_and_once_it_is_bound() -> None:
    lab = listing(tube_1=("place",))
    assert len(said(lab, 'pick(object=rack_1.slot("A1"))')) == 1
    body = "object tube: movable\n  pick(object=tube)"
    assert said(lab, body, open_bindings=True) == []
    assert len(said(lab, body, bindings={"tube": "tube_1"})) == 1


def test_the_bench_says_where_its_lists_are() -> None:
    (tube, cap) = (profile(BENCH).object(name) for name in ("tube_1", "bottle_2_cap"))
    assert tube is not None
    assert cap is not None
    text = (BENCH / "usage_profile.yaml").read_text(encoding="utf-8")
    assert tube.skills_span is not None
    assert text[tube.skills_span.start :].startswith("[pick, place,")
    assert (cap.skills, cap.skills_span) == ((), None)
