"""The JSON Schemas of the profiles, from their pydantic models, for editors that complete and check YAML."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.schema.development import DevelopmentProfile
from xei_lang.profiles.schema.registry import ObjectRegistry
from xei_lang.profiles.schema.usage import UsageProfile
from xei_lang.profiles.schema.values import Model

MODELS: Mapping[str, type[Model]] = MappingProxyType(
    {
        "usage_profile": UsageProfile,
        "calibration_profile": CalibrationProfile,
        "development_profile": DevelopmentProfile,
        "object_registry": ObjectRegistry,
    }
)
"""Each file of a profile, by its name without the ending, and its model."""


def profile_schema(name: str) -> dict[str, Any]:
    """The JSON Schema (2020-12) of one file of a profile; KeyError for a name that `MODELS` lacks."""
    schema = MODELS[name].model_json_schema(by_alias=True)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
