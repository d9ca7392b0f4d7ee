"""Words of other languages."""

from __future__ import annotations

import re
from collections.abc import Sequence

from xei_lang.syntax.habit import Habit, instead
from xei_lang.syntax.lexer import STRAY, Token

_INSTEAD = {
    "elif": "else if",
    "elsif": "else if",
    "elseif": "else if",
    "def": "procedure",
    "function": "procedure",
    "func": "procedure",
    "fn": "procedure",
    "var": "let",
    "const": "let",
    "include": "import",
    "assert": "require",
    "sleep": "wait",
    "foreach": "for",
}
"""Words that stand for one of the language's own, if the grammar then goes on."""

_ADVICE = {
    "while": "loops are bounded: `repeat 5 times until ready { }`",
    "loop": "loops are bounded: `repeat 5 times { }`",
    "return": "a procedure gives nothing back; a `measure` has a value",
    "break": "a loop ends by its `until`: `repeat 5 times until done { }`",
    "continue": "put the rest of the turn into an `if`",
    "try": 'there are no exceptions; `if` on a `measure`, or `stop "why"`, decide what happens',
    "switch": "write `if ... { } else if ... { }`",
    "class": "a file holds protocols and procedures",
    "from": 'procedures of another file come by `import "common/caps.xei"`',
    "async": "branches that overlap stand in `parallel { { } { } }`",
    "end": "a block ends in `}`",
    "endif": "a block ends in `}`",
    "begin": "a block begins with `{`",
    "unless": "write `if not ... { }`",
    "lambda": "there are no anonymous functions; write a `procedure`",
    "print": "text for people is a `note`, or a `confirm` that waits for an answer",
    "with": "a block that bounds its steps is `keep ... { }` or `do { } within 5 min`",
    "then": "a block begins with `{`",
}
_BRACE = re.compile(r"[ \t]*(?=\{)")
_KEYWORDS = frozenset(
    [
        "xei",
        "import",
        "table",
        "as",
        "protocol",
        "procedure",
        "param",
        "profile",
        "object",
        "given",
        "contains",
        "of",
        "at",
        "in",
        "for",
        "if",
        "else",
        "repeat",
        "times",
        "until",
        "do",
        "keep",
        "pause",
        "parallel",
        "unordered",
        "start",
        "await",
        "stop",
        "leave",
        "measure",
        "confirm",
        "let",
        "require",
        "unmapped",
        "because",
        "note",
        "within",
        "after",
        "by",
        "wait",
        "step",
        "and",
        "or",
        "not",
        "true",
        "false",
    ]
)


def find_word_habit(before: Sequence[Token], token: Token) -> Habit | None:
    """The habit behind a wrong word, or behind the word before it, which passed for a name."""
    if not before:
        return _word(token, ())
    return _word(before[-1], before[:-1]) or _word(token, before)


def _word(token: Token, before: Sequence[Token]) -> Habit | None:
    if token.kind != "NAME" or (before and before[-1].text in (".", "let", "param", "object", "(", ",")):
        return None
    lower = token.text.lower()
    if lower in _INSTEAD:
        right = _INSTEAD[lower]
        return _own_word(token, f"expected `{right}`", (f"write `{right}`",), right)
    if lower in _KEYWORDS and lower != token.text:
        return _own_word(token, f"expected `{lower}`", ("words of the language are in small letters",), lower)
    if token.text in _ADVICE:
        return _own_word(token, "no such statement", (_ADVICE[token.text],), None)
    return None


def _own_word(token: Token, label: str, help_: tuple[str, ...], mend: str | None) -> Habit:
    return Habit(f"`{token.text}` is no word here", label, token.start, token.end, help_, mend)


def find_pair_habit(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """The habit that shows in a word and what stands beside it."""
    if not before:
        return None
    return (
        _needless(before, token, text)
        or _repeat(before, token)
        or _range(before, token)
        or _import(before[-1], token)
        or _late_label(before, token)
    )


def _needless(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`wait for 10 min`, `if a then {`, `for x in xs do {`, `f"..."`."""
    previous = before[-1]
    if previous.text == "for" and len(before) > 1 and before[-2].text == "wait":
        return _left_out(previous, "`wait` stands before its time alone", token.start)
    if token.text in ("then", "do") and (brace := _BRACE.match(text, token.end)):
        return _left_out(token, f"no `{token.text}` stands before a block", brace.end())
    if token.text in ("f", "r", "b") and text.startswith('"', token.end):
        message = f"`{token.text}` before a text means nothing"
        help_ = ("a text stands as it is written; leave the letter out",)
        return Habit(message, "not needed", token.start, token.end, help_)
    return None


def _repeat(before: Sequence[Token], token: Token) -> Habit | None:
    """`repeat 3 {` and `repeat 3x {`."""
    if token.text == "{" and len(before) > 1 and before[-2].text == "repeat":
        return Habit("`repeat` lacks its `times`", "expected `times`", token.start, token.end, (), "times {")
    number = token.text.rstrip("xX")
    if before[-1].text == "repeat" and token.kind == STRAY and number.isdigit():
        right = f"{number} times"
        message = f"`{token.text}` is not a number"
        return Habit(message, f"expected `{right}`", token.start, token.end, (), right)
    return None


def _range(before: Sequence[Token], token: Token) -> Habit | None:
    """`for i in 1 to 8`."""
    behind_number = before[-1].kind in ("NUMBER", "QUANTITY")
    if token.text != "to" or not behind_number or not any(other.text == "in" for other in before[-4:]):
        return None
    return instead("to", "..", token.start, "a range is written `1 .. 8`")


def _import(previous: Token, token: Token) -> Habit | None:
    """`import caps`."""
    if previous.text != "import" or token.kind != "NAME":
        return None
    right = f'"{token.text}.xei"'
    help_ = (f"name a file by its path: `import {right}`",)
    label = "expected a text in quotes"
    return Habit("an import names a file", label, token.start, token.end, help_, right, certain=False)


def _left_out(word: Token, message: str, until: int) -> Habit:
    return Habit(message, "not needed", word.start, until, (f"leave `{word.text}` out",), "")


def _late_label(before: Sequence[Token], token: Token) -> Habit | None:
    """`warm: start heat()`."""
    if before[-1].text != "start" or len(before) < 3 or before[-2].text != ":":
        return None
    label, start = before[-3], before[-1]
    return Habit(
        "the label of a `start` stands behind that word",
        "expected a label after `start`",
        label.start,
        start.end,
        (f"write `start {label.text}: {token.text}`",),
        f"start {label.text}:",
    )
