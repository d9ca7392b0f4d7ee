"""`xei check --format`: the form that was asked for and no more on stdout, the same exit code for each."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cli.xei import PROFILES, Ran, xei

BAD = 'protocol tired {\n  profile "openarm_bench"\n  pik(object=tube_1)\n  let x = 1\n}\n'


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "tired.xei").write_text(BAD, encoding="utf-8")
    (tmp_path / "good.xei").write_text(
        BAD.replace("pik", "pick").replace("  let x = 1\n", ""), encoding="utf-8"
    )
    return tmp_path


def check(form: str, lab: Path) -> Ran:
    ran = xei("check", "tired.xei", "good.xei", "--format", form, cwd=lab)
    assert ran.code == 1
    return ran


def test_full_goes_to_stderr_and_says_once_where_more_is_told(lab: Path) -> None:
    ran = check("full", lab)
    assert ran.out == ""
    assert ran.err.endswith("\n2 files checked: 1 error, 1 warning; `xei explain XEI0201` says more\n")
    assert ran.err.count("xei explain") == 1


def test_concise(lab: Path) -> None:
    ran = check("concise", lab)
    lines = ran.out.splitlines()
    assert lines[0] == "tired.xei:3:3: error[XEI0201] there is no skill `pik`"
    assert lines[1].startswith("tired.xei:4:7: warning[XEI0501] ")
    assert (len(lines), ran.err) == (2, "")


def test_json_and_sarif(lab: Path) -> None:
    ran = check("json", lab)
    codes = [item["code"] for item in json.loads(ran.out)["diagnostics"]]
    log = json.loads(check("sarif", lab).out)
    assert (codes, ran.err) == (["XEI0201", "XEI0501"], "")
    assert [result["ruleId"] for result in log["runs"][0]["results"]] == codes


def test_github(lab: Path) -> None:
    lines = check("github", lab).out.splitlines()
    assert lines[0].startswith("::error file=tired.xei,line=3,col=3,endColumn=6,title=XEI0201::")
    assert lines[1].startswith("::warning file=tired.xei,line=4,col=7,endColumn=8,title=XEI0501::")


def test_junit_has_a_case_for_each_file(lab: Path) -> None:
    cases = ElementTree.fromstring(check("junit", lab).out).findall("testsuite/testcase")
    assert [(case.get("file"), case.find("failure") is not None) for case in cases] == [
        ("tired.xei", True),
        ("good.xei", False),
    ]


def test_what_is_right_says_nothing(lab: Path) -> None:
    ran = xei("check", "good.xei", "--format", "concise", cwd=lab)
    assert (ran.code, ran.out, ran.err) == (0, "", "")
    assert "explain" not in xei("check", "good.xei", cwd=lab).err
