"""Sources merged, object by object and field by field: a later source overrides what earlier ones said."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import LabObject
from xei_lang.world.sources.observation import Observation, Observations

USAGE_PROFILE = "usage_profile"
OBJECT_REGISTRY = "object_registry"
PRIOR = "prior"


@dataclass(frozen=True, slots=True)
class Seen:
    """A pose that a source other than the profile gave, and where that is written."""

    source: str
    T_frame_object: Pose
    frame_id: str
    span: Span | None


@dataclass(frozen=True, slots=True)
class Absent:
    """A source that says that an object is not there, and where that is written."""

    source: str
    span: Span | None


@dataclass(frozen=True, slots=True)
class Belief:
    """What the sources together say of one object; `seen` is None where only its prior says where it is, or
    where the last that was said is that it is `absent`.

    Each of `confidence`, `states` and `metadata` goes with who said it last.
    """

    item: LabObject
    seen: Seen | None
    absent: Absent | None
    confidence: float
    confidence_from: str
    states: tuple[tuple[str, str], ...]
    states_from: tuple[tuple[str, str], ...]
    metadata: tuple[tuple[str, str], ...]


def profile_source(item: LabObject) -> str:
    """The source that declares an object: the usage profile or the registry of system objects."""
    return OBJECT_REGISTRY if item.system else USAGE_PROFILE


def belief(item: LabObject, observed: tuple[tuple[str, Observation], ...]) -> Belief:
    """The merge of an object's own entry and what was observed of it, in the order of the sources."""
    own = f"{profile_source(item)} {PRIOR}"
    seen: Seen | None = None
    absent: Absent | None = None
    confidence, confidence_from = (item.prior.confidence if item.prior else 0.0), own
    states = {state.name: state.initial for state in item.states}
    states_from: dict[str, str] = {}
    metadata = {f"asset.{name}": path or "missing" for name, path in item.assets}
    for source, one in observed:
        if one.is_absent:
            seen, absent = None, Absent(source, one.span)
        if one.T_frame_object is not None:
            seen, absent = Seen(source, one.T_frame_object, one.frame_id, one.span), None
            metadata |= _details(one)
        if one.confidence is not None:
            confidence, confidence_from = one.confidence, source
        for name, value in one.states:
            states[name], states_from[name] = value, source
        metadata |= dict(one.metadata)
        metadata |= {f"perception.{name}": value for name, value in one.perception_args}
    return Belief(
        item,
        seen,
        absent,
        confidence,
        confidence_from,
        tuple(states.items()),
        tuple(states_from.items()),
        tuple(metadata.items()),
    )


def beliefs(objects: tuple[LabObject, ...], observed: tuple[Observations, ...]) -> dict[str, Belief]:
    """The belief of every object by its name; observations of other names are left out."""
    by_name: dict[str, list[tuple[str, Observation]]] = {}
    for source in observed:
        for one in source.items:
            by_name.setdefault(one.name, []).append((source.source, one))
    return {item.name: belief(item, tuple(by_name.get(item.name, ()))) for item in objects}


def _details(one: Observation) -> dict[str, str]:
    details: dict[str, str] = {}
    if one.stamp_ns is not None:
        details["seen.stamp_ns"] = str(one.stamp_ns)
    if one.covariance:
        details["seen.covariance"] = " ".join(f"{value:.6g}" for value in one.covariance)
    return details
