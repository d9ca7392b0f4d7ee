"""Which known name a wrong one was probably meant to be."""

from __future__ import annotations

from collections.abc import Iterable


def edit_distance(left: str, right: str) -> int:
    """Optimal string alignment distance: an insertion, deletion, substitution or swap costs 1."""
    before: list[int] = []
    previous = list(range(len(right) + 1))
    for i, a in enumerate(left, start=1):
        current = [i]
        for j, b in enumerate(right, start=1):
            cost = min(previous[j] + 1, current[j - 1] + 1, previous[j - 1] + (a != b))
            if i > 1 and j > 1 and a == right[j - 2] and left[i - 2] == b:
                cost = min(cost, before[j - 2] + 1)
            current.append(cost)
        before, previous = previous, current
    return previous[-1]


def did_you_mean(name: str, known: Iterable[str]) -> tuple[str, ...]:
    """At most three known names near enough to suggest, best first; nothing rather than a wild guess.

    A difference in case only always counts; otherwise the distance may be a third of the length, at least 1.
    """
    limit = max(1, len(name) // 3)
    ranked: list[tuple[int, str]] = []
    for candidate in sorted(set(known)):
        if candidate.lower() == name.lower():
            return (candidate,)
        if abs(len(candidate) - len(name)) <= limit:
            distance = edit_distance(name, candidate)
            if distance <= limit:
                ranked.append((distance, candidate))
    return tuple(candidate for _, candidate in sorted(ranked)[:3])
