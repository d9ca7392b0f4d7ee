"""What follows a dot and what is called: properties of objects, columns of tables, places, functions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.functions import STATE_VARIABLES, Functions
from xei_lang.check.lists import Evaluate
from xei_lang.check.places import METHODS, PROPERTIES, Places
from xei_lang.check.poses import POSE, Poses
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, listed, meant
from xei_lang.check.scope import Scope
from xei_lang.check.value_habits import NO_MEND, slot_of, state_of, unquoted_key
from xei_lang.check.value_words import kind, show
from xei_lang.check.values import POISON, ListValue, ObjectValue, RecordValue, TableValue, Val
from xei_lang.diagnostics import did_you_mean
from xei_lang.syntax.ast import Attr, CallExpr, Name

if TYPE_CHECKING:
    from xei_lang.check.conditions import Asked
    from xei_lang.check.nominal import Nominal


class Members:
    """Evaluates attributes and calls."""

    def __init__(
        self,
        registry: Registry,
        places: Places,
        functions: Functions,
        reporter: Reporter,
        evaluate: Evaluate,
    ) -> None:
        self._registry = registry
        self._places = places
        self._functions = functions
        self._reporter = reporter
        self._evaluate = evaluate
        self._poses = Poses(registry, reporter, evaluate)
        declared = (state.name for thing in registry.objects.values() for state in thing.states)
        self._variables = frozenset((*STATE_VARIABLES, *declared))

    def attribute(self, node: Attr, scope: Scope) -> Val:
        """`rack.slots`, `table.column`."""
        owner = self._evaluate(node.value, scope)
        if owner is POISON:
            return POISON
        name = node.name.id
        if isinstance(owner, RecordValue | TableValue):
            return self._column(owner, node)
        if isinstance(owner, ListValue) and (not owner.items or isinstance(owner.items[0], RecordValue)):
            return self._column_of(owner, node)
        if isinstance(owner, ObjectValue) and name in PROPERTIES:
            return self._places.property(owner, name, node.span)
        known = (*METHODS, *PROPERTIES)
        fix = guess(node.name.span, did_you_mean(name, known))
        if isinstance(owner, ObjectValue) and name in METHODS:
            shown, help = (
                f"`{name}` of `{show(owner)}` needs an argument",
                (f"write `{show(owner)}.{name}(...)`",),
            )
        elif isinstance(owner, ObjectValue):
            shown = f"`{show(owner)}` has no `{name}`"
            written = node.value.id if isinstance(node.value, Name) else show(owner)
            help, mend = state_of(owner, name, written, node.span)
            if mend is None:
                help, mend = slot_of(owner, name, written, node.span)
            fix = mend or fix
            help = (
                help
                or meant(did_you_mean(name, known))
                or (f"an object has {', '.join(f'`{word}`' for word in known)}",)
            )
        else:
            counted = isinstance(owner, ListValue) and name in ("length", "size", "count", "len")
            shown, fix = f"{kind(owner)} has no `{name}`", None
            help = ("`len(list)` counts its members",) if counted else ()
        self._reporter.report("XEI0319", shown, node.name.span, "no such attribute", help=help, fix=fix)
        return POISON

    def call(  # noqa: PLR0911 one return for each kind of function
        self, node: CallExpr, scope: Scope, states: Asked | Nominal | None
    ) -> Val:
        """`rack.slot("A1")`, `len(tubes)`; the state of a thing, as `states` answers it."""
        function = node.function
        if isinstance(function, Attr) and function.name.id in METHODS:
            return self._method(node, function, scope)
        if isinstance(function, Attr):
            self.attribute(function, scope)
            return POISON
        if isinstance(function, Name):
            if function.id == POSE:
                return self._poses.value(function, node, scope)
            if function.id in self._functions.names:
                args = tuple(self._evaluate(arg.value, scope) for arg in node.args)
                return self._functions.call(function, node, args)
            if states is not None and function.id in self._variables:
                subject = self._evaluate(node.args[0].value, scope) if node.args else POISON
                return states.value(function, node, subject)
            return self._functions.unknown(function, node, tuple(self._registry.skills))
        self._reporter.report("XEI0319", "this cannot be called", function.span, "not a function")
        return POISON

    def _column_of(self, rows: ListValue, node: Attr) -> Val:
        """A column of some rows, such as a part of a table."""
        cells = [self._column(row, node) for row in rows.items if isinstance(row, RecordValue)]
        return POISON if POISON in cells else ListValue(tuple(cells))

    def _column(self, owner: RecordValue | TableValue, node: Attr) -> Val:
        columns = owner.fields if isinstance(owner, RecordValue) else owner.columns
        name = node.name.id
        if name in columns:
            return columns[name]
        self._reporter.report(
            "XEI0319",
            f"the table has no column `{name}`",
            node.name.span,
            f"its columns are {listed(tuple(columns), 12)}",
            help=meant(did_you_mean(name, columns)),
            fix=guess(node.name.span, did_you_mean(name, columns)),
        )
        return POISON

    def _method(self, node: CallExpr, function: Attr, scope: Scope) -> Val:
        owner = self._evaluate(function.value, scope)
        if isinstance(owner, ObjectValue) and self._is_unquoted(owner, function, node, scope):
            return POISON
        args = [self._evaluate(arg.value, scope) for arg in node.args]
        if owner is POISON:
            return POISON
        if isinstance(owner, ObjectValue) and len(args) == 1:
            return self._places.method(owner, function.name.id, args[0], node)
        if isinstance(owner, ObjectValue):
            message, label = (
                f"`{function.name.id}` takes one argument, not {len(args)}",
                "expected one argument",
            )
        else:
            message, label = f"{kind(owner)} has no `{function.name.id}`", "only an object has places"
        self._reporter.report("XEI0319", message, node.span, label)
        return POISON

    def _is_unquoted(self, owner: ObjectValue, function: Attr, node: CallExpr, scope: Scope) -> bool:
        """Whether it is `rack.slot(A1)`, a name where a text belongs, which is reported."""
        key = node.args[0].value if len(node.args) == 1 else None
        if not isinstance(key, Name) or scope.find(key.id) is not None:
            return False
        known = self._places.keys(owner, function.name.id)
        help, fix = unquoted_key(key.id, function.name.id, known, key.span)
        if (help, fix) == NO_MEND:
            return False
        self._reporter.report(
            "XEI0202", f"`{key.id}` is not known here", key.span, "expected a text", help=help, fix=fix
        )
        return True
