"""How much work one check may do, so that a few lines cannot keep it busy for hours."""

from __future__ import annotations

from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Span

_PER_STEP = 10


class Budget:
    """Counts turns of loops and members of lists against ten times the bound on steps."""

    def __init__(self, max_steps: int, reporter: Reporter) -> None:
        self._limit = _PER_STEP * max_steps
        self._spent = 0
        self._reporter = reporter

    @property
    def is_spent(self) -> bool:
        """Whether the bound was passed, which then has been reported."""
        return self._spent > self._limit

    def spend(self, count: int, span: Span) -> bool:
        """Whether so much more may be done for what stands at `span`; the first refusal is reported."""
        if self.is_spent:
            return False
        self._spent += count
        if self.is_spent:
            self._reporter.report(
                "XEI0316",
                "the loops and lists up to here take too many turns and members",
                span,
                f"they may take {self._limit} together",
                help=("do fewer turns, or divide the work into several protocols",),
            )
        return not self.is_spent
