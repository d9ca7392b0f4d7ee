"""What happens: steps with label and clauses, the actions they can be, and statements that are no steps."""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast.expressions import Arg, Expression, Name, Range, StepRef, StringLit
from xei_lang.syntax.ast.types import TypeExpr


@record
class Block(Shown):
    """`{ ... }`; the span covers the braces."""

    statements: tuple[Statement, ...]
    span: Span


@record
class Within(Shown):
    """`within duration [of step]`: bounds the step itself, or the time since the end of another."""

    duration: Expression
    of: StepRef | None
    span: Span


@record
class After(Shown):
    """`after step [by range]`."""

    step: StepRef
    by: Range | None
    span: Span


Clause = Within | After


@record
class Call(Shown):
    """A skill or procedure with its arguments."""

    callee: Name
    args: tuple[Arg, ...]
    span: Span


@record
class Wait(Shown):
    """`wait duration`."""

    duration: Expression
    span: Span


@record
class Start(Shown):
    """`start label: call`; the label is that of the Step around it."""

    call: Call
    span: Span


@record
class Await(Shown):
    """`await step`."""

    step: StepRef
    span: Span


@record
class Stop(Shown):
    """`stop step` ends what was started."""

    step: StepRef
    span: Span


@record
class StopRun(Shown):
    """`stop "message"` ends the run."""

    message: StringLit
    span: Span


@record
class Leave(Shown):
    """`leave step` lets what was started outlive the protocol."""

    step: StepRef
    span: Span


@record
class Pause(Shown):
    """`pause step { ... }`."""

    step: StepRef
    body: Block
    span: Span


@record
class Keep(Shown):
    """`keep condition { ... }`: holds at every point inside."""

    condition: Expression
    body: Block
    span: Span


@record
class Measure(Shown):
    """`measure name: type = call [in limits]`; the name is also the step's name."""

    name: Name
    type: TypeExpr
    call: Call
    limits: Range | None
    span: Span


@record
class Confirm(Shown):
    """`confirm "text"`: a step of a person."""

    text: StringLit
    span: Span


@record
class Do(Shown):
    """`do { ... }`: a block that can carry a label and clauses."""

    body: Block
    span: Span


@record
class Parallel(Shown):
    """`parallel { {...} {...} }`, of one branch or more."""

    branches: tuple[Block, ...]
    span: Span


@record
class For(Shown):
    """`for names in iterable [unordered] { ... }`."""

    names: tuple[Name, ...]
    iterable: Expression | Range
    unordered: bool
    body: Block
    span: Span


@record
class Repeat(Shown):
    """`repeat count times [until condition] { ... } [else { ... }]`."""

    count: Expression
    until: Expression | None
    body: Block
    otherwise: Block | None
    span: Span


@record
class If(Shown):
    """`if condition { ... } [else ...]`; an `else if` is an If in `otherwise`."""

    condition: Expression
    body: Block
    otherwise: If | Block | None
    span: Span


Action = (
    Call
    | Wait
    | Start
    | Await
    | Stop
    | StopRun
    | Leave
    | Pause
    | Keep
    | Measure
    | Confirm
    | Do
    | Parallel
    | For
    | Repeat
    | If
)


@record
class Step(Shown):
    """An action with its label and its clauses; `label.span` covers the name without the colon."""

    label: Name | None
    action: Action
    clauses: tuple[Clause, ...]
    span: Span


@record
class Let(Shown):
    """`let name = value`; several names take a list apart."""

    names: tuple[Name, ...]
    value: Expression
    span: Span


@record
class Require(Shown):
    """`require condition`."""

    condition: Expression
    span: Span


@record
class Unmapped(Shown):
    """`unmapped "text" [because "reason"]`: a request that the protocol does not fulfil."""

    text: StringLit
    reason: StringLit | None
    span: Span


@record
class Note(Shown):
    """`note "text"`: a safety note that the plan carries."""

    text: StringLit
    span: Span


Statement = Step | Let | Require | Unmapped | Note
