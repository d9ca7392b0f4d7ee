"""Names for what is kept between runs: a name holds everything that what is kept was made from.

Apart from `compiled`, so that who only compares names imports no model of a profile.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import xei_lang
from xei_lang.profiles.files import ProfileFiles

_LOADING = (
    "profiles", "profiles/assets", "profiles/checks", "profiles/model", "profiles/schema", "diagnostics",
    "ir", "quantity", "syntax", "syntax/ast",
)  # fmt: skip

CodeState = tuple[tuple[str, int, int], ...]
"""Name, size and time (ns) of modules and of the schemas beside them, sorted."""


def default_cache() -> Path:
    """`$XDG_CACHE_HOME/xei`, else `~/.cache/xei` (XDG Base Directory Specification)."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    return (Path(base) if os.path.isabs(base) else Path(os.path.expanduser("~/.cache"))) / "xei"


def key_of(files: ProfileFiles) -> str:
    """A name for what a load of these files gives: their bytes, where they are shown, and the code that reads
    them.
    """
    root = _package()
    code = tuple(sorted(found for name in _LOADING for found in _modules(root, name)))
    return digest_of(files.shown, files.hashes, code)


def code_state() -> CodeState:
    """Every module and schema of xei. A change of any may change what is said of a protocol."""
    root = _package()
    return tuple(sorted(found for folder in _folders(root, "") for found in _modules(root, folder)))


def digest_of(*parts: object) -> str:
    """SHA-256 over the text of plain values, the version of xei and that of Python."""
    version = getattr(xei_lang, "__version__", "")
    text = repr((version, sys.version_info[:3], *parts))
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _package() -> str:
    return os.path.dirname(os.path.abspath(xei_lang.__file__))


def _modules(root: str, folder: str) -> Iterator[tuple[str, int, int]]:
    with contextlib.suppress(OSError), os.scandir(os.path.join(root, folder)) as entries:
        for entry in entries:
            if entry.name.endswith((".py", ".json")):
                status = entry.stat()
                yield f"{folder}/{entry.name}", status.st_size, status.st_mtime_ns


def _folders(root: str, folder: str) -> Iterator[str]:
    yield folder
    with contextlib.suppress(OSError), os.scandir(os.path.join(root, folder)) as entries:
        for entry in entries:
            if not entry.name.startswith(("_", ".")) and entry.is_dir():
                yield from _folders(root, os.path.join(folder, entry.name))
