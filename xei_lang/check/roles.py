"""Role expressions: what an object must be (`movable & liquid_container`, `surface | place_target`, `not
fragile`).
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

from xei_lang.check.registry import Registry, role_names
from xei_lang.check.values import ObjectValue
from xei_lang.profiles.model import LabObject
from xei_lang.profiles.roles import fits, holds
from xei_lang.syntax.ast import Generic, Role, RoleAnd, RoleNot, RoleOr, TypeExpr

_MOST_FREE_ROLES = 12


def unmet(expression: TypeExpr, roles: Iterable[str]) -> str:
    """The smallest parts of the expression that these roles fail, in words: "lacks `movable`"."""
    have = frozenset(roles)
    return " and ".join(_unmet_parts(expression, have))


def _unmet_parts(expression: TypeExpr, have: frozenset[str]) -> list[str]:
    if holds(expression, have.__contains__):
        return []
    match expression:
        case RoleAnd():
            return _unmet_parts(expression.left, have) + _unmet_parts(expression.right, have)
        case Role(id=name):
            return [f"lacks the role `{name}`"]
        case RoleNot(operand=Role(id=name)):
            return [f"has the role `{name}`, which is ruled out"]
        case RoleNot():
            return [f"is ruled out by `{text(expression)}`"]
        case _:
            return [f"is not `{text(expression)}`"]


def text(expression: TypeExpr) -> str:
    """The expression as it is written, with the parentheses that it needs."""
    match expression:
        case Role():
            return expression.id
        case RoleNot():
            return f"not {_grouped(expression.operand, RoleAnd | RoleOr)}"
        case RoleAnd():
            return f"{_grouped(expression.left, RoleOr)} & {_grouped(expression.right, RoleOr)}"
        case RoleOr():
            return f"{text(expression.left)} | {text(expression.right)}"
        case Generic():
            return f"{expression.name.id}[{text(expression.argument)}]"


def _grouped(expression: TypeExpr, looser: object) -> str:
    return f"({text(expression)})" if isinstance(expression, looser) else text(expression)  # type: ignore[arg-type]


def candidates(expression: TypeExpr, registry: Registry) -> tuple[str, ...]:
    """The registered objects that meet the expression, in order of their names."""
    return tuple(name for name, thing in registry.objects.items() if fits(expression, thing.roles))


def first_misfit(value: ObjectValue, needed: TypeExpr, registry: Registry) -> LabObject | None:
    """The object that fails: the registered one, or for an open one a candidate that would be without the
    roles.

    None says that all is well: either the declared roles imply the needed ones, or every object that may
    still be bound has them.
    """
    if value.registered is not None:
        return None if fits(needed, value.registered.roles) else value.registered
    if value.declared is None or implies(value.declared, needed):
        return None
    return next(
        (
            thing
            for thing in registry.objects.values()
            if fits(value.declared, thing.roles) and not fits(needed, thing.roles)
        ),
        None,
    )


def implies(left: TypeExpr, right: TypeExpr) -> bool:
    """Whether whatever has the roles `left` must have the roles `right`; False where there are too many to
    tell.
    """
    names = sorted({*role_names(left), *role_names(right)})
    if len(names) > _MOST_FREE_ROLES:
        return False
    for chosen in product((False, True), repeat=len(names)):
        has = dict(zip(names, chosen, strict=True)).__getitem__
        if holds(left, has) and not holds(right, has):
            return False
    return True
