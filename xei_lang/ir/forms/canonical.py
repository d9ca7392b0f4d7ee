"""The one way that xei writes JSON, so that the same value always gives the same bytes.

Keys keep the order in which the form puts them (people read forms, so `version` comes first); floats are the
shortest text that reads back as the same number; what JSON has no word for (NaN, infinity) is refused.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import cast

Json = Mapping[str, "Json"] | Sequence["Json"] | str | int | float | bool | None

_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
_SCALARS = (str, int, float, bool, type(None))


def dumps(value: Json) -> str:
    """A document: one space of indent a level, a container of scalars on one line, a newline at the end.

    Raises ValueError for NaN and infinity (write `null` or leave the key out) and TypeError for what is no
    `Json` value or a key that is no string: both are faults of the form, never of its input.
    """
    parts: list[str] = []
    _write(value, "\n", parts)
    parts.append("\n")
    return "".join(parts)


def line(value: Json) -> str:
    """The same value on one line without a line break, as JSON Lines want it. Raises like `dumps`."""
    _check_keys(value)
    return _flat(value)


def _flat(value: Json) -> str:
    return _ENCODER.encode(value)


def _write(value: Json, newline: str, parts: list[str]) -> None:
    if _is_row(value):
        parts.append(repr(value))
    elif isinstance(value, Mapping):
        _need_text_keys(value)
        if all(isinstance(item, _SCALARS) for item in value.values()):
            parts.append(_flat(dict(value)))
            return
        _write_items(value, newline, parts)
    elif isinstance(value, (list, tuple)) and not all(isinstance(item, _SCALARS) for item in value):
        inner = newline + " "
        for index, item in enumerate(value):
            parts.append(("," if index else "[") + inner)
            _write(item, inner, parts)
        parts.append(newline + "]")
    else:
        parts.append(_flat(value))


def _is_row(value: Json) -> bool:
    """Whether this is a list of finite floats, as trajectories have many: Python writes it as JSON does."""
    if not isinstance(value, list):
        return False
    return set(map(type, value)) == {float} and all(map(math.isfinite, cast("list[float]", value)))


def _write_items(value: Mapping[str, Json], newline: str, parts: list[str]) -> None:
    inner = newline + " "
    for index, (key, item) in enumerate(value.items()):
        parts.append(("," if index else "{") + inner + _flat(key) + ": ")
        _write(item, inner, parts)
    parts.append(newline + "}")


def _check_keys(value: Json) -> None:
    if isinstance(value, Mapping):
        _need_text_keys(value)
        for item in value.values():
            _check_keys(item)
    elif isinstance(value, (list, tuple)):
        for item in value:
            _check_keys(item)


def _need_text_keys(value: Mapping[str, Json]) -> None:
    for key in value:
        if not isinstance(key, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise TypeError(f"a JSON key must be text, not {key!r}")
