"""How much work one check may do, so that a few lines cannot keep it busy for hours."""

from __future__ import annotations

from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Span

_WORK = 250_000
"""Up to a second, in the cost of one value: a name, a number, a sum of two values."""
_PER_STEP = 20
TURN, CALL = 6, 16
"""What a turn of a loop and a call of a procedure cost beside the values in them."""


class Budget:
    """Counts values, turns of loops and members of lists against a bound.

    What a text needs when each of its values is worked out once is free (`allow` its characters), and so is
    what makes steps, which have a bound of their own (`reached` tells how many there are).
    """

    def __init__(self, reporter: Reporter) -> None:
        self._left = _WORK
        self._steps = 0
        self._reporter = reporter

    @property
    def is_spent(self) -> bool:
        """Whether the bound was passed, which then has been reported."""
        return self._left < 0

    def allow(self, count: int) -> None:
        """Raise the bound."""
        self._left += count

    def reached(self, steps: int) -> None:
        """Raise the bound by what new steps may cost."""
        if steps > self._steps and self._left >= 0:
            self._left += _PER_STEP * (steps - self._steps)
            self._steps = steps

    def spend(self, count: int, span: Span) -> bool:
        """Whether so much more may be done for what stands at `span`; the first refusal is reported."""
        if self._left < 0:
            return False
        self._left -= count
        if self._left < 0:
            self._reporter.report(
                "XEI0316",
                "the loops and lists up to here take too many turns and members",
                span,
                f"they may work out {_WORK} values together",
                help=("do fewer turns, or divide the work into several protocols",),
            )
            return False
        return True
