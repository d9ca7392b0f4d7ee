"""Values of JSON as expressions of the language, so that one checker serves both."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

from xei_lang.diagnostics import Span
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_values import PLACE, ValueReader
from xei_lang.quantity import TYPE_DIMENSIONS, QuantityError, parse_quantity
from xei_lang.syntax.ast import (
    Arg,
    Attr,
    Bool,
    CallExpr,
    Expression,
    ListLit,
    Name,
    Number,
    QuantityLit,
    StringLit,
)

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_LONGEST = 200
"""Of a text that should name something, no more is looked at, nor quoted in a message."""


@dataclass(frozen=True, slots=True, eq=False)
class AsExpression:
    """Makes expressions; of what is measured, either its `lower` or its `upper` end stands for it."""

    end: str

    def of(self, node: JsonNode, type_: str | None) -> Expression | None:
        """The expression that a value is written as where a type is expected.

        None for what cannot be a value at all, of which the reader of the form has told.
        """
        value, span = node.value, node.span
        if node.kind == "array":
            inner = type_[5:-1] if type_ and type_.startswith("List[") else None
            items = [self.of(item, inner) for item in node.elements]
            whole = tuple(item for item in items if item is not None)
            return ListLit(whole, span) if len(whole) == len(items) else None
        if node.kind == "object":
            return self._compound(node, type_)
        if isinstance(value, bool):
            return Bool(value, span)
        if isinstance(value, (int, float)):
            return Number(value if isinstance(value, int) else Fraction(repr(value)), span)
        return _text(str(value), type_, span)

    def _compound(self, node: JsonNode, type_: str | None) -> Expression | None:
        if "measured" in node.items:
            return self.of(node.items[self.end], type_)
        if "pose" in node.items:
            return self._pose(node)
        quantity = ValueReader().quantity(node)
        return QuantityLit(quantity, node.span) if quantity is not None else None

    def _pose(self, node: JsonNode) -> Expression | None:
        """The call of `pose` that it stands for."""
        pose, frame = node.items["pose"], node.items["frame"]
        parts = [(pose.keys[name], name, self.of(item, None)) for name, item in pose.items.items()]
        args = [Arg(Name(name, at), value, at) for at, name, value in parts if value is not None]
        if len(args) < len(parts):
            return None
        named = StringLit(str(frame.value)[:_LONGEST], frame.span)
        args.append(Arg(Name("frame", node.keys["frame"]), named, frame.span))
        return CallExpr(Name("pose", node.keys["pose"]), tuple(args), node.span)


def _text(text: str, type_: str | None, span: Span) -> Expression | None:
    if type_ in TYPE_DIMENSIONS:
        try:
            return QuantityLit(parse_quantity(text), span)
        except QuantityError:
            return None
    if type_ == "String":
        return StringLit(text, span)
    text = text[:_LONGEST]
    place = PLACE.fullmatch(text)
    if place is not None and _NAME.fullmatch(place["object"]):
        return _place(place, span)
    return Name(text, span) if _NAME.fullmatch(text) else StringLit(text, span)


def _place(found: re.Match[str], span: Span) -> Expression:
    key = Arg(None, StringLit(found["key"], span), span)
    return CallExpr(Attr(Name(found["object"], span), Name(found["kind"], span), span), (key,), span)
