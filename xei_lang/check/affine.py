"""What open values have in common: an interval as a constant and a share of each unknown.

`v - v` is nothing, and a vessel that holds `v` and is filled up by `5 mL - v` holds 5 mL: affine arithmetic
(Comba and Stolfi 1993), exact for sums, differences and multiples, which is what volumes are made of.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from xei_lang.check.values import Interval, Numeric, Shares, Unknown
from xei_lang.quantity import Quantity

Apply = Callable[[str, Numeric, Numeric], Numeric]
_MOST_SHARES = 16


def opened(interval: Interval, apply: Apply) -> Interval:
    """The interval as one value of its own, that is not known yet."""
    width = apply("-", interval.upper, interval.lower)
    shares = ((Unknown(), width),) if _sign(width) else ()
    return Interval(
        interval.lower, interval.upper, interval.nominal, interval.formula, interval.needs, shares
    )


def linear(op: str, left: Interval | Numeric, right: Interval | Numeric, apply: Apply) -> Interval | None:
    """`left op right` where that is linear in what is unknown; its width may be nothing. None elsewhere."""
    shares = _shares(op, left, right, apply)
    if shares is None or len(shares) > _MOST_SHARES:
        return None
    lower = upper = apply(op, _base(left, apply), _base(right, apply))
    for _, width in shares:
        if _sign(width) < 0:
            lower = apply("+", lower, width)
        else:
            upper = apply("+", upper, width)
    return Interval(lower, upper, apply(op, _nominal(left), _nominal(right)), shares=shares)


def _shares(op: str, left: Interval | Numeric, right: Interval | Numeric, apply: Apply) -> Shares | None:
    if any(isinstance(side, Interval) and not side.shares for side in (left, right)):
        return None
    if op in "+-":
        return _summed(op, _of(left), _of(right), apply)
    if isinstance(left, Interval) and not isinstance(right, Interval):
        return _wide((unknown, apply(op, width, right)) for unknown, width in left.shares)
    if op == "*" and isinstance(right, Interval) and not isinstance(left, Interval):
        return _wide((unknown, apply(op, left, width)) for unknown, width in right.shares)
    return None


def _summed(op: str, left: Shares, right: Shares, apply: Apply) -> Shares:
    found = dict(left)
    for unknown, width in right:
        before = found.get(unknown)
        found[unknown] = apply(op, apply("*", width, 0) if before is None else before, width)
    return _wide(found.items())


def _wide(shares: Iterable[tuple[Unknown, Numeric]]) -> Shares:
    return tuple((unknown, width) for unknown, width in shares if _sign(width))


def _of(side: Interval | Numeric) -> Shares:
    return side.shares if isinstance(side, Interval) else ()


def _base(side: Interval | Numeric, apply: Apply) -> Numeric:
    """What the side is worth where every unknown is at its lower end."""
    if not isinstance(side, Interval):
        return side
    base = side.lower
    for _, width in side.shares:
        if _sign(width) < 0:
            base = apply("-", base, width)
    return base


def _nominal(side: Interval | Numeric) -> Numeric:
    return side.nominal if isinstance(side, Interval) else side


def _sign(width: Numeric) -> int:
    value = width.value if isinstance(width, Quantity) else width
    return (value > 0) - (value < 0)
