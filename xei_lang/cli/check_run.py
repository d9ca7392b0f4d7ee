"""Checking files for `xei check`: each file's diagnostics, with the text that they speak of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from xei_lang.cli.options import Options
from xei_lang.cli.session import request_for
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.pipeline import check_request
from xei_lang.syntax.reading import read_source


@dataclass(frozen=True, slots=True, eq=False)
class Checked:
    """A file that was checked, by its name in messages. There is no source where it could not be read."""

    file: str
    said: Diagnostics
    source: Source | None


def check_file(file: Path, options: Options) -> Checked:
    """Everything that is to be said of one file."""
    source, found = read_source(file, str(file))
    if source is None:
        return Checked(str(file), found, None)
    request = replace(request_for(source, options, allow_unmapped=True), open_bindings=True)
    return Checked(str(file), (*found, *check_request(request)), source)


def check_files(files: Sequence[Path], options: Options) -> list[Checked]:
    """All files, in their order."""
    return [check_file(file, options) for file in files]
