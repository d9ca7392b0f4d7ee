"""Printing statements: one a line, blocks indented."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from xei_lang.syntax import ast
from xei_lang.syntax.format.expressions import SUM, ExpressionPrinter, NodeT
from xei_lang.syntax.format.layout import EMPTY, HARD, LINE, SPACE, Doc, cat, group, nest, spaced

_HEAD_INDENT = 2
"""Lines that go on the head of a block stand further in than the block, so that they are told apart."""
_WithBlocks = ast.Pause | ast.Keep | ast.Do | ast.Parallel | ast.For | ast.Repeat | ast.If


class StatementPrinter(ExpressionPrinter):
    """Takes the words of statements from the cursor, in their order, into a document."""

    # ---- blocks ----

    def block(self, statements: Sequence[NodeT], show: Callable[[NodeT], Doc]) -> Doc:
        """`{ ... }`, with one statement a line."""
        if not statements and self.cursor.is_bare():
            return spaced(self.cursor.take("{"), self.cursor.take("}"))
        opening = self.cursor.take("{")
        parts: list[Doc] = [self.cursor.trailing()]
        for index, statement in enumerate(statements):
            parts += [self.cursor.leading(first=index == 0), show(statement), self.cursor.trailing()]
        return cat(
            opening, nest(*parts, self.cursor.ending(first=not statements)), HARD, self.cursor.take("}")
        )

    def _body(self, node: ast.Block) -> Doc:
        return self.block(node.statements, self.statement)

    def _branch(self, node: ast.Block) -> Doc:
        """A branch of `parallel`: on one line if it is a single plain step."""
        (only,) = node.statements if len(node.statements) == 1 else (None,)
        is_plain = isinstance(only, ast.Step) and not isinstance(only.action, _WithBlocks)
        if only is None or not is_plain or not self.cursor.is_bare():
            return self._body(node)
        opening = self.cursor.take("{")
        return group(opening, nest(LINE, self.statement(only)), LINE, self.cursor.take("}"))

    # ---- statements ----

    def statement(self, node: ast.Statement) -> Doc:
        """One statement, without the comments before it."""
        take = self.cursor.take
        match node:
            case ast.Step():
                return self._step(node)
            case ast.Let():
                return spaced(take("let"), self.names(node.names), take("="), self.value(node.value))
            case ast.Require():
                return spaced(take("require"), self.value(node.condition))
            case ast.Unmapped():
                said = spaced(take("unmapped"), take())
                reason = () if node.reason is None else (LINE, take("because"), SPACE, take())
                return group(said, nest(*reason))
            case ast.Note():
                return spaced(take("note"), take())

    def _step(self, node: ast.Step) -> Doc:
        take = self.cursor.take
        parts: list[Doc] = []
        if isinstance(node.action, ast.Start):
            parts += [take("start"), SPACE]
        if node.label is not None:
            parts += [take(), take(":"), SPACE]
        parts.append(self._action(node.action))
        if not node.clauses:
            return cat(*parts)
        clauses = [doc for clause in node.clauses for doc in (LINE, self._clause(clause))]
        return cat(*parts, group(nest(*clauses)))

    def _clause(self, node: ast.Clause) -> Doc:
        take = self.cursor.take
        match node:
            case ast.Within():
                parts = [take("within"), SPACE, self.value(node.duration, SUM)]
                parts += [] if node.of is None else [SPACE, take("of"), SPACE, self.value(node.of)]
            case ast.After():
                parts = [take("after"), SPACE, self.value(node.step)]
                parts += [] if node.by is None else [SPACE, take("by"), SPACE, self.range(node.by)]
        return cat(*parts)

    def _action(self, node: ast.Action) -> Doc:  # noqa: PLR0911 one return for each kind of action
        take = self.cursor.take
        match node:
            case ast.Call():
                return self._call(node)
            case ast.Start():
                return self._call(node.call)
            case ast.Wait():
                return spaced(take("wait"), self.value(node.duration, SUM))
            case ast.Await() | ast.Stop() | ast.Leave():
                return spaced(take(), self.value(node.step))
            case ast.StopRun() | ast.Confirm():
                return spaced(take(), take())
            case ast.Measure():
                return self._measure(node)
            case _:
                return self._with_blocks(node)

    def _call(self, node: ast.Call) -> Doc:
        return cat(self.cursor.take(), self.arguments(node.args))

    def _measure(self, node: ast.Measure) -> Doc:
        take = self.cursor.take
        head = spaced(cat(take("measure"), SPACE, take(), take(":")), self.type(node.type), take("="))
        call = self._call(node.call)
        return cat(head, SPACE, call, self.limits(node.limits))

    def limits(self, node: ast.Range | None) -> Doc:
        """`in low .. high`, behind what it limits."""
        if node is None:
            return EMPTY
        return group(nest(LINE, self.cursor.take("in"), SPACE, self.range(node)))

    # ---- statements with blocks ----

    def _with_blocks(self, node: _WithBlocks) -> Doc:  # noqa: PLR0911 one return for each kind
        take = self.cursor.take
        match node:
            case ast.Do():
                return spaced(take("do"), self._body(node.body))
            case ast.Pause():
                return spaced(take("pause"), self.value(node.step), self._body(node.body))
            case ast.Keep():
                return spaced(take("keep"), self._head(self.value(node.condition)), self._body(node.body))
            case ast.Parallel():
                return spaced(take("parallel"), self.block(node.branches, self._branch))
            case ast.For():
                head = [take("for"), self._head(self.binding(node))]
                head += [take("unordered")] if node.unordered else []
                return spaced(*head, self._body(node.body))
            case ast.Repeat():
                return self._repeat(node)
            case ast.If():
                return self._if(node)

    def _head(self, condition: Doc) -> Doc:
        return nest(condition, columns=_HEAD_INDENT)

    def _repeat(self, node: ast.Repeat) -> Doc:
        take = self.cursor.take
        parts = [take("repeat"), self.value(node.count, SUM), take("times")]
        if node.until is not None:
            parts += [take("until"), self._head(self.value(node.until))]
        parts.append(self._body(node.body))
        if node.otherwise is not None:
            parts += [take("else"), self._body(node.otherwise)]
        return spaced(*parts)

    def _if(self, node: ast.If) -> Doc:
        take = self.cursor.take
        parts = [take("if"), self._head(self.value(node.condition)), self._body(node.body)]
        match node.otherwise:
            case None:
                pass
            case ast.If():
                parts += [take("else"), self._if(node.otherwise)]
            case ast.Block():
                parts += [take("else"), self._body(node.otherwise)]
        return spaced(*parts)
