"""`xei schema`: each schema is one, and takes what xei really writes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from click.testing import CliRunner, Result

from tests.cli.pictures import image_of_the_table
from tests.cli.xei import PROFILES, xei
from tests.world.calibration.recorded import recorded
from tests.world.map.ranging import recorded as recorded_scans
from tests.world.perception.pictures import lab, small_request, truth
from xei_lang.cli.schema_command import FORMS, command
from xei_lang.cli.schema_command import PROFILES as PROFILE_FILES
from xei_lang.world.perception.contract import PoseRequestModel, PoseResponseModel
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.mock import MockBackend
from xei_lang.world.perception.wire import request_json

PROTOCOL = """protocol small {
  profile "openarm_bench"
  param pause: Time = 1 s in 1 s .. 2 s
  ready: confirm "The bench is free"
  slide_to(height=200 mm) within 20 s
  wait pause after ready
  unmapped "label the tubes" because "no printer"
  note "Nothing was touched."
}
"""


def schema(*arguments: str) -> Result:
    return CliRunner().invoke(command, arguments, prog_name="xei schema")


def validator(name: str) -> jsonschema.Draft202012Validator:
    value = json.loads(schema(name).output)
    jsonschema.Draft202012Validator.check_schema(value)
    return jsonschema.Draft202012Validator(value)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    """What a check, a compilation and a run of a small protocol write, by the names of their forms."""
    folder = tmp_path_factory.mktemp("forms")
    (folder / "profiles").symlink_to(PROFILES)
    (folder / "small.xei").write_text(PROTOCOL, encoding="utf-8")
    (folder / "bad.xei").write_text(PROTOCOL.replace("slide_to(", "slid_to("), encoding="utf-8")
    (folder / "answers.json").write_text('{"ready": true}', encoding="utf-8")
    checked = xei("check", "bad.xei", "--format", "json", cwd=folder)
    compiled = xei("compile", "small.xei", "-o", "bundle", "--allow-unmapped", cwd=folder)
    assert compiled.code == 0, compiled.err
    ran = xei("run", "small.xei", "--answers", "answers.json", "--trace", "trace.jsonl", cwd=folder)
    assert ran.code == 0, ran.err
    found = {
        name: [json.loads((folder / "bundle" / f"{name}.json").read_text(encoding="utf-8"))]
        for name in ("plan", "goals", "timed", "scene", "manifest")
    }
    lines = (folder / "trace.jsonl").read_text(encoding="utf-8").splitlines()
    image_of_the_table(folder / "bench.png")
    seen = xei("perception", "detect", "bench.png", "--format", "json", cwd=folder)
    found |= {"tags": [json.loads(seen.out)], "recording": [recorded(1, 6), recorded(1, 6, form="poses")]}
    found["scene_file"] = [yaml.safe_load(xei("world", "show", "--format", "scene", cwd=folder).out)]
    found["world"] = [json.loads(xei("world", "show", "--format", "json", cwd=folder).out)]
    found["scans"] = [json.loads(line) for line in recorded_scans(2).splitlines()]
    asked = request_json(small_request("bottle_1", "table_b"))
    answered = Desk(lab(), MockBackend(truth())).poses(PoseRequestModel.model_validate(asked))
    assert isinstance(answered, PoseResponseModel)
    found |= {"pose_request": [asked], "pose_response": [answered.model_dump(mode="json")]}
    found["doctor"] = [json.loads(xei("doctor", "--format", "json", cwd=folder).out)]
    return {"check": [json.loads(checked.out)], "trace": [json.loads(line) for line in lines], **found}


@pytest.mark.parametrize("name", FORMS)
def test_a_schema_takes_what_is_written(name: str, written: dict[str, list[Any]]) -> None:
    takes = validator(name)
    for value in written[name]:
        takes.validate(value)
        assert not takes.is_valid({**value, "stray": 1})


@pytest.mark.parametrize("name", PROFILE_FILES)
def test_a_schema_takes_the_bench(name: str) -> None:
    file = PROFILES / "openarm_bench" / f"{name}.yaml"
    validator(name).validate(yaml.safe_load(file.read_text(encoding="utf-8")))


def test_all_schemas_are_listed() -> None:
    listed = [line.split()[0] for line in schema().output.splitlines()]
    assert listed == [*FORMS, *PROFILE_FILES]
    files = {path.name.removesuffix(".schema.json") for path in _package().rglob("*.schema.json")}
    assert files == set(FORMS)


def test_an_unknown_form_is_wrong_usage() -> None:
    ran = schema("plans")
    assert ran.exit_code == 2
    assert "there is no form `plans`; did you mean `plan`?" in ran.output


def _package() -> Path:
    return Path(__file__).parents[2] / "xei_lang"
