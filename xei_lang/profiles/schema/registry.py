"""object_registry.yaml: system objects, and which usage profile is in force."""

from __future__ import annotations

from typing import Literal

from xei_lang.profiles.schema.usage import ObjectModel
from xei_lang.profiles.schema.values import Model, Name, Text


class ObjectRegistry(Model):
    """What belongs to the room, and the current usage profile (a file of the same folder)."""

    version: Literal[1]
    usage_profile: Text
    system_objects: dict[Name, ObjectModel]
