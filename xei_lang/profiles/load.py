"""Loading a profile: from its compiled form where nothing has changed, else from its files.

This module imports neither yaml nor pydantic; those are paid for only where a file has changed.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span
from xei_lang.profiles.files import ProfileFiles, read_folder, shown_path

if TYPE_CHECKING:
    from xei_lang.profiles.model import Profile


def load_profile(folder: Path, cache: Path | None) -> tuple[Profile | None, Diagnostics]:
    """The profile in a folder, or why there is none; `cache` is the folder of compiled profiles, None for no
    cache.

    Warnings come back with a profile that is read from its compiled form, too.
    """
    try:
        files = read_folder(folder)
    except OSError as error:
        return None, (unreadable(folder, error),)
    return load_files(files, cache)


def load_files(files: ProfileFiles, cache: Path | None) -> tuple[Profile | None, Diagnostics]:
    """The profile of a folder that was read, as `load_profile` gives it."""
    from xei_lang.profiles import compiled

    if cache is None:
        return _build(files)
    key = compiled.key_of(files)
    stored = compiled.read(cache, key)
    if stored is not None:
        return stored
    profile, diagnostics = _build(files)
    if profile is not None:
        compiled.write(cache, key, profile, diagnostics)
    return profile, diagnostics


def _build(files: ProfileFiles) -> tuple[Profile | None, Diagnostics]:
    from xei_lang.profiles.build import build_profile

    return build_profile(files)


def unreadable(folder: Path, error: OSError) -> Diagnostic:
    """Why a folder that cannot be read is no profile."""
    shown = shown_path(folder)
    if isinstance(error, NotADirectoryError):
        return Diagnostic(
            "XEI0601",
            f"`{shown}` is a file, and a profile is a folder",
            help=("name the folder that it stands in",),
        )
    if isinstance(error, FileNotFoundError) and not folder.exists():
        return Diagnostic("XEI0601", f"there is no folder `{shown}`", help=("name the folder of a profile",))
    where = shown_path(Path(error.filename)) if error.filename else shown
    return Diagnostic(
        "XEI0602",
        f"`{where}` cannot be read: {error.strerror}",
        Span(where, 0, 0),
        help=("make it readable",),
    )
