"""Writing one file so that it is whole or not there."""

from __future__ import annotations

import errno
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
    refused = place_refused(path)
    if refused:
        return refused
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            target = Path(os.path.realpath(path))
            target.parent.mkdir(parents=True, exist_ok=True)
            _replace(target, data)
    except OSError as error:
        return (_refused(path, error, ("choose another place with -o",)),)
    return ()


def place_refused(path: Path, option: str = "-o", *, made: bool = True) -> Diagnostics:
    """Why no file may be written at a place, as far as that can be told without writing one.

    A file is `made` as `write_text` does, with its folders; or else it is opened where it stands.
    """
    try:
        if path.is_dir() and made:
            message = f"`{path}` is a folder, and a file was to be written"
            return (Diagnostic("XEI0101", message, help=(f"name a file with {option}",)),)
        if path.exists() and not (made and path.is_file()):
            _must_open(path)
        else:
            _must_make(Path(os.path.realpath(path)), made)
    except OSError as error:
        return (_refused(path, error, (f"choose another place with {option}",)),)
    return ()


def _must_open(path: Path) -> None:
    """Raise OSError where what is there cannot be written to. To open it may wait for who reads a pipe."""
    if path.is_dir():
        raise _error(errno.EISDIR)
    if not os.access(path, os.W_OK):
        raise _error(errno.EACCES)


def _must_make(target: Path, made: bool) -> None:
    """Raise OSError where no new file can be; `made` says that its folders are made, too."""
    if target.is_symlink():
        raise _error(errno.ELOOP)
    above = next(folder for folder in target.parents if folder.exists() or not made)
    if not above.exists():
        raise _error(errno.ENOENT)
    if not above.is_dir():
        raise _error(errno.ENOTDIR)
    if not os.access(above, os.W_OK | os.X_OK):
        raise _error(errno.EACCES)


def _error(number: int) -> OSError:
    return OSError(number, os.strerror(number))


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
