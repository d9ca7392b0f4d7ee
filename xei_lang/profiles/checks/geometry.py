"""Sizes that a profile states and that contradict each other."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.ir.tolerance import as_bound
from xei_lang.profiles.checks.leaning import check_leaning, lean_text, leans, turned_text
from xei_lang.profiles.checks.overlap import lowest_m
from xei_lang.profiles.grid import T_frame_object, T_world_frame
from xei_lang.profiles.model import LabObject, Profile, SlotGrid
from xei_lang.profiles.trees import Trees
from xei_lang.quantity.lengths import exact_mm

FIT_M = 0.0005
"""A bore must exceed what goes in by this much: catalogue diameters of tubes and bores hold to about half a
millimetre.
"""
_SLACK_M = 1e-6


def check_geometry(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Slots against their object and against what they accept, vessels, tables, and objects below their
    table.
    """
    for item in profile.objects:
        if item.slots is not None:
            yield from _slots(item, item.slots)
            yield from _bores(profile, item, item.slots)
        yield from _vessel(item)
        yield from _below(profile, item)
    yield from check_leaning(profile)
    yield from _table(profile)
    yield from _bounds(profile, trees)


def _slots(item: LabObject, grid: SlotGrid) -> Iterator[Diagnostic]:
    if grid.depth_m > grid.origin_m[2] + _SLACK_M:
        yield _wrong(
            item,
            grid,
            "are deeper than it is",
            f"{exact_mm(grid.depth_m)} deep, mouths {exact_mm(grid.origin_m[2])} above the bottom",
        )
    if grid.origin_m[2] > item.size_m[2] + _SLACK_M:
        yield _wrong(
            item,
            grid,
            "have mouths above its top",
            f"{exact_mm(grid.origin_m[2])}, and it is {exact_mm(item.size_m[2])} high",
        )
    if len(set(grid.rows)) < len(grid.rows):
        yield _wrong(item, grid, "have two rows of one name", ", ".join(grid.rows))
    counts = (grid.columns, len(grid.rows))
    for axis, name in enumerate("xy"):
        if counts[axis] > 1 and grid.pitch_m[axis] < grid.bore_m:
            yield _wrong(
                item,
                grid,
                "run into each other",
                f"pitch {exact_mm(grid.pitch_m[axis])}, bore {exact_mm(grid.bore_m)}",
            )
        first = grid.origin_m[axis] - grid.bore_m / 2
        last = grid.origin_m[axis] + (counts[axis] - 1) * grid.pitch_m[axis] + grid.bore_m / 2
        if first < -_SLACK_M or last > item.size_m[axis] + _SLACK_M:
            yield _wrong(
                item,
                grid,
                "reach past its edge",
                f"{exact_mm(first)} .. {exact_mm(last)} along {name}, it is {exact_mm(item.size_m[axis])}",
            )


def _wrong(item: LabObject, grid: SlotGrid, what: str, label: str) -> Diagnostic:
    return Diagnostic(
        "XEI0640",
        f"the slots of `{item.name}` {what}",
        grid.span,
        label=label,
        help=("measure slots and object again, and correct the one that is wrong",),
    )


def _bores(profile: Profile, item: LabObject, grid: SlotGrid) -> Iterator[Diagnostic]:
    for other in profile.objects:
        width = max(other.size_m[0], other.size_m[1])
        if set(other.roles) & set(grid.accepts) and width + FIT_M > grid.bore_m + _SLACK_M:
            yield Diagnostic(
                "XEI0640",
                f"`{other.name}` is too wide for the slots of `{item.name}` that accept it",
                grid.span,
                label=f"bore {exact_mm(grid.bore_m)}",
                labels=(Label(other.span, f"{exact_mm(width)} wide"),),
                notes=(
                    f"a bore must be {exact_mm(FIT_M)} wider than what it accepts: sizes hold to about that",
                ),
                help=("correct the sizes, or take the role out of the slots' `accepts`",),
            )


def _vessel(item: LabObject) -> Iterator[Diagnostic]:
    liquid = item.liquid
    if liquid is None:
        return
    if liquid.dead_volume_m3 >= liquid.capacity_m3:
        yield Diagnostic(
            "XEI0640",
            f"`{item.name}` can give back nothing of what it holds",
            item.span,
            label="its `dead_volume` is not below its `capacity`",
        )
    if liquid.inner_diameter_m >= min(item.size_m[0], item.size_m[1]):
        yield Diagnostic(
            "XEI0640",
            f"`{item.name}` is wider inside than outside",
            item.span,
            label=f"inner diameter {exact_mm(liquid.inner_diameter_m)},"
            f" outer {exact_mm(min(item.size_m[:2]))}",
        )


def _below(profile: Profile, item: LabObject) -> Iterator[Diagnostic]:
    """Objects of the lab may not begin under the table top whose frame they are told in."""
    tables = {station.ground_frame for station in profile.calibration.stations}
    placed = T_frame_object(profile, item)
    if placed is None or item.system or item.prior is None or item.prior.frame not in tables:
        return
    turned = leans(placed[1])
    height = lowest_m(item, placed[1]) if turned else placed[1].position_m[2]
    if height < -_SLACK_M:
        yield Diagnostic(
            "XEI0643",
            f"`{item.name}` would stand {exact_mm(-height)} below the top of `{placed[0]}`",
            item.prior.span,
            label="expected a height of 0 or above",
            notes=(
                "an object's frame is at its bottom",
                *((f"it {lean_text(placed[1])}", turned_text(placed[1])) if turned else ()),
            ),
        )


def _table(profile: Profile) -> Iterator[Diagnostic]:
    """The stated table height and the frame of the start station's table say the same."""
    calibration = profile.calibration
    station = next((item for item in calibration.stations if item.name == calibration.start_station), None)
    frame = next((item for item in calibration.frames if station and item.name == station.ground_frame), None)
    T_world_table = T_world_frame(profile, frame.name) if frame else None
    if frame is None or T_world_table is None:
        return
    height = T_world_table.position_m[2]
    within_m = max(as_bound(frame.position_tolerance_m, frame.tolerance_as), _SLACK_M)
    if abs(height - calibration.table_height_m) > within_m:
        yield Diagnostic(
            "XEI0640",
            f"the frame `{frame.name}` and the table's height disagree",
            frame.span,
            label=f"{exact_mm(height)} up, and `table` says {exact_mm(calibration.table_height_m)}",
        )


def _bounds(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    calibration = profile.calibration
    for path, (lower, upper) in (
        (("workspace",), calibration.workspace_bounds_m),
        (("table", "bounds"), calibration.table_bounds_m),
    ):
        if not all(low < high for low, high in zip(lower, upper, strict=True)):
            yield Diagnostic(
                "XEI0640",
                f"the bounds of `{path[0]}` hold nothing",
                trees.calibration.span_of(*path),
                label="expected every number of `lower` below that of `upper`",
            )
