"""`xei check --baseline`: only what is new is told, however lines have moved since the report was written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, Ran, xei

TIRED = 'protocol tired {\n  profile "openarm_bench"\n  pik(object=tube_1)\n  let x = 1\n}\n'
FORMS = ["json", "sarif"]


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "many").mkdir()
    (tmp_path / "many" / "tired.xei").write_text(TIRED, encoding="utf-8")
    (tmp_path / "many" / "other.xei").write_text(TIRED.replace("pik", "pock"), encoding="utf-8")
    return tmp_path


def store(lab: Path, form: str = "json", path: str = "many") -> None:
    (lab / "baseline.json").write_text(xei("check", "--format", form, path, cwd=lab).out, encoding="utf-8")


def compared(lab: Path, *args: str) -> Ran:
    return xei("check", *(args or ("many",)), "--baseline", "baseline.json", cwd=lab)


@pytest.mark.parametrize("form", FORMS)
def test_what_is_known_is_not_told(lab: Path, form: str) -> None:
    store(lab, form)
    ran = compared(lab)
    summary = "2 files checked: 0 errors, 0 warnings; known and not shown: 4, known and no longer there: 0\n"
    assert (ran.code, ran.out, ran.err) == (0, "", summary)


@pytest.mark.parametrize("form", FORMS)
def test_lines_may_move(lab: Path, form: str) -> None:
    store(lab, form)
    (lab / "many/tired.xei").write_text(
        "# a comment\n\n" + TIRED.replace("  let", "\n\n    let"), encoding="utf-8"
    )
    assert compared(lab).code == 0


@pytest.mark.parametrize("form", FORMS)
def test_what_is_new_is_told(lab: Path, form: str) -> None:
    store(lab, form)
    added = TIRED.replace("  let", "  drp(object=tube_1)\n  pik(object=tube_1)\n  let")
    (lab / "many/tired.xei").write_text(added, encoding="utf-8")
    ran = compared(lab, "many", "--format", "json")
    told = [(item["code"], item["line"]) for item in json.loads(ran.out)["diagnostics"]]
    assert (ran.code, told, ran.err) == (1, [("XEI0201", 4), ("XEI0201", 5)], "")


@pytest.mark.parametrize("form", FORMS)
def test_what_is_mended_is_counted(lab: Path, form: str) -> None:
    store(lab, form)
    (lab / "many/tired.xei").write_text(TIRED.replace("pik", "pick"), encoding="utf-8")
    assert "known and not shown: 3, known and no longer there: 1" in compared(lab).err
    (lab / "many/other.xei").unlink()
    assert "known and not shown: 1, known and no longer there: 3" in compared(lab).err


def test_of_files_that_were_not_checked_nothing_is_said(lab: Path) -> None:
    store(lab)
    assert "known and not shown: 2, known and no longer there: 0" in compared(lab, "many/tired.xei").err


def test_a_new_file_is_new(lab: Path) -> None:
    store(lab, path="many/tired.xei")
    ran = compared(lab)
    assert ran.code == 1
    assert "many/other.xei:3" in ran.err
    assert "tired.xei" not in ran.err


def test_what_stands_in_no_file_is_known_too(lab: Path) -> None:
    store(lab, path="nowhere.xei")
    assert compared(lab, "nowhere.xei").code == 0
    assert compared(lab, "elsewhere.xei").code == 2


def test_lines_that_a_message_counts_do_not_matter(lab: Path) -> None:
    table = 'import table "doses.csv" as doses\n' + TIRED.replace("pik(object=tube_1)", "wait doses[1].time")
    (lab / "table.xei").write_text(table, encoding="utf-8")
    (lab / "doses.csv").write_text("time [s]\n1\nx\n", encoding="utf-8")
    store(lab, path="table.xei")
    assert "in line 3" in (lab / "baseline.json").read_text()
    (lab / "doses.csv").write_text("time [s]\n1\n2\n3\nx\n", encoding="utf-8")
    ran = compared(lab, "table.xei")
    assert ran.code == 0, ran.err


def test_kept_results_are_compared_too(lab: Path) -> None:
    store(lab)
    first = compared(lab)
    assert compared(lab) == first == compared(lab, "many", "--no-cache", "--jobs", "2")


def test_a_missing_baseline_is_wrong_usage(lab: Path) -> None:
    ran = compared(lab)
    assert (ran.code, ran.out) == (2, "")
    assert "error[XEI0101]: `baseline.json` does not exist" in ran.err


@pytest.mark.parametrize(
    "text",
    [
        "", "{", "[]", "1", "null", '"runs"', "{}", '{"version": 1}', '{"version": 2, "diagnostics": []}',
        '{"version": 1, "diagnostics": [1]}', '{"version": 1, "diagnostics": {"a": 1}}',
        '{"version": 1, "diagnostics": [{"code": 1, "file": null, "message": "m"}]}', '{"runs": 1}',
        '{"runs": [{"results": [{}]}]}', '{"runs": [{"results": [{"partialFingerprints": {"xei/v1": 1}}]}]}',
        "[" * 100_000, TIRED, "\xff",
    ],
)  # fmt: skip
def test_a_foreign_baseline_is_wrong_usage(lab: Path, text: str) -> None:
    (lab / "baseline.json").write_text(text, encoding="latin-1")
    ran = compared(lab)
    assert (ran.code, ran.out) == (2, "")
    assert "error[XEI0125]: `baseline.json`" in ran.err


def test_a_cut_baseline_is_wrong_usage(lab: Path) -> None:
    store(lab)
    whole = (lab / "baseline.json").read_text(encoding="utf-8")
    (lab / "baseline.json").write_text(whole[: len(whole) // 2], encoding="utf-8")
    ran = compared(lab)
    assert ran.code == 2
    assert "`baseline.json` is not JSON" in ran.err
