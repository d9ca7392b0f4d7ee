"""Saying what is wrong with a text that does not follow the grammar, in the words of the one who wrote it."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic, Label, Source, Span
from xei_lang.syntax.driver import Driver
from xei_lang.syntax.habits import find_habit
from xei_lang.syntax.lexer import Token
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


def explain(source: Source, start: str, token: Token, driver: Driver) -> Diagnostic:
    """The diagnostic for the first token that cannot stand where it stands.

    A habit that is known (a wrong unit, `;`) is named as such.
    """
    before = driver.tokens(source.text, token.start)
    habit = find_habit(before, token, source.text)
    if habit is not None:
        span = Span(source.file, habit.start, habit.end)
        return Diagnostic(
            "XEI0104", habit.message, span, habit.label, help=habit.help, fix=habit.fix(source.file)
        )
    terminals = driver.expected(before, start)
    expected = _in_words(terminals, driver.tables)
    after = f" after {_quoted(before[-1].text)}" if before else ""
    span = _place(source, token, before)
    opened = _unclosed(before)
    if token.kind == END and opened is not None:
        message = f"the file ends before `{opened.text}` is closed"
        labels = (Label(Span(source.file, opened.start, opened.end), "opened here"),)
        return Diagnostic("XEI0104", message, span, f"expected `{_CLOSING[opened.text]}`", labels)
    found = "the text ends" if token.kind == END else f"found {_quoted(token.text)}"
    message = f"expected {expected}{after}, but {found}"
    labels = _opening_label(source, token, opened)
    return Diagnostic(
        "XEI0104", message, span, f"expected {expected}", labels, help=_advice(terminals, before)
    )


def _opening_label(source: Source, token: Token, opened: Token | None) -> tuple[Label, ...]:
    """Where the open bracket is, if the wrong token looks like the bracket was forgotten."""
    if opened is None or (opened.text == "{") or (token.text not in _OPENING and token.kind == "COMMA"):
        return ()
    return (Label(Span(source.file, opened.start, opened.end), "opened here"),)


def _advice(expected: frozenset[str], before: list[Token]) -> tuple[str, ...]:
    if expected == frozenset({"LPAR", "COLON"}) and before:
        name = before[-1].text
        return (f"a step is a call, `{name}(...)`; a label before a step ends in a colon, `{name}: ...`",)
    return ()


def _place(source: Source, token: Token, before: list[Token]) -> Span:
    """The token; the end of the last word where the text ends too early, so that a written line is shown."""
    if token.kind == END:
        end = before[-1].end if before else 0
        return Span(source.file, end, end)
    return Span(source.file, token.start, token.end)


def _unclosed(tokens: list[Token]) -> Token | None:
    """The innermost bracket that is still open after these tokens."""
    opened: list[Token] = []
    for token in tokens:
        if token.text in _CLOSING:
            opened.append(token)
        elif opened and token.text in _OPENING and opened[-1].text == _OPENING[token.text]:
            opened.pop()
    return opened[-1] if opened else None


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
