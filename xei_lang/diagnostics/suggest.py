"""Which known name a wrong one was probably meant to be."""

from __future__ import annotations

import re
import string
from collections.abc import Iterable

_LONG, _MANY = 60, 300
"""Beyond these a guess takes too long: longer names get none, among more names only those one slip away."""
_CHARS = string.ascii_lowercase + string.digits + "_"
_NUMBERED = re.compile(r"(.+)_(\d{1,9})")


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
    Where nothing is as near, a name may lack its number: `beaker` of `beaker_1`.
    """
    candidates = set(known)
    return _near(name, candidates) or _numbered(name, candidates)


def _numbered(name: str, candidates: set[str]) -> tuple[str, ...]:
    """The first numbered names of the word that the name comes nearest to."""
    found = [match for match in map(_NUMBERED.fullmatch, candidates) if match]
    words = _near(name, {match[1] for match in found})[:1]
    of_word = [(int(match[2]), match[0]) for match in found if match[1] in words]
    return tuple(candidate for _, candidate in sorted(of_word)[:3])


def _near(name: str, candidates: set[str]) -> tuple[str, ...]:
    limit = max(1, len(name) // 3)
    lower = name.lower()
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
