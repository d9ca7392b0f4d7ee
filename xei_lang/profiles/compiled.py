"""Compiled profiles: a frozen Profile on disk, used while no byte of its files and no line of the loader has
changed.

The form is a pickle that is read through an unpickler which makes nothing but xei's own dataclasses and exact
fractions, so that a file that somebody else wrote into the cache cannot run code. Anything that is wrong with
the cache means a slower load, and is no fault.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
from fractions import Fraction
from pathlib import Path
from typing import Any

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.profiles.cache_key import default_cache, key_of
from xei_lang.profiles.model import Profile

__all__ = ["default_cache", "key_of", "read", "write"]


def read(cache: Path, key: str) -> tuple[Profile, Diagnostics] | None:
    """The compiled profile of this key, or None."""
    try:
        data = _path(cache, key).read_bytes()
        profile, diagnostics = _Unpickler(io.BytesIO(data)).load()
    except Exception:  # a damaged or foreign file may fail in any way; it then counts as absent
        return None
    if not isinstance(profile, Profile) or not all(isinstance(item, Diagnostic) for item in diagnostics):
        return None
    return profile, diagnostics


def write(cache: Path, key: str, profile: Profile, diagnostics: Diagnostics) -> None:
    """Store a profile; a reader sees all of it or nothing. A cache that cannot be written stays as it is."""
    import tempfile

    with contextlib.suppress(OSError):
        cache.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=cache, prefix=".profile-")
        try:
            with os.fdopen(handle, "wb") as file:
                pickle.dump((profile, diagnostics), file, protocol=5)
            os.replace(temporary, _path(cache, key))
        except OSError:
            os.unlink(temporary)
            raise


def _path(cache: Path, key: str) -> Path:
    return cache / f"profile-{key[:40]}.pickle"


class _Unpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == ("fractions", "Fraction"):
            return Fraction
        if module.startswith("xei_lang.") and "." not in name:
            found = super().find_class(module, name)
            if isinstance(found, type) and hasattr(found, "__dataclass_fields__"):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} has no place in a compiled profile")
