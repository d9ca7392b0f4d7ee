"""Making the syntax tree: one method for each rule of the grammar, called by the driver with its children.

Children are tokens, nodes, and None for an option that was not taken; see grammar/xei.lark for their order.
"""

# ruff: noqa: D102 -- grammar/xei.lark says what each rule is

from __future__ import annotations

from typing import Any

from xei_lang.diagnostics import Source
from xei_lang.syntax import ast
from xei_lang.syntax.build_expressions import ExpressionBuilder
from xei_lang.syntax.lexer import Token


class Builder(ExpressionBuilder):
    """Builds one file's tree; holds the comments met so far, which become documentation of what follows."""

    def __init__(self, source: Source, comments: list[Token]) -> None:
        super().__init__(source)
        self._comments = comments

    # ---- files ----

    def on_module(self, c: list[Any]) -> ast.Module:
        version = c.pop(0) if c and isinstance(c[0], ast.Number) else None
        comments = tuple(
            ast.Comment(text.rstrip(), self.span(start, end)) for _, text, start, end in self._comments
        )
        return ast.Module(version, tuple(c), comments, self.span(0, len(self.source.text)))

    def on_pragma(self, c: list[Any]) -> ast.Number:
        return self.on_number(c[1:])

    def on_import_file(self, c: list[Any]) -> ast.Import:
        return ast.Import(self.string(c[1]), self.span(c[0].start, c[1].end))

    def on_import_table(self, c: list[Any]) -> ast.ImportTable:
        return ast.ImportTable(self.string(c[2]), self.declared(c[4]), self.span(c[0].start, c[4].end))

    def on_protocol(self, c: list[Any]) -> ast.Protocol:
        doc = self._doc(c[0].start)
        return ast.Protocol(self.declared(c[1]), tuple(c[3:-1]), doc, self.span(c[0].start, c[-1].end))

    def on_procedure(self, c: list[Any]) -> ast.Procedure:
        opening = next(i for i, child in enumerate(c) if isinstance(child, Token) and child.text == "{")
        params = tuple(child for child in c[3:opening] if isinstance(child, ast.Param))
        doc = self._doc(c[0].start)
        body = tuple(c[opening + 1 : -1])
        return ast.Procedure(self.declared(c[1]), params, body, doc, self.span(c[0].start, c[-1].end))

    # ---- declarations ----

    def on_formal(self, c: list[Any]) -> ast.Param:
        name, _, type_, _, default, _, limits = c
        last = limits or default or type_
        doc = self._doc(name.start)
        return ast.Param(
            self.declared(name), type_, default, limits, doc, self.span(name.start, last.span.end)
        )

    def on_param(self, c: list[Any]) -> ast.Param:
        _, name, _, type_, _, default, _, limits = c
        last = limits or default or type_
        doc = self._doc(c[0].start)
        return ast.Param(
            self.declared(name), type_, default, limits, doc, self.span(c[0].start, last.span.end)
        )

    def on_profile(self, c: list[Any]) -> ast.ProfileDecl:
        return ast.ProfileDecl(self.string(c[1]), self.span(c[0].start, c[1].end))

    def on_object(self, c: list[Any]) -> ast.ObjectDecl:
        _, name, _, type_, _, binding = c
        last = binding or type_
        doc = self._doc(c[0].start)
        return ast.ObjectDecl(self.declared(name), type_, binding, doc, self.span(c[0].start, last.span.end))

    def on_given(self, c: list[Any]) -> ast.Given:
        return ast.Given(c[1], self.span(c[0].start, c[1].span.end))

    def on_given_contains(self, c: list[Any]) -> ast.GivenContains:
        _, container, _, amount, _, content, _, concentration = c
        last = concentration or content
        return ast.GivenContains(
            container, amount, content, concentration, self.span(c[0].start, last.span.end)
        )

    # ---- steps ----

    def on_step(self, c: list[Any]) -> ast.Step:
        label, action, *clauses = c
        first = (label or action).span.start
        return ast.Step(label, action, tuple(clauses), self.span(first, c[-1].span.end))

    def on_started(self, c: list[Any]) -> ast.Step:
        (label, start), *clauses = c
        last = clauses[-1] if clauses else start
        return ast.Step(label, start, tuple(clauses), self.span(start.span.start, last.span.end))

    def on_start(self, c: list[Any]) -> tuple[ast.Name | None, ast.Start]:
        _, label, call = c
        return label, ast.Start(call, self.span(c[0].start, call.span.end))

    def on_label(self, c: list[Any]) -> ast.Name:
        return self.declared(c[0])

    def on_block(self, c: list[Any]) -> ast.Block:
        return ast.Block(tuple(c[1:-1]), self.span(c[0].start, c[-1].end))

    def on_after(self, c: list[Any]) -> ast.After:
        _, step, _, by = c
        return ast.After(step, by, self.span(c[0].start, (by or step).span.end))

    def on_within(self, c: list[Any]) -> ast.Within:
        _, duration, _, of = c
        return ast.Within(duration, of, self.span(c[0].start, (of or duration).span.end))

    def on_call(self, c: list[Any]) -> ast.Call:
        args = tuple(child for child in c[2:-1] if isinstance(child, ast.Arg))
        return ast.Call(self.name(c[0]), args, self.span(c[0].start, c[-1].end))

    def on_wait(self, c: list[Any]) -> ast.Wait:
        return ast.Wait(c[1], self.span(c[0].start, c[1].span.end))

    def on_await(self, c: list[Any]) -> ast.Await:
        return ast.Await(c[1], self.span(c[0].start, c[1].span.end))

    def on_stop(self, c: list[Any]) -> ast.Stop:
        return ast.Stop(c[1], self.span(c[0].start, c[1].span.end))

    def on_stop_run(self, c: list[Any]) -> ast.StopRun:
        return ast.StopRun(self.string(c[1]), self.span(c[0].start, c[1].end))

    def on_leave(self, c: list[Any]) -> ast.Leave:
        return ast.Leave(c[1], self.span(c[0].start, c[1].span.end))

    def on_pause(self, c: list[Any]) -> ast.Pause:
        return ast.Pause(c[1], c[2], self.span(c[0].start, c[2].span.end))

    def on_keep(self, c: list[Any]) -> ast.Keep:
        return ast.Keep(c[1], c[2], self.span(c[0].start, c[2].span.end))

    def on_measure(self, c: list[Any]) -> ast.Measure:
        _, name, _, type_, _, call, _, limits = c
        last = limits or call
        return ast.Measure(self.declared(name), type_, call, limits, self.span(c[0].start, last.span.end))

    def on_confirm(self, c: list[Any]) -> ast.Confirm:
        return ast.Confirm(self.string(c[1]), self.span(c[0].start, c[1].end))

    def on_do(self, c: list[Any]) -> ast.Do:
        return ast.Do(c[1], self.span(c[0].start, c[1].span.end))

    def on_parallel(self, c: list[Any]) -> ast.Parallel:
        return ast.Parallel(tuple(c[2:-1]), self.span(c[0].start, c[-1].end))

    def on_for(self, c: list[Any]) -> ast.For:
        names, rest = self.names(c[1:])
        iterable, body = rest[1], rest[-1]
        span = self.span(c[0].start, body.span.end)
        return ast.For(names, iterable, len(rest) == 4, body, span)

    def on_repeat(self, c: list[Any]) -> ast.Repeat:
        _, count, _, _, until, body, _, otherwise = c
        span = self.span(c[0].start, (otherwise or body).span.end)
        return ast.Repeat(count, until, body, otherwise, span)

    def on_if(self, c: list[Any]) -> ast.If:
        _, condition, body, _, otherwise = c
        return ast.If(condition, body, otherwise, self.span(c[0].start, (otherwise or body).span.end))

    # ---- statements that are no steps ----

    def on_let(self, c: list[Any]) -> ast.Let:
        names, value = c[1:-2:2], c[-1]
        return ast.Let(
            tuple(self.declared(name) for name in names), value, self.span(c[0].start, value.span.end)
        )

    def on_require(self, c: list[Any]) -> ast.Require:
        return ast.Require(c[1], self.span(c[0].start, c[1].span.end))

    def on_unmapped(self, c: list[Any]) -> ast.Unmapped:
        _, text, _, reason = c
        span = self.span(c[0].start, (reason or text).end)
        return ast.Unmapped(self.string(text), self.string(reason) if reason else None, span)

    def on_note(self, c: list[Any]) -> ast.Note:
        return ast.Note(self.string(c[1]), self.span(c[0].start, c[1].end))

    def _doc(self, start: int) -> str:
        """The text of the `##` lines right before a place, with nothing but white space between."""
        lines: list[str] = []
        for _, text, begins, ends in reversed(self._comments):
            if begins >= start:
                continue
            if not text.startswith("##") or self.source.text[ends:start].strip():
                break
            lines.append(text[2:].strip())
            start = begins
        return "\n".join(reversed(lines))
