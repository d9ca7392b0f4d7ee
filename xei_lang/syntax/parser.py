"""From text to syntax tree: what a user writes gives a tree, a diagnostic, or both; never an exception."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span, has_errors
from xei_lang.syntax import ast
from xei_lang.syntax.builder import Builder
from xei_lang.syntax.driver import Driver, WrongTokenError
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.nesting import MAX_FAULTS, too_deep, too_deeply_nested
from xei_lang.syntax.tables import load_tables

_MINIMAL = 'protocol name {\n  profile "openarm_bench"\n  wait 1 s\n}'


class Parser:
    """Parses any number of texts; loading the tables (a few milliseconds) is done once, when it is made."""

    def __init__(self) -> None:
        self._driver = Driver(load_tables())

    def module(self, source: Source) -> tuple[ast.Module | None, Diagnostics]:
        """A whole file. Where the text does not follow the grammar, what could be read of it.

        Every mistake is reported; `damaged` of the module says where it is not what was written. None where
        nothing could be read.
        """
        module, diagnostics = self._parse(source, "module")
        if (
            module is not None
            and not has_errors(diagnostics)
            and not any(isinstance(item, ast.Protocol | ast.Procedure) for item in module.items)
        ):
            return None, (*diagnostics, _no_protocol(source, module))
        return module, diagnostics

    def predicate(self, source: Source) -> tuple[ast.Predicate | None, Diagnostics]:
        """A condition or an update (`cap(object) := open`), as in the `requires` and `ensures` of a skill."""
        return self._parse(source, "predicate")

    def expression(self, source: Source) -> tuple[ast.Expression | ast.Range | None, Diagnostics]:
        """A value or a range, such as `4 s .. 30 s`."""
        return self._parse(source, "expression")

    def role_expression(self, source: Source) -> tuple[ast.TypeExpr | None, Diagnostics]:
        """A role expression or value type, such as `movable & not fragile`."""
        return self._parse(source, "role_expression")

    def _parse(self, source: Source, start: str) -> tuple[Any, Diagnostics]:
        try:
            return self._build(source, start, self._driver.scanner.tokens(source.text))
        except WrongTokenError:
            return self._rescue(source, start)

    def _build(self, source: Source, start: str, tokens: Iterable[Token]) -> tuple[Any, Diagnostics]:
        comments: list[Token] = []
        builder = Builder(source, comments)
        node = self._driver.parse(tokens, start, builder, comments)
        deep = too_deep(node)
        if deep is not None:
            return None, (*builder.diagnostics, too_deeply_nested(deep))
        return node, _first(builder.diagnostics, source)

    def _rescue(self, source: Source, start: str) -> tuple[Any, Diagnostics]:
        from xei_lang.syntax.recovery import recover
        from xei_lang.syntax.stack import Machine

        recovered = recover(source, Machine(self._driver.tables, start), self._driver.scanner)
        said = recovered.diagnostics
        if recovered.tokens is None or start != "module":
            return None, said
        module, more = self._build(source, start, recovered.tokens)
        if module is not None:
            module = replace(module, damaged=recovered.damaged)
        trusted = [diagnostic for diagnostic in more if not _is_in(diagnostic.span, recovered.changed)]
        return module, (*said, *trusted) if module is not None else said


def _first(found: list[Diagnostic], source: Source) -> Diagnostics:
    """As many of what is wrong inside of tokens as anyone reads."""
    if len(found) <= MAX_FAULTS:
        return tuple(found)
    from xei_lang.syntax.faults import too_many

    span = found[MAX_FAULTS].span
    assert span is not None
    return (*found[:MAX_FAULTS], too_many(source, span.start, span.end, MAX_FAULTS))


def _is_in(span: Span | None, damaged: tuple[Span, ...]) -> bool:
    return span is None or any(part.start <= span.start <= part.end for part in damaged)


def parse_module(source: Source) -> tuple[ast.Module | None, Diagnostics]:
    """Parse one file; to parse several texts, make one Parser."""
    return Parser().module(source)


def parse_predicate(source: Source) -> tuple[ast.Predicate | None, Diagnostics]:
    """Parse one predicate of a skill bank."""
    return Parser().predicate(source)


def parse_expression(source: Source) -> tuple[ast.Expression | ast.Range | None, Diagnostics]:
    """Parse one expression or range."""
    return Parser().expression(source)


def parse_role_expression(source: Source) -> tuple[ast.TypeExpr | None, Diagnostics]:
    """Parse one role expression or value type."""
    return Parser().role_expression(source)


def _no_protocol(source: Source, module: ast.Module) -> Diagnostic:
    span = Span(source.file, 0, 0)
    if module.items:
        return Diagnostic(
            "XEI0103",
            "this file has imports, but no protocol and no procedure",
            module.items[-1].span,
            "expected a `protocol` or `procedure` after this",
            help=(f"a small protocol looks like this:\n{_MINIMAL}",),
        )
    message = "this file is empty" if not source.text.strip() else "this file has no protocol in it"
    return Diagnostic("XEI0103", message, span, help=(f"a small protocol looks like this:\n{_MINIMAL}",))
