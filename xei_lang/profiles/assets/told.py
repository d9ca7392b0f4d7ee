"""What is said of a mesh or a point cloud."""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.ir.geometry import Box, Cylinder, Pose, Shape, Vec3
from xei_lang.profiles.assets.fit import Extent
from xei_lang.profiles.assets.units import LEAST_M, MOST_M, SCALES

WORDS = {"m": "metres", "mm": "millimetres", "cm": "centimetres", "in": "inches"}


@dataclass(frozen=True, slots=True)
class Named:
    """A file as a profile names it: `what` is `mesh` or `point_cloud`, `place` where its path stands, and
    `units_place` where its unit does, or would. `gives_shape` says that the object's shape is taken from it.
    """

    owner: str
    what: str
    path: str
    units: str | None
    T_object_file: Pose
    place: Span
    units_place: Span
    gives_shape: bool

    @property
    def thing(self) -> str:
        """`the mesh of `tube_1``, for sentences."""
        return f"the {self.what.replace('_', ' ')} of `{self.owner}`"

    @property
    def transform(self) -> str:
        """The key that places the file in the object's frame."""
        return "T_object_mesh" if self.what == "mesh" else "T_object_cloud"


def is_absent(named: Named, shown: str) -> Diagnostic:
    """XEI0672: the file is not there, and the shape is known without it."""
    return Diagnostic(
        "XEI0672",
        f"the profile has no `{named.path}`",
        named.place,
        label=f"named as {named.thing}",
        help=(f"put it at `{shown}`, or write `null` until there is one",),
    )


def unreadable(named: Named, reason: str) -> Diagnostic:
    """XEI0631: not what a mesh or a point cloud is."""
    return Diagnostic(
        "XEI0631",
        f"`{named.path}` {reason}",
        named.place,
        label=f"named as {named.thing}",
        help=(f"export or scan it again, or {_without(named)}",),
    )


def _without(named: Named) -> str:
    if named.gives_shape:
        return "state the shape as a `box` or a `cylinder`"
    return f"write `{named.what}: null` until there is one"


def no_library(named: Named, library: str) -> Diagnostic:
    """XEI0688: meshes are read by a library of an extra."""
    return Diagnostic(
        "XEI0688",
        f"reading `{named.path}` needs `{library}`, which is not installed",
        named.place,
        help=("pip install 'xei-lang[meshes]'",),
    )


def no_units(named: Named, longest: float, guess: str) -> Diagnostic:
    """XEI0633: a size is wanted, and the unit is not stated."""
    help_ = "state its unit: `m`, `mm`, `cm` or `in`"
    if guess:
        size = text_of(longest * SCALES[guess])
        help_ = f"written in {WORDS[guess]}? then it is {size} at its longest; write `units: {guess}`"
    return Diagnostic(
        "XEI0633",
        f"nothing says in which unit `{named.path}` is written",
        named.place,
        label=f"its numbers span {longest:.4g} at its longest",
        notes=("files of meshes and point clouds do not say their unit",),
        help=(help_,),
    )


def assumed_units(named: Named, guess: str, stated: Span) -> Diagnostic:
    """XEI0634: the unit is not stated, and the object's shape tells which it must be."""
    said = f"taken to be in {WORDS[guess]}, as its size then agrees" if guess else "no unit makes it so large"
    mend = f"write `{named.what}: {{file: {named.path}, units: {guess}}}`"
    return Diagnostic(
        "XEI0634",
        f"nothing says in which unit `{named.path}` is written",
        named.place,
        label=said,
        labels=(Label(stated, "the shape is stated here"),),
        help=(mend if guess else "state its unit, and correct the shape or the file",),
    )


def wrong_units(
    named: Named, size_m: Vec3, guess: str, stated: tuple[Span, float] | None = None
) -> Diagnostic:
    """XEI0633: the stated unit makes a size that no lab has, or another one than is `stated` (where, and its
    longest side). `size_m` are the edges that it makes.
    """
    longest_m = max(size_m)
    way = "high" if size_m[2] == longest_m else "long"
    assert named.units is not None
    label = f"expected a longest side between {text_of(LEAST_M)} and {text_of(MOST_M)}"
    labels: tuple[Label, ...] = ()
    if stated:
        label = f"expected {text_of(stated[1])}, found {text_of(longest_m)}"
        labels = (Label(stated[0], f"{text_of(stated[1])} at its longest"),)
    mend = "give the unit that it is written in, or scale it"
    if guess:
        mend = f"written in {WORDS[guess]}? write `units: {guess}`"
    return Diagnostic(
        "XEI0633",
        f"{named.thing} would be {text_of(longest_m)} {way} in {WORDS[named.units]}",
        named.units_place,
        label=label,
        labels=labels,
        help=(mend,),
    )


def misplaced(named: Named, extent: Extent, stated: Span | None) -> Diagnostic:
    """XEI0635, or the warning XEI0636 where the shape is `stated`: not at the frame."""
    x, y, z = extent.bottom_m
    position = tuple(
        value - off for value, off in zip(named.T_object_file.position_m, (x, y, z), strict=True)
    )
    mend = ", ".join(text_of(value + 0.0) for value in position)
    mends = f"write `{named.transform}: {{position: [{mend}]}}`, with its `rpy` if it has one"
    if named.T_object_file == Pose() and _is_y_up(extent):
        mends = (
            f"its y axis looks like the way up: write `{named.transform}: {{rpy: [90 deg, 0 deg, 0 deg]}}`"
        )
    return Diagnostic(
        "XEI0636" if stated else "XEI0635",
        f"{named.thing} does not stand on the object's frame",
        named.place,
        label=f"the centre of its bottom is at {text_of(x)}, {text_of(y)}, {text_of(z)}",
        labels=(Label(stated, "the shape is stated here"),) if stated else (),
        notes=("an object's frame is at the centre of its bottom, z up",),
        help=(mends,),
    )


def disagrees(named: Named, found: Shape, stated: Shape, where: Span, slack: str) -> Diagnostic:
    """XEI0636: another size than is stated."""
    return Diagnostic(
        "XEI0636",
        f"{named.thing} has another size than its shape",
        named.place,
        label=f"found {shape_text(found)}",
        labels=(Label(where, f"expected {shape_text(stated)}"),),
        notes=(f"sizes count as the same within {slack}",),
        help=("measure the object, and correct its shape or the file",),
    )


def is_open(named: Named) -> Diagnostic:
    """XEI0637: a mesh with holes."""
    return Diagnostic(
        "XEI0637",
        f"{named.thing} has holes",
        named.place,
        label="some edge belongs to one triangle only, or to more than two",
        notes=("its size is right, unless triangles are missing; who draws it may look inside",),
        help=("close it in a mesh editor, if the file was not meant to be open",),
    )


def _is_y_up(extent: Extent) -> bool:
    """Whether the bottom along y is at zero and the rest is centred, as graphics programs write it."""
    (x0, y0, z0), (x1, _, z1) = extent.lower_m, extent.upper_m
    slack = 0.02 * max(extent.size_m)
    return abs(y0) <= slack and abs(x0 + x1) <= slack and abs(z0 + z1) <= slack and z0 < -slack


def shape_text(shape: Shape) -> str:
    """`a cylinder, 17 mm x 118 mm`."""
    if isinstance(shape, Box):
        return "a box, " + " x ".join(text_of(value) for value in shape.size_m)
    if isinstance(shape, Cylinder):
        return f"a cylinder, {text_of(2 * shape.radius_m)} x {text_of(shape.height_m)}"
    return f"a sphere, {text_of(2 * shape.radius_m)}"


def kind_text(shape: Shape) -> str:
    """`a cylinder`."""
    return "a box" if isinstance(shape, Box) else f"a {type(shape).__name__.lower()}"


def size_of(shape: Shape) -> Vec3:
    """The edges of the bounding box of a shape that stands upright, metres."""
    if isinstance(shape, Box):
        return shape.size_m
    across = 2 * shape.radius_m
    return (across, across, shape.height_m if isinstance(shape, Cylinder) else across)


def text_of(length_m: float) -> str:
    """A length for people: millimetres to a tenth, and metres where it is long."""
    if abs(length_m) >= 1.0:
        return f"{length_m:.4g} m"
    digits = 1 if abs(length_m) >= 0.001 else 3
    return f"{round(1000 * length_m, digits) + 0.0:g} mm" if math.isfinite(length_m) else "no length"
