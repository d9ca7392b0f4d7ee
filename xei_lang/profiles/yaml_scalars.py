"""What an unquoted word of a profile means: less than YAML 1.1 makes of it, and no surprise.

YAML 1.1 reads `on` and `yes` as true, `1:30` as 90 (base 60), `010` as 8 and `1_000` as 1000. Here these are
refused, with the way to write what was meant; dates stay text.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from xei_lang.profiles.yaml_tree import Scalar

_INT = re.compile(r"[-+]?(0|[1-9][0-9]{0,17})")
_FLOAT = re.compile(r"[-+]?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?")
_OTHER_BOOL = re.compile(r"yes|no|on|off|y|n|true|false", re.IGNORECASE)
_SEXAGESIMAL = re.compile(r"[-+]?[0-9]+(:[0-5]?[0-9])+(\.[0-9]*)?")
_OTHER_NUMBER = re.compile(
    r"[-+]?(0[0-9_]+|0x[0-9a-f_]+|0b[01_]+|0o[0-7]+|[0-9]+(_[0-9]+)+(\.[0-9_]*)?|\.[0-9]+|[0-9]+\.)",
    re.IGNORECASE,
)
_NOT_FINITE = re.compile(r"[-+]?\.inf|\.nan", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Surprise:
    """An unquoted word that YAML reads otherwise than people do: what YAML makes of it, and what to write."""

    reads_as: str
    write: str
    label: str = "quote it, or say it plainly"


def read_plain(text: str) -> Scalar | Surprise:
    """The value of an unquoted scalar."""
    if text in ("", "null", "~"):
        return None
    if text in ("true", "false"):
        return text == "true"
    if _INT.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text) and len(text) <= 40:
        return float(text)
    return _surprise(text) or text


def _surprise(text: str) -> Surprise | None:
    if _OTHER_BOOL.fullmatch(text):
        truth = "true" if text.lower() in ("yes", "on", "y", "true") else "false"
        return Surprise("a truth value", f'`{truth}` for a truth value, `"{text}"` for the word')
    if _SEXAGESIMAL.fullmatch(text):
        return Surprise("a number in base 60", f'a quantity such as `90 s`, or `"{text}"` for the text')
    if _NOT_FINITE.fullmatch(text):
        return Surprise("a number that is not finite", "what was measured", "no finite number")
    if _OTHER_NUMBER.fullmatch(text):
        return Surprise(
            "a number in a way that readers do not expect", f'the number in plain decimals, or `"{text}"`'
        )
    return None
