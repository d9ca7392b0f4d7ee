"""Faults injected into a compiled protocol are found too, not only those in plans made for the test."""

from __future__ import annotations

import pytest

from tests.e2e.made import PROTOCOLS, compiled
from tests.motion.verify.faults import MAKERS, inject
from xei_lang.motion.verify import RobotDescription, VerifyOptions, verify_timed
from xei_lang.profiles.open import robot_texts

PARTS = 3


@pytest.mark.parametrize("part", range(PARTS))
def test_every_class_of_faults_is_found_in_a_compiled_protocol(part: int) -> None:
    _, outcome = compiled(next(path for path in PROTOCOLS if path.stem == "put_on_rack"))
    made = outcome.made
    assert made.profile and made.timed and made.graph and made.world
    robot = RobotDescription(*robot_texts(made.profile))
    calibration = made.profile.calibration
    options = VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad)
    missed = []
    for seed in range(part, len(MAKERS), PARTS):
        fault = inject(made.timed, made.graph, made.world, robot, seed)
        given = (fault.plan, fault.graph, fault.world, robot, calibration.limits)
        report = verify_timed(*given, options=options)
        if fault.kind not in {finding.kind for finding in report.findings}:
            missed.append((seed, fault.name, fault.kind))
    assert missed == []
