"""A profile's `calibration_profile.yaml`, edited in place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from xei_lang.cli.write_file import rewrite_text
from xei_lang.diagnostics import Diagnostic, Diagnostics, Source
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import Profile
from xei_lang.syntax.reading import read_source


def calibration_path(lab: Profile) -> Path:
    """Where the file is."""
    return Path(lab.folder) / CALIBRATION


def rewrite_calibration(lab: Profile, edit: Callable[[Source], str | Diagnostic]) -> tuple[bool, Diagnostics]:
    """Put what `edit` makes of the file in its place, whole or not at all: whether it changed, and what stood
    in the way.
    """
    file = calibration_path(lab)
    source, problems = read_source(file, str(file))
    if source is None:
        return False, problems
    text = edit(source)
    if isinstance(text, Diagnostic):
        return False, (text,)
    if text == source.text:
        return False, ()
    problems = rewrite_text(file, text)
    return not problems, problems
