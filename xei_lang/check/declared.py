"""What stands behind the colon of a parameter: a value type or a role expression, told apart by its names."""

from __future__ import annotations

from xei_lang.check.expectation import Expectation
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, meant
from xei_lang.check.types import VALUE_TYPES
from xei_lang.diagnostics import did_you_mean
from xei_lang.syntax.ast import Generic, Role, TypeExpr, walk


def declared_expectation(
    node: TypeExpr, what: str, registry: Registry, reporter: Reporter
) -> Expectation | None:
    """What a declared name takes; None where the type names nothing, which is reported."""
    if isinstance(node, Generic):
        if node.name.id != "List":
            _unknown(node.name.id, node, registry, reporter, ("List",))
            return None
        inner = declared_expectation(node.argument, what, registry, reporter)
        if inner is None:
            return None
        return Expectation(what, inner.type, None, inner.roles, (), inner.lists + 1)
    if isinstance(node, Role) and node.id in VALUE_TYPES:
        return Expectation(what, node.id)
    if isinstance(node, Role) and node.id == "object":
        return Expectation(what, "object")
    return (
        Expectation(what, "object", None, node)
        if known_roles(node, registry, reporter, VALUE_TYPES)
        else None
    )


def known_roles(node: TypeExpr, registry: Registry, reporter: Reporter, also: tuple[str, ...] = ()) -> bool:
    """Whether objects have every role of an expression; `also` are names to suggest besides roles."""
    fine = True
    for part in walk(node):
        if isinstance(part, Role) and part.id not in registry.roles:
            _unknown(part.id, part, registry, reporter, also)
            fine = False
        elif isinstance(part, Generic):
            _unknown(part.name.id, part, registry, reporter, also)
            fine = False
    return fine


def _unknown(
    name: str, node: TypeExpr, registry: Registry, reporter: Reporter, also: tuple[str, ...]
) -> None:
    if name in VALUE_TYPES:
        message, label = f"`{name}` is a type of values, not a role", "expected a role that objects have"
    else:
        message = f"there is no {'type or role' if also else 'role'} `{name}`"
        label = "no object has this role, and no skill asks for it"
    known = tuple(sorted(registry.roles))
    near = did_you_mean(name, (*also, *known))
    reporter.report(
        "XEI0215",
        message,
        node.span,
        label,
        help=meant(near) or (f"roles are {', '.join(known)}",),
        fix=guess(node.span, near),
    )
