"""The bytes of a mesh or a point cloud, as they went into the profile's cache key."""

from __future__ import annotations

import hashlib
import os

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.profiles.files import ProfileFiles

MAX_ASSET_BYTES = 100_000_000


def is_missing(files: ProfileFiles, name: str) -> bool:
    """Whether nothing at all is at this path of the profile, which stays in its folder."""
    return not _leaves(name) and not os.path.lexists(files.folder / name)


def read_asset(files: ProfileFiles, name: str, place: Span) -> bytes | Diagnostic:
    """The bytes of a file of the profile, or why they cannot be had (XEI0602).

    `name` is relative to the profile's folder; only what `read_folder` hashed is read, so that a compiled
    profile is never older than its assets.
    """
    reason, way_out = _refusal(files, name)
    if not reason:
        try:
            data = (files.folder / name).read_bytes()
        except OSError as error:
            reason, way_out = f"`{name}` cannot be read: {error.strerror}", "make it readable"
        else:
            if hashlib.sha256(data).hexdigest() == dict(files.hashes)[name]:
                return data
            reason, way_out = f"`{name}` changed while it was read", "run xei again once it is written"
    return Diagnostic("XEI0602", reason, place, help=(way_out,))


def _refusal(files: ProfileFiles, name: str) -> tuple[str, str]:
    """Why a file may not be read, and the way out; empty where it may."""
    path, root = files.folder / name, os.path.realpath(files.folder)
    if _leaves(name):
        reason = f"`{name}` would leave the profile's folder"
    elif is_missing(files, name):
        put = f"put it at `{files.shown_path(name)}`, or state the shape as a `box` or a `cylinder`"
        return f"the profile has no `{name}`", put
    elif not os.path.realpath(path).startswith(root.rstrip(os.sep) + os.sep):
        reason = f"`{name}` is a link that leads out of the profile's folder"
    else:
        return _unusual(files, name)
    return reason, "copy the file into the profile's folder, and name it from there"


def _leaves(name: str) -> bool:
    return os.path.isabs(name) or ".." in name.split("/") or "\0" in name


def _unusual(files: ProfileFiles, name: str) -> tuple[str, str]:
    path = files.folder / name
    if not os.path.exists(path):
        return f"`{name}` is a link to nothing", "link it to a file of the profile, or copy that"
    if not os.path.isfile(path):
        return f"`{name}` is no file", "name a mesh or a point cloud"
    if name not in dict(files.hashes):
        return f"`{name}` is hidden, or is no plain path", "write its path as `assets/name.stl`, without dots"
    size = os.stat(path).st_size
    if size > MAX_ASSET_BYTES:
        limit = MAX_ASSET_BYTES // 1_000_000
        return f"`{name}` has {size / 1e6:.0f} MB, the limit is {limit} MB", "reduce it to what is needed"
    return "", ""
