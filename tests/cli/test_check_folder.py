"""`xei check` of a folder: every file that is there, each mistake once, whatever the folder holds."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, ROOT, Ran, xei

GOOD = 'protocol fine {\n  profile "openarm_bench"\n  wait 1 s\n}\n'
IMPORTING = 'import "lib.xei"\n' + GOOD.replace("wait 1 s", "rest()")


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "many").mkdir()
    return tmp_path


def write(lab: Path, **texts: str) -> None:
    for name, text in texts.items():
        (lab / "many" / f"{name}.xei").write_text(text, encoding="utf-8")


def found(lab: Path, *args: str) -> list[tuple[str, str]]:
    report = json.loads(xei("check", "--format", "json", *(args or ("many",)), cwd=lab).out)
    return [(item["file"], item["code"]) for item in report["diagnostics"]]


@pytest.mark.parametrize("bad", ["wait 1 mL", "wiat 1 s", "wait 1 s }"])
def test_a_mistake_in_an_import_is_told_once_by_its_own_file(lab: Path, bad: str) -> None:
    write(lab, lib=f"procedure rest() {{\n  {bad}\n}}\n", a=IMPORTING, b=IMPORTING, z=IMPORTING)
    alone = found(lab, "many/lib.xei")
    assert alone
    assert found(lab) == alone
    assert found(lab, "many", "--jobs", "2", "--no-cache") == alone
    assert found(lab, "many/z.xei", "many/a.xei")[: len(alone)] == alone


def test_a_mistake_that_only_one_call_has_is_still_told(lab: Path) -> None:
    lib = "procedure rest(n: Int) {\n  wait ([1 s, 2 s])[n]\n}\n"
    calls = [IMPORTING.replace("rest()", f"rest(n={n})") for n in (1, 7, 7)]
    write(lab, lib=lib, a=calls[0], b=calls[1], c=calls[2])
    assert [file for file, _ in found(lab)] == ["many/lib.xei"]


def test_a_mistake_in_a_profile_is_told_once(tmp_path: Path) -> None:
    import shutil

    shutil.copytree(PROFILES, tmp_path / "profiles")
    usage = tmp_path / "profiles/openarm_bench/usage_profile.yaml"
    usage.write_text(usage.read_text().replace("mass: 6.5 g", "mass: 6.5 mL", 1), encoding="utf-8")
    (tmp_path / "many").mkdir()
    write(tmp_path, a=GOOD, b=GOOD, c=GOOD)
    ran = xei("check", "many", cwd=tmp_path)
    assert ran.code == 1
    assert ran.err.count("error[") == 1
    assert "3 files checked: 1 error, 0 warnings" in ran.err


def test_a_mistake_in_a_table_is_told_once(lab: Path) -> None:
    (lab / "many/t.csv").write_text("time [s]\nx\n", encoding="utf-8")
    text = 'import table "t.csv" as t\n' + GOOD.replace("1 s", "t[1].time")
    write(lab, a=text, b=text)
    assert found(lab) == [("many/t.csv", "XEI0124")]


def linked(lab: Path, *links: str) -> None:
    """Files that each import others and can be imported: `ab` lets a import b."""
    names = sorted({name for link in links for name in link})
    for name in names:
        lines = [f'import "{link[1]}.xei"\n' for link in links if link[0] == name]
        rest = f"\nprocedure rest_{name}() {{\n  wait 1 s\n}}\n"
        write(lab, **{name: "".join(lines) + GOOD + rest})


@pytest.mark.parametrize(
    ("links", "circles"),
    [
        (["ab", "ba"], 1),
        (["ab", "bc", "ca", "da", "eb"], 1),
        (["aa", "ba"], 1),
        (["ab", "ba", "bc", "cb"], 2),
        (["ab", "ba", "cd", "dc"], 2),
    ],
)
def test_a_circle_of_imports_is_told_once(lab: Path, links: list[str], circles: int) -> None:
    linked(lab, *links)
    said = found(lab)
    assert [code for _, code in said] == ["XEI0121"] * circles
    assert found(lab) == said  # from the cache of results
    assert found(lab, "many", "--jobs", "2", "--no-cache") == said
    assert found(lab, "many/b.xei")


def test_equal_mistakes_in_two_files_are_two(lab: Path) -> None:
    write(lab, a=GOOD.replace("1 s", "1 mL"), b=GOOD.replace("1 s", "1 mL"))
    assert [file for file, _ in found(lab)] == ["many/a.xei", "many/b.xei"]


def test_links_pipes_and_folders_with_the_suffix(lab: Path) -> None:
    write(lab, real=GOOD)
    many = lab / "many"
    (many / "loop").symlink_to(many)
    (many / "broken.xei").symlink_to("nowhere.xei")
    (many / "itself.xei").symlink_to("itself.xei")
    (many / "linked.xei").symlink_to("real.xei")
    (many / "folder.xei").mkdir()
    (many / "folder.xei" / "inner.xei").write_text(GOOD.replace("wait", "wiat"), encoding="utf-8")
    os.mkfifo(many / "pipe.xei")
    ran = xei("check", "many", cwd=lab, timeout=30)
    assert ran.code == 1
    assert "5 files checked: 3 errors" in ran.err
    assert "`many/broken.xei` does not exist" in ran.err
    assert "`many/itself.xei` cannot be read" in ran.err
    assert "many/folder.xei/inner.xei:3:" in ran.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_folder_that_may_not_be_read_is_told(lab: Path) -> None:
    write(lab, a=GOOD)
    (lab / "many/closed").mkdir()
    (lab / "many/closed").chmod(0)
    try:
        ran = xei("check", "many", cwd=lab)
    finally:
        (lab / "many/closed").chmod(0o755)
    assert ran.code == 2
    assert "`many/closed`" in ran.err


@pytest.mark.parametrize("form", ["full", "concise", "github", "junit", "json", "sarif"])
def test_no_name_gives_orders_to_a_terminal(lab: Path, form: str) -> None:
    for name in ("a\nb", "c\x1b[31md", "e\x9bf", "g\u202eh"):
        write(lab, **{name: GOOD.replace("wait", "wiat")})
    (lab / "many" / os.fsdecode(b"latin\xe9.xei")).write_text("", encoding="utf-8")
    first = xei("check", "many", "--format", form, "--jobs", "2", cwd=lab)
    assert first.code == 1
    assert xei("check", "many", "--format", form, cwd=lab) == first
    assert not [char for char in first.out + first.err if not (char.isprintable() or char == "\n")]


def test_a_folder_without_protocols_has_its_name_shown_safely(lab: Path) -> None:
    (lab / "odd\x1b[31m").mkdir()
    ran = xei("check", "odd\x1b[31m", cwd=lab)
    assert (ran.code, "\x1b" in ran.err) == (2, False)


def test_many_files_in_many_folders_keep_their_order(lab: Path) -> None:
    for number in range(120):
        folder = lab / "many" / f"d{number % 7}"
        folder.mkdir(exist_ok=True)
        (folder / f"p{number}.xei").write_text(GOOD.replace("1 s", "1 mL"), encoding="utf-8")
    files = [file for file, _ in found(lab, "many", "--jobs", "2")]
    assert files == [str(path) for path in sorted(map(Path, files))]
    assert len(files) == 120


def on_terminal(lab: Path, *args: str) -> tuple[int, str]:
    """What a check prints on a terminal, and its exit code."""
    ours, theirs = pty.openpty()
    program = [sys.executable, "-c", "from xei_lang.cli.main import run; run()", "check", *args]
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(lab / ".cache"),
        "NO_COLOR": "1",
    }
    process = subprocess.Popen(program, cwd=lab, env=environment, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    printed = b""
    try:
        while data := os.read(ours, 4096):
            printed += data
    except OSError:  # the terminal's end, on Linux
        pass
    os.close(ours)
    return process.wait(timeout=60), printed.decode()


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_long_work_shows_a_bar_on_a_terminal_and_wipes_it_away(lab: Path, jobs: str) -> None:
    lines = "".join(f"  let a{number} = {number} + 1\n  wait a{number} * 1 s\n" for number in range(1500))
    write(lab, **{f"slow{number}": GOOD.replace("  wait", lines + "  wait") for number in range(8)})
    code, printed = on_terminal(lab, "--no-cache", "--jobs", jobs, "many")
    assert code == 0
    assert "\rcheck    [" in printed
    assert printed.rstrip("\r\n").rpartition("\r")[2] == "8 files checked: 0 errors, 0 warnings"
    piped: Ran = xei("check", "many", cwd=lab)
    assert (piped.out, piped.err) == ("", "8 files checked: 0 errors, 0 warnings\n")


def test_short_work_shows_no_bar(lab: Path) -> None:
    write(lab, a=GOOD)
    xei("check", "many", cwd=lab)
    assert "[" not in on_terminal(lab, "many")[1]
