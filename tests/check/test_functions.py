"""The functions that rearrange lists, as expressions see them and as laws."""

from __future__ import annotations

from collections import Counter
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.check.checking import ids, plan_of, protocol
from xei_lang.check.rearrange import chunks, pairs, products, shuffled
from xei_lang.check.values import ListValue, Val
from xei_lang.ir.skill_plan import ObjectRef

LISTS = st.lists(st.integers(), max_size=30)


def plain(value: Val) -> object:
    return [plain(item) for item in value.items] if isinstance(value, ListValue) else value


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[sum(c) for c in chunks([1, 2, 3, 4, 5], 2)]", [3, 7, 5]),
        ("[b - a for a, b in pairs([1, 4, 9])]", [3, 5]),
        ("[10 * a + b for a, b in product([1, 2], [3, 4])]", [13, 14, 23, 24]),
        ("[len(x) for x in product([1], [2], [3])]", [3]),
        ("shuffle([1, 2, 3, 4, 5], seed=7)", [5, 2, 4, 1, 3]),
        ("[ceil(x / 2) for x in [max(1, 2, 3), min([4, 3])]]", [2, 2]),
    ],
)
def test_values(text: str, expected: list[int]) -> None:
    body = f'for x in {text} {{ repeat x times {{ wait 1 s }}  confirm "next" }}'
    counts, waits = [], 0
    for step in plan_of(protocol(body)).steps:
        waits = waits + 1 if step.kind == "wait" else waits
        if step.kind == "confirm":
            counts.append(waits)
            waits = 0
    assert counts == expected


def test_a_dilution_goes_along_pairs() -> None:
    body = "for a, b in pairs([cup_1, tube_1]) { pour(source=a, target=b, volume=1 mL) }"
    assert plan_of(protocol(body)).steps[0].arg("target") == ObjectRef("tube_1")


@given(LISTS, st.integers(1, 9))
def test_chunks_hold_everything_in_order(items: list[int], size: int) -> None:
    made = [list(chunk.items) for chunk in chunks(items, size).items if isinstance(chunk, ListValue)]
    assert [item for chunk in made for item in chunk] == items
    assert all(len(chunk) == size for chunk in made[:-1])
    assert all(1 <= len(chunk) <= size for chunk in made)


@given(LISTS)
def test_pairs_are_neighbours(items: list[int]) -> None:
    assert plain(pairs(items)) == [items[at : at + 2] for at in range(len(items) - 1)]


@given(st.lists(LISTS.map(lambda items: items[:4]), min_size=2, max_size=3))
def test_product_counts(lists: list[list[int]]) -> None:
    made = plain(products(lists))
    assert isinstance(made, list)
    assert len(made) == len(lists[0]) * len(lists[1]) * (len(lists[2]) if len(lists) > 2 else 1)


@given(LISTS, st.integers())
def test_shuffle_keeps_everything_and_obeys_its_seed(items: list[int], seed: int) -> None:
    assert Counter(shuffled(items, seed).items) == Counter(items)
    assert shuffled(items, seed) == shuffled(items, seed)


def test_every_order_comes_up_about_equally_often() -> None:
    counts = Counter(shuffled((1, 2, 3, 4), seed).items for seed in range(4800))
    assert set(counts) == set(permutations((1, 2, 3, 4)))
    assert all(140 <= count <= 260 for count in counts.values())


@pytest.mark.parametrize(
    ("condition", "value"),
    [
        ("v - v == 0 mL", True),
        ("v == v", True),
        ("v < v", False),
        ("v + 1 mL > v", True),
        ("2 * v - v <= 4 mL", True),
        ("5 mL - v >= 1 mL", True),
        ("max(v, 4 mL) == 4 mL", True),
        ("v != 7 mL", True),
    ],
)
def test_an_open_value_is_known_again(condition: str, value: bool) -> None:
    body = f"""
      param v: Volume = 2 mL in 1 mL .. 4 mL
      if {condition} {{ yes: wait 1 s }} else {{ no: wait 1 s }}
    """
    taken = ids(body, open_bindings=True)
    assert taken == (["yes"] if value else ["no"])


def test_a_part_in_the_middle_counts_with_an_open_number() -> None:
    body = """
      param n: Int = 2 in 1 .. 3
      for part in chunks([tube_1, tube_2, tube_3], n) { for t in part { pick(object=t, arm=left) } }
    """
    assert len(ids(body, open_bindings=True)) == 3
