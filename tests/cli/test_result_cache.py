"""Results are kept while nothing that they were made from has changed, and never a moment longer."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.cli.xei import PROFILES, ROOT, start, xei
from xei_lang.cli import result_cache
from xei_lang.cli.check_run import Run, check_file, check_files
from xei_lang.cli.options import Options
from xei_lang.cli.result_cache import ResultCache
from xei_lang.diagnostics import Diagnostics
from xei_lang.inputs import Inputs, Outside
from xei_lang.profiles.cache_key import default_cache
from xei_lang.syntax.reading import read_source

MAIN = Path("protocols/main.xei")
TEXTS = {
    "protocols/main.xei": 'import "lib.xei"\nimport table "doses.csv" as doses\n\nprotocol main {\n'
    '  profile "openarm_bench"\n  rest()\n  for dose in doses { wait dose.time }\n  let unused = 1\n}\n',
    "protocols/lib.xei": 'import "deeper/settle.xei"\n\nprocedure rest() {\n  settle()\n}\n',
    "protocols/deeper/settle.xei": "procedure settle() {\n  wait 1 s\n}\n",
    "protocols/doses.csv": "time [s],count [Int]\n1,2\n3,4\n",
}
OPTIONS = Options(None, (), (), 0, False, False)


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    bench = PROFILES / "openarm_bench"
    # What Python leaves beside generate.py is no part of a profile.
    own = shutil.ignore_patterns("__pycache__")
    shutil.copytree(bench, tmp_path / "profiles" / bench.name, ignore=own)
    for name, text in TEXTS.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / ".cache"))
    return tmp_path


def check(options: Options = OPTIONS, file: Path = MAIN) -> Diagnostics:
    (checked,) = check_files([file], Run(options, 1, True, lambda _done: None))
    return checked.said


def kept(options: Options = OPTIONS, file: Path = MAIN) -> Diagnostics | None:
    """What the cache says of a file now; None where it knows nothing."""
    source, _ = read_source(file, str(file))
    outside = Outside(Inputs(None), file, options.profile)
    found = source and ResultCache(default_cache(), options).find(source, outside)
    return found[0] if found else None


def results() -> list[Path]:
    return sorted(default_cache().glob("results-*"))


def test_an_unchanged_file_is_not_checked_again(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert kept() is None
    said = check()
    assert [item.code for item in said] == ["XEI0501"]
    assert kept() == said
    monkeypatch.setattr("xei_lang.cli.check_run.check_file", lambda *_: pytest.fail("was checked again"))
    assert check() == said


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_changed_byte_anywhere_is_a_miss(lab: Path, data: st.DataObject) -> None:
    said = kept() or check()
    inputs = sorted(
        path
        for path in [*lab.joinpath("protocols").rglob("*"), *lab.joinpath("profiles").rglob("*")]
        if path.is_file()
    )
    path = data.draw(st.sampled_from(inputs))
    before = path.read_bytes()
    at = data.draw(st.integers(0, max(0, len(before) - 1)))
    byte = data.draw(st.integers(0, 255).filter(lambda value: before[at : at + 1] != bytes([value])))
    path.write_bytes(before[:at] + bytes([byte]) + before[at + 1 :])
    try:
        assert kept() is None
    finally:
        path.write_bytes(before)
    assert kept() == said


@pytest.mark.parametrize("name", [*TEXTS, "profiles/openarm_bench/object_registry.yaml"])
def test_a_file_that_goes_is_a_miss(lab: Path, name: str) -> None:
    check()
    (lab / name).rename(lab / "away")
    assert kept() is None
    (lab / "away").rename(lab / name)
    assert kept() is not None


def test_a_file_that_comes_is_a_miss(lab: Path) -> None:
    check()
    added = lab / "profiles" / "openarm_bench" / "notes.txt"
    added.write_text("more", encoding="utf-8")
    assert kept() is None


def test_an_import_that_appears_later_is_seen(lab: Path) -> None:
    (lab / "protocols/lib.xei").rename(lab / "away")
    assert [item.code for item in check()][:1] == ["XEI0122"]
    assert [item.code for item in kept() or ()][:1] == ["XEI0122"]
    (lab / "away").rename(lab / "protocols/lib.xei")
    assert kept() is None
    assert [item.code for item in check()] == ["XEI0501"]


def test_what_help_offers_for_a_missing_import_is_looked_for_anew(lab: Path) -> None:
    text = TEXTS[str(MAIN)].replace("lib.xei", "libb.xei")
    (lab / MAIN).write_text(text, encoding="utf-8")
    assert "did you mean `lib.xei`?" in check()[0].help
    (lab / "protocols/lib.xei").rename(lab / "protocols/other.xei")
    assert kept() is None


def test_a_nearer_profile_is_a_miss(lab: Path) -> None:
    check()
    shutil.copytree(lab / "profiles", lab / "protocols" / "profiles")
    assert kept() is None


def test_a_profile_that_appears_later_is_seen(lab: Path) -> None:
    profile = lab / "profiles" / "openarm_bench"
    text = TEXTS[str(MAIN)].replace("openarm_bench", "other_bench")
    (lab / MAIN).write_text(text, encoding="utf-8")
    assert [item.code for item in check()] == ["XEI0601"]
    assert kept() is not None
    profile.rename(lab / "profiles" / "other_bench")
    assert kept() is None


def test_a_smaller_project_folder_is_a_miss(lab: Path) -> None:
    (lab / "shared").mkdir()
    (lab / "protocols/deeper").rename(lab / "shared/deeper")
    (lab / "protocols/lib.xei").write_text(TEXTS["protocols/lib.xei"].replace("deeper", "../shared/deeper"))
    assert [item.code for item in check()] == ["XEI0501"]
    (lab / "protocols/.git").mkdir()
    assert kept() is None
    assert "XEI0120" in [item.code for item in check()]


def test_a_library_depends_on_being_the_only_profiles(lab: Path) -> None:
    library = Path("protocols/lib.xei")
    assert check(file=library) == ()
    assert kept(file=library) == ()
    shutil.copytree(lab / "profiles/openarm_bench", lab / "profiles/second")
    assert kept(file=library) is None


def test_a_plan_from_elsewhere_is_kept_as_long_as_its_profile(lab: Path) -> None:
    plan = Path("protocols/plan.json")
    (lab / plan).write_text(
        '{"version": 1, "skill_calls": [{"step_id": "a", "skill": "pikc"}]}', encoding="utf-8"
    )
    said = check(file=plan)
    assert [item.code for item in said] == ["XEI0201"]
    assert kept(file=plan) == said
    shutil.copytree(lab / "profiles/openarm_bench", lab / "profiles/second")
    assert kept(file=plan) is None


@pytest.mark.parametrize(
    "options",
    [
        Options(Path("profiles"), (), (), 0, False, False),
        Options(None, (("a", "tube_1"),), (), 0, False, False),
        Options(None, (), (("a", "1 s"),), 0, False, False),
        Options(None, (), (), 1, False, False),
    ],
)
def test_other_options_are_a_miss(lab: Path, options: Options) -> None:
    check()
    assert kept(options) is None


def test_another_working_folder_is_a_miss(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check()
    elsewhere = lab / "elsewhere"
    shutil.copytree(lab / "protocols", elsewhere / "protocols")
    monkeypatch.chdir(elsewhere)
    assert kept() is None


def test_other_code_is_a_miss(lab: Path, tmp_path: Path) -> None:
    """A copy of xei with one module that is a line longer knows none of the results."""
    copy = tmp_path / "copy"
    for name in ("xei_lang", "grammar", "docs/errors"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    program = (
        "import sys\nfrom pathlib import Path\nfrom tests.cli.test_result_cache import kept\n"
        "import xei_lang\nassert xei_lang.__file__.startswith(sys.argv[1]), xei_lang.__file__\n"
        "print(kept() is not None)"
    )

    def known() -> str:
        environment = {**os.environ, "PYTHONPATH": f"{copy}{os.pathsep}{ROOT}"}
        command = [sys.executable, "-c", program, str(copy)]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout.strip()

    environment = {"PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(lab / ".cache")}
    xei("check", str(MAIN), cwd=lab, env=environment)
    assert known() == "True"
    with (copy / "xei_lang" / "check" / "loops.py").open("a") as module:
        module.write("\n")
    assert known() == "False"


def test_every_damage_to_the_cache_is_a_miss(lab: Path) -> None:
    said = check()
    (path,) = results()
    whole = path.read_bytes()
    assert kept() == said
    for length in range(0, len(whole), 7):
        path.write_bytes(whole[:length])
        assert kept() is None
    for at in range(0, len(whole), 5):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert kept() is None
    path.write_bytes(b"\0" * 1000)
    assert check() == said
    assert kept() == said


@pytest.mark.parametrize(
    "foreign",
    [
        [], 1, None, {}, {str(MAIN): None}, {str(MAIN): 1}, {str(MAIN): []}, {str(MAIN): ["x", [], []]},
        {str(MAIN): ["TEXT", 1, []]}, {str(MAIN): ["TEXT", [["odd", "x"]], []]},
        {str(MAIN): ["TEXT", [[["odd"], "x"]], []]}, {str(MAIN): ["TEXT", [], [["XEI9999"]]]},
        {str(MAIN): ["TEXT", [], 5]}, {str(MAIN): ["TEXT", [[[1], "x"]], []]},
    ],
)  # fmt: skip
def test_a_foreign_file_in_the_cache_is_a_miss(lab: Path, foreign: object) -> None:
    check()
    (path,) = results()
    text = hashlib.sha256((lab / MAIN).read_bytes()).hexdigest()
    payload = json.dumps(foreign).replace("TEXT", text).encode()
    path.write_bytes(hashlib.sha256(payload).hexdigest().encode() + b"\n" + payload)
    assert kept() is None


def test_a_cache_that_cannot_be_written_changes_nothing(lab: Path) -> None:
    expected = check()
    shutil.rmtree(lab / ".cache")
    (lab / ".cache").write_text("in the way", encoding="utf-8")
    assert check() == expected
    assert kept() is None


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_changes_nothing(lab: Path) -> None:
    expected = check()
    (path,) = results()
    path.unlink()
    path.with_name(f"{path.name}.{os.getpid()}").symlink_to("/dev/full")
    assert check() == expected
    assert results() == []


def test_a_profile_that_changes_while_it_is_read_is_not_kept(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calibration = lab / "profiles/openarm_bench/calibration_profile.yaml"

    def disturbed(*arguments: object) -> object:
        found = check_file(*arguments)  # type: ignore[arg-type]
        calibration.write_text(calibration.read_text() + "\n", encoding="utf-8")
        return found

    monkeypatch.setattr("xei_lang.cli.check_run.check_file", disturbed)
    check()
    assert results() == []


def test_two_at_once_leave_a_whole_cache(lab: Path) -> None:
    running = [start("check", "protocols", cwd=lab) for _ in range(4)]
    ended = [process.communicate(timeout=120) for process in running]
    assert len({err for _, err in ended}) == 1
    assert [process.returncode for process in running] == [0] * 4
    for path in results():
        named, _, payload = path.read_bytes().partition(b"\n")
        assert named.decode() == hashlib.sha256(payload).hexdigest()
    assert len(results()) == 2


def test_the_oldest_results_make_room(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(result_cache, "MAX_RESULTS", 3)
    for number in range(5):
        (lab / f"protocols/p{number}.xei").write_text(TEXTS[str(MAIN)], encoding="utf-8")
        check(file=Path(f"protocols/p{number}.xei"))
    known = [kept(file=Path(f"protocols/p{number}.xei")) is not None for number in range(5)]
    assert known == [False, False, True, True, True]
    monkeypatch.setattr(result_cache, "MAX_BYTES", results()[0].stat().st_size + 10)
    check(Options(None, (), (), 7, False, False))
    assert len(results()) == 1
    assert kept(Options(None, (), (), 7, False, False)) is not None


@pytest.mark.parametrize("form", ["full", "concise", "json", "sarif", "github", "junit"])
def test_what_is_printed_from_the_cache_is_the_same_to_the_byte(lab: Path, form: str) -> None:
    (lab / "protocols/lib.xei").write_text("procedure rest() {\r\n  # µ\r\n  wait 1 mL\r\n}\r\n", newline="")
    first = xei("check", "protocols", "--format", form, cwd=lab)
    assert first.code == 1
    assert len(results()) == 2
    assert xei("check", "protocols", "--format", form, cwd=lab) == first
    assert xei("check", "protocols", "--format", form, "--no-cache", cwd=lab) == first
