"""The trees of a profile's YAML files, for checks that point at a single word."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.profiles.model import LabObject
from xei_lang.profiles.yaml_tree import Node


@dataclass(frozen=True, slots=True)
class Trees:
    """One tree a file; a path that a file does not have gives the place of the deepest part that it has."""

    usage: Node
    registry: Node
    development: Node
    calibration: Node

    def of_object(self, item: LabObject, *path: str | int) -> Span:
        """A place below an object, in the file that declares it."""
        if item.system:
            return self.registry.span_of("system_objects", item.name, *path)
        return self.usage.span_of("objects", item.name, *path)

    def of_skill(self, name: str, *path: str | int) -> Span:
        """A place below a skill."""
        return self.development.span_of("skills", name, *path)
