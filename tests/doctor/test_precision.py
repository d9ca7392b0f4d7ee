"""Places that are known too little for what is to fit there."""

from __future__ import annotations

from dataclasses import replace

from tests.world.bench import bench
from xei_lang.doctor.precision import precision_blockers


def test_tips_that_a_pipette_may_miss_block_until_the_way_is_known() -> None:
    found = [item for item in precision_blockers(bench()) if item.item == "slots.tip_box_1"]
    assert [item.code for item in found] == ["XEI0676"]
    assert "the tips of `tip_box_1` take `pipette_1` with an error of 0.8 mm" in found[0].measure
    frames = tuple(
        replace(frame, position_tolerance_m=1e-4, rotation_tolerance_rad=1e-4)
        for frame in bench().calibration.frames
    )
    known = replace(bench(), calibration=replace(bench().calibration, frames=frames))
    assert not [item for item in precision_blockers(known) if item.item == "slots.tip_box_1"]


def test_elements_that_a_finger_may_miss_block_until_the_way_is_known() -> None:
    found = [item for item in precision_blockers(bench()) if item.item == "elements.incubator_screen"]
    assert [item.code for item in found] == ["XEI0676"]
    assert "or use larger elements: a touch meets `" in found[0].measure
    assert "with an error of 5.0 mm" in found[0].measure
    frames = tuple(
        replace(frame, position_tolerance_m=1e-4, rotation_tolerance_rad=1e-4)
        for frame in bench().calibration.frames
    )
    known = replace(bench(), calibration=replace(bench().calibration, frames=frames))
    assert not [item for item in precision_blockers(known) if item.item == "elements.incubator_screen"]
