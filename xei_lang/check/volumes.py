"""Nominal volumes along the walk: what each thing holds, as far as that is known, and what made it so."""

from __future__ import annotations

from xei_lang.check.values import POISON, Interval, Poison, Val
from xei_lang.diagnostics import Label
from xei_lang.quantity import Quantity
from xei_lang.record import Shown, record

_MOST_LABELS = 3


@record
class Amount(Shown):
    """What a thing holds: a volume, or POISON once it depends on what is not known.

    `labels` are the last places that made it so, the newest at the end.
    """

    value: Quantity | Interval | Poison
    labels: tuple[Label, ...]

    def then(self, value: Val, label: Label) -> Amount:
        """The amount after a change at `label`."""
        kept = tuple(old for old in self.labels if old.span != label.span)
        known = value if isinstance(value, (Quantity, Interval)) else POISON
        return Amount(known, (*kept[1 - _MOST_LABELS :], label))


NEVER_SAID = Amount(POISON, ())
"""What nothing has been said of."""

WRONG = Amount(POISON, ())
"""What was said wrongly, which is reported: nothing more needs to be said of it."""


class Volumes:
    """The amounts by the names of things."""

    def __init__(self) -> None:
        self._amounts: dict[str, Amount] = {}

    def copy(self) -> Volumes:
        """Amounts of their own, for another branch."""
        twin = Volumes()
        twin._amounts = dict(self._amounts)
        return twin

    def get(self, name: str) -> Amount:
        """What a thing holds; NEVER_SAID where nothing was said of it."""
        return self._amounts.get(name, NEVER_SAID)

    def set(self, name: str, amount: Amount) -> None:
        """Let a thing hold an amount."""
        self._amounts[name] = amount

    def changed_since(self, base: Volumes) -> tuple[str, ...]:
        """The things whose amounts were set since these were copied from `base`."""
        return tuple(name for name, amount in self._amounts.items() if base.get(name) is not amount)

    def adopt(self, base: Volumes, branch: Volumes) -> None:
        """Take over what a branch, copied from `base`, has set."""
        for name in branch.changed_since(base):
            self._amounts[name] = branch._amounts[name]

    def join(self, other: Volumes) -> Volumes:
        """What is known whichever of two branches was taken: amounts that differ are known no more."""
        both = Volumes()
        for name in dict.fromkeys((*self._amounts, *other._amounts)):
            first, second = self.get(name), other.get(name)
            same = first is second or first.value == second.value
            labels = (*first.labels[-1:], *second.labels[-1:])
            both._amounts[name] = first if same else Amount(POISON, tuple(dict.fromkeys(labels)))
        return both
