"""A small profile with a change in it."""

from __future__ import annotations

import shutil
from pathlib import Path

SMALL = Path(__file__).parent / "small"


def changed_profile(folder: Path, edit: str) -> Path:
    """Copy the small profile to `folder/lab` and change it.

    `edit` is a file's name on a line, then lines `- old` and `+ new`; each old text stands in the file just
    once.
    Several files follow each other, each after its name.
    """
    lab = folder / "lab"
    shutil.copytree(SMALL, lab)
    file, old = lab, ""
    for line in edit.rstrip("\n").split("\n"):
        if line.startswith("- "):
            old = line[2:]
        elif line.startswith("+ "):
            text = file.read_text(encoding="utf-8")
            assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file.name}"
            file.write_text(text.replace(old, line[2:].replace("\\n", "\n")), encoding="utf-8")
        else:
            file = lab / line
    return lab
