"""Places that profiles name in words, and the threads of caps, which name two of them."""

from __future__ import annotations

import re
from typing import Literal

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.profiles.model import Thread
from xei_lang.profiles.schema.usage import ThreadModel
from xei_lang.profiles.yaml_tree import Node, Path

_PLACE = re.compile(r"([a-z][a-z0-9_]*)\.(slot|spot)\(\s*\"([^\"]+)\"\s*\)")

NamedPlace = tuple[str, Literal["slot", "spot"], str]
"""An object, the kind of its place, and the place's name."""


def named_place(text: str, span: Span, found: list[Diagnostic]) -> NamedPlace | None:
    """What `rack_1.slot("A1")` names; None, with why in `found`, for words that name no place."""
    match = _PLACE.fullmatch(text.strip())
    if match is None:
        found.append(
            Diagnostic(
                "XEI0609",
                f"`{text}` is not a place",
                span,
                label="expected a slot or a spot",
                help=("""write for example 'rack_1.slot("A1")' or 'table.spot("bottle")'""",),
            )
        )
        return None
    return match[1], "slot" if match[2] == "slot" else "spot", match[3]


def build_thread(
    model: ThreadModel | None, root: Node, path: Path, found: list[Diagnostic]
) -> tuple[Thread | None, bool]:
    """The thread at `path`, None where there is none, and whether it could be read; `found` says why not."""
    if model is None:
        return None, True
    places: list[NamedPlace] = []
    for key, text in (("closes", model.closes), ("rest", model.rest)):
        span = root.span_of(*path, key)
        place = named_place(text, span, found)
        if place is None:
            return None, False
        if place[1] == "slot":
            message = f"`{text}` is a slot, and a cap lies and closes on a spot"
            help_ = "give the object a spot under `spots`, and name that"
            found.append(Diagnostic("XEI0609", message, span, label="expected a spot", help=(help_,)))
            return None, False
        places.append(place)
    (on, _, mouth), (rest, _, spot) = places
    return Thread(on, mouth, model.lead.si, model.turns, rest, spot, root.key_span(*path)), True
