"""Texts that should say something and are blank: what a skill is given, what a person is told."""

from __future__ import annotations

from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import Confirm, Note, StopRun, Unmapped


def says_something(
    value: object, what: str, span: Span, reporter: Reporter, rule: Span | None = None
) -> bool:
    """Whether a value is no blank text; reported where it is one (XEI0327)."""
    if not isinstance(value, str) or value.strip():
        return True
    reporter.report(
        "XEI0327",
        f"{what} takes a text, and this one is empty",
        span,
        "expected at least one letter",
        notes=(reporter.rule(rule),) if rule is not None else (),
        help=("say what is meant",),
    )
    return False


def check_statement_text(node: Confirm | Note | StopRun | Unmapped, reporter: Reporter) -> None:
    """What a statement tells people."""
    word = {Confirm: "confirm", Note: "note", StopRun: "stop", Unmapped: "unmapped"}[type(node)]
    text = node.message if isinstance(node, StopRun) else node.text
    says_something(text.value, f"`{word}`", text.span, reporter)
