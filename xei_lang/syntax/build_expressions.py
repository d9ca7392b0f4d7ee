"""The part of the builder that makes values, types and the updates of a skill bank."""

# ruff: noqa: D102 -- grammar/xei.lark says what each rule is

from __future__ import annotations

import dataclasses
import re
from fractions import Fraction
from typing import Any

from xei_lang.diagnostics import Diagnostic, Source, Span
from xei_lang.quantity import Quantity, QuantityError, parse_quantity
from xei_lang.syntax import ast
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.nesting import MAX_NESTING, too_deeply_nested

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_ESCAPE = re.compile(r"\\(.)")
_ESCAPES = {"\\": "\\", '"': '"', "n": "\n", "t": "\t"}
_MAX_DIGITS = 40
_LEAVES = (ast.Name, ast.Number, ast.QuantityLit, ast.StringLit, ast.Bool, ast.Role)


class ExpressionBuilder:
    """`diagnostics` collects what is wrong inside single tokens: the tree is whole all the same."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.diagnostics: list[Diagnostic] = []
        self._quantities: dict[str, Quantity] = {}
        self._brackets: tuple[int, int, int] = (0, 0, 0)
        """The round brackets that were closed last, and how many others they hold."""

    # ---- tokens ----

    def span(self, start: int, end: int) -> Span:
        return Span(self.source.file, start, end)

    def name(self, token: Token) -> ast.Name:
        _, text, start, end = token
        return ast.Name(text, Span(self.source.file, start, end))

    def declared(self, token: Token) -> ast.Name:
        """A name where it is made: those that the language gives out are lower case."""
        if not _NAME.fullmatch(token.text):
            self.diagnostics.append(
                Diagnostic(
                    "XEI0106",
                    f"`{token.text}` is not written as a name",
                    self.span(token.start, token.end),
                    "expected lower-case letters, digits and `_`, a letter first",
                    help=_name_help(token.text),
                )
            )
        return self.name(token)

    def names(self, children: list[Any]) -> tuple[tuple[ast.Name, ...], list[Any]]:
        """The names of `a, b in ...`, and the children from `in` on."""
        end = next(i for i, child in enumerate(children) if child.text == "in" and i % 2)
        return tuple(self.declared(child) for child in children[:end:2]), children[end:]

    def string(self, token: Token) -> ast.StringLit:
        span = self.span(token.start, token.end)
        text = token.text[1:-1]
        if "\\" in text:
            for match in _ESCAPE.finditer(text):
                if match[1] not in _ESCAPES:
                    self._wrong_escape(match[0], token.start + 1 + match.start())
            text = _ESCAPE.sub(lambda match: _ESCAPES.get(match[1], match[0]), text)
        return ast.StringLit(text, span)

    def _wrong_escape(self, written: str, start: int) -> None:
        self.diagnostics.append(
            Diagnostic(
                "XEI0104",
                f"`{written}` means nothing inside a text",
                self.span(start, start + len(written)),
                'expected one of `\\\\`, `\\"`, `\\n`, `\\t`',
                help=("write `\\\\` for a backslash",),
            )
        )

    # ---- atoms ----

    def on_name(self, c: list[Any]) -> ast.Name:
        return self.name(c[0])

    def on_number(self, c: list[Any]) -> ast.Number:
        text, span = c[0].text, self.span(c[0].start, c[0].end)
        if len(text) > _MAX_DIGITS:
            self._unreadable(f"a number may have at most {_MAX_DIGITS} digits", span)
            return ast.Number(0, span)
        whole, dot, part = text.partition(".")
        value = Fraction(int(whole + part), 10 ** len(part)) if dot else int(whole)
        return ast.Number(value, span)

    def on_quantity(self, c: list[Any]) -> ast.QuantityLit | ast.Number:
        text, span = c[0].text, self.span(c[0].start, c[0].end)
        value = self._quantities.get(text)
        if value is None:
            try:
                value = self._quantities[text] = parse_quantity(text)
            except QuantityError as error:
                self._unreadable(error.reason, span)
                return ast.Number(0, span)
        return ast.QuantityLit(value, span)

    def _unreadable(self, reason: str, span: Span) -> None:
        self.diagnostics.append(Diagnostic("XEI0104", reason, span))

    def on_string(self, c: list[Any]) -> ast.StringLit:
        return self.string(c[0])

    def on_true(self, c: list[Any]) -> ast.Bool:
        return ast.Bool(True, self.span(c[0].start, c[0].end))

    def on_false(self, c: list[Any]) -> ast.Bool:
        return ast.Bool(False, self.span(c[0].start, c[0].end))

    def on_paren(self, c: list[Any]) -> Any:
        """What is in brackets, which now count to its span, unless it is a single word or literal."""
        opening, inner, closing = c
        self._nested_brackets(opening.start, closing.end)
        if isinstance(inner, _LEAVES):
            return inner
        return dataclasses.replace(inner, span=self.span(opening.start, closing.end))

    def _nested_brackets(self, start: int, end: int) -> None:
        """Brackets around brackets make no node, so that the depth of the tree says nothing of them."""
        last_start, last_end, depth = self._brackets
        depth = depth + 1 if start < last_start and last_end < end else 1
        self._brackets = (start, end, depth)
        if depth == MAX_NESTING + 1:
            self.diagnostics.append(too_deeply_nested(self.span(start, start + 1)))

    def on_tuple(self, c: list[Any]) -> ast.TupleLit:
        items = tuple(child for child in c if not isinstance(child, Token))
        return ast.TupleLit(items, self.span(c[0].start, c[-1].end))

    def on_list(self, c: list[Any]) -> ast.ListLit:
        items = tuple(child for child in c if not isinstance(child, Token))
        return ast.ListLit(items, self.span(c[0].start, c[-1].end))

    def on_comprehension(self, c: list[Any]) -> ast.Comprehension:
        names, rest = self.names(c[3:])
        _, iterable, _, condition, closing = rest
        return ast.Comprehension(c[1], names, iterable, condition, self.span(c[0].start, closing.end))

    # ---- operators ----

    def on_binary(self, c: list[Any]) -> ast.Binary:
        left, op, right = c
        return ast.Binary(op.text, left, right, self.span(left.span.start, right.span.end))

    def on_compare(self, c: list[Any]) -> ast.Compare:
        left, op, right = c
        return ast.Compare(op.text, left, right, self.span(left.span.start, right.span.end))

    def on_bool_or(self, c: list[Any]) -> ast.BoolOp:
        return ast.BoolOp("or", c[0], c[2], self.span(c[0].span.start, c[2].span.end))

    def on_bool_and(self, c: list[Any]) -> ast.BoolOp:
        return ast.BoolOp("and", c[0], c[2], self.span(c[0].span.start, c[2].span.end))

    def on_bool_not(self, c: list[Any]) -> ast.Unary:
        return ast.Unary("not", c[1], self.span(c[0].start, c[1].span.end))

    def on_negative(self, c: list[Any]) -> ast.Unary:
        return ast.Unary("-", c[1], self.span(c[0].start, c[1].span.end))

    def on_attribute(self, c: list[Any]) -> ast.Attr:
        return ast.Attr(c[0], self.name(c[2]), self.span(c[0].span.start, c[2].end))

    def on_index(self, c: list[Any]) -> ast.Index:
        return ast.Index(c[0], c[2], self.span(c[0].span.start, c[3].end))

    def on_range(self, c: list[Any]) -> ast.Range:
        lower, _, upper, _, step = c
        return ast.Range(lower, upper, step, self.span(lower.span.start, (step or upper).span.end))

    def on_call_expression(self, c: list[Any]) -> ast.CallExpr:
        args = tuple(child for child in c[2:-1] if isinstance(child, ast.Arg))
        return ast.CallExpr(c[0], args, self.span(c[0].span.start, c[-1].end))

    def on_named_argument(self, c: list[Any]) -> ast.Arg:
        name, _, value = c
        return ast.Arg(self.name(name), value, self.span(name.start, value.span.end))

    def on_positional_argument(self, c: list[Any]) -> ast.Arg:
        return ast.Arg(None, c[0], c[0].span)

    # ---- types and role expressions ----

    def on_role(self, c: list[Any]) -> ast.Role:
        return ast.Role(c[0].text, self.span(c[0].start, c[0].end))

    def on_generic(self, c: list[Any]) -> ast.Generic:
        return ast.Generic(self.name(c[0]), c[2], self.span(c[0].start, c[3].end))

    def on_and_role(self, c: list[Any]) -> ast.RoleAnd:
        return ast.RoleAnd(c[0], c[2], self.span(c[0].span.start, c[2].span.end))

    def on_or_role(self, c: list[Any]) -> ast.RoleOr:
        return ast.RoleOr(c[0], c[2], self.span(c[0].span.start, c[2].span.end))

    def on_not_role(self, c: list[Any]) -> ast.RoleNot:
        return ast.RoleNot(c[1], self.span(c[0].start, c[1].span.end))

    # ---- further entrances ----

    def on_update(self, c: list[Any]) -> ast.Update:
        target, op, value = c
        return ast.Update(target, op.text, value, self.span(target.span.start, value.span.end))

    def on_predicate(self, c: list[Any]) -> ast.Predicate:
        return c[0]

    def on_expression(self, c: list[Any]) -> ast.Expression | ast.Range:
        return c[0]

    def on_role_expression(self, c: list[Any]) -> ast.TypeExpr:
        return c[0]


def _name_help(text: str) -> tuple[str, ...]:
    lowered = text.lower().lstrip("_")
    return (f"write `{lowered}`",) if _NAME.fullmatch(lowered) else ()
