"""The documentation is run: protocols are checked, commands are executed, and what they print is compared.

The blocks of a page, in their order:

- `xei`: a whole file is written to `protocols/<its name>.xei` of a copy of the project, or to the path that
  is its first line (`# protocols/lib/caps.xei`); a piece of a protocol is put inside one of the bench. It is
  checked, and must be clean or say exactly what the `text` block behind it shows; unless the next block is an
  `sh` block that names its file.
- `sh`: what calls xei (and does not install it) is run in that copy, and prints what the `text` block behind
  it shows. Numbers that depend on the machine or on the plan that was found are not compared.
- `csv`: is written to the path in its first line, which is not part of it; so is `obj`, a mesh.
- `json`: is written to the file that was named last before it.
- `yaml`: is put behind the skills of the bench's skill bank.
- `diff`: changes a file of the bench, which a line "In `usage_profile.yaml`:" before it names, from there on.

`--update-golden` writes the `text` blocks anew.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.docs.error_pages import Change

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
XEI = (sys.executable, "-c", "from xei_lang.cli.main import run; run()")
PIECE = 'protocol piece {{\n  profile "openarm_bench"\n{}\n}}\n'

_BLOCK = re.compile(r"^```(?P<language>[a-z]*)\n(?P<body>.*?)^```$\n?", re.DOTALL | re.MULTILINE)
_CHANGED = re.compile(r"^In `(\w+\.yaml)`:\n\n\Z", re.MULTILINE)
_NAME = re.compile(r"^protocol (\w+)", re.MULTILINE)
_STATED = re.compile(r"# (protocols/\S+)$", re.MULTILINE)
_WHOLE = re.compile(r"^(xei \d|import|protocol|procedure)\b", re.MULTILINE)
_COMMAND = re.compile(r"^(\.venv/bin/)?xei\s")
_BLOCKER = re.compile(r", before .*\[XEI\d{4}\]$", re.MULTILINE)
_NUMBER = re.compile(r"\d+(\.\d+)?")
_MEASURED = ("motion ", "verify ", "bundle ", "dry-run: ")


@dataclass(frozen=True)
class Block:
    """A fenced block of a page, the JSON file named last before it (of a diff, the file that it changes), and
    the blocks after it.
    """

    language: str
    body: str
    line: int
    file: str
    output: re.Match[str] | None
    """The `text` block behind it."""
    next_command: str
    """The body of the block behind it, where that is an `sh` block."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A copy of what commands of the documentation need: profiles and protocols."""
    for folder in ("profiles", "protocols"):
        shutil.copytree(ROOT / folder, tmp_path / "xei" / folder)
    return tmp_path / "xei"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_holds_what_it_says(
    page: Path, project: Path, update_golden: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = page.read_text(encoding="utf-8")
    cache = tmp_path_factory.getbasetemp() / "docs-cache"
    replaced: list[tuple[re.Match[str], str]] = []
    failures: list[str] = []
    for block in _blocks(text):
        printed = _run(block, project, cache)
        shown = block.output["body"] if block.output else ""
        if printed is None or (block.output is None and block.language == "sh" and "error[" not in printed):
            continue
        if _comparable(printed) == _comparable(shown):
            continue
        if update_golden and block.output is not None:
            replaced.append((block.output, f"```text\n{printed}```\n"))
        else:
            failures.append(f"{page.name}:{block.line} shows\n{shown}\nbut this is printed:\n{printed}")
    assert not failures, "\n".join(failures)
    if replaced:
        page.write_text(_with(text, replaced), encoding="utf-8")


def test_links_lead_somewhere() -> None:
    for page in (*PAGES, *sorted((ROOT / "docs" / "decisions").glob("*.md"))):
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
            assert "://" in link or (page.parent / link).exists(), f"{page.name}: {link}"


def test_the_readme_has_its_test_command_between_markers() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    marked = re.search(r"<!-- test -->\n```sh\n(.*?)```\n<!-- /test -->", readme, re.DOTALL)
    assert marked is not None
    assert "pytest" in marked[1]


def _blocks(text: str) -> Iterator[Block]:
    found = list(_BLOCK.finditer(text))
    for index, block in enumerate(found):
        follower = found[index + 1] if index + 1 < len(found) else None
        is_output = follower is not None and follower["language"] == "text"
        between = text[block.end() : follower.start()] if follower else "-"
        line = text.count("\n", 0, block.start()) + 1
        before = text[: block.start()]
        changed = _CHANGED.search(before) if block["language"] == "diff" else None
        named = [changed[1]] if changed else re.findall(r"`([a-z]+\.json)`", before)
        output = follower if is_output and "\n#" not in between else None
        command = follower["body"] if follower and follower["language"] == "sh" else ""
        yield Block(block["language"], block["body"], line, named[-1] if named else "", output, command)


def _run(block: Block, project: Path, cache: Path) -> str | None:
    """What the block prints; None where there is nothing to run in it."""
    if block.language == "xei":
        file = _written(block.body, project)
        return None if file in block.next_command else _call(["check", file, "--quiet"], project, cache)
    if block.language in ("csv", "obj"):
        head, _, rows = block.body.partition("\n")
        path = project / head.removeprefix("# ")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(rows, encoding="utf-8")
    if block.language == "yaml":
        bank = project / "profiles" / "openarm_bench" / "development_profile.yaml"
        bank.write_text(f"{bank.read_text(encoding='utf-8')}\n{block.body}", encoding="utf-8")
    if block.language == "diff":
        Change(block.file, block.body).apply(project / "profiles" / "openarm_bench")
    if block.language == "json" and block.file:
        (project / block.file).write_text(block.body, encoding="utf-8")
    if block.language != "sh":
        return None
    commands = [line for line in block.body.splitlines() if _COMMAND.match(line)]
    return "".join(_call(shlex.split(line)[1:], project, cache) for line in commands) if commands else None


def _written(body: str, project: Path) -> str:
    stated, named = _STATED.match(body), _NAME.search(body)
    file = stated[1] if stated else f"protocols/{named[1] if named else 'piece'}.xei"
    (project / file).parent.mkdir(parents=True, exist_ok=True)
    (project / file).write_text(body if _WHOLE.search(body) else PIECE.format(body), encoding="utf-8")
    return file


def _call(arguments: list[str], project: Path, cache: Path) -> str:
    """Run xei; what it says on either stream. The exit code must fit whether it speaks of errors, or of what
    blocks a deployment.

    What goes to `> FILE` is not said.
    """
    if ">" in arguments:
        command, file = arguments[: arguments.index(">")], arguments[-1]
        written = subprocess.run(
            [*XEI, *command],
            cwd=project,
            env=_environment(cache),
            capture_output=True,
            text=True,
            check=False,
        )
        assert written.returncode != 70, written.stderr
        (project / file).write_text(written.stdout, encoding="utf-8")
        return written.stderr
    done = subprocess.run(
        [*XEI, *arguments],
        cwd=project,
        env=_environment(cache),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
        check=False,
    )
    assert done.returncode != 70, done.stdout
    stands = "error[" in done.stdout or (
        arguments[0] == "doctor" and _BLOCKER.search(done.stdout) is not None
    )
    assert (done.returncode != 0) == stands, (
        f"xei {shlex.join(arguments)} ended with {done.returncode}:\n{done.stdout}"
    )
    return done.stdout


def _environment(cache: Path) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache), "NO_COLOR": "1"}


def _comparable(text: str) -> list[str]:
    return [_without_measures(line) for line in text.splitlines()]


def _without_measures(line: str) -> str:
    """A line of the table of handoffs without its duration; of what was planned, only what it is."""
    words = line.split()
    if line.startswith(_MEASURED):
        return " ".join(words[:2])
    if len(words) > 3 and words[-1] in ("ms", "s") and _NUMBER.fullmatch(words[-2]):
        return " ".join(words[:-2])
    return line


def _with(text: str, replaced: list[tuple[re.Match[str], str]]) -> str:
    for old, new in reversed(replaced):
        text = text[: old.start()] + new + text[old.end() :]
    return text
