"""Clauses of time as constraints between ends of steps. They are recorded here, and solved later."""

from __future__ import annotations

import math

from xei_lang.check import arithmetic
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.functions import not_yet
from xei_lang.check.labels import Extent, Found, Labels
from xei_lang.check.report import Reporter
from xei_lang.check.run_time import known_now, needs_of
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import Types
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, Val, nominal
from xei_lang.ir.skill_plan import TimeConstraint
from xei_lang.quantity import Quantity
from xei_lang.syntax.ast import After, Clause, Expression, Within

_MOST_PAIRS = 10_000


class Clauses:
    """Turns `within` and `after` clauses into constraints."""

    def __init__(self, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter

    def constraint(
        self, clause: Clause, own: Found, labels: Labels, scope: Scope, state: State
    ) -> tuple[TimeConstraint, ...]:
        """What a clause of the steps `own` says; nothing where it is wrong, or covers no step at all."""
        if isinstance(clause, After):
            return self._after(clause, own, labels, scope, state)
        return self._within(clause, own, labels, scope, state)

    def duration(self, node: Expression, what: str, scope: Scope, state: State) -> Quantity | None:
        """A time that is known now and not negative; None where it is wrong, or open without bounds."""
        value = self.time(node, what, scope, state)
        value = nominal(known_now(value, f"the time that {what} takes", node.span, self._reporter))
        return value if isinstance(value, Quantity) else None

    def time(self, node: Expression, what: str, scope: Scope, state: State) -> Val:
        """A time that is not negative, whatever is measured; POISON where it is wrong."""
        value = self._evaluator.value(node, scope)
        value = self._types.coerce(value, Expectation(what, "Time"), node, state)
        least = value.lower if needs_of(value) and isinstance(value, Interval) else nominal(value)
        if isinstance(least, Quantity) and least.value < 0:
            may = "may be" if needs_of(value) else "is"
            self._reporter.report(
                "XEI0322", f"{what} takes a time that is not negative", node.span, f"{may} {show(least)}"
            )
            return POISON
        return value

    def _within(
        self, clause: Within, own: Found, labels: Labels, scope: Scope, state: State
    ) -> tuple[TimeConstraint, ...]:
        bound = self.duration(clause.duration, "`within`", scope, state)
        start = own if clause.of is None else labels.find(clause.of, self._reporter)
        if bound is None or own is None or start is None:
            return ()
        if clause.of is not None:
            return self._between(start, own, (0.0, bound.si), clause)
        if len(own.firsts) * len(own.lasts) > _MOST_PAIRS:
            not_yet(self._reporter, "a bound on the time of so many steps that may overlap", clause.span)
            return ()
        return tuple(
            TimeConstraint(first, "start", last, "end", 0.0, bound.si, clause.span)
            for first in own.firsts
            for last in own.lasts
        )

    def _after(
        self, clause: After, own: Found, labels: Labels, scope: Scope, state: State
    ) -> tuple[TimeConstraint, ...]:
        before = labels.find(clause.step, self._reporter)
        low: Val | None = None
        high: Val | None = None
        if clause.by is not None:
            low = self.duration(clause.by.lower, "`by`", scope, state)
            high = self.duration(clause.by.upper, "`by`", scope, state)
            if low is None or high is None:
                return ()
            if arithmetic.compare(">", low, high):
                self._reporter.report(
                    "XEI0322",
                    f"nothing can be `by {show(low)} .. {show(high)}` after a step",
                    clause.by.span,
                    "the first time is longer than the second",
                    help=("write the shorter time first",),
                )
                return ()
        if own is None or before is None:
            return ()
        bounds = (
            (low.si, high.si) if isinstance(low, Quantity) and isinstance(high, Quantity) else (0.0, math.inf)
        )
        return self._between(before, own, bounds, clause)

    def _between(
        self, before: Extent, own: Extent, bounds: tuple[float, float], clause: Clause
    ) -> tuple[TimeConstraint, ...]:
        """From the latest end of some steps to the earliest start of others.

        An upper bound holds between the latest and the earliest only, which no conjunction of pairs says.
        """
        pairs = [(last, first) for last in before.lasts for first in own.firsts]
        if len(pairs) > 1 and bounds[1] != math.inf:
            not_yet(self._reporter, "a longest time between steps of which some may overlap", clause.span)
            return ()
        return tuple(
            TimeConstraint(last, "end", first, "start", *bounds, clause.span) for last, first in pairs
        )
