"""What pydantic found, said as diagnostics: in the file's words, at the place, with the way out."""

from __future__ import annotations

import re
from types import UnionType
from typing import Any, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span, did_you_mean
from xei_lang.profiles.yaml_tree import Node, Path

_KINDS = {
    "string_type": "a text",
    "int_type": "a whole number",
    "float_type": "a number",
    "bool_type": "`true` or `false`",
    "list_type": "a list",
    "tuple_type": "a list",
    "dict_type": "a mapping of keys to values",
    "model_type": "a mapping of keys to values",
    "model_attributes_type": "a mapping of keys to values",
}
_A_NAME = "a name: small letters, digits and `_`, beginning with a letter"
_PATTERNS = {
    "^[A-Za-z]": "one to four letters",
    "^[0-9]{4}-": "a day, such as `2026-11-20`",
    "^[0-9a-f]{64}": "a SHA-256: 64 digits and letters from a to f",
    r"^\d{4}-": "a time in UTC, such as `2026-11-20T10:15:00Z`",
}
_COUNTED = {
    "too_short": "at least {min_length} entries",
    "too_long": "at most {max_length} entries",
    "string_too_short": "at least {min_length} letters",
    "string_too_long": "at most {max_length} letters",
}

_WORD = re.compile(r"'([^']*)'")
_LISTED = 8
"""So many words are listed in a headline."""


def explain(error: ValidationError, root: Node, model: type[BaseModel]) -> Diagnostics:
    """One diagnostic for each fault; of the branches of a union, the first that speaks."""
    found: list[Diagnostic] = []
    seen: set[tuple[Span | None, str]] = set()
    for details in error.errors(include_url=False):
        diagnostic = _explain_one(details, root, model)
        place = (diagnostic.span, diagnostic.code)
        is_no_quantity = diagnostic.code == "XEI0609" and (diagnostic.span, "XEI0610") in seen
        if place not in seen and not is_no_quantity:
            seen.add(place)
            found.append(diagnostic)
    return tuple(found)


def _explain_one(details: ErrorDetails, root: Node, model: type[BaseModel]) -> Diagnostic:
    path = _path(details["loc"], root, missing=details["type"] == "missing")
    kind = details["type"]
    if kind == "extra_forbidden":
        return _unknown_key(path, root, model)
    if kind == "missing":
        return _missing_key(path, root)
    if kind == "quantity":
        context = details.get("ctx", {})
        return Diagnostic(
            "XEI0610",
            details["msg"],
            root.span_of(*path),
            label="expected a quantity",
            help=(context["help"],),
        )
    if path == ("version",):
        return Diagnostic(
            "XEI0611",
            f"version {root.find(path).scalar} of this profile is not one that xei reads",
            root.span_of(*path),
            label="expected 1",
            help=("write `version: 1`",),
        )
    return _wrong_value(details, path, root)


def _path(loc: tuple[int | str, ...], root: Node, missing: bool) -> Path:
    """The part of pydantic's path that the file has; pydantic adds names of union branches and `[key]`."""
    path: list[int | str] = []
    node = root
    for position, step in enumerate(loc):
        below = node.child(step)
        if below is None:
            if missing and position == len(loc) - 1:
                path.append(step)
            continue
        path.append(step)
        node = below
    return tuple(path)


def _unknown_key(path: Path, root: Node, model: type[BaseModel]) -> Diagnostic:
    known = known_keys(model, path[:-1])
    key = str(path[-1])
    near = did_you_mean(key, known)
    where = f" of `{path[-2]}`" if len(path) > 1 and isinstance(path[-2], str) else ""
    help_ = (
        f"did you mean `{near[0]}`?" if near else "known here: " + ", ".join(f"`{name}`" for name in known)
    )
    return Diagnostic(
        "XEI0607", f"`{key}` is not a key{where}", root.key_span(*path), label="unknown key", help=(help_,)
    )


def _missing_key(path: Path, root: Node) -> Diagnostic:
    key, owner = path[-1], path[:-1]
    what = f"`{owner[-1]}` has" if owner and isinstance(owner[-1], str) else "this has"
    span = root.span_of(*owner) if owner else Span(root.span.file, root.span.start, root.span.start + 1)
    return Diagnostic(
        "XEI0608",
        f"{what} no `{key}`",
        span,
        label=f"expected a `{key}` in here",
        help=(f"add `{key}: ...`",),
    )


def _wrong_value(details: ErrorDetails, path: Path, root: Node) -> Diagnostic:
    node = root.find(path)
    name = next((f"`{step}`" for step in reversed(path) if isinstance(step, str)), "this")
    shown = "nothing" if node.kind == "scalar" and node.scalar is None else _shown(node)
    wanted = _KINDS.get(details["type"])
    if wanted:
        return Diagnostic(
            "XEI0609",
            f"{name} must be {wanted}, found {shown}",
            root.span_of(*path),
            label=f"expected {wanted}",
        )
    if details["type"] in _COUNTED:
        context = details.get("ctx", {})
        wanted = _COUNTED[details["type"]].format(**context)
        wanted = wanted.replace(" 1 letters", " 1 letter").replace(" 1 entries", " 1 entry")
        length = context.get("actual_length", len(str(node.scalar)))
        return Diagnostic(
            "XEI0609", f"{name} must have {wanted}, found {length}", root.span_of(*path),
            label=f"expected {wanted}",
        )  # fmt: skip
    reason = details["msg"].removeprefix("Input should ").removeprefix("Value error, ")
    if details["type"] == "string_pattern_mismatch":
        pattern = details.get("ctx", {}).get("pattern", "")
        wanted = next((words for start, words in _PATTERNS.items() if pattern.startswith(start)), _A_NAME)
        reason = f"must be {wanted}"
        span = root.key_span(*path) if details["loc"][-1] == "[key]" else root.span_of(*path)
        return Diagnostic(
            "XEI0609",
            f"{shown if node.kind == 'scalar' else name} {reason}",
            span,
            label=f"expected {wanted}",
        )
    words = _WORD.findall(str(details.get("ctx", {}).get("expected", "")))
    if details["type"] == "literal_error" and len(words) > _LISTED:
        near = did_you_mean(str(node.scalar), words)
        known = "known are " + ", ".join(f"`{word}`" for word in words)
        return Diagnostic(
            "XEI0609",
            f"{shown} is no {name}",
            root.span_of(*path),
            label=f"expected one of {len(words)} words",
            help=(f"did you mean `{near[0]}`?" if near else known,),
        )
    reason = reason.removeprefix("be ")
    return Diagnostic(
        "XEI0609", f"{name} must be {reason}, found {shown}", root.span_of(*path), label=f"expected {reason}"
    )


def _shown(node: Node) -> str:
    if node.kind == "scalar":
        return f"`{str(node.scalar)[:40]}`"
    return "a list" if node.kind == "list" else "a mapping"


def known_keys(model: type[BaseModel], path: Path) -> tuple[str, ...]:
    """The keys that the model at this path has."""
    found = _model_at(model, path)
    if found is None:
        return ()
    return tuple(field.alias or name for name, field in found.model_fields.items())


def _model_at(annotation: Any, path: Path) -> type[BaseModel] | None:
    """The pydantic model that validates what stands at a path below a type."""
    while hasattr(annotation, "__metadata__"):
        annotation = annotation.__origin__
    if get_origin(annotation) in (Union, UnionType):
        branches = (_model_at(branch, path) for branch in get_args(annotation))
        return next((branch for branch in branches if branch is not None), None)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        if not path:
            return annotation
        fields = {field.alias or name: field for name, field in annotation.model_fields.items()}
        field = fields.get(str(path[0]))
        return _model_at(field.annotation, path[1:]) if field else None
    arguments = get_args(annotation)
    if get_origin(annotation) in (dict, list) and path:
        return _model_at(arguments[-1], path[1:])
    return None
