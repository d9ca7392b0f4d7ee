"""Which written parameter leaves no grasp of an object that has some without it."""

from __future__ import annotations

import math
from dataclasses import replace

from xei_lang.diagnostics import Label
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.grasp_family import Grasps, Request, grasps
from xei_lang.lower.operations.grasp_ways import APPROACHES, ELEVATIONS_DEG
from xei_lang.lower.parameters import Setting
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import mm

_ABOVE = "hand and fingers must stay above what the object stands in, here and where it is set down next"


def refuse_written(work: Work, known: LabObject, request: Request) -> None:
    """Give up a step for whose request no grasp is left, where a written parameter is to blame (XEI0702)."""
    standoff = work.layers.written("standoff")
    if standoff is not None and grasps(replace(request, standoff_m=math.inf)) is not None:
        _refuse(
            work,
            known,
            standoff,
            f"`standoff` of {standoff.text} does not take the fingertips clear of `{known.name}`",
            f"expected at least {_least_standoff_mm(request)} mm",
        )
    depth = work.layers.written("grasp_depth")
    free = grasps(replace(request, depth_m=None)) if depth is not None else None
    if depth is not None and free is not None:
        _refuse(
            work,
            known,
            depth,
            f"`grasp_depth` of {depth.text} leaves no grasp of `{known.name}`",
            f"expected {_depths(request, free)} under its top",
        )
    approach = work.layers.written("approach")
    if approach is not None and grasps(replace(request, elevations_deg=ELEVATIONS_DEG)) is not None:
        others = [
            name
            for name, elevations in sorted(APPROACHES.items())
            if grasps(replace(request, elevations_deg=elevations)) is not None
        ]
        _refuse(
            work,
            known,
            approach,
            f"no grasp of `{known.name}` comes by `approach: {approach.text}`",
            f"expected {' or '.join(f'`{name}`' for name in others) or 'none'}",
        )


def _refuse(work: Work, known: LabObject, blamed: Setting, message: str, label: str) -> None:
    refuse(
        "XEI0702",
        message,
        blamed.span or work.span,
        label,
        (Label(known.span, f"`{known.name}` is stated here"),),
        notes=() if blamed.name == "standoff" else (_ABOVE,),
    )


def _least_standoff_mm(request: Request) -> int:
    """The shortest way back, in whole millimetres, that some grasp needs. There must be one without limit."""
    needed_mm = math.floor(max(0.0, request.standoff_m) * 1000) + 1
    while grasps(replace(request, standoff_m=needed_mm / 1000)) is None:
        needed_mm += 1
    return needed_mm


def _depths(request: Request, free: Grasps) -> str:
    """How deep under the top the grasps lie that there are."""
    depths = [request.height_m - member.T_reference_tool.position_m[2] for member in free.members]
    least, most = mm(min(depths)), mm(max(depths))
    return least if least == most else f"{least} .. {most}"
