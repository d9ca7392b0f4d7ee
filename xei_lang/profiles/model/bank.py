"""What a development profile says: the skills, their contracts and templates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.diagnostics import Span
from xei_lang.profiles.model.lab import OperationDefault
from xei_lang.quantity import Quantity
from xei_lang.record import Record, record

if TYPE_CHECKING:
    from xei_lang.ir.goals import GoalKind
    from xei_lang.syntax.ast import Predicate, TypeExpr


@record
class ArgSpec(Record):
    """An argument of a skill. `type` is `object`, `Place`, `Pose`, `Station`, `Arm`, a quantity's type,
    `Int`, `Float`, `Bool`, `String`, or `choice` (then `choices` are its words). Bounds hold for quantities
    and numbers, ends included.

    For a Place, `choices` are the kinds that it admits (`slot`, `spot`, `surface`; empty admits all), and an
    object whose roles satisfy `roles` may be given for its whole surface. `roles_text` is what the profile
    says, for messages.
    """

    name: str
    type: str
    roles: TypeExpr | None
    min: Quantity | None
    max: Quantity | None
    default: str | Quantity | int | float | bool | None
    required: bool
    choices: tuple[str, ...]
    span: Span
    roles_text: str = ""


@record
class ReturnSpec(Record):
    """What a skill that measures gives back: a quantity's type, `Int` or `Float`, and its bounds, ends
    included; None where the instrument is not known to have any.
    """

    type: str
    min: Quantity | None
    max: Quantity | None
    span: Span


@record
class SkillRule(Record):
    """A predicate of a skill's contract, in its words and parsed."""

    text: str
    predicate: Predicate
    span: Span


MOST_TIMES = 100
"""How often a template may go through the same lines."""


@record
class Repeat(Record):
    """Lines of a template that are gone through several times, `times` being a number or the name of one.

    `number` tells the repeats of a template apart; `span` is the word `repeat`.
    """

    times: str | int
    number: int
    span: Span


@record
class TemplateStep(Record):
    """One line of a skill's template: a goal kind and its fields, whose values may name arguments (`arm`),
    points of an operation (`object.pregrasp`) or operation parameters (`open_width`).

    Neighbours with the same `repeat` are gone through together, as often as it says. `path` is where the
    line stands below `template` in the file.
    """

    kind: GoalKind
    fields: tuple[tuple[str, str | int | float | bool], ...]
    span: Span
    repeat: Repeat | None = None
    path: tuple[str | int, ...] = ()

    def field(self, name: str) -> str | int | float | bool | None:
        """The value of a field, or None."""
        return dict(self.fields).get(name)


@record
class SkillSpec(Record):
    """A registered skill: its contract and its template.

    While an instrument carries it out, it holds the objects of the arguments `occupies`, and what stands in
    or on them; `touchable` says that these may be worked with all the same. `min_confidence` is how surely
    it must be known where its objects are, None where it asks for no more than every skill does.
    """

    name: str
    owner: str
    summary: str
    args: tuple[ArgSpec, ...]
    exposed: bool
    requires: tuple[SkillRule, ...]
    ensures: tuple[SkillRule, ...]
    duration_s: tuple[float, float]
    unsupported: tuple[str, ...]
    process: str
    phrases: tuple[str, ...]
    parameters: tuple[OperationDefault, ...]
    template: tuple[TemplateStep, ...]
    span: Span
    returns: ReturnSpec | None = None
    occupies: tuple[str, ...] = ()
    touchable: bool = False
    occupies_span: Span | None = None
    min_confidence: float | None = None
    duration_span: Span | None = None

    def arg(self, name: str) -> ArgSpec | None:
        """The argument of this name, or None."""
        return next((item for item in self.args if item.name == name), None)


@record
class SkillBank(Record):
    """The capability contract: the robot's parts and everything it has learnt to do."""

    urdf: str
    srdf: str
    arms: tuple[str, ...]
    owners: tuple[str, ...]
    skills: tuple[SkillSpec, ...]

    def skill(self, name: str) -> SkillSpec | None:
        """The skill of this name, or None."""
        return next((item for item in self.skills if item.name == name), None)
