from __future__ import annotations

import pytest

from xei_lang.diagnostics import did_you_mean

BENCH = ("beaker_1", "beaker_2", "beaker_10", "tube_1", "tube_2", "tube_10", "tube_12", "cap_rest_1", "table")


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("tabel", ("table",)),
        ("tub_1", ("tube_1",)),
        ("beakr", ("beaker_1", "beaker_2", "beaker_10")),
        ("Tube", ("tube_1", "tube_2", "tube_10")),
        ("cap_rst", ("cap_rest_1",)),
        ("centrifuge", ()),
        ("", ()),
    ],
)
def test_a_name_may_lack_its_number(name: str, near: tuple[str, ...]) -> None:
    assert did_you_mean(name, BENCH) == near


def test_what_is_nearer_with_its_number_comes_before_what_lacks_it() -> None:
    assert did_you_mean("tube", ("tub", "tube_1")) == ("tub",)


def test_many_numbered_names_are_one_word() -> None:
    assert did_you_mean("wel", [f"well_{number}" for number in range(5000)]) == ("well_0", "well_1", "well_2")
