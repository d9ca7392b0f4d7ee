"""Keys of an answer that the contract does not have: which, where, and what was meant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from xei_lang.diagnostics import did_you_mean

_UNITS = (
    "unit",
    "units",
    "length_unit",
    "length_units",
    "position_unit",
    "position_units",
    "scale",
    "scale_m",
)
_LONGEST = 80


def stray_key(form: type[BaseModel], error: ValidationError) -> tuple[str, str] | None:
    """The first key that a form does not have, in words, and the way out; None where there is none."""
    found = next((one for one in error.errors(include_url=False) if one["type"] == "extra_forbidden"), None)
    if found is None:
        return None
    *path, key = found["loc"]
    name = _printable(str(key))
    where = f" (`{_text([*path, name])}`)" if path else ""
    words = f"says `{name}`{_value(found['input'])}{where}, which the contract does not have"
    if name.lower() in _UNITS:
        return (
            words,
            f"all lengths are in metres, and angles in a rotation matrix: send these, and no `{name}`",
        )
    near = did_you_mean(name, _keys(form, path))
    return words, f"did you mean `{near[0]}`?" if near else f"leave `{name}` out"


def _value(given: object) -> str:
    """A word or number, which tells what was meant; nothing of what is longer."""
    is_short = isinstance(given, (str, int, float)) and len(str(given)) <= 20
    return f" as `{_printable(str(given))}`" if is_short else ""


def _keys(form: type[BaseModel], path: Sequence[int | str]) -> tuple[str, ...]:
    """The keys of the model at a place of a form; none where the place is no model's."""
    for part in path:
        if isinstance(part, str):
            inner = form.model_fields.get(part)
            models = tuple(_models(inner.annotation)) if inner is not None else ()
            if not models:
                return ()
            form = models[0]
    return tuple(form.model_fields)


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    """The models in a type such as `Annotated[list[Model], ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from _models(inner)


def _text(path: Sequence[int | str]) -> str:
    """`objects[0].units`."""
    parts = [f"[{part}]" if isinstance(part, int) else f".{part}" for part in path]
    return "".join(parts).removeprefix(".")


def _printable(text: str) -> str:
    return "".join(letter if letter.isprintable() and letter != "`" else " " for letter in text[:_LONGEST])
