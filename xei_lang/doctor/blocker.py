"""A deployment blocker: what keeps a profile off a simulation, a strict compilation or a real robot."""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.record import Record, record

Stage = Literal["simulate", "strict", "hardware"]
STAGES: tuple[Stage, ...] = ("simulate", "strict", "hardware")
"""From the mildest use of a profile to the real one. What blocks one stage blocks those after it."""


@record
class Blocker(Record):
    """One thing that stands in the way.

    `representation` is the file or handoff that it belongs to (`calibration_profile`), `item` its place there
    (`frames.table`), `status` what is wrong with it in a word (`placeholder`, `missing`). `blocks` is the
    first stage that it stops. `measure` says what to do about it, `write_to` where the answer goes: a file of
    the profile and the item in it (`calibration_profile.yaml:frames.table`). `span` is the place that speaks
    of it, where there is one.
    """

    code: str
    representation: str
    item: str
    status: str
    blocks: Stage
    measure: str
    write_to: str
    span: Span | None = None
