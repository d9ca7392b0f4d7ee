"""What stands behind one code."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """What a code stands for: a title that needs no context, and how grave it is."""

    title: str
    severity: Literal["error", "warning", "info"] = "error"
