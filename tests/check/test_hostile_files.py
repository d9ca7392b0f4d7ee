"""Files that are made to break something: tables, imports and texts that a terminal would obey."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.check.checking import protocol
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.syntax.loading import LoadedFile, Unusable
from xei_lang.syntax.project import ProjectFiles
from xei_lang.syntax.reading import MAX_BYTES, read_source

HEADS = (
    "volume (uL)",
    "volume",
    "n",
    "name",
    "",
    "volume (ul)",
    "temp (degC)",
    "n (",
    "\x1b[31mn",
    "n\u202e",
)
CELLS = (
    "1",
    "2.5",
    "-3",
    "1e999",
    "9" * 400,
    "A1",
    '"a,b"',
    '"',
    '""',
    "tube_1",
    "=1+1",
    " ",
    "\x00",
    "\x1b[2J",
)
ENDS = ("\n", "\r\n", "\r", "\n\n", "")
FORBIDDEN = "\x1b\x07\x08\x7f\x00\u202e\u2066"


def shown(found: Diagnostics, source: Source) -> str:
    text = render_full(found, {source.file: source})
    assert not any(char in text for char in FORBIDDEN)
    text.encode("utf-8")
    return text


@st.composite
def tables(draw: st.DrawFn) -> str:
    """CSV text that is nearly right: ragged rows, odd heads, quotes in the wrong places."""
    width = draw(st.integers(0, 4))
    rows = [draw(st.lists(st.sampled_from(HEADS), min_size=width, max_size=width))]
    cell = st.one_of(st.sampled_from(CELLS), st.text(max_size=4))
    rows += draw(st.lists(st.lists(cell, max_size=5), max_size=6))
    end = draw(st.sampled_from(ENDS))
    text = end.join(draw(st.sampled_from([",", ",", ";", "\t"])).join(row) for row in rows)
    return draw(st.sampled_from(["", "", "\ufeff"])) + text + end


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(tables())
def test_no_table_raises(text: str) -> None:
    body = "for row in plan { wait 1 s }\nlet a = [r.n for r in plan if r.volume > 1 uL]\nwait 1 s"
    own = f'import table "plan.csv" as plan\n{protocol(body)}'
    plan, found = check_with(own, {"plan.csv": text})
    assert (plan is None) == any(item.severity == "error" for item in found)


@pytest.mark.parametrize(
    "text",
    [
        "n\n" + "1," * 50_000,
        "n," * 50_000 + "\n1\n",
        'n\n"' + "1\n" * 10_000,
        "n\n" + "x" * 200_000,
        "n\n" + "1\n" * 10_000,
        "n\n" + "x\n" * 10_000,
        "\x00" * 100_000,
        "n (" + "(" * 100_000 + "\n1",
    ],
    ids=[
        "long row",
        "wide head",
        "open quote",
        "huge cell",
        "many rows",
        "many wrong cells",
        "NULs",
        "a unit",
    ],
)
def test_a_large_table_comes_to_an_end(text: str) -> None:
    _, found = check_with(
        f'import table "plan.csv" as plan\n{protocol("for row in plan { wait 1 s }")}', {"plan.csv": text}
    )
    assert len(found) < 300


def check_with(own: str, files: dict[str, str]) -> tuple[object, Diagnostics]:
    """Check a text with files of its project."""
    from tests.check.checking import profile
    from xei_lang.check import CheckOptions, check_module
    from xei_lang.syntax import Parser

    class Given:
        def identity(self, file: str) -> str:
            return file

        def read(self, importing: str, path: str) -> LoadedFile | Unusable:
            return (
                LoadedFile(Source(path, files[path]), path) if path in files else Unusable("does not exist")
            )

    source = Source("t.xei", own)
    module, said = Parser().module(source)
    assert module is not None, said
    plan, found = check_module(module, source, profile(), CheckOptions(files=Given(), open_bindings=True))
    texts = {source.file: source, **{name: Source(name, text) for name, text in files.items()}}
    written = render_full(found, texts)
    assert not any(char in written for char in FORBIDDEN)
    written.encode("utf-8")
    return plan, found


@pytest.fixture
def project(tmp_path: Path) -> Path:
    root = tmp_path / "project"
    (root / "profiles").mkdir(parents=True)
    (root / "run.xei").write_text("", encoding="utf-8")
    os.mkfifo(root / "pipe.xei")
    os.mkfifo(root / "pipe.csv")
    (root / "loop.xei").symlink_to(root / "pool.xei")
    (root / "pool.xei").symlink_to(root / "loop.xei")
    (root / "zero.xei").symlink_to("/dev/zero")
    with (root / "huge.xei").open("wb") as file:
        file.truncate(MAX_BYTES + 1)
    return root


@pytest.mark.parametrize(
    ("path", "outside"),
    [("pipe.xei", False), ("pipe.csv", False), ("loop.xei", False), ("zero.xei", True), ("huge.xei", False),
     (".", False), ("..", True), ("./profiles", False), ("run.xei/x", False), ("a" * 5_000, False)],
)  # fmt: skip
def test_what_is_no_file_of_text_is_refused_at_once(project: Path, path: str, outside: bool) -> None:
    run = project / "run.xei"
    found = ProjectFiles(run).read(str(run), path)
    assert isinstance(found, Unusable)
    assert found.outside is outside


@pytest.mark.parametrize("name", ["pipe.xei", "loop.xei", "huge.xei", "profiles"])
def test_such_a_file_is_refused_where_it_is_named_by_hand(project: Path, name: str) -> None:
    source, said = read_source(project / name, name)
    assert source is None
    assert said


def test_an_endless_device_is_refused() -> None:
    assert read_source(Path("/dev/zero"), "zero")[0] is None


NASTY = "\x1b[31m\x1b]0;t\x07 \u202e \u2066 \x00 \x7f \x85"


@pytest.mark.parametrize("form", ["full", "concise", "json", "sarif", "github", "junit"])
def test_no_form_lets_a_terminal_obey_a_text(tmp_path: Path, form: str) -> None:
    (tmp_path / "a\x1b[31m\u202e.xei").write_text(
        f'import "{NASTY}.xei"\nimport table "t.csv" as t\nprotocol p {{\n profile "{NASTY}"\n'
        f' note "{NASTY}"\n pick(object=tube\x1b[2J)\n wait "{NASTY}"\n}}\n',
        encoding="utf-8",
    )
    (tmp_path / "b.xei").write_text(
        'import table "t.csv" as t\nprotocol p {\n profile "openarm_bench"\n wait 1 s\n'
        f' if object == "{NASTY}" {{ wait "{NASTY}" }}\n}}\n',
        encoding="utf-8",
    )
    (tmp_path / "t.csv").write_text(f"n (\x1b[31m),\u202e\n\x1b[2J,\x07\n{NASTY},1,2\n", encoding="utf-8")
    root = Path(__file__).resolve().parents[2]
    command = [sys.executable, "-c", "from xei_lang.cli.main import run; run()", "check", "--no-cache"]
    command += ["--format", form, "--profile", str(root / "profiles" / "openarm_bench"), str(tmp_path)]
    ran = subprocess.run(
        command, cwd=root, capture_output=True, timeout=120, check=False, env={**os.environ, "NO_COLOR": "1"}
    )
    written = (ran.stdout + ran.stderr).decode("utf-8")
    assert ran.returncode == 1, written
    assert not any(char in written for char in f"{FORBIDDEN}\x85"), repr(written)
