"""An object that should stand somewhere and does not: because a hand has it, or because nobody knows where it
is.
"""

from __future__ import annotations

from typing import NoReturn

from xei_lang.diagnostics import Span
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Scene


def refuse_unplaced(scene: Scene, name: str, span: Span, use: str) -> NoReturn:
    """Give up a step about an object that does not stand (XEI0710); `use` ends "cannot be", as in "looked
    at".
    """
    carried = name
    while scene.holder(carried) is None and scene.carrier_of(carried):
        carried = scene.carrier_of(carried)
    holder = scene.holder(carried)
    if holder is None:
        refuse("XEI0710", f"it is not known where `{name}` stands", span, "not in the world")
    where = f"in the {holder} hand" if carried == name else f"on `{carried}`, which is in the {holder} hand"
    refuse(
        "XEI0710",
        f"`{name}` cannot be {use}: it is {where}",
        span,
        "expected an object that stands somewhere",
        (scene.held[holder].since,),
        help=(f"set `{carried}` down first",),
    )
