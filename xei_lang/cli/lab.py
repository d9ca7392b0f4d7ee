"""The profile for commands that are given no protocol, and parts of xei that may not be installed."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.report import exit_code, show
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.profiles.compiled import default_cache
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.lookup import find_profile, missing_profile, only_profile
from xei_lang.profiles.model import Profile

_OPTIONAL = frozenset({"cv2", "casadi", "fastapi", "uvicorn", "httpx"})


def open_lab(named: str | None, color: bool) -> Profile:
    """The profile that `--profile` names, or else the only one in `profiles/` from here upward.

    Exits, with a diagnostic, where there is none or it has errors.
    """
    folder, missing = profile_folder(named)
    profile, found = load_profile(folder, default_cache()) if folder else (None, missing)
    if profile is None:
        show(found, {}, color)
        sys.exit(exit_code(found) or INPUT_HAS_ERRORS)
    return profile


def profile_folder(named: str | None) -> tuple[Path | None, Diagnostics]:
    """The folder of the profile that is meant: by its name or path, or the only one that there is."""
    here = Path.cwd()
    if named is None:
        found = only_profile(here)
        return found, () if found else (missing_profile("", here, None, None),)
    path = Path(named)
    found = find_profile(path.name, here, path if "/" in named and path.exists() else None)
    return found, () if found else (missing_profile(named, here, None, None),)


def optional(module: str, color: bool) -> ModuleType:
    """A module of xei that needs a library of the extra `perception`; exits where that is not installed."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as missing:
        if missing.name not in _OPTIONAL:
            raise
        message = f"this needs `{missing.name}`, which is not installed"
        show((Diagnostic("XEI0688", message, help=("pip install 'xei-lang[perception]'",)),), {}, color)
        sys.exit(INPUT_HAS_ERRORS)
