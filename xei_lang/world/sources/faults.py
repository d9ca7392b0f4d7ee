"""Observations that cannot be taken at all: of things, frames and states that the profile does not have, of
another size, or two of one thing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.ir.geometry import Vec3
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.quantity.lengths import mm
from xei_lang.world.sources.observation import Observation, Observations

_UNKNOWN = "XEI0655"
_SIZE = "XEI0656"
_SCALES = ((1000.0, "metres", "millimetres"), (0.001, "millimetres", "metres"), (25.4, "inches", "mm"))
_SCALE_SLACK = 0.25
"""Sizes differ by a unit where their ratio is within this fraction of that of the units."""


def observation_faults(
    profile: Profile, observed: Observations, frames: Sequence[str]
) -> Iterator[Diagnostic]:
    """Everything about a source's observations that can be told without placing them; `frames` are those
    that stay where they are.
    """
    names, first = [item.name for item in profile.objects], set[str]()
    for one in observed.items:
        item = profile.object(one.name)
        if one.name in first:
            yield _said(observed, f"`{one.name}` was seen twice", one.span, "seen again here", "keep one")
        first.add(one.name)
        if item is None:
            yield _unknown(observed, "an object of this profile", one.name, names, one.span)
            continue
        if one.is_absent and item.system:
            yield _furniture(observed, item, one.span)
        if one.T_frame_object is not None and one.frame_id not in frames:
            yield _unknown(observed, "a frame that stays where it is", one.frame_id, frames, one.span)
        yield from _states(item, one, observed)
        if one.size_m is not None:
            yield from _size(item, one.size_m, one, observed)


def _furniture(observed: Observations, item: LabObject, span: Span | None) -> Diagnostic:
    """Without a table what stands on it would hang in the air, and motion would be planned through it."""
    message = f"`{item.name}` cannot be absent: it belongs to the room"
    help_ = "take the line out, or, where it is gone for good, take it out of `object_registry.yaml`"
    return _told("XEI0664", observed, message, span, "furniture is where the calibration has it", help_)


def _states(item: LabObject, one: Observation, observed: Observations) -> Iterator[Diagnostic]:
    declared = {state.name: state.values for state in item.states}
    for name, value in one.states:
        if name not in declared:
            yield _unknown(observed, f"a state of `{item.name}`", name, tuple(declared), one.span)
        elif value not in declared[name]:
            yield _unknown(observed, f"a value of `{name}({item.name})`", value, declared[name], one.span)


def _size(item: LabObject, size_m: Vec3, one: Observation, observed: Observations) -> Iterator[Diagnostic]:
    """A size that is another unit's is an error: everything else that comes from there may be wrong too."""
    known, seen = max(item.size_m), max(size_m)
    ratio = seen / known if known > 0.0 else 1.0
    for factor, wanted, found in _SCALES:
        if abs(math.log(ratio / factor)) < _SCALE_SLACK if ratio > 0.0 else False:
            message = f"`{item.name}` was seen {ratio:.4g} times as large as the profile has it"
            label = f"its numbers look like {found} where {wanted} are meant"
            yield _told(_SIZE, observed, message, one.span, label, "scale the mesh that it was seen with")
            return
    worst = max(range(3), key=lambda axis: abs(size_m[axis] - item.size_m[axis]))
    off_m = abs(size_m[worst] - item.size_m[worst])
    if off_m > max(0.005, 0.15 * item.size_m[worst]):
        message = f"`{item.name}` was seen {mm(size_m[worst])} along {'xyz'[worst]}"
        label = f"the profile has {mm(item.size_m[worst])}"
        help_ = "it may be another thing; measure it, and correct its shape or the mesh that it is seen with"
        yield _told("XEI0657", observed, message, one.span, label, help_)


def _unknown(
    observed: Observations, what: str, name: str, known: Sequence[str], span: Span | None
) -> Diagnostic:
    near = did_you_mean(name, known)
    shown = ", ".join(f"`{one}`" for one in sorted(known)[:12])
    help_ = f"did you mean `{near[0]}`?" if near else f"known are {shown}" if shown else "there is none"
    return _said(observed, f"`{name}` is not {what}", span, f"expected {what}", help_)


def _said(observed: Observations, message: str, span: Span | None, label: str, help_: str) -> Diagnostic:
    return _told(_UNKNOWN, observed, message, span, label, help_)


def _told(
    code: str, observed: Observations, message: str, span: Span | None, label: str, help_: str
) -> Diagnostic:
    notes = (f"said by {observed.source}",) if span is None else ()
    if span is None and label:
        notes = (*notes, label)
    return Diagnostic(code, message, span, label if span else "", (), notes, (help_,))
