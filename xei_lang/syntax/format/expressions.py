"""Printing values and types: brackets by precedence only, numbers and texts as they were written."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

from xei_lang.diagnostics import Span
from xei_lang.syntax import ast
from xei_lang.syntax.format.comments import Cursor
from xei_lang.syntax.format.layout import COMMA, LINE, SOFT, SPACE, Doc, cat, group, nest, spaced

OR, AND, NOT, COMPARISON, SUM, TERM, UNARY, POSTFIX, ATOM = range(1, 10)
"""How tightly what stands there binds, from the rules of the grammar."""
_UNION, _BOTH, _SINGLE = 1, 2, 3
_WORDS = (ast.Name, ast.Number, ast.QuantityLit, ast.StringLit, ast.Bool, ast.Role)
_UNIT = re.compile(r"([0-9.]+)[ \t]*([A-Za-z%].*)")


class _Spanned(Protocol):
    @property
    def span(self) -> Span: ...


NodeT = TypeVar("NodeT", bound=_Spanned)


class ExpressionPrinter:
    """Takes the words of an expression from the cursor, in their order, into a document."""

    def __init__(self, cursor: Cursor) -> None:
        self.cursor = cursor

    # ---- values ----

    def value(self, node: ast.Expression | ast.Range, level: int = OR) -> Doc:
        """A value that must bind at least as tightly as `level`."""
        if isinstance(node, ast.Range):
            return self.range(node)
        return self._bracketed(node, _level(node) < level, self._value, own=isinstance(node, ast.TupleLit))

    def _bracketed(
        self, node: NodeT, needed: bool, show: Callable[[NodeT], Doc], *, own: bool = False
    ) -> Doc:
        """A node with one pair of its brackets if it needs that; a pair with a comment at its end stays."""
        kept = self.cursor.brackets_around(node.span, is_word=isinstance(node, _WORDS), own=own)
        if needed and not any(kept):
            kept[0] = True
        return self._inside(kept, lambda: show(node))

    def _inside(self, kept: list[bool], show: Callable[[], Doc]) -> Doc:
        openings: list[Doc | None] = []
        for is_kept in kept:
            if is_kept:
                openings.append(self.cursor.take("("))
            else:
                openings.append(None)
                self.cursor.skip("(")
        inner = show()
        for opening in reversed(openings):
            if opening is None:
                self.cursor.skip(")")
            else:
                inner = self._enclosed(opening, [inner], ")")
        return inner

    def _value(self, node: ast.Expression) -> Doc:  # noqa: PLR0911 one return for each kind of value
        take = self.cursor.take
        match node:
            case ast.Name() | ast.Number() | ast.StringLit() | ast.Bool():
                return take()
            case ast.QuantityLit():
                return self._quantity()
            case ast.Unary() if node.op == "-":
                return cat(take("-"), self.value(node.operand, UNARY))
            case ast.Unary():
                return spaced(take("not"), self.value(node.operand, NOT))
            case ast.Binary() | ast.BoolOp() | ast.Compare():
                return self._chain(node)
            case ast.Attr():
                return cat(self.value(node.value, POSTFIX), take("."), take())
            case ast.Index():
                return cat(self.value(node.value, POSTFIX), self._index(node.index))
            case ast.CallExpr():
                return cat(self.value(node.function, POSTFIX), self.arguments(node.args))
            case ast.ListLit():
                return self.several("[", node.items, self.value, "]")
            case ast.TupleLit():
                return self.several("(", node.items, self.value, ")")
            case ast.Comprehension():
                return self._comprehension(node)

    def _quantity(self) -> Doc:
        """A number, one space, its unit; the number as it was written."""
        return self.cursor.take(written=_UNIT.sub(r"\1 \2", self.cursor.next))

    def _chain(self, node: ast.Binary | ast.BoolOp | ast.Compare) -> Doc:
        """Operators that bind alike, on one line or each at the start of a line."""
        head, *tail = self._links(node)
        return group(head, nest(*tail))

    def _links(self, node: ast.Binary | ast.BoolOp | ast.Compare) -> list[Doc]:
        level, left = _level(node), node.left
        if isinstance(node, ast.Compare):
            parts = [self.value(left, SUM)]
        elif isinstance(left, ast.Binary | ast.BoolOp) and _level(left) == level:
            parts = self._inline(left, self._links, self._chain)
        else:
            parts = [self.value(left, level)]
        right = SUM if isinstance(node, ast.Compare) else level + 1
        return [*parts, LINE, self.cursor.take(node.op), SPACE, self.value(node.right, right)]

    def _inline(
        self, node: NodeT, links: Callable[[NodeT], list[Doc]], show: Callable[[NodeT], Doc]
    ) -> list[Doc]:
        """The links of a chain that go before others of their kind, without brackets, which mean nothing."""
        kept = self.cursor.brackets_around(node.span, is_word=False, own=False)
        if any(kept):
            return [self._inside(kept, lambda: show(node))]
        for _ in kept:
            self.cursor.skip("(")
        parts = links(node)
        for _ in kept:
            self.cursor.skip(")")
        return parts

    def _index(self, node: ast.Expression | ast.Range) -> Doc:
        return self._enclosed(self.cursor.take("["), [self.value(node)], "]")

    def _comprehension(self, node: ast.Comprehension) -> Doc:
        take = self.cursor.take
        opening = take("[")
        parts = [self.value(node.element), LINE, take("for"), SPACE, self.binding(node)]
        if node.condition is not None:
            parts += [LINE, take("if"), SPACE, self.value(node.condition)]
        return self._enclosed(opening, parts, "]")

    def binding(self, node: ast.Comprehension | ast.For) -> Doc:
        """`a, b in values`."""
        names, take = self.names(node.names), self.cursor.take
        return cat(names, SPACE, take("in"), SPACE, self.value(node.iterable))

    def names(self, names: tuple[ast.Name, ...]) -> Doc:
        """`a, b`."""
        parts = [self.cursor.take()]
        for _ in names[1:]:
            parts += [self.cursor.comma(), SPACE, self.cursor.take()]
        return cat(*parts)

    def range(self, node: ast.Range) -> Doc:
        """`low .. high step by`."""
        take = self.cursor.take
        parts = [self.value(node.lower, SUM), LINE, take(".."), SPACE, self.value(node.upper, SUM)]
        if node.step is not None:
            parts += [LINE, take("step"), SPACE, self.value(node.step, SUM)]
        return group(parts[0], nest(*parts[1:]))

    # ---- lists of anything ----

    def arguments(self, args: tuple[ast.Arg, ...]) -> Doc:
        """What stands between the brackets of a call, with them."""
        return self.several("(", args, self._argument, ")")

    def _argument(self, node: ast.Arg) -> Doc:
        if node.name is None:
            return self.value(node.value)
        return cat(self.cursor.take(), self.cursor.take("="), self.value(node.value))

    def several(
        self, opening: str, nodes: Sequence[NodeT], show: Callable[[NodeT], Doc], closing: str
    ) -> Doc:
        """Things between brackets: on one line, or one a line with a comma behind each."""
        begin = self.cursor.take(opening)
        parts: list[Doc] = []
        for index, node in enumerate(nodes):
            parts += [self.cursor.comma(), LINE, show(node)] if index else [show(node)]
        if self.cursor.next == ",":
            self.cursor.skip(",")
        return self._enclosed(begin, [*parts, COMMA] if nodes else [], closing)

    def _enclosed(self, opening: Doc, parts: Sequence[Doc], closing: str) -> Doc:
        """What stands between brackets, the comments before the closing one with it."""
        return group(opening, nest(SOFT, *parts, self.cursor.remarks()), SOFT, self.cursor.take(closing))

    # ---- types ----

    def type(self, node: ast.TypeExpr, level: int = _UNION) -> Doc:
        """A type or role expression that must bind at least as tightly as `level`."""
        return self._bracketed(node, _type_level(node) < level, self._type)

    def _type(self, node: ast.TypeExpr) -> Doc:
        take = self.cursor.take
        match node:
            case ast.Role():
                return take()
            case ast.Generic():
                return cat(take(), take("["), self.type(node.argument), take("]"))
            case ast.RoleNot():
                return spaced(take("not"), self.type(node.operand, _SINGLE))
            case ast.RoleAnd() | ast.RoleOr():
                head, *tail = self._role_links(node)
                return group(head, nest(*tail))

    def _role_links(self, node: ast.RoleAnd | ast.RoleOr) -> list[Doc]:
        level, left = _type_level(node), node.left
        if isinstance(left, ast.RoleAnd | ast.RoleOr) and _type_level(left) == level:
            parts = self._inline(left, self._role_links, self._type)
        else:
            parts = [self.type(left, level)]
        sign = self.cursor.take("&" if isinstance(node, ast.RoleAnd) else "|")
        return [*parts, LINE, sign, SPACE, self.type(node.right, level + 1)]


def _level(node: ast.Expression) -> int:
    match node:
        case ast.BoolOp():
            return OR if node.op == "or" else AND
        case ast.Compare():
            return COMPARISON
        case ast.Binary():
            return SUM if node.op in "+-" else TERM
        case ast.Unary():
            return UNARY if node.op == "-" else NOT
        case ast.Attr() | ast.Index() | ast.CallExpr():
            return POSTFIX
        case _:
            return ATOM


def _type_level(node: ast.TypeExpr) -> int:
    match node:
        case ast.RoleOr():
            return _UNION
        case ast.RoleAnd():
            return _BOTH
        case _:
            return _SINGLE
