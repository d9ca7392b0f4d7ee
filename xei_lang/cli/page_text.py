"""The pages of docs/errors/ as text for a terminal: of Markdown just what those pages use."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator

_FRONT = re.compile(r"\A---\n.*?^---\n+", re.DOTALL | re.MULTILINE)
_PIECE = re.compile(r"^```[a-z]*\n(?P<code>[\s\S]*?)^```$|(?P<text>(?:^(?!```).+\n?)+)", re.MULTILINE)
_INDENT = "    "


def page_text(markdown: str, width: int, color: bool = False) -> str:
    """A page, its paragraphs wrapped to `width` columns and its blocks indented; headings bold if `color`."""
    pieces = _pieces(_FRONT.sub("", markdown), width, color)
    return "\n\n".join(pieces) + "\n"


def _pieces(markdown: str, width: int, color: bool) -> Iterator[str]:
    for found in _PIECE.finditer(markdown):
        if found["code"] is not None:
            yield textwrap.indent(found["code"].rstrip("\n"), _INDENT)
        elif found["text"].startswith("#"):
            heading = _wrapped(found["text"].lstrip("# "), width)
            yield f"\x1b[1m{heading}\x1b[0m" if color else heading
        else:
            yield _wrapped(found["text"], width)


def _wrapped(text: str, width: int) -> str:
    return textwrap.fill(" ".join(text.split()), width, break_long_words=False, break_on_hyphens=False)
