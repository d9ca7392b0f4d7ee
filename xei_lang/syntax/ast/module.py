"""A file: imports, protocols, procedures, their declarations, and the comments between."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.record import Shown
from xei_lang.syntax.ast.expressions import Expression, Name, Number, Range, StringLit
from xei_lang.syntax.ast.statements import Statement
from xei_lang.syntax.ast.types import TypeExpr


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Comment(Shown):
    """A comment with its `#`, up to the end of its line."""

    text: str
    span: Span

    @property
    def is_doc(self) -> bool:
        """Whether it is written with `##`."""
        return self.text.startswith("##")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Import(Shown):
    """`import "path"`."""

    path: StringLit
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ImportTable(Shown):
    """`import table "path" as name`."""

    path: StringLit
    name: Name
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ProfileDecl(Shown):
    """`profile "name"`."""

    name: StringLit
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Param(Shown):
    """A parameter of a protocol or procedure; `doc` is the text of the `##` lines before it."""

    name: Name
    type: TypeExpr
    default: Expression | None
    limits: Range | None
    doc: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ObjectDecl(Shown):
    """`object name: roles [= binding]`."""

    name: Name
    type: TypeExpr
    binding: Expression | None
    doc: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Given(Shown):
    """`given condition`."""

    condition: Expression
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class GivenContains(Shown):
    """`given container contains amount of content [at concentration]`."""

    container: Expression
    amount: Expression
    content: Expression
    concentration: Expression | None
    span: Span


Declaration = ProfileDecl | Param | ObjectDecl | Given | GivenContains
Member = Declaration | Statement


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Procedure(Shown):
    """`procedure name(params) { ... }`."""

    name: Name
    params: tuple[Param, ...]
    body: tuple[Member, ...]
    doc: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Protocol(Shown):
    """`protocol name { ... }`; declarations and statements in the order in which they were written."""

    name: Name
    body: tuple[Member, ...]
    doc: str
    span: Span


Item = Import | ImportTable | Protocol | Procedure


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Module(Shown):
    """A whole file. `version` is the number behind `xei`, None where the file does not say.

    `damaged` are the parts that did not follow the grammar and were mended or left out to make this tree.
    """

    version: Number | None
    items: tuple[Item, ...]
    comments: tuple[Comment, ...]
    span: Span
    damaged: tuple[Span, ...] = ()
