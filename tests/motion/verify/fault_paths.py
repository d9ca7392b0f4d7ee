"""Trajectories changed: bumps, ramps, other speeds, cuts, all in closed form on `Knots`."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tests.motion.verify.maker import evaluate
from xei_lang.ir.timed import Knots, Samples, TimedGoal


def resampled(goal: TimedGoal, knots: Knots) -> TimedGoal:
    """The goal with other knots, its end and its samples with them."""
    end = goal.start_s + knots.times_s[-1]
    assert goal.samples is not None
    steps = max(2, round(knots.times_s[-1] * 100))
    times = tuple(goal.start_s + knots.times_s[-1] * k / steps for k in range(steps + 1))
    rows = [evaluate(knots, t - goal.start_s) for t in times]
    columns = [tuple(tuple(map(float, row[k])) for row in rows) for k in range(3)]
    return replace(goal, end_s=end, knots=knots, samples=Samples(times, *columns))


def add_polynomial(knots: Knots, joint: int, powers: list[float]) -> Knots:
    """Add `sum_k powers[k] * sigma**k` to one joint's path, sigma running from 0 to 1 over the whole path."""
    first, length = knots.breaks[0], knots.breaks[-1] - knots.breaks[0]
    pieces = []
    for start, piece in zip(knots.breaks, knots.coefficients, strict=False):
        rows = [list(row) for row in piece]
        width = len(rows[0])
        offset = (start - first) / length
        while len(rows) < len(powers):
            rows.append([0.0] * width)
        for k, power in enumerate(powers):
            for j in range(k + 1):
                rows[j][joint] += power * math.comb(k, j) * offset ** (k - j) / length**j
        pieces.append(tuple(tuple(row) for row in rows))
    return replace(knots, coefficients=tuple(pieces))


def bump(knots: Knots, joint: int, height: float) -> Knots:
    """Lift one joint's path in its middle by `height`, ends and their slopes as they were: `64 s^3 (1 -
    s)^3`."""
    return add_polynomial(knots, joint, [0, 0, 0, 64 * height, -192 * height, 192 * height, -64 * height])


def ramp(knots: Knots, joint: int, height: float) -> Knots:
    """Let one joint's path end `height` higher, as smoothly: `10 s^3 - 15 s^4 + 6 s^5`."""
    return add_polynomial(knots, joint, [0, 0, 0, 10 * height, -15 * height, 6 * height])


def faster(knots: Knots, factor: float) -> Knots:
    """The same path run `factor` times as fast."""
    times = tuple(t / factor for t in knots.times_s)
    ds, dds = tuple(v * factor for v in knots.ds), tuple(a * factor**2 for a in knots.dds)
    return replace(knots, times_s=times, ds=ds, dds=dds)


def middle_time(knots: Knots) -> float:
    """When the path is half way: found by bisection on `s`, which rises."""
    wanted, low, high = 0.5 * (knots.breaks[0] + knots.breaks[-1]), 0.0, knots.times_s[-1]
    for _ in range(60):
        mid = 0.5 * (low + high)
        i = max(k for k in range(len(knots.dds)) if knots.times_s[k] <= mid or k == 0)
        w = mid - knots.times_s[i]
        s = knots.s[i] + knots.ds[i] * w + knots.dds[i] * w * w / 2
        low, high = (mid, high) if s < wanted else (low, mid)
    return 0.5 * (low + high)


def probe(knots: Knots, count: int = 60) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
    """Times with position, velocity and acceleration."""
    times = [knots.times_s[-1] * (k + 0.5) / count for k in range(count)]
    return [(t, *evaluate(knots, t)) for t in times]


def split(knots: Knots, i: int, parts: list[tuple[float, float]]) -> Knots:
    """Interval i cut into parts (length, added path acceleration) and what is left of it."""
    times, s, ds, dds = (
        list(knots.times_s[: i + 1]),
        list(knots.s[: i + 1]),
        list(knots.ds[: i + 1]),
        list(knots.dds[:i]),
    )
    for length, added in parts:
        pull = knots.dds[i] + added
        dds.append(pull)
        s.append(s[-1] + ds[-1] * length + pull * length**2 / 2)
        ds.append(ds[-1] + pull * length)
        times.append(times[-1] + length)
    dds += knots.dds[i:]
    rows = [tuple(a) + tuple(b[i + 1 :]) for a, b in ((times, knots.times_s), (s, knots.s), (ds, knots.ds))]
    return Knots(knots.breaks, knots.coefficients, rows[0], rows[1], rows[2], tuple(dds))


def cut_path(knots: Knots) -> Knots:
    """A path of one piece as two pieces of the same motion (Taylor's formula at the cut)."""
    cut = 0.5 * (knots.breaks[1] - knots.breaks[0])
    rows = np.array(knots.coefficients[0])
    second = [
        sum(math.comb(k, j) * cut ** (k - j) * rows[k] for k in range(j, len(rows))) for j in range(len(rows))
    ]
    pieces = (knots.coefficients[0], tuple(tuple(map(float, row)) for row in second))
    return replace(
        knots, breaks=(knots.breaks[0], knots.breaks[0] + cut, knots.breaks[1]), coefficients=pieces
    )


def shifted(piece: tuple[tuple[float, ...], ...], column: int, shift: float) -> tuple[tuple[float, ...], ...]:
    """A piece with one joint shifted as a whole."""
    first = tuple(value + shift * (k == column) for k, value in enumerate(piece[0]))
    return (first, *piece[1:])
