"""What a hand would carry, against the payload of the calibration profile."""

from __future__ import annotations

from xei_lang.diagnostics import Label, Span
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task
from xei_lang.quantity import Quantity
from xei_lang.record import Record, record

_WATER_KG_M3 = 1000.0
"""What is in a vessel weighs what as much water does: no profile states densities."""


@record
class _Part(Record):
    """A part of a load: in words, its mass (kg), and where it is stated."""

    words: str
    mass_kg: float
    span: Span | None


def refuse_heavy(task: Task, name: str, span: Span) -> None:
    """Give up a step in whose hand the object, what rides on it and what the plan knows to be in them weigh
    more than the payload (XEI0730). `span` is the user's words for the object.
    """
    parts = [part for one in (name, *task.scene.riders_of(name)) for part in _parts(task, one)]
    calibration, load_kg = task.profile.calibration, sum(part.mass_kg for part in parts)
    if load_kg <= calibration.payload_kg + 1e-9:
        return
    told = [Label(part.span, f"{part.words} weighs {_mass(part.mass_kg)}") for part in parts if part.span]
    if calibration.payload_span is not None:
        told.append(Label(calibration.payload_span, f"an arm carries {_mass(calibration.payload_kg)}"))
    sum_of = " and ".join(f"{_mass(part.mass_kg)} of {part.words}" for part in parts)
    refuse(
        "XEI0730",
        f"`{name}` is too heavy for a hand",
        span,
        f"weighs {_mass(load_kg)}, expected at most {_mass(calibration.payload_kg)}",
        tuple(told),
        notes=(f"in the hand: {sum_of}",) if len(parts) > 1 else (),
    )


def _parts(task: Task, name: str) -> tuple[_Part, ...]:
    known = task.profile.object(name)
    facts = task.step.state_before
    volume = next((fact.value for fact in facts if (fact.variable, fact.subject) == ("volume", name)), None)
    own = _Part(f"`{name}`", known.mass_kg, known.mass_span) if known else None
    within = None
    if isinstance(volume, Quantity) and volume.value > 0:
        within = _Part(f"the {volume} in `{name}`, taken for water,", volume.si * _WATER_KG_M3, None)
    return tuple(part for part in (own, within) if part is not None and part.mass_kg > 0.0)


def _mass(mass_kg: float) -> str:
    grams = round(mass_kg * 1000, 3)
    return f"{grams:g} g" if grams < 1000 else f"{grams / 1000:g} kg"
