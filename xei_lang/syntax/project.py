"""The files that a protocol may import: those of its project folder, and no others.

The project folder is the nearest folder upward from the protocol that holds `profiles/`, `pyproject.toml` or
`.git`; without one it is the protocol's own folder.
"""

from __future__ import annotations

import os
from pathlib import Path

from xei_lang.diagnostics import Source, did_you_mean
from xei_lang.record import Shown, record
from xei_lang.syntax.loading import LoadedFile, Unusable
from xei_lang.syntax.reading import read_source

_MARKS = ("profiles", "pyproject.toml", ".git")


def project_folder(protocol: Path) -> Path:
    """The project folder of a protocol, with symbolic links resolved."""
    own = Path(os.path.realpath(protocol.parent))
    marked = (folder for folder in (own, *own.parents) if any((folder / mark).exists() for mark in _MARKS))
    return next(marked, own)


@record
class ProjectFiles(Shown):
    """Reads files of the project of one protocol; a file is named in messages as the importing one is."""

    protocol: Path

    def identity(self, file: str) -> str:
        """The real path of a file."""
        return os.path.realpath(file)

    def read(self, importing: str, path: str) -> LoadedFile | Unusable:
        """The file that `path` means in the file `importing`, or why it cannot be had."""
        wrong = _misnamed(path)
        if wrong is not None:
            return wrong
        joined = os.path.normpath(os.path.join(os.path.dirname(importing), path)).replace(os.sep, "/")
        real = os.path.realpath(joined)
        folder = project_folder(self.protocol)
        if not Path(real).is_relative_to(folder):
            linked = Path(os.path.abspath(joined)).is_relative_to(folder)
            how = "is a link out of" if linked else "lies outside of"
            return Unusable(f"{how} the project folder", True, (f"put a copy of it below `{folder.name}`",))
        if os.path.exists(real) and not os.path.isfile(real):
            return Unusable("is a folder, not a file" if os.path.isdir(real) else "is no regular file")
        source, problems = read_source(Path(real), path)
        if source is not None:
            return LoadedFile(Source(joined, source.text), real)
        problem = problems[0]
        return Unusable(problem.message.removeprefix(f"`{path}` "), help=_near(joined, path) or problem.help)


def _misnamed(path: str) -> Unusable | None:
    if not path.strip() or not path.isprintable():
        return Unusable("is no path")
    if "\\" in path:
        return Unusable("has a backslash in it", help=(f"write `{path.replace(chr(92), '/')}`",))
    if path.startswith(("/", "~")) or path[1:2] == ":":
        return Unusable("is an absolute path", True, ("name the file as seen from this one",))
    return None


def _near(joined: str, path: str) -> tuple[str, ...]:
    """The file of that folder that was perhaps meant."""
    try:
        names = sorted(os.listdir(os.path.dirname(joined) or "."))
    except OSError:
        return ()
    name = os.path.basename(path)
    suffix = os.path.splitext(path)[1] or ".xei"
    known = tuple(item for item in names if item.endswith(suffix))
    close = (name + suffix,) if name + suffix in known else did_you_mean(name, known)
    shown = " or ".join(f"`{os.path.join(os.path.dirname(path), item)}`" for item in close)
    return (f"did you mean {shown}?",) if close else ()
