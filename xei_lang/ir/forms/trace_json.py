"""Trace as JSON Lines: one event a line, each line holding the SHA-256 of the one before.

Keys: `seq, t, stage, step_id, goal_id, prev_hash, representation`; the line of stage `end` also has `status`,
on a failure `failed_stage`, and as its very last key a `seal`. No line follows that one to hold its hash, so
the seal is the SHA-256 of the line itself with 64 zeros in the seal's place.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from xei_lang.ir.forms.canonical import line
from xei_lang.ir.trace import TraceEvent

NO_HASH = "0" * 64
_HOISTED = ("status", "failed_stage")
_SEAL = '"seal": "'


def to_line(event: TraceEvent) -> str:
    """The line of an event, without a line break."""
    value: dict[str, Any] = {
        "seq": event.seq,
        "t": event.t,
        "stage": event.stage,
        "step_id": event.step_id,
        "goal_id": event.goal_id,
        "prev_hash": event.prev_hash,
    }
    if event.stage != "end":
        return line({**value, "representation": event.representation})
    hoisted = {key: event.representation[key] for key in _HOISTED if key in event.representation}
    rest = {key: item for key, item in event.representation.items() if key not in _HOISTED}
    open_line = line({**value, **hoisted, "representation": rest, "seal": NO_HASH})
    return _with_seal(open_line, line_hash(open_line))


def from_line(text: str) -> TraceEvent:
    """The event of a line. Raises ValueError (or KeyError) for text that `to_line` did not write."""
    value = json.loads(text)
    hoisted = {key: value[key] for key in _HOISTED if key in value}
    return TraceEvent(
        seq=value["seq"],
        t=value["t"],
        stage=value["stage"],
        prev_hash=value["prev_hash"],
        step_id=value["step_id"],
        goal_id=value["goal_id"],
        representation={**hoisted, **value["representation"]},
    )


def line_hash(text: str) -> str:
    """The SHA-256, in hex, of a line's UTF-8 bytes without its line break."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def is_sealed(text: str) -> bool:
    """Whether a last line carries a seal that fits its own bytes."""
    start = len(text) - len(_SEAL) - len(NO_HASH) - 2
    if start < 0 or not text.startswith(_SEAL, start) or not text.endswith('"}'):
        return False
    seal = text[start + len(_SEAL) : -2]
    return seal == line_hash(_with_seal(text, NO_HASH))


def _with_seal(text: str, seal: str) -> str:
    return text[: -len(NO_HASH) - 2] + seal + '"}'
