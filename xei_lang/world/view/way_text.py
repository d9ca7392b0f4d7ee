"""How well the place of something is known: the way to it, and what each link of the way adds."""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.tolerance import SIGMAS
from xei_lang.quantity.lengths import millimetres
from xei_lang.world.transforms import Share, Transform

_MEANS = {"bound": "bound", "std": "standard deviation"}


def way_lines(way: Transform) -> Iterator[str]:
    """The way and its tolerance; then a line for each link that adds to it, and how they are summed up."""
    turn = f"{math.degrees(way.rotation_tolerance_rad):.2g} deg"
    path = " > ".join(way.path)
    yield f"by {path}, {way.status}, good to {millimetres(way.position_tolerance_m)} mm and {turn}"
    shares = [one for one in way.shares if one.most_m > 0.0]
    width = max((len(one.link.name) for one in shares), default=0)
    yield from (f"  {one.link.name.ljust(width)}  {_share(one)}" for one in shares)
    if way.position_std_m > 0.0:
        bounds = f"{_mm(way.position_bound_m)} mm of bounds, " if way.position_bound_m else ""
        yield f"  in all: {bounds}{SIGMAS:g} standard deviations of {_mm(way.position_std_m)} mm"


def _share(share: Share) -> str:
    link = share.link
    means = _MEANS[link.tolerance_as]
    if not link.rotation_tolerance_rad * share.lever_m:
        return f"{means} of {_mm(share.position_m)} mm"
    turned = f"{math.degrees(link.rotation_tolerance_rad):.3g} deg over {_mm(share.lever_m)} mm"
    return f"{_mm(link.position_tolerance_m)} mm and {turned}: {means} of {_mm(share.position_m)} mm"


def _mm(length_m: float) -> str:
    return f"{float(f'{1e3 * length_m:.3g}'):g}" if length_m < 0.1 else millimetres(length_m)
