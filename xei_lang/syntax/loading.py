"""How later rooms get at other files: through a `Files` that they are given, so that they touch no disk."""

from __future__ import annotations

from typing import Protocol

from xei_lang.diagnostics import Source
from xei_lang.record import Shown, record


@record
class LoadedFile(Shown):
    """The text of a file, and what tells it from all others however it was named."""

    source: Source
    identity: str


@record
class Unusable(Shown):
    """Why a file cannot be had: words that follow its name (`does not exist`), and what may help.

    `outside` says that it would lie, or lies, outside of the project folder.
    """

    reason: str
    outside: bool = False
    help: tuple[str, ...] = ()


class Files(Protocol):
    """The files of the project that a protocol belongs to."""

    def identity(self, file: str) -> str:
        """What tells a file from all others, by the name that its `Source` carries."""
        ...

    def read(self, importing: str, path: str) -> LoadedFile | Unusable:
        """The file that `path` means in the file `importing`."""
        ...


class RecordedFiles:
    """Files of a project that remember what was read of them, for those who must name every input."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._read: dict[str, Source] = {}

    @property
    def sources(self) -> tuple[Source, ...]:
        """The texts that were read, by the files' names as messages show them."""
        return tuple(self._read[file] for file in sorted(self._read))

    def identity(self, file: str) -> str:
        """What tells a file from all others, by the name that its `Source` carries."""
        return self._files.identity(file)

    def read(self, importing: str, path: str) -> LoadedFile | Unusable:
        """The file that `path` means in the file `importing`, remembered where it could be read."""
        found = self._files.read(importing, path)
        if isinstance(found, LoadedFile):
            self._read[found.source.file] = found.source
        return found
