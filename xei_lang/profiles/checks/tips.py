"""Pipettes whose stated tips contradict their shape: collision checks keep room for a tip only where the
shape has one.
"""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.ir.geometry import Box, Cylinder, Primitive
from xei_lang.profiles.model import LabObject, Profile, Tip
from xei_lang.quantity.lengths import exact_mm

_SLACK_M = 1e-6


def check_tips(profile: Profile) -> Iterator[Diagnostic]:
    """Tips that the pipette's nose goes through, and shapes that leave out a part of the tip."""
    for item in profile.objects:
        if item.tip is not None:
            yield from _tip(item, item.tip)


def _tip(item: LabObject, tip: Tip) -> Iterator[Diagnostic]:
    if tip.seat_m >= tip.length_m:
        yield Diagnostic(
            "XEI0640",
            f"the tips of `{item.name}` are shorter than what sits in them",
            tip.span,
            label=f"{exact_mm(tip.length_m)} long, the nose sits {exact_mm(tip.seat_m)} deep",
            help=("measure both again, and correct the one that is wrong",),
        )
        return
    covered = _covered_m(item.geometry, tip.diameter_m / 2)
    if covered < tip.length_m - tip.seat_m - _SLACK_M:
        yield Diagnostic(
            "XEI0640",
            f"the shape of `{item.name}` leaves out its tip",
            tip.span,
            label=f"{exact_mm(tip.length_m - tip.seat_m)} of a tip stand out,"
            f" {exact_mm(tip.diameter_m)} wide",
            labels=(Label(item.span, f"its shape has {exact_mm(covered)} of that"),),
            notes=(
                "a pipette's frame is at the end of a tip on it, and its shape has the tip on at all times",
            ),
            help=("put the tip into its `shape` and `collision`, from the object's bottom up",),
        )


def _covered_m(geometry: tuple[Primitive, ...], radius_m: float) -> float:
    """Up to which height from the frame on the upright parts on its axis are at least this wide."""
    spans: list[tuple[float, float]] = []
    for part in geometry:
        x, y, z = part.T_object_shape.position_m
        upright = part.T_object_shape.axes()[2][2] > 1.0 - 1e-9
        shape = part.shape
        if isinstance(shape, (Box, Cylinder)) and upright and max(abs(x), abs(y)) < _SLACK_M:
            wide = min(shape.size_m[:2]) / 2 if isinstance(shape, Box) else shape.radius_m
            half = (shape.size_m[2] if isinstance(shape, Box) else shape.height_m) / 2
            if wide >= radius_m - _SLACK_M:
                spans.append((z - half, z + half))
    reached = 0.0
    for lower, upper in sorted(spans):
        if lower <= reached + _SLACK_M:
            reached = max(reached, upper)
    return reached
