"""Elements of touch screens that are not on their screen's face, or on top of each other (XEI0640).

A face is the side of a box that looks along its own -x: as wide as the box along y, as high as along z.
Elements are told from its lower left corner, to the right and up, by their centre and size.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.ir.geometry import Box
from xei_lang.profiles.model import Element, LabObject, Profile
from xei_lang.quantity.lengths import exact_mm

_SLACK_M = 1e-6


def check_elements(profile: Profile) -> Iterator[Diagnostic]:
    """Every element of every object."""
    for item in profile.objects:
        if not item.elements:
            continue
        if not isinstance(item.shape, Box):
            yield _no_face(item)
            continue
        for element in item.elements:
            yield from _outside(item, element)
        for one, other in combinations(item.elements, 2):
            yield from _on_each_other(item, one, other)


def _no_face(item: LabObject) -> Diagnostic:
    return Diagnostic(
        "XEI0640",
        f"`{item.name}` has elements and no flat face for them",
        item.elements[0].span,
        label="an element is told on the side of a box",
        labels=(Label(item.span, "its shape is no box"),),
        help=("state its `shape` as a box, or take its `elements` out",),
    )


def _outside(item: LabObject, element: Element) -> Iterator[Diagnostic]:
    (left, right), (low, high) = element.spans_m
    _, width, height = item.size_m
    if element.is_on(width, height):
        return
    yield Diagnostic(
        "XEI0640",
        f"the element `{element.name}` reaches past the face of `{item.name}`",
        element.span,
        label=f"{exact_mm(left)} .. {exact_mm(right)} to the right, {exact_mm(low)} .. {exact_mm(high)} up",
        labels=(Label(item.span, f"its face is {exact_mm(width)} wide and {exact_mm(height)} high"),),
        notes=("`center` is told from the lower left corner of the face, to the right and up",),
        help=("measure element and screen again, and correct the one that is wrong",),
    )


def _on_each_other(item: LabObject, one: Element, other: Element) -> Iterator[Diagnostic]:
    sides = zip(one.spans_m, other.spans_m, strict=True)
    if all(min(a[1], b[1]) - max(a[0], b[0]) > _SLACK_M for a, b in sides):
        yield Diagnostic(
            "XEI0640",
            f"the elements `{one.name}` and `{other.name}` of `{item.name}` overlap",
            other.span,
            label="a touch here may be meant for the other one",
            labels=(Label(one.span, "the other one"),),
            help=("measure both again, and correct the one that is wrong",),
        )
