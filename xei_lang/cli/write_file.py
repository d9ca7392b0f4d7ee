"""Writing one file so that it is whole or not there."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Diagnostics


def write_text(path: Path, text: str) -> Diagnostics:
    """Write beside the target, then rename; a refusal of the system comes back as a diagnostic.

    A symbolic link stays and what it leads to is written. What is no regular file (`/dev/stdout`, a pipe) is
    written to, and never replaced.
    """
    return write_bytes(path, text.encode())


def write_bytes(path: Path, data: bytes) -> Diagnostics:
    """As `write_text`, for what is no text."""
    if path.is_dir():
        message = f"`{path}` is a folder, and a file was to be written"
        return (Diagnostic("XEI0101", message, help=("name a file with -o",)),)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            _replace(Path(os.path.realpath(path)), data)
    except OSError as error:
        return (_refused(path, error, ("choose another place with -o",)),)
    return ()


def rewrite_text(path: Path, text: str, *, bom: bool = False) -> Diagnostics:
    """Put a text in the place of a file's present one, whole or not at all.

    A symbolic link stays and what it leads to is written; permissions stay; line ends are those of the text.
    With `bom` the file begins with a byte order mark.
    """
    try:
        target = path.resolve(strict=True)
        if not os.access(target, os.W_OK):
            raise PermissionError(None, "permission denied")
        _replace(target, text.encode("utf-8-sig" if bom else "utf-8"), stat.S_IMODE(target.stat().st_mode))
    except OSError as error:
        return (_refused(path, error, ("check the permissions of the file and its folder",)),)
    return ()


def _replace(path: Path, data: bytes, mode: int | None = None) -> None:
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with aside.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            aside.chmod(mode)
        aside.replace(path)
    finally:
        aside.unlink(missing_ok=True)


def _refused(path: Path, error: OSError, help: tuple[str, ...]) -> Diagnostic:
    reason = (error.strerror or str(error)).lower()
    return Diagnostic("XEI0101", f"`{path}` cannot be written: {reason}", help=help)
