"""Saying what is wrong with a text that does not follow the grammar, in the words of the one who wrote it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from xei_lang.diagnostics import Diagnostic, Edit, Fix, Label, Source, Span
from xei_lang.syntax.braces import BraceFault
from xei_lang.syntax.habit import Habit
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.repairs import Repair
from xei_lang.syntax.stack import Machine, Stack
from xei_lang.syntax.tables import END, Tables

_CLOSING = {"(": ")", "[": "]", "{": "}"}
_OPENING = {closing: opening for opening, closing in _CLOSING.items()}
_VALUE = frozenset({"NUMBER", "QUANTITY", "STRING", "LPAR", "LSQB"})
_OPERATORS = frozenset(
    {"PLUS", "MINUS", "STAR", "SLASH", "DOT", "AND", "OR", "COMPARISON", "VBAR", "AMPERSAND"}
)
_STEPS = frozenset({"WAIT", "LET", "REQUIRE", "REPEAT", "PARALLEL"})
_NAMES = {"NAME": "a name", "NUMBER": "a number", "STRING": "a text in quotes", "QUANTITY": "a quantity"}
_STATEMENT_WORDS = frozenset(
    {
        "WAIT",
        "LET",
        "REQUIRE",
        "REPEAT",
        "PARALLEL",
        "START",
        "AWAIT",
        "STOP",
        "LEAVE",
        "PAUSE",
        "KEEP",
        "MEASURE",
    }
    | {"CONFIRM", "DO", "FOR", "IF", "UNMAPPED", "NOTE", "PROFILE", "PARAM", "OBJECT", "GIVEN"}
)
_MOST_NAMED = 4


@dataclass(frozen=True, slots=True)
class Site:
    """A token that cannot follow: the machine as it was, what stands before, and the likely mend."""

    machine: Machine
    stack: Stack
    before: tuple[Token, ...]
    token: Token
    begins_line: bool
    opened: tuple[Token, Any, int] | None
    repair: Repair | None


def explain(source: Source, site: Site) -> Diagnostic:
    """The diagnostic for a token that cannot stand where it stands."""
    token, before = site.token, site.before
    opened = site.opened[0] if site.opened else None
    slip = _slip(source, site)
    if slip is not None:
        return slip
    terminals = site.machine.expected(site.stack)
    expected = _in_words(terminals, site.machine.tables)
    after = f" after {_quoted(before[-1].text)}" if before else ""
    span = _place(source, site)
    if token.kind == END and opened is not None:
        return _never_closed(source, opened, span)
    found = "the text ends" if token.kind == END else f"found {_quoted(token.text)}"
    message = f"expected {expected}{after}, but {found}"
    labels = _opening_label(source, token, opened)
    help_ = _advice(terminals, before)
    return Diagnostic("XEI0104", message, span, f"expected {expected}", labels, help=help_)


def explain_habit(source: Source, habit: Habit) -> Diagnostic:
    """The diagnostic for a miswriting that is known by name."""
    span = Span(source.file, habit.start, habit.end)
    fix = habit.fix(source.file)
    return Diagnostic("XEI0104", habit.message, span, habit.label, help=habit.help, fix=fix)


def explain_brace(source: Source, fault: BraceFault, tokens: Sequence[Token]) -> Diagnostic:
    """The diagnostic for a brace whose lack or surplus shows in the indentation."""
    token, file = tokens[fault.index], source.file
    if fault.kind == "extra":
        span = Span(file, token.start, token.end)
        fix = Fix("unsafe", (Edit(span, ""),))
        return Diagnostic("XEI0104", "this `}` closes nothing", span, "one too many", fix=fix)
    end = tokens[fault.index - 1].end
    if fault.kind == "opening":
        message = f"a `{{` is missing after {_quoted(tokens[fault.index - 1].text)}"
        fix = Fix("unsafe", (Edit(Span(file, end, end), " {"),))
        return Diagnostic("XEI0104", message, Span(file, end, end), "expected `{`", fix=fix)
    opener = fault.opener
    labels = (Label(Span(file, opener.start, opener.end), "opened here"),) if opener else ()
    if token.kind == END and opener:
        return _never_closed(source, opener, Span(file, end, end))
    if (opener and "\n" not in source.text[opener.start : end]) or token.kind == END:
        place, label = Span(file, end, end), "expected `}`"
        edit = Edit(place, " }")
    else:
        place, label = Span(file, token.start, token.end), "by its indentation, this stands behind the block"
        line = source.text.rfind("\n", 0, token.start) + 1
        edit = Edit(Span(file, line, line), " " * fault.indent + "}\n")
    message = f"a `}}` is missing before {_quoted(token.text)}"
    return Diagnostic("XEI0104", message, place, label, labels, fix=Fix("unsafe", (edit,)))


def too_many(source: Source, start: int, end: int, count: int) -> Diagnostic:
    """The last word on a file that has more mistakes than anyone reads."""
    return Diagnostic(
        "XEI0109",
        f"only the first {count} syntax errors of this file are shown",
        Span(source.file, start, end),
        "what follows was not read",
        help=("mend these first",),
    )


def _slip(source: Source, site: Site) -> Diagnostic | None:
    """A word that is nearly the keyword that belongs there, or a sign that was written twice."""
    repair = site.repair
    if repair is None:
        return None
    blamed = repair.blamed
    span = Span(source.file, blamed.start, blamed.end)
    if repair.kind == "replace" and repair.meant:
        fix = Fix("unsafe", (Edit(span, repair.meant),))
        message = f"{_quoted(blamed.text)} cannot stand here; `{repair.meant}` can"
        return Diagnostic("XEI0104", message, span, f"expected `{repair.meant}`", fix=fix)
    twice = site.before[-repair.back - 1 : len(site.before) - repair.back]
    if repair.kind == "delete" and twice and twice[0].text == blamed.text:
        fix = Fix("unsafe", (Edit(span, ""),))
        return Diagnostic(
            "XEI0104", f"{_quoted(blamed.text)} stands here twice", span, "one too many", fix=fix
        )
    return None


def explain_unclosed(source: Source, opener: Token, end: int) -> Diagnostic:
    """The diagnostic for a bracket that lacks its end on its line."""
    return _never_closed(source, opener, Span(source.file, end, end), "line")


def _never_closed(source: Source, opened: Token, span: Span, what: str = "file") -> Diagnostic:
    message = f"the {what} ends before `{opened.text}` is closed"
    labels = (Label(Span(source.file, opened.start, opened.end), "opened here"),)
    return Diagnostic("XEI0104", message, span, f"expected `{_CLOSING[opened.text]}`", labels)


def _opening_label(source: Source, token: Token, opened: Token | None) -> tuple[Label, ...]:
    """Where the open bracket is, if the wrong token looks like the bracket was forgotten."""
    if opened is None or (opened.text == "{") or (token.text not in _OPENING and token.kind == "COMMA"):
        return ()
    return (Label(Span(source.file, opened.start, opened.end), "opened here"),)


def _advice(expected: frozenset[str], before: tuple[Token, ...]) -> tuple[str, ...]:
    if expected == frozenset({"LPAR", "COLON"}) and before:
        name = before[-1].text
        return (f"a step is a call, `{name}(...)`; a label before a step ends in a colon, `{name}: ...`",)
    return ()


def _place(source: Source, site: Site) -> Span:
    """The wrong token; the end of the last one if that lacks something and the wrong one begins a line.

    A line that breaks off is the place of the mistake, not the good line below it.
    """
    token, before = site.token, site.before
    if token.kind == END or (before and site.begins_line):
        end = before[-1].end if before else 0
        if token.kind == END or _lacks(site):
            return Span(source.file, end, end)
    return Span(source.file, token.start, token.end)


def _lacks(site: Site) -> bool:
    """Whether it is the token before the wrong one that something is missing behind."""
    if site.machine.shift(site.stack, "WAIT") or site.machine.shift(site.stack, "PROTOCOL"):
        return False
    repair = site.repair
    if repair is not None and repair.back == 0:
        return repair.kind == "insert"
    return repair is not None or site.before[-1].text not in (",", "(", "[")


def _in_words(expected: frozenset[str], tables: Tables) -> str:
    """What may stand in a place, as a list for people: kinds of things first, then single words and signs."""
    rest = set(expected)
    parts: list[str] = []
    if rest >= {"PROTOCOL", "IMPORT"}:
        parts.append("a protocol, a procedure or an import")
        rest.clear()
    if rest >= _STEPS:
        parts.append("a declaration or step" if "PARAM" in rest else "a step")
        rest -= _STATEMENT_WORDS | {"NAME", "AFTER", "WITHIN", END}
    if rest >= _VALUE:
        parts.append("a value")
        rest -= _VALUE | {"NAME", "TRUE", "FALSE", "NOT", "MINUS", "COLON"}
    if "DOT" in rest:
        rest -= {"LPAR", "LSQB"}
    parts.extend(words for kind, words in _NAMES.items() if kind in rest)
    if parts:
        rest -= {"COLON"}
    operators = rest & _OPERATORS
    spelled = [text for text, kind in _spelled(tables) if kind in rest - operators]
    parts.extend(f"`{text}`" for text in sorted(spelled, key=lambda text: (text.isalpha(), text)))
    if END in rest and not parts:
        parts.append("the end of the text")
    if operators and not (parts and operators == {"DOT"}):
        signs = [f"`{text}`" for text, kind in _spelled(tables) if kind in operators]
        parts.extend(signs if len(signs) <= 2 else ["an operator"])
    if len(parts) > _MOST_NAMED + 1:
        parts = [*parts[:_MOST_NAMED], "something else"]
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} or {parts[-1]}"


def _spelled(tables: Tables) -> list[tuple[str, str]]:
    return sorted((tables.words | tables.signs | {":=": "UPDATE"}).items())


def _quoted(text: str) -> str:
    shown = text if len(text) <= 40 else text[:37] + "..."
    return f"`{shown}`"
