"""`xei check`: is this protocol right, without planning any motion."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

import click

from xei_lang.cli.check_run import Checked, check_files
from xei_lang.cli.files import count, protocol_files
from xei_lang.cli.options import Options, compiling
from xei_lang.cli.report import exit_code, show, with_quoted
from xei_lang.diagnostics import Diagnostics, Source


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="PATH...")
@click.option(
    "--format",
    "form",
    type=click.Choice(["full", "concise", "json", "sarif", "github", "junit"]),
    default="full",
    show_default=True,
    help="How to print what was found.",
)
@compiling
def command(*, paths: tuple[Path, ...], form: str, options: Options) -> None:  # fmt: skip
    """Check protocols: names, skills, arguments, units, roles, objects.

    A folder stands for all .xei files below it.

    Example: xei check protocols/
    """
    files = protocol_files(paths)
    checked = check_files(files, options)
    sources = {item.source.file: item.source for item in checked if item.source is not None}
    said = tuple(diagnostic for item in checked for diagnostic in item.said)
    if form != "full":
        _print(form, checked, sources)
    else:
        show(
            tuple(item for item in said if not options.quiet or item.severity == "error"),
            sources,
            options.color,
        )
        if not options.quiet:
            click.echo(_summary(said, len(files)), err=True)
    gc.freeze()  # the process ends here: what it holds goes with it, unsearched
    sys.exit(exit_code(said))


def _print(form: str, checked: list[Checked], sources: dict[str, Source]) -> None:
    from xei_lang.cli.check_forms import render

    said = tuple(diagnostic for item in checked for diagnostic in item.said)
    pairs = [(item.file, item.said) for item in checked]
    click.echo(render(form, pairs, with_quoted(said, sources)), nl=False)


def _summary(said: Diagnostics, files: int) -> str:
    errors = [diagnostic.code for diagnostic in said if diagnostic.severity == "error"]
    warnings = [diagnostic.code for diagnostic in said if diagnostic.severity == "warning"]
    counts = (count(files, "file"), count(len(errors), "error"), count(len(warnings), "warning"))
    summary = "{} checked: {}, {}".format(*counts)
    first = (*errors, *warnings)[:1]
    return f"{summary}; `xei explain {first[0]}` says more" if first else summary
