"""SkillPlan as JSON: the form that `xei compile --emit plan` prints and that a bundle keeps as `plan.json`.

Values are written as somebody who reads the plan with another program wants them:

- a quantity is `{"value": 2, "unit": "mL"}`, in the unit in which it was written, never converted; where no
  decimal is it (a third of 10 mL), `exact` has it as a fraction;
- an object, a station, an arm, a word is its name: `"tube_1"`, `"bench_b"`, `"either"`;
- a place is its text in a protocol, `"rack_2.slot(\\"A1\\")"`, and for a whole surface the object's name;
- a pose is `{"pose": {"x": ..., ...}, "frame": "table"}` with its six parts, `POSE_PARTS`;
- what a measurement gives is `{"measured": "od[2] * 2 mL", "lower": ..., "upper": ...}`;
- numbers, truth values and texts are those of JSON, a list is an array.

Every step is in `skill_calls`, in the order of the text; one that calls no skill has its kind as `skill`
(`wait`, `confirm`). `needs` names the measuring steps that its conditions and arguments read, by ids as they
stand there. A bound on time without an upper end has `null` there. Lines count from 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from xei_lang.diagnostics import Sources, Span
from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.skill_plan import (
    Fact,
    ObjectRef,
    PlaceRef,
    PoseIn,
    RunValue,
    SafetyNote,
    SkillPlan,
    StationRef,
    Step,
    TimeConstraint,
    UnmappedRequest,
    Value,
)
from xei_lang.quantity import Quantity

POSE_PARTS = ("x", "y", "z", "roll", "pitch", "yaw")
"""The parts of a pose in its forms, in their order."""


def to_json(plan: SkillPlan, sources: Sources) -> dict[str, Json]:
    """The whole plan. `sources` hold the protocol's text, for its lines; a span of another file has line
    `null`.
    """
    return {
        "version": 1,
        "protocol": plan.protocol,
        "profile": plan.profile,
        "skill_calls": [_step(step, sources) for step in plan.steps],
        "unmapped_requests": [_unmapped(request, sources) for request in plan.unmapped_requests],
        "safety_notes": [_note(note, sources) for note in plan.safety_notes],
        "constraints": [_constraint(constraint, sources) for constraint in plan.constraints],
        "initial_state": facts_form(plan.initial_state),
    }


def value_form(value: Value) -> Json:  # noqa: PLR0911 one return for each kind of value
    """One value of an argument or a fact."""
    match value:
        case Quantity():
            return _quantity(value)
        case ObjectRef() | StationRef():
            return value.name
        case PlaceRef():
            return f'{value.object}.{value.kind}("{value.key}")' if value.key else value.object
        case PoseIn():
            parts = zip(POSE_PARTS, (*value.position, *value.rotation), strict=True)
            return {"pose": {name: _quantity(part) for name, part in parts}, "frame": value.frame}
        case RunValue():
            ends = {"lower": value_form(value.lower), "upper": value_form(value.upper)}
            return {"measured": value.formula, **ends}
        case tuple():
            return [value_form(item) for item in value]
        case _:
            return value


def facts_form(facts: Iterable[Fact]) -> dict[str, Json]:
    """Facts by variable and subject: `{"holding": {"left": "nothing"}}`.

    Where a subject has several values (both arms full, and not known which holds what) they are an array.
    """
    form: dict[str, dict[str, Json]] = {}
    for fact in facts:
        values, value = form.setdefault(fact.variable, {}), value_form(fact.value)
        if fact.subject not in values:
            values[fact.subject] = value
            continue
        before = values[fact.subject]
        values[fact.subject] = [*before, value] if isinstance(before, list) else [before, value]
    return dict(form)


def _step(step: Step, sources: Sources) -> dict[str, Json]:
    return {
        "step_id": step.step_id,
        "skill": step.skill or step.kind,
        "owner": step.owner,
        "args": {argument.name: value_form(argument.value) for argument in step.args},
        "line": _line(step.span, sources),
        "kind": step.kind,
        "defaults": [argument.name for argument in step.args if argument.source == "default"],
        "after": list(step.after),
        "resources": list(step.resources),
        "duration_s": [step.duration_s[0], _finite(step.duration_s[1])],
        "branch": step.branch,
        "turn": list(step.turn),
        "when": [condition.text for condition in step.when],
        "keep": [condition.text for condition in step.keep],
        "needs": list(step.needs),
        "origin": [{"procedure": call.procedure, "line": _line(call.span, sources)} for call in step.origin],
        "state_before": facts_form(step.state_before),
    }


def _unmapped(request: UnmappedRequest, sources: Sources) -> dict[str, Json]:
    return {
        "text": request.text,
        "reason": request.reason,
        "after_step": request.after_step,
        "line": _line(request.span, sources),
    }


def _note(note: SafetyNote, sources: Sources) -> dict[str, Json]:
    return {"text": note.text, "after_step": note.after_step, "line": _line(note.span, sources)}


def _constraint(constraint: TimeConstraint, sources: Sources) -> dict[str, Json]:
    return {
        "from_step": constraint.from_step,
        "from_end": constraint.from_end,
        "to_step": constraint.to_step,
        "to_end": constraint.to_end,
        "lower_s": constraint.lower_s,
        "upper_s": _finite(constraint.upper_s),
        "line": _line(constraint.span, sources),
    }


def _line(span: Span, sources: Sources) -> int | None:
    source = sources.get(span.file)
    return source.line_number(span.start) if source else None


def _quantity(value: Quantity) -> dict[str, Json]:
    magnitude = value.magnitude
    if magnitude.denominator == 1:
        return {"value": magnitude.numerator, "unit": value.unit}
    near = float(magnitude)
    form: dict[str, Json] = {"value": near, "unit": value.unit}
    return form if Fraction(repr(near)) == magnitude else {**form, "exact": str(magnitude)}


def _finite(seconds: float) -> float | None:
    return seconds if math.isfinite(seconds) else None
