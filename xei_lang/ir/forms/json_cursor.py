"""Where a reader of JSON stands in its text, and what it says where that goes on otherwise than it may."""

from __future__ import annotations

import re
from typing import NoReturn

from xei_lang.diagnostics import Diagnostic, Label, Source, Span
from xei_lang.ir.forms.json_tree import NodeKind

NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?P<part>(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)")
WORD = re.compile(r"[+-]?[\w.]+|//|/\*|.", re.DOTALL)
"""What stands here as a person sees it, whether JSON has it or not."""
WORDS: dict[str, tuple[NodeKind, bool | None]] = {
    "true": ("boolean", True),
    "false": ("boolean", False),
    "null": ("null", None),
}

_SPACE = re.compile(r"[ \t\r\n]*")
_HABITS = {
    "'": "texts stand in double quotes",
    "//": "JSON has no comments",
    "/*": "JSON has no comments",
    "#": "JSON has no comments",
    "True": "write `true`",
    "False": "write `false`",
    "None": "write `null`",
    "NaN": "JSON has no word for what is not a number",
    "Infinity": "JSON has no word for infinity",
    "-Infinity": "JSON has no word for infinity",
}
"""What other languages write, and what to know of it here."""


class BrokenError(Exception):
    """Reading cannot go on; never leaves the reader of JSON."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class Cursor:
    """A place in a text, and in `found` what was said so far of values before it."""

    def __init__(self, source: Source) -> None:
        self.file = source.file
        self.text = source.text
        self.at = 0
        self.found: list[Diagnostic] = []

    def take(self, sign: str) -> bool:
        """Whether the next sign, past any space, is this one, which then is passed."""
        self.space()
        return self.here(sign)

    def here(self, sign: str) -> bool:
        """Whether this sign stands right here, which then is passed."""
        if not self.text.startswith(sign, self.at):
            return False
        self.at += len(sign)
        return True

    def space(self) -> None:
        """Pass any space."""
        found = _SPACE.match(self.text, self.at)
        assert found is not None
        self.at = found.end()

    def is_over(self) -> bool:
        """Whether the text ends here."""
        return self.at >= len(self.text)

    def since(self, start: int) -> Span:
        """From `start` to here."""
        return Span(self.file, start, self.at)

    def say(self, message: str, span: Span, label: str, labels: tuple[Label, ...] = ()) -> None:
        """Keep what is wrong with one value, and read on."""
        self.found.append(Diagnostic("XEI0110", message, span, label, labels))

    def fail(self, expected: str) -> NoReturn:
        """Raise BrokenError: what stands next is not what is `expected`."""
        self.space()
        found = WORD.match(self.text, self.at)
        word = short(found[0]) if found else ""
        span = Span(self.file, self.at, found.end() if found else self.at)
        message = f"`{word}` is not JSON" if word else "the text ends too early"
        if word in WORDS or NUMBER.fullmatch(word) or word in '{}[],:"':
            message = f"`{word}` cannot stand here"
        help_ = _HABITS.get(word)
        if word in ("}", "]") and expected.startswith("a "):
            help_ = "JSON has no comma behind the last one"
        raise BrokenError(
            Diagnostic("XEI0110", message, span, f"expected {expected}", help=(help_,) if help_ else ())
        )


def short(text: str) -> str:
    """A text as a message quotes it: cut where it is long."""
    return text if len(text) <= 60 else f"{text[:57]}..."
