"""What the operations of a pipette share: the pipette in the hand, its upright pose, and how far it goes into
an opening.

A pipette's frame is where the end of a tip on it is, and its shape is that of the pipette with a tip: a
collision check keeps room for the tip whether it is on or not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive, Shape, Vec3
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.held import held_of_step, held_upright
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject, Tip


@dataclass(frozen=True, slots=True)
class Pipette:
    """The pipette that a hand holds, and the tips that it takes."""

    held: Held
    known: LabObject
    tip: Tip

    @property
    def nose_m(self) -> float:
        """Where the pipette's nose is, above the end of a tip on it."""
        return self.tip.length_m - self.tip.seat_m

    def upright(self, tip_end: Vec3) -> Pose:
        """The pipette upright with the end of its tip at a point, turned as it was grasped."""
        return held_upright(self.held, tip_end)

    def tool_point(self) -> Setting:
        """The parameter that says how far the tip's end is below the nose."""
        rule = f"`tip` of `{self.known.name}`: its length less what sits on the nose"
        return computed_length("tool_point", self.nose_m, rule)


def held_pipette(work: Work) -> Pipette:
    """The pipette in the arm's hand, if the step names it; refuses otherwise (XEI0707, XEI0726)."""
    held, known = held_of_step(work, "when it is used as a pipette")
    if known.tip is None:
        refuse(
            "XEI0726",
            f"`{known.name}` takes no tips: its profile lacks `tip`",
            work.step.span,
            "expected a pipette",
            (Label(known.span, "the object is stated here"),),
        )
    return Pipette(held, known, known.tip)


def goes_in_m(geometry: tuple[Primitive, ...], radius_m: float) -> float:
    """How far an upright object goes, from its origin up, into a round opening of this radius about its axis;
    infinite for one that is narrow enough all along.

    Parts are taken by their outermost point about the axis, from their lowest point on.
    """
    wide = (_lowest(part) for part in geometry if _outermost(part) > radius_m)
    return max(0.0, min(wide, default=math.inf))


def _outermost(part: Primitive) -> float:
    x, y, _ = part.T_object_shape.position_m
    return math.hypot(x, y) + _radius(part.shape, _is_upright(part))


def _lowest(part: Primitive) -> float:
    half = _half_height(part.shape) if _is_upright(part) else _radius(part.shape, False)
    return part.T_object_shape.position_m[2] - half


def _is_upright(part: Primitive) -> bool:
    return abs(part.T_object_shape.axes()[2][2]) > 1.0 - 1e-9


def _radius(shape: Shape, upright: bool) -> float:
    """About the shape's own axis, or of the ball around the whole shape where it lies askew."""
    across = math.hypot(shape.size_m[0], shape.size_m[1]) / 2 if isinstance(shape, Box) else shape.radius_m
    return across if upright else math.hypot(across, _half_height(shape))


def _half_height(shape: Shape) -> float:
    if isinstance(shape, Box):
        return shape.size_m[2] / 2
    if isinstance(shape, Cylinder):
        return shape.height_m / 2
    return shape.radius_m + (shape.height_m / 2 if isinstance(shape, Capsule) else 0.0)
