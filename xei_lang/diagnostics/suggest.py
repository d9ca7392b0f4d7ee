"""Which known name a wrong one was probably meant to be."""

from __future__ import annotations

import string
from collections.abc import Iterable

_LONG, _MANY = 60, 300
"""Beyond these a guess takes too long: longer names get none, among more names only those one slip away."""
_CHARS = string.ascii_lowercase + string.digits + "_"


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
    lower = name.lower()
    candidates = set(known)
    same = min((candidate for candidate in candidates if candidate.lower() == lower), default=None)
    if same is not None:
        return (same,)
    near = [candidate for candidate in candidates if abs(len(candidate) - len(name)) <= limit]
    if len(name) > _LONG or len(near) > _MANY:
        return tuple(sorted(candidates & _one_away(name)))[:3] if len(name) <= _LONG else ()
    ranked = sorted((edit_distance(name, candidate), candidate) for candidate in near)
    return tuple(candidate for distance, candidate in ranked[:3] if distance <= limit)


def _one_away(name: str) -> frozenset[str]:
    """Every name that one insertion, deletion, substitution or swap makes of this one."""
    cuts = [(name[:at], name[at:]) for at in range(len(name) + 1)]
    shorter = [before + behind[1:] for before, behind in cuts]
    swapped = [before + behind[1] + behind[0] + behind[2:] for before, behind in cuts if len(behind) > 1]
    changed = [before + char + behind[cut:] for before, behind in cuts for char in _CHARS for cut in (0, 1)]
    return frozenset((*shorter, *swapped, *changed))
