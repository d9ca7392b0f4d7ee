"""Every code that a diagnostic may carry: one line each, in one place.

Ranges: 01xx files and syntax, 02xx names and binding, 03xx types, units and arguments, 04xx state and time,
05xx warnings, 06xx profiles and world, 07xx lowering and operation parameters, 08xx motion, 09xx running,
bundles and traces. A code is never reused for something else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal


@dataclass(frozen=True, slots=True)
class Entry:
    """What a code stands for: a title that needs no context, and how grave it is."""

    title: str
    severity: Literal["error", "warning", "info"] = "error"


_ENTRIES = {
    # 01xx files and syntax
    "XEI0101": Entry("a file cannot be read"),
    "XEI0102": Entry("a file is not UTF-8 text"),
    "XEI0103": Entry("a file has no protocol in it"),
    "XEI0104": Entry("the text does not follow the grammar"),
    "XEI0105": Entry("a construct of the language that this version does not compile yet"),
    # 02xx names and binding
    # 03xx types, units and arguments
    # 05xx warnings
    # 06xx profiles and world
    # 07xx lowering and operation parameters
    # 08xx motion
    # 09xx running, bundles and traces
}

CATALOGUE: Mapping[str, Entry] = MappingProxyType(_ENTRIES)
