"""What stands behind a colon: a value type (`List[Volume]`) or a role expression (`movable & not fragile`).

The grammar cannot tell the two apart; the checker does, by the names.
"""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast.expressions import Name


@record
class Role(Shown):
    """The name of a role or of a value type."""

    id: str
    span: Span


@record
class RoleAnd(Shown):
    """`left & right`."""

    left: TypeExpr
    right: TypeExpr
    span: Span


@record
class RoleOr(Shown):
    """`left | right`."""

    left: TypeExpr
    right: TypeExpr
    span: Span


@record
class RoleNot(Shown):
    """`not operand`."""

    operand: TypeExpr
    span: Span


@record
class Generic(Shown):
    """`List[Volume]`."""

    name: Name
    argument: TypeExpr
    span: Span


TypeExpr = Role | RoleAnd | RoleOr | RoleNot | Generic
