"""What stands behind a colon: a value type (`List[Volume]`) or a role expression (`movable & not fragile`).

The grammar cannot tell the two apart; the checker does, by the names.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.record import Shown
from xei_lang.syntax.ast.expressions import Name


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Role(Shown):
    """The name of a role or of a value type."""

    id: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RoleAnd(Shown):
    """`left & right`."""

    left: TypeExpr
    right: TypeExpr
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RoleOr(Shown):
    """`left | right`."""

    left: TypeExpr
    right: TypeExpr
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RoleNot(Shown):
    """`not operand`."""

    operand: TypeExpr
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Generic(Shown):
    """`List[Volume]`."""

    name: Name
    argument: TypeExpr
    span: Span


TypeExpr = Role | RoleAnd | RoleOr | RoleNot | Generic
