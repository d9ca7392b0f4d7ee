"""Whether a file may be written is told without writing one, as writing it then tells."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from xei_lang.cli.write_file import place_refused, write_text


def tree(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


@pytest.mark.parametrize(
    "place", ["file", "new", "a/b/new", "file/new", "folder", "link", "dangling", "round", "x" * 300]
)
def test_what_is_refused_is_what_cannot_be_written(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("file")
    (tmp_path / "dangling").symlink_to("other/new")
    (tmp_path / "round").symlink_to("round")
    before = tree(tmp_path)
    said = place_refused(tmp_path / place)
    assert tree(tmp_path) == before
    assert said == write_text(tmp_path / place, "text")


@pytest.mark.parametrize("place", ["/dev/null", "/dev/stdout", "pipe"])
def test_devices_and_pipes_are_places(tmp_path: Path, place: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert place_refused(tmp_path / place) == place_refused(tmp_path / place, made=False) == ()


def test_what_is_only_opened_needs_its_folder(tmp_path: Path) -> None:
    assert place_refused(tmp_path / "a" / "new") == ()
    (said,) = place_refused(tmp_path / "a" / "new", "--trace", made=False)
    assert said.message.endswith("cannot be written: no such file or directory")
    assert said.help == ("choose another place with --trace",)


SCRIPT = """
import os, sys
from pathlib import Path
from xei_lang.cli.write_file import place_refused
if os.geteuid() == 0:
    os.setuid(65534)
for path in sys.argv[1:]:
    for made in (True, False):
        print([item.message for item in place_refused(Path(path), made=made)])
"""


def test_folders_and_files_without_permission_are_none(tmp_path: Path) -> None:
    for parent in (tmp_path, *tmp_path.parents[:3]):
        if parent.stat().st_uid == os.getuid() and parent != Path("/tmp"):
            parent.chmod(0o755)
    (tmp_path / "closed").mkdir()
    (tmp_path / "open").mkdir()
    (tmp_path / "open" / "kept").write_text("")
    (tmp_path / "open" / "kept").chmod(0o444)
    (tmp_path / "open").chmod(0o777)
    (tmp_path / "closed").chmod(0o555)
    paths = [str(tmp_path / name) for name in ("closed/new", "closed/a/new", "open/new", "open/kept")]
    done = subprocess.run(
        [sys.executable, "-B", "-c", SCRIPT, *paths],
        capture_output=True, text=True, check=False, timeout=60, cwd=Path(__file__).parents[2],
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    denied = [f"`{path}` cannot be written: permission denied" for path in paths]
    lines = done.stdout.splitlines()
    assert lines[0] == lines[1] == str([denied[0]])
    assert lines[2] == str([denied[1]])
    assert lines[3] == str([f"`{paths[1]}` cannot be written: no such file or directory"])
    assert lines[4:6] == ["[]", "[]"]
    # A file is replaced where it may not be changed; what is only opened must be its writer's.
    assert lines[6:] == ["[]", str([denied[3]])]
