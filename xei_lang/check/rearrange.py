"""Functions that make lists of lists: `chunks`, `pairs`, `product`, and `shuffle`."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, product

from xei_lang.check.values import ListValue, Val

_MASK = (1 << 64) - 1


def chunks(items: Sequence[Val], size: int) -> ListValue:
    """Parts of `size` members in their order; the last one may be shorter."""
    return ListValue(tuple(ListValue(tuple(items[at : at + size])) for at in range(0, len(items), size)))


def pairs(items: Sequence[Val]) -> ListValue:
    """Each member with the next: `(a, b), (b, c)`."""
    return ListValue(tuple(ListValue(pair) for pair in pairwise(items)))


def products(lists: Sequence[Sequence[Val]]) -> ListValue:
    """Every choice of one member of each list; the last list goes through first."""
    return ListValue(tuple(ListValue(choice) for choice in product(*lists)))


def shuffled(items: Sequence[Val], seed: int) -> ListValue:
    """The members in an order that the seed alone decides, the same on every machine and for ever.

    Fisher-Yates (Durstenfeld 1964) over SplitMix64 (Steele, Lea, Flood 2014), with rejection so that each
    order is equally likely.
    """
    made, state = list(items), seed & _MASK
    for last in range(len(made) - 1, 0, -1):
        count = last + 1
        fair = (1 << 64) - (1 << 64) % count
        while True:
            state, drawn = _splitmix64(state)
            if drawn < fair:
                break
        made[last], made[drawn % count] = made[drawn % count], made[last]
    return ListValue(tuple(made))


def _splitmix64(state: int) -> tuple[int, int]:
    state = (state + 0x9E3779B97F4A7C15) & _MASK
    mixed = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & _MASK
    return state, mixed ^ (mixed >> 31)
