"""Where a written parameter leaves no grasp, it is named with what it may be; what no parameter could mend is
still the object's own matter.
"""

from __future__ import annotations

import pytest

from tests.lower.plans import bench, put_on_rack
from tests.lower.test_jaws_hold import WRITTEN, grasped
from tests.lower.test_refusals import refused, shaped
from xei_lang.ir.geometry import Cylinder
from xei_lang.lower import lower
from xei_lang.profiles.model import OperationDefault, Profile
from xei_lang.quantity import parse_quantity


def approached(word: str) -> Profile:
    said = (OperationDefault("approach", word, WRITTEN),)
    return shaped("tube_1", Cylinder(0.0085, 0.1), grasp=said)


def test_a_standoff_that_is_too_short_is_named_with_the_least_that_does() -> None:
    found = refused(put_on_rack(), grasped("tube_1", standoff="5 mm"))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message == "`standoff` of 5 mm does not take the fingertips clear of `tube_1`"
    least = found.label.removeprefix("expected at least ")
    graph, problems = lower(put_on_rack(), grasped("tube_1", standoff=least), bench()[1])
    assert graph is not None, problems
    shorter = f"{parse_quantity(least).si * 1000 - 1:g} mm"
    assert refused(put_on_rack(), grasped("tube_1", standoff=shorter)).code == "XEI0702"


def test_a_depth_without_a_grasp_is_named_with_those_that_have_one() -> None:
    found = refused(put_on_rack(), grasped("tube_1", grasp_depth="100 mm"))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message == "`grasp_depth` of 100 mm leaves no grasp of `tube_1`"
    least, most = found.label.removeprefix("expected ").removesuffix(" under its top").split(" .. ")
    for depth in (least, most):
        graph, problems = lower(put_on_rack(), grasped("tube_1", grasp_depth=depth), bench()[1])
        assert graph is not None, (depth, problems)


def test_an_approach_without_a_grasp_is_named_with_those_that_have_one() -> None:
    found = refused(put_on_rack(), approached("side"))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message == "no grasp of `tube_1` comes by `approach: side`"
    assert found.label == "expected `top`"
    graph, problems = lower(put_on_rack(), approached("top"), bench()[1])
    assert graph is not None, problems


@pytest.mark.parametrize("said", [{}, {"standoff": "5 mm"}, {"grasp_depth": "3 mm"}])
def test_an_object_that_no_grasp_fits_anyway_is_told_as_before(said: dict[str, str]) -> None:
    grasp = tuple(OperationDefault(key, parse_quantity(value), WRITTEN) for key, value in said.items())
    found = refused(put_on_rack(), shaped("tube_1", Cylinder(0.0085, 0.066), grasp=grasp))
    assert found.code == "XEI0704"
