"""A file: imports, protocols, procedures, their declarations, and the comments between."""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast.expressions import Expression, Name, Number, Range, StringLit
from xei_lang.syntax.ast.statements import Statement
from xei_lang.syntax.ast.types import TypeExpr


@record
class Comment(Shown):
    """A comment with its `#`, up to the end of its line."""

    text: str
    span: Span

    @property
    def is_doc(self) -> bool:
        """Whether it is written with `##`."""
        return self.text.startswith("##")


@record
class Import(Shown):
    """`import "path"`."""

    path: StringLit
    span: Span


@record
class ImportTable(Shown):
    """`import table "path" as name`."""

    path: StringLit
    name: Name
    span: Span


@record
class ProfileDecl(Shown):
    """`profile "name"`."""

    name: StringLit
    span: Span


@record
class Param(Shown):
    """A parameter of a protocol or procedure; `doc` is the text of the `##` lines before it."""

    name: Name
    type: TypeExpr
    default: Expression | None
    limits: Range | None
    doc: str
    span: Span


@record
class ObjectDecl(Shown):
    """`object name: roles [= binding]`."""

    name: Name
    type: TypeExpr
    binding: Expression | None
    doc: str
    span: Span


@record
class Given(Shown):
    """`given condition`."""

    condition: Expression
    span: Span


@record
class GivenContains(Shown):
    """`given container contains amount of content [at concentration]`."""

    container: Expression
    amount: Expression
    content: Expression
    concentration: Expression | None
    span: Span


Declaration = ProfileDecl | Param | ObjectDecl | Given | GivenContains
Member = Declaration | Statement


@record
class Procedure(Shown):
    """`procedure name(params) { ... }`."""

    name: Name
    params: tuple[Param, ...]
    body: tuple[Member, ...]
    doc: str
    span: Span


@record
class Protocol(Shown):
    """`protocol name { ... }`; declarations and statements in the order in which they were written."""

    name: Name
    body: tuple[Member, ...]
    doc: str
    span: Span


Item = Import | ImportTable | Protocol | Procedure


@record
class Module(Shown):
    """A whole file. `version` is the number behind `xei`, None where the file does not say.

    `damaged` are the parts that did not follow the grammar and were mended or left out to make this tree.
    """

    version: Number | None
    items: tuple[Item, ...]
    comments: tuple[Comment, ...]
    span: Span
    damaged: tuple[Span, ...] = ()
