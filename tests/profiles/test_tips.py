"""A pipette's tips and shape: the shape has the tip on, or the profile is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.world.bench import bench
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive
from xei_lang.profiles.checks.tips import check_tips
from xei_lang.profiles.model import LabObject, Profile


def part(shape: Cylinder | Box, lower: float, x: float = 0.0) -> Primitive:
    height = shape.size_m[2] if isinstance(shape, Box) else shape.height_m
    return Primitive(shape, Pose((x, 0.0, lower + height / 2)))


BODY = part(Cylinder(0.017, 0.17), 0.13)
SHAFT = part(Cylinder(0.006, 0.06), 0.07)
TIP = part(Cylinder(0.0045, 0.07), 0.0)


def with_parts(*parts: Primitive, **tip: float) -> Profile:
    def change(item: LabObject) -> LabObject:
        assert item.tip is not None
        return replace(item, geometry=parts, tip=replace(item.tip, **tip))

    known = bench()
    objects = (change(item) if item.name == "pipette_1" else item for item in known.objects)
    return replace(known, objects=tuple(objects))


def test_the_bench_has_its_tip_in_its_shape() -> None:
    assert list(check_tips(bench())) == []


@pytest.mark.parametrize(
    "parts",
    [
        (TIP, SHAFT, BODY),
        (BODY, TIP, SHAFT),
        (part(Box((0.01, 0.009, 0.3)), 0.0),),
        (part(Cylinder(0.0045, 0.04), 0.0), part(Cylinder(0.005, 0.05), 0.03)),
    ],
)
def test_any_shape_that_holds_the_tip_is_good(parts: tuple[Primitive, ...]) -> None:
    assert list(check_tips(with_parts(*parts))) == []


@pytest.mark.parametrize(
    ("parts", "shown"),
    [
        ((SHAFT, BODY), "its shape has 0 mm of that"),
        ((part(Cylinder(0.004, 0.07), 0.0), SHAFT, BODY), "its shape has 0 mm of that"),
        ((part(Cylinder(0.0045, 0.06), 0.0), SHAFT, BODY), "its shape has 60 mm of that"),
        ((part(Cylinder(0.0045, 0.07), 0.0, x=0.01), SHAFT, BODY), "its shape has 0 mm of that"),
    ],
)
def test_a_shape_without_all_of_the_tip_is_refused(parts: tuple[Primitive, ...], shown: str) -> None:
    (found,) = check_tips(with_parts(*parts))
    assert found.code == "XEI0640"
    assert found.labels[0].message == shown


def test_a_nose_does_not_go_through_its_tip() -> None:
    (found,) = check_tips(with_parts(TIP, SHAFT, BODY, seat_m=0.078))
    assert found.code == "XEI0640"
    assert found.label == "78 mm long, the nose sits 78 mm deep"
