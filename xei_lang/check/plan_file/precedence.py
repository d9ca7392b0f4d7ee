"""Which steps of a plan surely come before which, by way of `after`, and which never happen in one run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from xei_lang.ir.skill_plan import Step


@dataclass(frozen=True, slots=True, eq=False)
class Precedence:
    """Steps by their places in an order that `after` allows.

    `earlier[k]` and `later[k]` have the bit of each step that comes before and after step `k` in any run.
    """

    steps: tuple[Step, ...]
    earlier: tuple[int, ...]
    later: tuple[int, ...]

    def apart(self, one: int, other: int) -> bool:
        """Whether nothing says which of the two comes first."""
        return one != other and not (self.earlier[one] | self.later[one]) >> other & 1

    def together(self, one: int, other: int) -> bool:
        """Whether both may happen in one run: no condition of one denies a condition of the other."""
        ours = {item.text for item in self.steps[one].when}
        theirs = {item.text for item in self.steps[other].when}
        return not (_denied(ours) & theirs or _denied(theirs) & ours)


def precedence(steps: Sequence[Step]) -> Precedence | None:
    """For steps in an order that `after` allows; None where an id stands twice or a step is after one that is
    not before it here, which is told of elsewhere.
    """
    places = {step.step_id: place for place, step in enumerate(steps)}
    if len(places) < len(steps):
        return None
    earlier: list[int] = []
    for place, step in enumerate(steps):
        before = [places.get(name, place) for name in step.after]
        if any(found >= place for found in before):
            return None
        reached = 0
        for found in before:
            reached |= earlier[found] | 1 << found
        earlier.append(reached)
    later = [0] * len(steps)
    for place in range(len(steps) - 1, -1, -1):
        for name in steps[place].after:
            later[places[name]] |= later[place] | 1 << place
    return Precedence(tuple(steps), tuple(earlier), tuple(later))


def _denied(texts: set[str]) -> set[str]:
    return {f"not ({text})" for text in texts}
