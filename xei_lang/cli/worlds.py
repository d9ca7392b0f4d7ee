"""What `--world` names, as a source of the world that can be asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.cli.options import PROFILE_WORLD
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.profiles.model import Profile
    from xei_lang.world.sources import Observations


def observed_by(named: str, profile: Profile) -> tuple[tuple[Observations, ...], Diagnostics]:
    """What the source that `--world` names says of a profile's objects; with errors, nothing to be used."""
    if named == PROFILE_WORLD:
        return (), ()
    if "://" in named:
        return (), (_no_source(named),)
    from xei_lang.world.sources.scene_file import SceneFileSource

    text, problems = read_source(Path(named), named)
    if text is None:
        return (), problems
    seen, said = SceneFileSource(text).observe(profile)
    return (() if seen is None else (seen,)), said


def _no_source(named: str) -> Diagnostic:
    """A pose service finds objects in a picture, and no camera can be asked for one yet."""
    service = named.startswith(("http://", "https://"))
    note = (
        "a pose service finds objects in a picture of the bench, and no camera can be asked for one yet"
        if service
        else "known are `profile` and the path of a scene file"
    )
    return Diagnostic(
        "XEI0663",
        f"`{named}` cannot be asked where things are",
        notes=(note,),
        help=("record what was seen as a scene file: `xei schema scene_file` prints its form",),
    )
