from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
import yaml

from xei_lang.profiles.schema_json import MODELS, profile_schema

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", MODELS)
def test_published_schemas_are_current(name, update_golden):
    path = ROOT / "docs" / "schemas" / f"{name}.schema.json"
    text = json.dumps(profile_schema(name), indent=2, ensure_ascii=False) + "\n"
    if update_golden:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="")
    assert path.exists(), f"{path} is missing; pytest --update-golden writes it"
    assert path.read_text(encoding="utf-8") == text


@pytest.mark.parametrize("name", MODELS)
def test_the_schema_takes_the_bench_and_refuses_a_stray_key(name):
    validator = jsonschema.Draft202012Validator(profile_schema(name))
    validator.check_schema(profile_schema(name))
    text = (ROOT / "profiles" / "openarm_bench" / f"{name}.yaml").read_text(encoding="utf-8")
    document = yaml.safe_load(text)
    validator.validate(document)
    assert not validator.is_valid({**document, "stray": 1})
