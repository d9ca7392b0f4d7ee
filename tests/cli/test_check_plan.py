"""`xei check plan.json`: a plan from elsewhere, in each shape that a file can have."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, PROTOCOLS, Ran, xei

STEP = {"step_id": "rise", "skill": "slide_to", "args": {"height": {"value": 300, "unit": "mm"}}}
PLAN = {"version": 1, "profile": "openarm_bench", "skill_calls": [STEP]}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    return tmp_path


def check(folder: Path, content: str | bytes, *options: str) -> Ran:
    data = content.encode() if isinstance(content, str) else content
    (folder / "plan.json").write_bytes(data)
    return xei("check", "plan.json", *options, cwd=folder)


def test_what_compile_prints_can_be_checked(folder: Path) -> None:
    source = PROTOCOLS / "put_on_rack.xei"
    printed = xei("compile", str(source), "--emit", "plan", "--quiet", cwd=folder)
    assert printed.code == 0, printed.err
    ran = check(folder, printed.out)
    assert (ran.code, ran.err) == (0, "1 file checked: 0 errors, 0 warnings\n")


def test_the_minimal_form(folder: Path) -> None:
    step = {**STEP, "owner": "slide", "line": 3}
    form = {"unmapped_requests": [{"text": "label it", "reason": "no printer", "after_step": "rise"}],
            "safety_notes": [], "constraints": []}  # fmt: skip
    assert check(folder, json.dumps({**PLAN, **form, "skill_calls": [step]})).code == 0


def test_a_plan_may_leave_its_profile_open(folder: Path) -> None:
    assert check(folder, json.dumps({"version": 1, "skill_calls": [STEP]})).code == 0
    ran = check(folder, json.dumps({**PLAN, "profile": "openarm_bank"}))
    assert ran.code == 1
    assert "error[XEI0601]" in ran.err
    assert "plan.json:1:" in ran.err


def test_the_forms_for_programs_tell_places_in_the_json(folder: Path) -> None:
    text = json.dumps({**PLAN, "skill_calls": [{**STEP, "skill": "slid_to"}]}, indent=1)
    ran = check(folder, text, "--format", "json")
    assert ran.code == 1
    (said,) = json.loads(ran.out)["diagnostics"]
    assert (said["code"], said["file"], said["line"]) == ("XEI0201", "plan.json", 7)
    (edit,) = said["fix"]["edits"]
    data = text.encode()
    mended = data[: edit["start"]] + edit["text"].encode() + data[edit["end"] :]
    assert check(folder, mended).code == 0


def test_a_mended_plan_is_checked_anew(folder: Path) -> None:
    assert check(folder, json.dumps({**PLAN, "skill_calls": [{**STEP, "skill": "slid_to"}]})).code == 1
    assert check(folder, json.dumps(PLAN)).code == 0


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"", "XEI0110"),
        (b"protocol p { }", "XEI0110"),
        (json.dumps(PLAN).encode("utf-16"), "XEI0102"),
        (b'{"version": "\xff"}', "XEI0102"),
        (b"[" * 100_000, "XEI0107"),
        (b'{"a":' * 100_000, "XEI0107"),
        (b'["' + b"x" * (17 * 1024 * 1024) + b'"]', "XEI0107"),
        (b'{"version": NaN}', "XEI0110"),
        (b'{"version": 1, "skill_calls": [], "version": 1}', "XEI0110"),
        (b'{"version": ' + b"1" * 10_000 + b', "skill_calls": []}', "XEI0110"),
        (b'{"version": 1e99999, "skill_calls": []}', "XEI0110"),
        (b'{"skill_calls": []}', "XEI0111"),
        (b"[]", "XEI0111"),
        (b"null", "XEI0111"),
        (b'{"version": 1, "skill_calls": [], "\x1b[31m": 1}', "XEI0110"),
        (b'{"version": 1, "skill_calls": [], "\\u001b[31m": 1}', "XEI0111"),
    ],
    ids=lambda value: repr(value[:20]) if isinstance(value, bytes) else value,
)
def test_a_hostile_file_is_a_diagnostic(folder: Path, content: bytes, code: str) -> None:
    ran = check(folder, content)
    assert ran.code in (1, 2)
    assert f"error[{code}]" in ran.err
    assert all(char == "\n" or char.isprintable() for char in ran.err)
    assert len(ran.err) < 10_000


def test_a_byte_order_mark_does_no_harm(folder: Path) -> None:
    assert check(folder, b"\xef\xbb\xbf" + json.dumps(PLAN).encode()).code == 0
