"""Where a profile is looked for: where one says, upward from the protocol, then in the package."""

from __future__ import annotations

from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.profiles.files import shown_path
from xei_lang.resources import resource_path


def find_profile(name: str, start: Path, explicit: Path | None) -> Path | None:
    """The folder of the profile of this name, or None.

    `explicit` is the folder itself, or one that holds profiles, and is then the only place. `start` is the
    protocol, or the folder that it stands in.
    """
    for place in search_places(start, explicit):
        candidate = place / name
        if _is_profile(candidate):
            return candidate
    if explicit is not None and _is_profile(explicit):
        return explicit
    return None


def only_profile(start: Path) -> Path | None:
    """The profile of the nearest folder of profiles, if it holds just one."""
    nearest = next(
        (found for place in search_places(start, None) if (found := _profiles(place))), list[Path]()
    )
    return nearest[0] if len(nearest) == 1 else None


def search_places(start: Path, explicit: Path | None) -> tuple[Path, ...]:
    """The folders that hold folders of profiles, in the order in which they are searched."""
    if explicit is not None:
        return (explicit,)
    absolute = start.absolute()
    folder = absolute if absolute.is_dir() else absolute.parent
    upward = tuple(parent / "profiles" for parent in (folder, *folder.parents))
    packaged = resource_path("profiles")
    return upward if packaged in upward else (*upward, packaged)


def missing_profile(name: str, start: Path, explicit: Path | None, span: Span | None) -> Diagnostic:
    """What to say where `find_profile` found none: what there is instead, and where it looked.

    `span` is where the protocol names the profile.
    """
    places = search_places(start, explicit)
    found = sorted({folder.name: folder for place in reversed(places) for folder in _profiles(place)}.items())
    near = did_you_mean(name, [known for known, _ in found])
    looked = [shown_path(place) for place in places if place.is_dir()] or [shown_path(places[0])]
    if near:
        way_out = f"did you mean `{near[0]}`?"
    elif found:
        way_out = "found: " + ", ".join(f"`{known}` ({shown_path(folder)})" for known, folder in found)
    else:
        way_out = f"make a folder `profiles/{name}` beside the protocol, or name one with --profile"
    return Diagnostic(
        "XEI0601",
        f"there is no profile `{name}`",
        span,
        label="no folder of this name is a profile",
        notes=("looked in " + ", ".join(f"`{place}`" for place in looked),),
        help=(way_out,),
    )


def _profiles(place: Path) -> list[Path]:
    try:
        return [folder for folder in sorted(place.iterdir()) if _is_profile(folder)]
    except OSError:
        return []


def _is_profile(folder: Path) -> bool:
    """Whether a folder means to be a profile: a broken one is found, and its faults are told."""
    try:
        return folder.is_dir() and any(folder.glob("*_profile.yaml"))
    except OSError:
        return False
