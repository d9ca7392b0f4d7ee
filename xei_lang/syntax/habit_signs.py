"""Signs of other languages, of word processors and of lists."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from xei_lang.syntax.habit import Habit, instead, short
from xei_lang.syntax.layout import line_end
from xei_lang.syntax.lexer import STRAY, Token

_VALUES = frozenset({"NAME", "NUMBER", "QUANTITY", "STRING", "RPAR", "RSQB"})
_PROSE = re.compile(r"[ \t]*[A-Za-z][\w'-]*[.,:;!?]?[ \t]+[A-Za-z]")
"""Two words with nothing between them but a space, as no expression has them."""
_SIGNS = {"&": "and", "|": "or", "&&": "and", "||": "or"}
_INSTEAD = {
    ("<", ">"): ("!=", "write `!=`"),
    ("..", "."): ("..", "write `..`; both ends are included"),
}
_NOTHING = {
    ("*", "*"): ("there is no power `**`", "multiply"),
    ("-", ">"): ("`->` means nothing here", "what goes where is said by named arguments: `pour(source=a)`"),
    ("..", "<"): ("a range always holds both of its ends", "write `0 .. 7` for eight values"),
}
_TYPED = {
    "\N{GREATER-THAN OR EQUAL TO}": ">=",
    "\N{LESS-THAN OR EQUAL TO}": "<=",
    "\N{NOT EQUAL TO}": "!=",
    "\N{MULTIPLICATION SIGN}": "*",
    "\N{MIDDLE DOT}": "*",
    "\N{DIVISION SIGN}": "/",
    "\N{MINUS SIGN}": "-",
    "\N{HORIZONTAL ELLIPSIS}": "..",
    "!": "not ",
}
_DASHES = "\N{EN DASH}\N{EM DASH}"
_SPACES = "\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}\N{THIN SPACE}\N{ZERO WIDTH SPACE}"
_OPENING_QUOTES = (
    "\N{LEFT SINGLE QUOTATION MARK}\N{LEFT DOUBLE QUOTATION MARK}\N{DOUBLE LOW-9 QUOTATION MARK}"
)
_QUOTES = f"'{_OPENING_QUOTES}\N{RIGHT SINGLE QUOTATION MARK}\N{RIGHT DOUBLE QUOTATION MARK}"
_QUOTED = re.compile(rf'[{_QUOTES}]([^{_QUOTES}"\n\\]*)[{_QUOTES}](?!\w)')


def find_sign_habit(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """The habit behind a wrong sign; None where none is known."""
    joined = bool(before) and before[-1].end == token.start
    return (
        _comment(before, token, text)
        or _semicolon(before, token, text)
        or _changed(before, token, text)
        or (_pair(before[-1], token) if joined else None)
        or _and_or(token, text)
        or _list_mark(before, token, text)
        or _block(before, token, text)
        or (_typed(token) or _stray(token, text) if token.kind == STRAY else None)
    )


def _and_or(token: Token, text: str) -> Habit | None:
    """`&`, `&&`, `|`, `||`, `=>`, `=<`."""
    if token.text == "=" and text[token.end : token.end + 1] in (">", "<"):
        sign = text[token.end]
        return instead(f"={sign}", f"{sign}=", token.start, f"write `{sign}=`")
    if token.text not in _SIGNS:
        return None
    right = _SIGNS[token.text]
    doubled = len(token.text) == 1 and text.startswith(token.text, token.end)
    return instead(token.text * (1 + doubled), right, token.start, f"write `{right}`")


def _comment(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`// rest` and `/* rest */`."""
    if token.text == "/" and text.startswith("*", token.end):
        help_ = ("a comment is a line that begins with `#`",)
        return Habit("`/*` begins no comment here", "expected `#`", token.start, token.end + 1, help_)
    beside = (text[token.start - 1 : token.start], text[token.end : token.end + 1])
    if token.text == "//" or (token.text == "/" and "/" in beside):
        return _slashes(before, token, text)
    return None


def _changed(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`x++`."""
    named = bool(before) and before[-1].kind == "NAME"
    if not named or token.text not in ("+", "-") or not text.startswith(token.text, token.end):
        return None
    help_ = ("a name keeps its value; make a new one with `let`",)
    message = f"`{token.text * 2}` changes nothing here"
    return Habit(message, "no such operator", token.start, token.end + 1, help_)


def _slashes(before: Sequence[Token], token: Token, text: str) -> Habit:
    """A comment of C; behind a value it may be a division of Python, unless several words follow."""
    start = token.start - (text[token.start - 1 : token.start] == "/")
    before = [other for other in before if other.end <= start]
    end = line_end(text, start)
    begins_line = not text[text.rfind("\n", 0, start) + 1 : start].strip()
    behind_value = bool(before) and before[-1].kind in _VALUES and not begins_line
    certain = not behind_value or bool(_PROSE.match(text, start + 2, end))
    return replace(instead("//", "#", start, "write `#`", certain=certain), through=end)


def _semicolon(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """Left out, but a number stays apart from the next word: `5; m()` is no quantity."""
    if token.text != ";":
        return None
    rest = text[token.end : line_end(text, token.end)].strip()
    mend = ""
    if before and before[-1].kind == "NUMBER" and rest:
        line = text.rfind("\n", 0, token.start) + 1
        mend = "\n" + text[line : line + len(text[line:]) - len(text[line:].lstrip())]
    help_ = ("leave it out: a step ends where the next begins",)
    return Habit("`;` has no place in a protocol", "not needed", token.start, token.end, help_, mend)


def _pair(previous: Token, token: Token) -> Habit | None:
    pair = (previous.text, token.text)
    start, end = previous.start, token.end
    if pair in _INSTEAD:
        return instead("".join(pair), *_INSTEAD[pair][:1], start, _INSTEAD[pair][1])
    if pair in _NOTHING:
        message, help_ = _NOTHING[pair]
        return Habit(message, "no such sign", start, end, (help_,))
    if token.text[:1] == '"' and previous.text == '""':
        help_ = "text for readers is a comment: `##` before what it explains, or `note`"
        return Habit("a text stands in one pair of quotes", "three quotes", start, token.start + 1, (help_,))
    return None


def _list_mark(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`1. pick(...)`, `- pick(...)`: steps as a list in a document."""
    begins = not before or "\n" in text[before[-1].end : token.start]
    if not begins:
        return None
    mark = re.compile(r"(?:[0-9]+[.):]|[-*\N{BULLET}\N{EN DASH}])[ \t]*(?=[A-Za-z_])").match(
        text, token.start
    )
    if mark is None:
        return None
    written = mark[0].rstrip()
    return Habit(
        f"steps have no list mark such as `{written}`",
        "not needed",
        token.start,
        mark.end(),
        ("leave it out: steps happen in the order in which they are written",),
        "",
    )


_HEADERS = frozenset({"FOR", "IF", "PROTOCOL", "PROCEDURE", "KEEP", "REPEAT", "ELSE", "PARALLEL", "DO"})


def _block(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`for x in xs:`, and a value in braces."""
    rest = text[token.end : line_end(text, token.end)].partition("#")[0].strip()
    if token.text == ":" and not rest and any(other.kind in _HEADERS for other in before[-8:]):
        message = "a block begins with `{`, not with `:`"
        help_ = ("a block stands in braces: `{` here, and `}` on a line behind the block",)
        return Habit(message, "expected `{`", token.start, token.end, help_, "{", certain=False)
    if token.text == "{" and before and before[-1].text in ("=", "(", ",", "[", "in", "+"):
        help_ = ("write a list `[...]`, an argument for each key, or `import table` from a CSV file",)
        return Habit("there are no dictionaries", "expected a value", token.start, token.end, help_)
    return None


def _typed(token: Token) -> Habit | None:
    """What a word processor, or a book, has for a sign of the language."""
    first = token.text[0]
    if token.text in _TYPED:
        right = _TYPED[token.text]
        return instead(token.text, right, token.start, f"write `{right.strip()}`")
    if first in _DASHES:
        return instead(
            token.text, "..", token.start, "write a range as `4 .. 8`, a minus as `-`", certain=False
        )
    if first in _SPACES:
        message = f"a space of another kind, U+{ord(first):04X}, stands here"
        help_ = ("it comes from a text processor; write an ordinary space",)
        return Habit(message, "not a space", token.start, token.end, help_, " ")
    return None


def _stray(token: Token, text: str) -> Habit:
    first = token.text[0]
    if first in _QUOTES:
        return _quotes(token, text)
    if first != '"':
        return _unknown(token)
    help_ = ("a text stays on one line",)
    label = 'expected `"` before the end of the line'
    mend = _closed(token.text)
    return Habit("a text is not closed", label, token.start, token.end, help_, mend, certain=False)


def _closed(written: str) -> str:
    """A text that was not closed, closed before the brackets and braces at the end of its line."""
    text = written.rstrip(" \t\r)]},{")
    return f'{text}"{written[len(text) :]}'


_HELP = {
    "%": ("`%` is a unit, as in `70 %`; there is no remainder",),
    "^": ("there is no power; multiply",),
    "\N{PLUS-MINUS SIGN}": ("write a range: `36 degC .. 38 degC`",),
    "~": ("write a range: `9 min .. 11 min`",),
    "\N{ALMOST EQUAL TO}": ("write a range: `9 min .. 11 min`",),
    "?": ("a choice is written `if a { } else { }`",),
    "@": ("concentrations stand behind `at`: `at 5 mg/mL`",),
    "$": ("names stand as they are, without a sign",),
}


def _unknown(token: Token) -> Habit:
    if token.text[0].isdigit():
        message = f"`{short(token.text)}` is neither a number nor a name"
        return Habit(message, "a name begins with a letter", token.start, token.end)
    shown = token.text if token.text.isprintable() else f"U+{ord(token.text[0]):04X}"
    help_ = _HELP.get(token.text, ())
    message = f"`{short(shown)}` is no part of the language"
    return Habit(message, "cannot stand here", token.start, token.end, help_)


def _quotes(token: Token, text: str) -> Habit:
    message, label = "a text stands in straight double quotes", 'expected `"`'
    quoted = _QUOTED.match(text, token.start)
    if quoted is None:
        return Habit(message, label, token.start, token.start + 1)
    mended = f'"{quoted[1]}"'
    return Habit(message, label, token.start, quoted.end(), (f"write `{short(mended)}`",), mended)
