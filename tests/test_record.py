"""Records compare, hash and print as `@dataclass` would have them."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.record import Record, Shown


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Pair(Record):
    first: int
    second: str = "b"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Other(Record):
    first: int
    second: str = "b"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Node(Shown):
    inner: Pair


def test_equal_fields_of_one_class_are_equal_and_hash_alike() -> None:
    assert Pair(1) == Pair(1, "b")
    assert hash(Pair(1)) == hash(Pair(1, "b"))
    assert Pair(1) != Pair(2)
    assert Pair(1) != Other(1)
    assert Pair(1) != (1, "b")


def test_what_is_only_shown_compares_by_identity() -> None:
    node = Node(Pair(1))
    assert node == node
    assert node != Node(Pair(1))
    assert len({node, Node(Pair(1))}) == 2


def test_text_is_that_of_a_dataclass() -> None:
    assert repr(Node(Pair(1))) == "Node(inner=Pair(first=1, second='b'))"


def test_records_have_no_dict() -> None:
    assert not hasattr(Pair(1), "__dict__")
