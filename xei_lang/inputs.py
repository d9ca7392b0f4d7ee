"""What a check takes from outside of its own text: the files that it imports, and its profile.

`Inputs` are fetched once and serve many checks, which so see one state of the disk. `Outside` is what one
check sees of them; it remembers each question that the check asked, with a digest of the answer. As long as
the same questions have the same answers, a check of the same text says the same: whatever lets a check learn
anything else about the disk must become a question here.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostics, Source, Span
from xei_lang.profiles.cache_key import digest_of, key_of
from xei_lang.profiles.files import ProfileFiles, read_folder
from xei_lang.profiles.lookup import find_profile, missing_profile, only_profile
from xei_lang.syntax.loading import LoadedFile, Unusable
from xei_lang.syntax.project import ProjectFiles, project_folder

if TYPE_CHECKING:
    from xei_lang.profiles.model import Profile
    from xei_lang.syntax.ast import Module
    from xei_lang.syntax.parser import Parser

Question = tuple[str, ...]
"""A kind (`read`, `identity`, `named`, `given`, `only`) and what it asks about."""

Loaded = tuple["Profile | None", Diagnostics]


class Inputs:
    """Files, profiles and the parser, each fetched when it is first needed; `cache` as for `load_profile`."""

    def __init__(self, cache: Path | None) -> None:
        self._cache = cache
        self._parser: Parser | None = None
        self._folders: dict[Path, Path] = {}
        self._found: dict[tuple[str, Path, Path | None], Path | None] = {}
        self._only: dict[Path, Path | None] = {}
        self._read: dict[tuple[Path, str, str], LoadedFile | Unusable] = {}
        self._files: dict[Path, ProfileFiles | OSError] = {}
        self._states: dict[Path, str] = {}
        self._loaded: dict[Path, Loaded] = {}

    @property
    def parser(self) -> Parser:
        """The parser of all texts."""
        from xei_lang.syntax.parser import Parser

        self._parser = self._parser or Parser()
        return self._parser

    def read(self, protocol: Path, importing: str, path: str) -> LoadedFile | Unusable:
        """The file that `path` means in `importing`, a file of the project that `protocol` belongs to."""
        own = protocol.parent
        project = self._folders.get(own) or self._folders.setdefault(own, project_folder(protocol))
        key = (project, os.path.dirname(importing), path)
        if key not in self._read:
            self._read[key] = ProjectFiles(protocol).read(importing, path)
        return self._read[key]

    def find(self, name: str, protocol: Path, explicit: Path | None) -> Path | None:
        """The folder of the profile that a protocol names, as `find_profile` gives it."""
        key = (name, protocol.parent, explicit)
        if key not in self._found:
            self._found[key] = find_profile(name, protocol, explicit)
        return self._found[key]

    def only(self, protocol: Path) -> Path | None:
        """The profile that a file without one is checked with, as `only_profile` gives it."""
        if protocol.parent not in self._only:
            self._only[protocol.parent] = only_profile(protocol)
        return self._only[protocol.parent]

    def load(self, folder: Path) -> Loaded:
        """The profile in a folder, as `load_profile` gives it."""
        from xei_lang.profiles.load import load_files, unreadable

        if folder not in self._loaded:
            files = self._profile_files(folder)
            broken = isinstance(files, OSError)
            self._loaded[folder] = (
                (None, (unreadable(folder, files),)) if broken else load_files(files, self._cache)
            )
        return self._loaded[folder]

    def state(self, folder: Path) -> str:
        """A digest of everything that loading the profile in a folder depends on."""
        if folder not in self._states:
            files = self._profile_files(folder)
            broken = isinstance(files, OSError)
            self._states[folder] = (
                digest_of(str(folder), files.errno, files.filename, folder.exists())
                if broken
                else key_of(files)
            )
        return self._states[folder]

    def _profile_files(self, folder: Path) -> ProfileFiles | OSError:
        if folder not in self._files:
            try:
                self._files[folder] = read_folder(folder)
            except OSError as error:
                self._files[folder] = error
        return self._files[folder]


class Outside:
    """What lies outside of one protocol; `asked` holds each question with a digest of its answer."""

    def __init__(self, inputs: Inputs, protocol: Path, explicit: Path | None) -> None:
        self._inputs = inputs
        self._protocol = protocol
        self._explicit = explicit
        self.asked: dict[Question, str] = {}

    def parse(self, source: Source) -> tuple[Module | None, Diagnostics]:
        """The syntax tree of a text, as `parse_module` gives it."""
        return self._inputs.parser.module(source)

    def identity(self, file: str) -> str:
        """As `Files.identity`."""
        self._ask("identity", file)
        return ProjectFiles(self._protocol).identity(file)

    def read(self, importing: str, path: str) -> LoadedFile | Unusable:
        """As `Files.read`."""
        self._ask("read", importing, path)
        return self._inputs.read(self._protocol, importing, path)

    def profile(self, named: tuple[str, Span] | None, *, library: bool) -> Loaded:
        """The profile that a protocol names; a file of procedures is checked with the only one there is."""
        from xei_lang.profiles.open import open_with

        folder = self._explicit
        if folder is None and library:
            self._ask("only")
            folder = self._inputs.only(self._protocol)
        elif named is not None:
            self._ask("named", named[0])
        elif folder is not None:
            self._ask("given")
        return open_with(named, self._protocol, folder, self._inputs.load)

    def answer(self, question: Question) -> str:
        """The digest of what a question has for an answer now; raises ValueError where it is none."""
        match question:
            case ("read", importing, path):
                return _digest(self._inputs.read(self._protocol, importing, path))
            case ("identity", file):
                return digest_of(ProjectFiles(self._protocol).identity(file))
            case ("named", name):
                folder = self._inputs.find(name, self._protocol, self._explicit)
                return self._missing(name) if folder is None else self._inputs.state(folder)
            case ("given",) if self._explicit is not None:
                return self._inputs.state(self._explicit)
            case ("only",):
                folder = self._inputs.only(self._protocol)
                return digest_of(None) if folder is None else self._inputs.state(folder)
            case _:
                raise ValueError(question)

    def _ask(self, *question: str) -> None:
        self.asked[question] = self.answer(question)

    def _missing(self, name: str) -> str:
        return digest_of(repr(missing_profile(name, self._protocol, self._explicit, None)))


def _digest(found: LoadedFile | Unusable) -> str:
    if isinstance(found, Unusable):
        return digest_of("unusable", found.reason, found.outside, found.help)
    return digest_of(found.source.file, found.identity, found.source.text)
