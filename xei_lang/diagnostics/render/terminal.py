"""Making any text safe and measurable on a terminal."""

from __future__ import annotations

TAB = "    "
_STYLES = {"error": "1;31", "warning": "1;33", "info": "1;36", "gutter": "1;34", "bold": "1"}


def visible(text: str) -> str:
    """Text with tabs widened and all that does not print (escape codes, direction marks) spelled out."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_visible_char(char) for char in text)


def visible_lines(text: str) -> list[str]:
    """Like `visible`, for a text whose own line breaks are kept."""
    return [visible(line) for line in text.split("\n")]


def columns(text: str) -> int:
    """How many columns a visible text takes: two for wide East Asian characters, none for combining marks."""
    if text.isascii():
        return len(text)
    import unicodedata

    width = 0
    for char in text:
        if not unicodedata.combining(char):
            width += 2 if unicodedata.east_asian_width(char) in "WF" else 1
    return width


def paint(text: str, style: str, color: bool) -> str:
    """The text in one of the styles, where colours are wanted."""
    return f"\x1b[{_STYLES[style]}m{text}\x1b[0m" if color and text else text


def _visible_char(char: str) -> str:
    if char == "\t":
        return TAB
    return char if char.isprintable() else f"<U+{ord(char):04X}>"
