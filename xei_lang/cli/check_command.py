"""`xei check`: is this protocol right, without planning any motion."""

from __future__ import annotations

import gc
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from xei_lang.cli.check_run import Checked, Run, check_files
from xei_lang.cli.files import count, protocol_files
from xei_lang.cli.once import told_once
from xei_lang.cli.options import Options, compiling
from xei_lang.cli.progress import Bar
from xei_lang.cli.report import exit_code, show, with_quoted
from xei_lang.diagnostics import Diagnostic, Diagnostics, Source


@dataclass(frozen=True, slots=True, eq=False)
class _Asked:
    """What one call of the command asks for."""

    paths: tuple[Path, ...]
    form: str
    jobs: int
    cached: bool
    baseline: Path | None
    options: Options


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
@click.option(
    "--jobs",
    type=click.IntRange(1, 256),
    default=1,
    show_default=True,
    metavar="N",
    help="Check files in N processes.",
)
@click.option("--watch", is_flag=True, help="Check again whenever a file changes, until Ctrl-C.")
@click.option(
    "--baseline",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Report only what is not in this report of --format json or sarif.",
)
@click.option("--no-cache", is_flag=True, help="Check unchanged files too, and keep no results.")
@compiling
def command(
    *,
    paths: tuple[Path, ...],
    form: str,
    jobs: int,
    watch: bool,
    baseline: Path | None,
    no_cache: bool,
    options: Options,
) -> None:  # fmt: skip
    """Check protocols: names, skills, arguments, units, roles, objects.

    A folder stands for all .xei files below it; a .json file is checked as a plan from elsewhere.

    \b
    Examples:
      xei check protocols/
      xei check --jobs 4 --format junit protocols/ > report.xml
      xei check --watch protocols/put_on_rack.xei
      xei check --format json protocols/ > baseline.json
      xei check --baseline baseline.json protocols/
    """
    asked = _Asked(paths, form, jobs, not no_cache, baseline, options)
    if watch:
        from xei_lang.cli.watch import watch_files

        sys.exit(watch_files(paths, options, lambda files: _check(asked, files)))
    code, _ = _check(asked, protocol_files(paths))
    gc.freeze()  # the process ends here: what it holds goes with it, unsearched
    sys.exit(code)


def _check(asked: _Asked, files: Sequence[Path]) -> tuple[int, list[Checked]]:
    """Check files and print what there is to say; the exit code, and what was checked."""
    checked = _checked(asked, files)
    once = told_once(checked)
    sources = {item.source.file: item.source for item in once if item.source is not None}
    told = ""
    if asked.baseline is not None:
        from xei_lang.cli.baseline import compare, read_baseline

        baseline = read_baseline(asked.baseline)
        if isinstance(baseline, Diagnostic):
            show((baseline,), {}, asked.options.color)
            return exit_code((baseline,)), checked
        compared = compare(once, with_quoted(_said(once), sources), baseline)
        once = compared.checked
        told = f"; known and not shown: {compared.hidden}, known and no longer there: {compared.gone}"
    said = _said(once)
    if asked.form != "full":
        _print(asked.form, once, sources)
    else:
        quiet = asked.options.quiet
        shown = tuple(item for item in said if not quiet or item.severity == "error")
        show(shown, sources, asked.options.color)
        if not quiet:
            click.echo(_summary(said, len(files), told), err=True)
    return exit_code(said), checked


def _checked(asked: _Asked, files: Sequence[Path]) -> list[Checked]:
    bar, total = Bar(), len(files)

    def progress(done: int) -> None:
        if not asked.options.quiet:
            bar("check", done, total)

    try:
        return check_files(files, Run(asked.options, asked.jobs, asked.cached, progress))
    finally:
        bar.clear()


def _print(form: str, checked: list[Checked], sources: dict[str, Source]) -> None:
    from xei_lang.cli.check_forms import render

    pairs = [(item.file, item.said) for item in checked]
    click.echo(render(form, pairs, with_quoted(_said(checked), sources)), nl=False)


def _said(checked: Sequence[Checked]) -> Diagnostics:
    return tuple(diagnostic for item in checked for diagnostic in item.said)


def _summary(said: Diagnostics, files: int, told: str) -> str:
    errors = [diagnostic.code for diagnostic in said if diagnostic.severity == "error"]
    warnings = [diagnostic.code for diagnostic in said if diagnostic.severity == "warning"]
    counts = (count(files, "file"), count(len(errors), "error"), count(len(warnings), "warning"))
    summary = "{} checked: {}, {}".format(*counts) + told
    first = (*errors, *warnings)[:1]
    return f"{summary}; `xei explain {first[0]}` says more" if first else summary
