"""Declared objects: which registered ones they are, by the protocol or by `--bind`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.declared import declared_expectation, known_roles
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.option_values import OptionValues
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed, meant
from xei_lang.check.roles import candidates, fits, text, unmet
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import Types
from xei_lang.check.values import POISON, ObjectValue, Poison, Val
from xei_lang.diagnostics import Label, Span, did_you_mean
from xei_lang.diagnostics.options import option_value
from xei_lang.syntax.ast import Generic, Name, ObjectDecl, TypeExpr

if TYPE_CHECKING:
    from xei_lang.check.binding import CheckOptions


class Objects:
    """Gives declared objects their values."""

    def __init__(
        self,
        registry: Registry,
        evaluator: Evaluator,
        types: Types,
        reporter: Reporter,
        options: CheckOptions,
        values: OptionValues,
    ) -> None:
        self._registry = registry
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter
        self._options = options
        self._values = values

    def value(self, node: ObjectDecl, scope: Scope, state: State) -> Val:
        """The registered object, or one that is still open; a list of them for `List[...]`."""
        if isinstance(node.type, Generic):
            return self._list(node, scope, state)
        if not known_roles(node.type, self._registry, self._reporter):
            return POISON
        given = self._options.bindings.get(node.name.id)
        if given is not None:
            at = option_value("bind", node.name.id, given)
            return self._bound(node, given, at, f"`--bind {node.name.id}={given}`")
        if node.binding is not None:
            if isinstance(node.binding, Name) and scope.find(node.binding.id) is None:
                return self._bound(node, node.binding.id, node.binding.span, f"`{node.binding.id}`")
            return self._from_expression(node, self._evaluator.value(node.binding, scope), state)
        return self._unbound(node)

    def _unbound(self, node: ObjectDecl) -> Val:
        if self._options.open_bindings:
            return self._open(node)
        self._reporter.report(
            "XEI0206",
            f"object `{node.name.id}` is not bound to a registered object",
            node.name.span,
            f"needs an object that is `{text(node.type)}`",
            help=self._binding_help(node),
        )
        return POISON

    def _list(self, node: ObjectDecl, scope: Scope, state: State) -> Val:
        """`object tubes: List[movable]`: in `xei check` a list that nothing is bound to may be any."""
        name = node.name.id
        roles: TypeExpr = node.type
        while isinstance(roles, Generic):
            roles = roles.argument
        expected = declared_expectation(node.type, f"object `{name}`", self._registry, self._reporter)
        if expected is None:
            return POISON
        if expected.roles is None and expected.type != "object":
            known_roles(roles, self._registry, self._reporter)
            return POISON
        given = self._options.bindings.get(name)
        if given is not None:
            return self._values.read("bind", name, given, expected, state)
        if node.binding is not None:
            value = self._evaluator.value(node.binding, scope)
            return self._types.coerce(value, expected, node.binding, state)
        if not self._options.open_bindings:
            fitting = candidates(roles, self._registry)
            example = ", ".join(fitting[:2])
            self._reporter.report(
                "XEI0206",
                f"object `{name}` is not bound to registered objects",
                node.name.span,
                f"needs a list of objects that are `{text(roles)}`",
                help=(f"bind it with `--bind {name}=[{example}]`",) if fitting else (),
            )
        return POISON

    def _from_expression(self, node: ObjectDecl, value: Val, state: State) -> Val:
        assert node.binding is not None
        if isinstance(value, Poison):
            return POISON
        if isinstance(value, ObjectValue) and value.registered is not None:
            return self._bound(node, value.registered.name, node.binding.span, f"`{value.registered.name}`")
        expected = Expectation(f"object `{node.name.id}`", "object", None, node.type)
        return self._types.coerce(value, expected, node.binding, state)

    def _bound(self, node: ObjectDecl, name: str, span: Span, words: str) -> Val:
        thing = self._registry.objects.get(name)
        if thing is None:
            self._reporter.report(
                "XEI0202",
                f"{words} names no registered object",
                span,
                "no such object in the profile",
                help=meant(did_you_mean(name, self._registry.objects)) or self._binding_help(node),
            )
            return POISON
        if fits(node.type, thing.roles):
            return ObjectValue(name, thing, node.type)
        fitting = candidates(node.type, self._registry)
        self._reporter.report(
            "XEI0309",
            f"{words} {unmet(node.type, thing.roles)}, "
            f"but object `{node.name.id}` is to be `{text(node.type)}`",
            span,
            f"`{name}` has the roles {', '.join(thing.roles) or 'none'}",
            labels=(Label(node.type.span, "declared so here"),),
            notes=(self._reporter.rule(thing.span),),
            help=(f"registered objects that would do: {listed(fitting)}",)
            if fitting
            else ("no registered object would do",),
        )
        return POISON

    def _open(self, node: ObjectDecl) -> Val:
        if candidates(node.type, self._registry):
            return ObjectValue(node.name.id, None, node.type)
        self._reporter.report(
            "XEI0206",
            f"no registered object can be bound to `{node.name.id}`",
            node.type.span,
            f"none is `{text(node.type)}`",
        )
        return POISON

    def _binding_help(self, node: ObjectDecl) -> tuple[str, ...]:
        fitting = candidates(node.type, self._registry)
        if not fitting:
            return ("no registered object would do",)
        name = node.name.id
        return (
            f"bind it in the protocol, `object {name}: {text(node.type)} = {fitting[0]}`, or with "
            f"`--bind {name}={fitting[0]}`; objects that would do: {listed(fitting)}",
        )
