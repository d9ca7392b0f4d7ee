"""What `grasp:` of an object may say beside the names of operation parameters."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

ALIASES: Mapping[str, str] = MappingProxyType({"width": "grasp_width"})
"""Shorter names, as they stand under `grasp:`, and the parameters that they mean."""

CHOICES = ("approach",)
"""Parameters whose value is a word."""


def parameter_of(name: str) -> str:
    """The operation parameter that a key under `grasp:` means."""
    return ALIASES.get(name, name)
