"""What has a value: literals, names, operators, calls, ranges; and the updates of a skill bank."""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.quantity import Quantity
from xei_lang.record import Shown, record


@record
class Name(Shown):
    """A name where it is declared or used."""

    id: str
    span: Span


@record
class Number(Shown):
    """A plain number: an int if it was written without a decimal point, else an exact fraction."""

    value: int | Fraction
    span: Span


@record
class QuantityLit(Shown):
    """A number with a unit, never negative: `-20 degC` is a Unary over it."""

    value: Quantity
    span: Span


@record
class StringLit(Shown):
    """A text; `value` has its escapes resolved, the span covers the quotes."""

    value: str
    span: Span


@record
class Bool(Shown):
    """`true` or `false`."""

    value: bool
    span: Span


@record
class Unary(Shown):
    """`-operand` or `not operand`."""

    op: Literal["-", "not"]
    operand: Expression
    span: Span


@record
class Binary(Shown):
    """Arithmetic on two values."""

    op: Literal["+", "-", "*", "/"]
    left: Expression
    right: Expression
    span: Span


@record
class Compare(Shown):
    """One comparison; the grammar has no chains of them."""

    op: Literal["==", "!=", "<=", ">=", "<", ">"]
    left: Expression
    right: Expression
    span: Span


@record
class BoolOp(Shown):
    """`left and right`, `left or right`."""

    op: Literal["and", "or"]
    left: Expression
    right: Expression
    span: Span


@record
class Attr(Shown):
    """`value.name`, as in `rack.row`."""

    value: Expression
    name: Name
    span: Span


@record
class Range(Shown):
    """`lower .. upper`, both ends included, with an optional step."""

    lower: Expression
    upper: Expression
    step: Expression | None
    span: Span


@record
class Index(Shown):
    """`value[index]`; a Range selects several."""

    value: Expression
    index: Expression | Range
    span: Span


@record
class Arg(Shown):
    """One argument of a call; `name` is None where only a value was given."""

    name: Name | None
    value: Expression
    span: Span


@record
class CallExpr(Shown):
    """A call that has a value, such as `rack.row("A")` or `volume(tube)`."""

    function: Expression
    args: tuple[Arg, ...]
    span: Span


@record
class ListLit(Shown):
    """`[a, b]`."""

    items: tuple[Expression, ...]
    span: Span


@record
class TupleLit(Shown):
    """`(a, b)`, of two items or more."""

    items: tuple[Expression, ...]
    span: Span


@record
class Comprehension(Shown):
    """`[element for names in iterable if condition]`."""

    element: Expression
    names: tuple[Name, ...]
    iterable: Expression | Range
    condition: Expression | None
    span: Span


Expression = (
    Name
    | Number
    | QuantityLit
    | StringLit
    | Bool
    | Unary
    | Binary
    | Compare
    | BoolOp
    | Attr
    | Index
    | CallExpr
    | ListLit
    | TupleLit
    | Comprehension
)

StepRef = Name | Attr | Index
"""A step by its path: `warm`, `warm[2]`, `call.warm`."""


@record
class Update(Shown):
    """What a skill does to a state variable: `cap(object) := open`, `volume(source) -= volume`."""

    target: Expression
    op: Literal[":=", "+=", "-="]
    value: Expression
    span: Span


Predicate = Expression | Update
