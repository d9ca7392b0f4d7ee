"""`xei check`: is this protocol right, without planning any motion."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.exit_codes import WRONG_USAGE
from xei_lang.cli.options import cache_folder, compiling, pairs, wants_color
from xei_lang.cli.report import exit_code, show, with_quoted
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.pipeline import FRONT, Request, compile_request
from xei_lang.syntax.reading import read_source


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="PATH...")
@click.option("--format", "form", type=click.Choice(["full", "json"]), default="full", show_default=True,
              help="How to print what was found.")  # fmt: skip
@compiling
def command(
    paths: tuple[Path, ...],
    form: str,
    profile: Path | None,
    bindings: tuple[str, ...],
    params: tuple[str, ...],
    seed: int,
    color: str,
    quiet: bool,
) -> None:
    """Check protocols: names, skills, arguments, units, roles, objects.

    A folder stands for all .xei files below it.

    Example: xei check protocols/
    """
    files = _files(paths)
    bound, given = pairs("--bind", bindings), pairs("--param", params)
    said: Diagnostics = ()
    sources: dict[str, Source] = {}
    for file in files:
        source, problems = read_source(file, str(file))
        said = (*said, *problems)
        if source is not None:
            sources[source.file] = source
            request = Request(source, profile, cache_folder(), bound, given, open_bindings=True, seed=seed)
            said = (*said, *compile_request(request, FRONT).diagnostics)
    _print(said, sources, form, len(files), wants_color(color), quiet)
    sys.exit(exit_code(said))


def _files(paths: tuple[Path, ...]) -> list[Path]:
    found: list[Path] = []
    for path in paths:
        found.extend(sorted(path.rglob("*.xei")) if path.is_dir() else [path])
    if not found:
        folders = ", ".join(f"`{path}`" for path in paths)
        click.echo(f"error: there is no .xei file in {folders}", err=True)
        sys.exit(WRONG_USAGE)
    return list(dict.fromkeys(found))


def _print(
    said: Diagnostics, sources: dict[str, Source], form: str, files: int, color: bool, quiet: bool
) -> None:
    if form == "json":
        from xei_lang.diagnostics.render.json import render_json

        click.echo(render_json(said, with_quoted(said, sources), files), nl=False)
        return
    errors = sum(diagnostic.severity == "error" for diagnostic in said)
    warnings = sum(diagnostic.severity == "warning" for diagnostic in said)
    show(tuple(item for item in said if not quiet or item.severity == "error"), sources, color)
    if not quiet:
        click.echo(_summary(files, errors, warnings), err=True)


def _summary(files: int, errors: int, warnings: int) -> str:
    counted = [_count(errors, "error"), _count(warnings, "warning")]
    return f"{_count(files, 'file')} checked: {', '.join(counted)}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
