"""Bundles on disk: written aside and renamed into place, so that none is ever half there."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, cast

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.export.manifest import FORMAT, VERSION, Manifest
from xei_lang.ir.forms.canonical import dumps

MANIFEST = "manifest.json"
Content = bytes | Callable[[Path], None]
"""A file's bytes, or what writes a file or a folder at a path (and raises OSError where the disk refuses)."""

_NO_SPACE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write_bundle(directory: Path, contents: Mapping[str, Content], manifest: Manifest) -> Diagnostics:
    """Write the contents, by relative path, and their manifest; replaces an older bundle at the same place.

    Files are written and synced in a hidden folder beside the target, which is then renamed. Whatever stops
    this, an interrupt included, leaves the target as it was. A folder of anything else is never replaced.
    """
    try:
        target = Path(os.path.realpath(directory))
        if target.name:
            target.parent.mkdir(parents=True, exist_ok=True)
            _recover(target)
        refusal = _refusal(target, directory)
        if refusal:
            return (refusal,)
        aside = target.with_name(f".{target.name}.xei-new.{os.getpid()}")
        try:
            aside.mkdir()
            _fill(aside, contents, manifest)
            _swap(aside, target)
        finally:
            shutil.rmtree(aside, ignore_errors=True)
            if target.exists():
                shutil.rmtree(_old(target), ignore_errors=True)
    except OSError as error:
        return (_refused_by_system(directory, error),)
    return ()


def place_refused(directory: Path) -> Diagnostics:
    """Why no bundle may stand at a place, as far as that can be told before there is one."""
    try:
        target = Path(os.path.realpath(directory))
        refusal = _refusal(target, directory)
        above = next(folder for folder in target.parents or (target,) if folder.exists())
        if not above.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not os.access(above, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as error:
        return (_refused_by_system(directory, error),)
    return (refusal,) if refusal else ()


@dataclass(frozen=True, slots=True)
class Bundle:
    """A bundle whose every file is the one that was written. `files` are the bytes by relative path."""

    manifest: Mapping[str, Any]
    files: Mapping[str, bytes]


def read_bundle(directory: Path) -> tuple[Bundle | None, Diagnostics]:
    """The bundle of a folder with all hashes verified, or what is wrong with it."""
    try:
        text = (directory / MANIFEST).read_bytes()
    except OSError as error:
        help = ("compile the protocol to a bundle first: `xei compile FILE -o DIR`",)
        reason = (error.strerror or str(error)).lower()
        message = f"`{directory}` has no {MANIFEST} that can be read: {reason}"
        return None, (Diagnostic("XEI0952", message, help=help),)
    manifest = _manifest(text)
    if manifest is None:
        message = f"`{directory / MANIFEST}` is no manifest of a bundle of version {VERSION}"
        return None, (Diagnostic("XEI0952", message, help=(_AGAIN,)),)
    files: dict[str, bytes] = {}
    found: list[Diagnostic] = []
    for name, expected in manifest["files"].items():
        try:
            files[name] = (directory / name).read_bytes()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            found.append(
                Diagnostic("XEI0953", f"`{name}` of the bundle cannot be read: {reason}", help=(_AGAIN,))
            )
            continue
        if hashlib.sha256(files[name]).hexdigest() != expected:
            note = "its SHA-256 is not the one in the manifest"
            message = f"`{name}` of the bundle was changed after it was written"
            found.append(Diagnostic("XEI0954", message, notes=(note,), help=(_AGAIN,)))
    return (None, tuple(found)) if found else (Bundle(manifest, files), ())


_AGAIN = "compile the protocol again"


def _fill(folder: Path, contents: Mapping[str, Content], manifest: Manifest) -> None:
    for name, content in contents.items():
        if not _is_inside(name):
            raise ValueError(f"{name} is no path inside a bundle")
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            content(path)
    hashes = {path.relative_to(folder).as_posix(): _sha256(path) for path in _files(folder)}
    (folder / MANIFEST).write_text(dumps(manifest.to_json(hashes)), encoding="utf-8", newline="\n")
    for path in (*_files(folder), *_folders(folder)):
        _sync(path)


def _swap(aside: Path, target: Path) -> None:
    old = _old(target)
    try:
        if target.exists():
            target.rename(old)
        aside.rename(target)
    except BaseException:
        if old.exists() and not target.exists():
            old.rename(target)
        raise
    _sync(target.parent)


def _recover(target: Path) -> None:
    """Put right what a process left that was killed: a bundle renamed away, or a folder half filled."""
    old = _old(target)
    if old.exists():
        if target.exists():
            shutil.rmtree(old)
        else:
            old.rename(target)
    for leftover in target.parent.glob(f".{_escaped(target.name)}.xei-new.*"):
        if not _is_running(leftover.name.rpartition(".")[2]):
            shutil.rmtree(leftover)


def _refusal(target: Path, shown: Path) -> Diagnostic | None:
    help = ("choose another place with `-o DIR`",)
    if target.exists() and not target.is_dir():
        return Diagnostic("XEI0951", f"`{shown}` is a file, and a bundle is a folder", help=help)
    if target.is_dir() and any(target.iterdir()) and not _is_bundle(target):
        note = "only a bundle is ever replaced, so that nothing else can be lost"
        return Diagnostic("XEI0951", f"`{shown}` is a folder that is no bundle", notes=(note,), help=help)
    return None


def _is_bundle(folder: Path) -> bool:
    try:
        value: Any = json.loads((folder / MANIFEST).read_bytes())
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(value, dict) and cast(dict[str, Any], value).get("format") == FORMAT


def _manifest(text: bytes) -> dict[str, Any] | None:
    try:
        value: Any = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(value, dict):
        return None
    manifest = cast(dict[str, Any], value)
    files: Any = manifest.get("files")
    if manifest.get("format") != FORMAT or manifest.get("version") != VERSION or not isinstance(files, dict):
        return None
    named = cast(dict[str, Any], files)
    return manifest if all(_is_inside(name) for name in named) else None


def _is_inside(name: str) -> bool:
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and "\0" not in name


def _refused_by_system(shown: Path, error: OSError) -> Diagnostic:
    reason = error.strerror or str(error)
    help = "choose a folder that can be written with `-o DIR`"
    if error.errno in _NO_SPACE:
        help = "free some space, or choose another place with `-o DIR`"
    note = "what stood there before is untouched"
    return Diagnostic(
        "XEI0950", f"`{shown}` cannot be written: {reason.lower()}", notes=(note,), help=(help,)
    )


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.rglob("*")) if path.is_file())


def _folders(folder: Path) -> Iterator[Path]:
    yield from (path for path in sorted(folder.rglob("*")) if path.is_dir())
    yield folder


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _old(target: Path) -> Path:
    return target.with_name(f".{target.name}.xei-old")


def _escaped(name: str) -> str:
    return "".join(f"[{char}]" if char in "*?[" else char for char in name)


def _is_running(pid: str) -> bool:
    with suppress(ValueError, ProcessLookupError, OverflowError):
        try:
            os.kill(int(pid), 0)
        except PermissionError:
            return True
        return True
    return False
