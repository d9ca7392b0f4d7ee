"""JSON that can be shown anywhere: whatever does not print is written as an escape."""

from __future__ import annotations

import json
import re
from typing import Any

_SUSPECT = re.compile(r"[^\x20-\x7e\n]")


def json_text(value: Any) -> str:
    """The value as indented JSON, ending in a line break; readable letters stay as they are.

    JSON itself demands escapes only below U+0020; a terminal also obeys others (U+009B begins an escape
    sequence, U+202E turns the writing direction), and lone surrogates have no UTF-8.
    """
    return _SUSPECT.sub(_escaped, json.dumps(value, indent=2, ensure_ascii=False)) + "\n"


def _escaped(match: re.Match[str]) -> str:
    char = match[0]
    return char if char.isprintable() else json.dumps(char)[1:-1]
