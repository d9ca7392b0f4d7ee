"""Opening the profile that a protocol names, and reading the robot's description that belongs to it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.lookup import find_profile, missing_profile

if TYPE_CHECKING:
    from xei_lang.profiles.model import Profile


def open_profile(
    named: tuple[str, Span] | None, protocol: Path, explicit: Path | None, cache: Path | None
) -> tuple[Profile | None, Diagnostics]:
    """The profile that a protocol names (`named`: the name and where it stands), or why there is none.

    `explicit` is the folder that `--profile` names; then the protocol need not name one.
    """
    return open_with(named, protocol, explicit, lambda folder: load_profile(folder, cache))


def open_with(
    named: tuple[str, Span] | None,
    protocol: Path,
    explicit: Path | None,
    load: Callable[[Path], tuple[Profile | None, Diagnostics]],
) -> tuple[Profile | None, Diagnostics]:
    """As `open_profile`, for those who load a folder in a way of their own."""
    if named is None and explicit is not None:
        return load(explicit)
    if named is None:
        return None, (_unnamed(protocol),)
    name, span = named
    folder = find_profile(name, protocol, explicit)
    if folder is None:
        return None, (missing_profile(name, protocol, explicit, span),)
    return load(folder)


def robot_texts(profile: Profile) -> tuple[str, str]:
    """The URDF and the SRDF of a profile, as text.

    Raises OSError where a file has gone since it was loaded.
    """
    folder = Path(profile.folder)
    urdf, srdf = folder / profile.bank.urdf, folder / profile.bank.srdf
    return urdf.read_text(encoding="utf-8"), srdf.read_text(encoding="utf-8")


def _unnamed(protocol: Path) -> Diagnostic:
    return Diagnostic(
        "XEI0601",
        "the protocol names no profile",
        Span(str(protocol), 0, 0),
        label="a protocol is compiled for one laboratory and its robot",
        help=('write `profile "openarm_bench"` as the first line of the protocol, or give --profile FOLDER',),
    )
