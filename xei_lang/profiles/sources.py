"""The texts of a profile's files, for quoting in messages; each is read when it is first asked for."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from xei_lang.diagnostics import Source, Sources
from xei_lang.profiles.files import shown_path
from xei_lang.profiles.model import Profile

_SUFFIXES = (".yaml", ".urdf", ".srdf")


class _Sources(Mapping[str, Source]):
    """All texts below a folder; one that cannot be read is empty, and nothing of it is quoted."""

    def __init__(self, shown: str) -> None:
        self._shown = shown
        self._read: dict[str, Source] = {}

    def __getitem__(self, file: str) -> Source:
        if not (file.startswith(f"{self._shown}/") and file.endswith(_SUFFIXES)):
            raise KeyError(file)
        if file not in self._read:
            self._read[file] = Source(file, _text(file))
        return self._read[file]

    def __iter__(self) -> Iterator[str]:
        for parent, folders, names in os.walk(self._shown):
            folders.sort()
            for name in sorted(names):
                if name.endswith(_SUFFIXES):
                    yield os.path.join(parent, name).replace(os.sep, "/")

    def __len__(self) -> int:
        return sum(1 for _ in self)


def profile_sources(profile: Profile) -> Sources:
    """The YAML files, the URDF and the SRDF of a profile by the names that its spans carry."""
    return _Sources(profile.folder)


def folder_sources(folder: Path) -> Sources:
    """The same for a folder whose profile did not load, to show why."""
    return _Sources(shown_path(folder))


def _text(file: str) -> str:
    try:
        with open(file, encoding="utf-8", errors="replace", newline="") as opened:
            return opened.read()
    except OSError:
        return ""
