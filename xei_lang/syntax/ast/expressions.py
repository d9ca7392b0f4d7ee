"""What has a value: literals, names, operators, calls, ranges; and the updates of a skill bank."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.quantity import Quantity
from xei_lang.record import Shown


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Name(Shown):
    """A name where it is declared or used."""

    id: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Number(Shown):
    """A plain number: an int if it was written without a decimal point, else an exact fraction."""

    value: int | Fraction
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class QuantityLit(Shown):
    """A number with a unit, never negative: `-20 degC` is a Unary over it."""

    value: Quantity
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StringLit(Shown):
    """A text; `value` has its escapes resolved, the span covers the quotes."""

    value: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Bool(Shown):
    """`true` or `false`."""

    value: bool
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Unary(Shown):
    """`-operand` or `not operand`."""

    op: Literal["-", "not"]
    operand: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Binary(Shown):
    """Arithmetic on two values."""

    op: Literal["+", "-", "*", "/"]
    left: Expression
    right: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Compare(Shown):
    """One comparison; the grammar has no chains of them."""

    op: Literal["==", "!=", "<=", ">=", "<", ">"]
    left: Expression
    right: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BoolOp(Shown):
    """`left and right`, `left or right`."""

    op: Literal["and", "or"]
    left: Expression
    right: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Attr(Shown):
    """`value.name`, as in `rack.row`."""

    value: Expression
    name: Name
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Range(Shown):
    """`lower .. upper`, both ends included, with an optional step."""

    lower: Expression
    upper: Expression
    step: Expression | None
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Index(Shown):
    """`value[index]`; a Range selects several."""

    value: Expression
    index: Expression | Range
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Arg(Shown):
    """One argument of a call; `name` is None where only a value was given."""

    name: Name | None
    value: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CallExpr(Shown):
    """A call that has a value, such as `rack.row("A")` or `volume(tube)`."""

    function: Expression
    args: tuple[Arg, ...]
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ListLit(Shown):
    """`[a, b]`."""

    items: tuple[Expression, ...]
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TupleLit(Shown):
    """`(a, b)`, of two items or more."""

    items: tuple[Expression, ...]
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
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


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Update(Shown):
    """What a skill does to a state variable: `cap(object) := open`, `volume(source) -= volume`."""

    target: Expression
    op: Literal[":=", "+=", "-="]
    value: Expression
    span: Span


Predicate = Expression | Update
