"""All that is known of one frame: where it is, how that is known, and what it was taken to be before."""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.tolerance import tolerance_text
from xei_lang.ir.world import Frame, World
from xei_lang.profiles.model import CalibratedFrame, EarlierTransform, Profile
from xei_lang.world.history import Change, changes
from xei_lang.world.transforms import lookup
from xei_lang.world.view.way_text import way_lines

BASE = "robot_base"


def frame_text(world: World, profile: Profile, frame: Frame, *, history: bool) -> str:
    """Some lines about a frame of the world; `history` tells its former values, too."""
    stated = next((one for one in profile.calibration.frames if one.name == frame.name), None)
    lines = [f"{frame.name}, a frame", f"  in {frame.parent}: {pose_text(frame.T_parent_frame)}"]
    lines += [f"    {line}" for line in (_known(stated) if stated else _carried(world, frame))]
    way = lookup(world, BASE, frame.name)
    if way.shares:
        lines.append(f"  in {BASE} at {world.robot.station}: {pose_text(way.T_target_source)}")
        lines += [f"    {line}" for line in way_lines(way)]
    if history:
        lines += [f"  {line}" for line in history_lines(stated)]
    return "\n".join(lines) + "\n"


def history_lines(stated: CalibratedFrame | None) -> Iterator[str]:
    """What a frame was taken to be before, the newest first."""
    if stated is None or not stated.history:
        yield "never measured anew"
        return
    yield "before"
    for change in changes(stated):
        yield from (f"  {line}" for line in _before(change))


def _known(stated: CalibratedFrame | EarlierTransform) -> Iterator[str]:
    when = f" on {stated.measured_on}" if stated.measured_on else ""
    tolerance = tolerance_text(
        stated.position_tolerance_m, stated.rotation_tolerance_rad, stated.tolerance_as
    )
    yield f"{stated.status}{when}, good to {tolerance}"
    yield stated.method
    if stated.residual:
        yield f"left over: {stated.residual}"


def _carried(world: World, frame: Frame) -> Iterator[str]:
    tolerance = tolerance_text(frame.position_tolerance_m, frame.rotation_tolerance_rad, frame.tolerance_as)
    how = f"docked at {world.robot.station}" if frame.name == BASE else "carried by the robot"
    yield f"{frame.status}, {how}, good to {tolerance}"


def _before(change: Change) -> Iterator[str]:
    yield pose_text(change.earlier.T_parent_frame)
    yield from (f"  {line}" for line in _known(change.earlier))
    told = "more than both tolerances allow" if change.is_jump else "then it was measured anew"
    apart = f"{1e3 * change.position_m:.2f} mm and {math.degrees(change.rotation_rad):.3f} deg"
    yield f"  {apart} from what came after: {told}"
