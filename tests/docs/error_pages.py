"""What a page of docs/errors/ holds, and its examples as files.

A page has the code and its title from the catalogue, what it means, then `## Why`, `## Example`, `## Fix` and
`Related: XEI0101, XEI0102.` In an example or a fix

- an `xei` block is checked; a first line `# xei compile example.xei --bind a=b` has it compiled as far as its
  goals with these options (pages from XEI06xx on are always compiled so). Without one, a protocol that waits
  stands for it;
- a line "In a file `name.csv`:" before a `csv` or `xei` block writes it under that name;
- a line "In `usage_profile.yaml`:" before a `diff` block changes that file in a copy of the bench's profile;
- a line "In a file `name`:" before a `text` block writes it, too; in a scene file, `...` is the digest
  of the bench's objects;
- a `json` block is a plan, `plan.json`, and is checked as `xei check plan.json` does;
- a `yaml` or `xml` block in a fix shows lines that the bench's profile has;
- where a `sh` block of the example calls `xei doctor`, the blockers that the bench does not have are meant.

A page whose example nothing here can run begins with the front matter `NOT_RUN`.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from xei_lang.profiles.load import load_profile
from xei_lang.world.sources.identity import objects_sha256

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "errors"
BENCH = ROOT / "profiles" / "openarm_bench"
NOT_RUN = "---\nexample: not run in tests\n---\n\n"
EXAMPLE = "example.xei"
PLAN = "plan.json"
PLAIN = 'protocol p {\n  profile "openarm_bench"\n  wait 1 s\n}\n'

_UNTOLD = "objects_sha256: ..."
_BLOCK = re.compile(
    r"(?:^In (?:a file )?`(?P<file>[\w./]+)`:\n\n)?^```(?P<language>[a-z]+)\n(?P<body>.*?)^```$", re.S | re.M
)


@cache
def _digest() -> str:
    profile, said = load_profile(BENCH, None)
    assert profile is not None, said
    return objects_sha256(profile)


@dataclass(frozen=True)
class Change:
    """A change to a file of the profile, a diff without line numbers: the first place that fits is meant."""

    file: str
    diff: str

    def apply(self, profile: Path) -> None:
        lines = self.diff.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] != "+")
        new = "".join(line[1:] for line in lines if line[0] != "-")
        path = profile / self.file
        text = path.read_text(encoding="utf-8")
        assert old in text, f"{self.file} of the bench does not hold\n{old}"
        path.write_text(text.replace(old, new, 1), encoding="utf-8")


@dataclass(frozen=True)
class Section:
    """The example or the fix of a page."""

    changes: tuple[Change, ...]
    files: dict[str, str]
    """Its `xei`, `csv` and `json` blocks by their names, in their order; the last protocol, or the plan, is
    what is checked.
    """
    profile_lines: tuple[str, ...]
    """Blocks of YAML or XML, which show lines as the bench has them."""

    def write(self, folder: Path) -> Path:
        """Write the profile and the protocol into a folder, and return the protocol."""
        shutil.copytree(BENCH, folder / "profiles" / BENCH.name, ignore=shutil.ignore_patterns("*.py"))
        for change in self.changes:
            change.apply(folder / "profiles" / BENCH.name)
        protocols = [name for name in self.files if name.endswith(".xei")]
        if not protocols and PLAN in self.files:
            protocols = [PLAN]
        files = self.files if protocols else {**self.files, EXAMPLE: PLAIN}
        for name, text in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
        return folder / (protocols[-1] if protocols else EXAMPLE)


@dataclass(frozen=True)
class Page:
    code: str
    title: str
    is_run: bool
    sections: dict[str, str]
    related: tuple[str, ...]

    @property
    def is_of_doctor(self) -> bool:
        return "xei doctor" in self.sections["Example"]

    def section(self, name: str) -> Section:
        changes, files, lines = [], {}, []
        for block in _BLOCK.finditer(self.sections[name]):
            if block["language"] == "diff":
                assert block["file"], f"{self.code}: a diff stands under a line that names its file"
                changes.append(Change(block["file"], block["body"]))
            elif block["language"] == "text" and block["file"]:
                files[block["file"]] = block["body"].replace(_UNTOLD, f"objects_sha256: {_digest()}")
            elif block["language"] == "json":
                files[PLAN] = block["body"]
            elif block["language"] == "csv":
                assert block["file"], f"{self.code}: a table stands under a line that names its file"
                files[block["file"]] = block["body"]
            elif block["language"] == "xei":
                files[block["file"] or EXAMPLE] = block["body"]
            elif block["language"] in ("yaml", "xml"):
                lines.append(block["body"])
        return Section(tuple(changes), files, tuple(lines))


def read_page(path: Path) -> Page:
    text = path.read_text(encoding="utf-8")
    is_run = not text.startswith("---\n")
    assert is_run or text.startswith(NOT_RUN), f"{path.name} has another front matter than {NOT_RUN!r}"
    head, *parts = re.split(r"^## ", text.removeprefix(NOT_RUN), flags=re.M)
    title = re.match(r"# (XEI\d{4}): (.*)\n\n\S", head)
    assert title is not None, f"{path.name} begins with its code and title, and says what it is"
    related = re.search(r"^Related: (.*)\.\n\Z", text, re.M)
    sections = dict(part.split("\n", 1) for part in parts)
    assert list(sections) == ["Why", "Example", "Fix"], f"{path.name} has {list(sections)}"
    return Page(
        title[1], title[2], is_run, sections, tuple(re.findall(r"XEI\d{4}", related[1] if related else ""))
    )
