"""Whether roles meet a role expression (`movable & not fragile`)."""

from __future__ import annotations

from collections.abc import Callable

from xei_lang.syntax.ast import Generic, Role, RoleAnd, RoleNot, RoleOr, TypeExpr


def holds(expression: TypeExpr, has: Callable[[str], bool]) -> bool:
    """Whether the expression is true of something of which `has` tells the roles."""
    match expression:
        case Role():
            return has(expression.id)
        case RoleAnd():
            return holds(expression.left, has) and holds(expression.right, has)
        case RoleOr():
            return holds(expression.left, has) or holds(expression.right, has)
        case RoleNot():
            return not holds(expression.operand, has)
        case Generic():
            return False


def fits(expression: TypeExpr, roles: tuple[str, ...]) -> bool:
    """Whether something with just these roles meets the expression."""
    return holds(expression, roles.__contains__)
