"""The texts of a profile's files, for quoting in messages; each is read when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.diagnostics import Source, Sources
from xei_lang.profiles.model import Profile


class _Sources(Mapping[str, Source]):
    def __init__(self, files: tuple[str, ...]) -> None:
        self._files = files
        self._read: dict[str, Source] = {}

    def __getitem__(self, file: str) -> Source:
        if file not in self._files:
            raise KeyError(file)
        if file not in self._read:
            self._read[file] = Source(file, _text(file))
        return self._read[file]

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)


def profile_sources(profile: Profile) -> Sources:
    """The YAML files, the URDF and the SRDF of a profile by the names that its spans carry.

    A file that cannot be read any more is empty text: its spans then show without a quotation.
    """
    return folder_sources(profile.folder, tuple(name for name, _ in profile.files))


def folder_sources(shown: str, names: tuple[str, ...]) -> Sources:
    """The same for a folder whose profile did not load: `shown` is the folder as messages show it."""
    suffixes = (".yaml", ".urdf", ".srdf")
    return _Sources(tuple(f"{shown}/{name}" for name in names if name.endswith(suffixes)))


def _text(file: str) -> str:
    try:
        with open(file, encoding="utf-8", errors="replace", newline="") as opened:
            return opened.read()
    except OSError:
        return ""
