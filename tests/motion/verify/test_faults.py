"""The verifier finds every one of 1,000 injected faults, and nothing in the good plans that they were made
from."""

from __future__ import annotations

from random import Random

import pytest

from tests.motion.verify.closed import closed_tube
from tests.motion.verify.fault_bench import Bench
from tests.motion.verify.faults import MAKERS, inject
from tests.motion.verify.scene import Case, arm_of, pick_and_place, tour
from xei_lang.motion.verify import verify_timed

CASES = (pick_and_place, tour, closed_tube)
FAULTS, PART = 1000, 50


@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_nothing_is_found_in_good_plans(make) -> None:
    report = verify_timed(*make())
    assert report.findings == ()
    assert report.checked.configurations > 1000
    assert report.checked.distances > 100


@pytest.mark.parametrize("part", range(FAULTS // PART))
def test_every_fault_is_found(part: int) -> None:
    missed = [seed for seed in range(part * PART, (part + 1) * PART) if not _found(seed)]
    assert missed == []


def test_every_class_of_faults_fits_some_plan() -> None:
    names = {maker.__name__ for maker in MAKERS}
    fitting = {maker.__name__ for maker in MAKERS if any(_fits(maker, case()) for case in CASES)}
    assert fitting == names


def _case(seed: int) -> Case:
    return CASES[seed // len(MAKERS) % len(CASES)]()


def _found(seed: int) -> bool:
    case = _case(seed)
    fault = inject(*case, seed)
    report = verify_timed(fault.plan, fault.graph, fault.world, case[3])
    return fault.kind in {finding.kind for finding in report.findings}


def _fits(maker, case: Case) -> bool:
    plan, graph, world, robot = case
    benches = (Bench(plan, graph, world, robot, arm_of(robot.urdf_text), Random(seed)) for seed in range(10))
    return any(maker(bench) is not None for bench in benches)
