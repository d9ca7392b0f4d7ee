"""The forms in which `xei check` prints what it found, each from a module that only it imports."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

from xei_lang import __version__
from xei_lang.diagnostics import Diagnostics, Sources

if TYPE_CHECKING:
    from xei_lang.diagnostics.render.junit import Checked


def render(form: str, checked: Sequence[Checked], sources: Sources) -> str:
    """What `--format FORM` prints to standard output; `form` is one of `FORMS`."""
    return FORMS[form](checked, sources)


def _concise(checked: Sequence[Checked], sources: Sources) -> str:
    from xei_lang.diagnostics.render.concise import render_concise

    return render_concise(_all(checked), sources)


def _json(checked: Sequence[Checked], sources: Sources) -> str:
    from xei_lang.diagnostics.render.json import render_json

    return render_json(_all(checked), sources, len(checked))


def _sarif(checked: Sequence[Checked], sources: Sources) -> str:
    from xei_lang.diagnostics.render.sarif import render_sarif

    return render_sarif(_all(checked), sources, __version__)


def _github(checked: Sequence[Checked], sources: Sources) -> str:
    from xei_lang.diagnostics.render.github import render_github

    return render_github(_all(checked), sources)


def _junit(checked: Sequence[Checked], sources: Sources) -> str:
    from xei_lang.diagnostics.render.junit import render_junit

    return render_junit(checked, sources)


def _all(checked: Sequence[Checked]) -> Diagnostics:
    return tuple(diagnostic for _, said in checked for diagnostic in said)


FORMS: Mapping[str, Callable[[Sequence[Checked], Sources], str]] = MappingProxyType(
    {"concise": _concise, "json": _json, "sarif": _sarif, "github": _github, "junit": _junit}
)
"""The forms that go to standard output; `full`, which people read, goes to standard error."""
