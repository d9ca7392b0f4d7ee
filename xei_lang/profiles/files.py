"""The files of a profile folder: what is there, its bytes' hashes, and the texts of those that are read."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Source, Span
from xei_lang.record import Shown, record

DEVELOPMENT = "development_profile.yaml"
CALIBRATION = "calibration_profile.yaml"
REGISTRY = "object_registry.yaml"
MAX_TEXT_BYTES = 2_000_000


@record
class ProfileFiles(Shown):
    """A profile folder as read: `shown` is its path for messages, `hashes` the SHA-256 of each file below it,
    sorted.
    """

    folder: Path
    shown: str
    hashes: tuple[tuple[str, str], ...]

    def shown_path(self, name: str) -> str:
        """The path of one of the files, as messages show it."""
        return f"{self.shown}/{name}"


def read_folder(folder: Path) -> ProfileFiles:
    """Hash every file below the folder but hidden ones and Python's caches; raises OSError.

    Links to folders are followed, as reading follows them, but no folder is gone through twice.
    """
    hashes: list[tuple[str, str]] = []
    seen: set[str] = set()
    for parent, folders, names in os.walk(folder, onerror=_raise, followlinks=True):
        real = os.path.realpath(parent)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        folders[:] = [name for name in folders if name != "__pycache__" and not name.startswith(".")]
        for name in names:
            path = os.path.join(parent, name)
            if not name.startswith(".") and os.path.isfile(path):
                with open(path, "rb") as file:
                    digest = hashlib.file_digest(file, "sha256").hexdigest()
                hashes.append((os.path.relpath(path, folder).replace(os.sep, "/"), digest))
    return ProfileFiles(folder, shown_path(folder), tuple(sorted(hashes)))


def shown_path(path: Path) -> str:
    """The path as people expect it in messages: relative to the working folder where it lies below that."""
    absolute = os.path.abspath(path)
    here = os.getcwd()
    below = absolute == here or absolute.startswith(here.rstrip(os.sep) + os.sep)
    return (os.path.relpath(absolute, here) if below else absolute).replace(os.sep, "/")


def read_text(
    files: ProfileFiles, name: str, found: list[Diagnostic], named_at: Span | None = None
) -> Source | None:
    """The text of one file; None, with a diagnostic, where it is missing, too large or no UTF-8.

    `named_at` is the place that names the file, where another file does so.
    """
    shown = files.shown_path(name)
    place = named_at or Span(shown, 0, 0)
    if os.path.isabs(name) or ".." in name.split("/"):
        found.append(
            Diagnostic(
                "XEI0602",
                f"`{name}` would leave the profile's folder",
                place,
                help=("name a file inside the profile's folder",),
            )
        )
        return None
    try:
        data = _bytes_of(files.folder / name)
    except OSError as error:
        missing = isinstance(error, FileNotFoundError)
        message = f"the profile has no `{name}`" if missing else f"`{name}` cannot be read: {error.strerror}"
        found.append(
            Diagnostic(
                "XEI0602",
                message,
                place,
                notes=(
                    f"a profile has `{DEVELOPMENT}`, `{CALIBRATION}`, `{REGISTRY}` and the files they name",
                ),
                help=(f"put it at `{shown}`" if missing else f"make `{shown}` a file that can be read",),
            )
        )
        return None
    if len(data) > MAX_TEXT_BYTES:
        found.append(
            Diagnostic(
                "XEI0602",
                f"`{name}` is larger than {MAX_TEXT_BYTES // 1_000_000} MB",
                place,
                help=("keep meshes and recordings in files of their own",),
            )
        )
        return None
    return _decode(data, name, shown, found)


def _bytes_of(path: Path) -> bytes:
    # Opening a pipe waits for whoever writes to it.
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(None, "it is no regular file")
    return path.read_bytes()


def _decode(data: bytes, name: str, shown: str, found: list[Diagnostic]) -> Source | None:
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        column = error.start - (data.rfind(b"\n", 0, error.start) + 1) + 1
        offset = len(data[: error.start].decode("utf-8"))
        found.append(
            Diagnostic(
                "XEI0602",
                f"`{name}` is not UTF-8 text",
                Span(shown, offset, offset + 1),
                label=f"byte 0x{data[error.start]:02x} at line {line}, byte {column}",
                help=("save the file as UTF-8",),
            )
        )
        return None
    if text.startswith("\ufeff"):
        found.append(
            Diagnostic(
                "XEI0602",
                f"`{name}` begins with a byte order mark",
                Span(shown, 0, 1),
                help=("save the file as UTF-8 without a byte order mark",),
            )
        )
        return None
    return Source(shown, text)


def _raise(error: OSError) -> None:
    raise error
