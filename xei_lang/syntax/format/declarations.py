"""Printing a file: imports, protocols, procedures and what is declared in them."""

from __future__ import annotations

from xei_lang.syntax import ast
from xei_lang.syntax.format.expressions import POSTFIX, SUM
from xei_lang.syntax.format.layout import EMPTY, HARD, LINE, SPACE, Doc, cat, group, nest, spaced
from xei_lang.syntax.format.statements import StatementPrinter


class FilePrinter(StatementPrinter):
    """Takes the words of a whole file from the cursor, in their order, into a document."""

    def module(self, node: ast.Module) -> Doc:
        """The file, with an empty line around each protocol and procedure."""
        parts: list[Doc] = []
        before: ast.Number | ast.Item | None = None
        for item in ((node.version,) if node.version else ()) + node.items:
            apart = any(isinstance(one, ast.Protocol | ast.Procedure) for one in (before, item))
            leading = self.cursor.leading(first=before is None, apart=apart and before is not None)
            parts += [leading, self._item(item), self.cursor.trailing()]
            before = item
        return cat(*parts, self.cursor.ending(first=before is None), HARD)

    def _item(self, node: ast.Number | ast.Item) -> Doc:
        take = self.cursor.take
        match node:
            case ast.Number():
                return spaced(take("xei"), take())
            case ast.Import():
                return spaced(take("import"), take())
            case ast.ImportTable():
                return spaced(take("import"), take("table"), take(), take("as"), take())
            case ast.Protocol():
                return spaced(take("protocol"), take(), self.block(node.body, self._member))
            case ast.Procedure():
                head = cat(
                    take("procedure"), SPACE, take(), self.several("(", node.params, self._formal, ")")
                )
                return spaced(head, self.block(node.body, self._member))

    def _member(self, node: ast.Member) -> Doc:
        take = self.cursor.take
        match node:
            case ast.ProfileDecl():
                return spaced(take("profile"), take())
            case ast.Param():
                return spaced(take("param"), self._formal(node))
            case ast.ObjectDecl():
                head = cat(take("object"), SPACE, take(), take(":"), SPACE, self.type(node.type))
                return cat(head, self._default(node.binding, POSTFIX))
            case ast.Given():
                return spaced(take("given"), self.value(node.condition))
            case ast.GivenContains():
                return self._given_contains(node)
            case _:
                return self.statement(node)

    def _formal(self, node: ast.Param) -> Doc:
        """`name: type = value in low .. high`."""
        head = cat(self.cursor.take(), self.cursor.take(":"), SPACE, self.type(node.type))
        return cat(head, self._default(node.default), self.limits(node.limits))

    def _default(self, value: ast.Expression | None, level: int = 1) -> Doc:
        if value is None:
            return EMPTY
        return cat(SPACE, self.cursor.take("="), SPACE, self.value(value, level))

    def _given_contains(self, node: ast.GivenContains) -> Doc:
        take = self.cursor.take
        parts = [take("given"), SPACE, self.value(node.container, POSTFIX)]
        tail = [LINE, take("contains"), SPACE, self.value(node.amount, SUM)]
        tail += [SPACE, take("of"), SPACE, self.value(node.content, POSTFIX)]
        if node.concentration is not None:
            tail += [LINE, take("at"), SPACE, self.value(node.concentration, SUM)]
        return group(*parts, nest(*tail))
