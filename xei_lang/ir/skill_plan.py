"""SkillPlan: which registered skills a protocol asks for, in which order, with every argument resolved.

The plan is a partial order: `after` names the steps that must have ended before one starts. A plain sequence
is a chain. Branches of a choice, turns of a loop and calls of procedures leave their marks (`branch`, `turn`,
`origin`) so that a step can always be shown at the place where somebody wrote it.
"""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.quantity import Quantity
from xei_lang.record import Record, record

StepKind = Literal[
    "skill", "wait", "confirm", "start", "await", "pause", "resume", "stop", "leave", "measure", "require"
]
Side = Literal["left", "right"]
ArmChoice = Literal["left", "right", "either"]


@record
class ObjectRef(Record):
    """A registered object, by its name in the usage profile."""

    name: str


@record
class PlaceRef(Record):
    """A place on or in an object: a slot of a rack (`kind="slot"`, `key="A1"`) or a named spot of a surface.

    Written `rack_1.slot("A1")` or `table.spot("bottle")`; a whole surface has `kind="surface"` and an empty
    key.
    """

    object: str
    kind: Literal["slot", "spot", "surface"]
    key: str


@record
class StationRef(Record):
    """A navigation pose from which a bench is worked: a scene origin of the calibration profile."""

    name: str


@record
class PoseIn(Record):
    """A pose in a frame of the calibration profile (or `world`), in the units in which it was written.

    `position` is x, y, z (Length), `rotation` roll, pitch, yaw (Angle) about the frame's fixed axes:
    `R = Rz(yaw) Ry(pitch) Rx(roll)`, as in URDF.
    """

    frame: str
    position: tuple[Quantity, Quantity, Quantity]
    rotation: tuple[Quantity, Quantity, Quantity]


@record
class RunValue(Record):
    """A value that measurements give: `formula` says how, with the ids of those steps, `needs`
    (`od[2] * 2 mL`).

    Whatever is measured within its limits, the value lies in `lower .. upper`, ends included.
    """

    formula: str
    needs: tuple[str, ...]
    lower: Quantity | int | float | bool
    upper: Quantity | int | float | bool


Value = (
    Quantity
    | int
    | float
    | bool
    | str
    | ObjectRef
    | PlaceRef
    | StationRef
    | PoseIn
    | RunValue
    | tuple["Value", ...]
)
"""What an argument can be once it is checked. An arm is its name as a string (`left`, `right`, `either`)."""


@record
class Condition(Record):
    """A condition that the plan leaves open. `text` is an expression of the language in which the measuring
    steps `needs` are named by their ids (`od[2] < 0.1`); without `needs` it is in the words of the protocol.
    """

    text: str
    needs: tuple[str, ...]
    span: Span


@record
class Argument(Record):
    """A checked argument: its value and where both came from (`default` when the skill bank supplied it)."""

    name: str
    value: Value
    type: str
    source: Literal["call", "default"]
    span: Span


@record
class Call(Record):
    """One frame of the call chain that led to a step: the procedure and where it was called."""

    procedure: str
    span: Span


@record
class Fact(Record):
    """A known value of a state variable: `holding(left) == tube_1`, `at(tube_1) == rack_1.slot("A1")`."""

    variable: str
    subject: str
    value: Value


@record
class Step(Record):
    """One step of the plan.

    `step_id` is the step's path (`rack[2].insert#1`); `resources` are what it occupies (`left_arm`, `slide`,
    `base`). `when` holds the conditions under which the step happens, all of them; empty means always. A step
    that does not happen counts as ended. `keep` holds the conditions that the run must find true before and
    after the step. `needs` are the measuring steps that its conditions and arguments read. `state_before`
    lists what is known when it starts, sorted by variable and subject.
    """

    step_id: str
    kind: StepKind
    span: Span
    skill: str = ""
    owner: str = ""
    args: tuple[Argument, ...] = ()
    duration_s: tuple[float, float] = (0.0, 0.0)
    after: tuple[str, ...] = ()
    branch: str = ""
    turn: tuple[int, ...] = ()
    when: tuple[Condition, ...] = ()
    resources: tuple[str, ...] = ()
    state_before: tuple[Fact, ...] = ()
    origin: tuple[Call, ...] = ()
    keep: tuple[Condition, ...] = ()
    needs: tuple[str, ...] = ()

    def arg(self, name: str) -> Value | None:
        """The value of an argument, or None where neither the call nor the skill bank gives one."""
        return next((argument.value for argument in self.args if argument.name == name), None)


@record
class UnmappedRequest(Record):
    """Something that was asked for and that this robot cannot do, kept in its place."""

    text: str
    reason: str
    after_step: str | None
    span: Span


@record
class SafetyNote(Record):
    """A note of the protocol that people who run it must read."""

    text: str
    after_step: str | None
    span: Span


@record
class TimeConstraint(Record):
    """`lower_s <= time(to) - time(from) <= upper_s` between ends of steps (`upper_s` may be infinite)."""

    from_step: str
    from_end: Literal["start", "end"]
    to_step: str
    to_end: Literal["start", "end"]
    lower_s: float
    upper_s: float
    span: Span


@record
class SkillPlan(Record):
    """The first handoff after the language: skill calls, gaps, notes and timing, each with its source."""

    protocol: str
    profile: str
    steps: tuple[Step, ...]
    initial_state: tuple[Fact, ...] = ()
    constraints: tuple[TimeConstraint, ...] = ()
    unmapped_requests: tuple[UnmappedRequest, ...] = ()
    safety_notes: tuple[SafetyNote, ...] = ()
