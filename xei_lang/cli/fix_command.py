"""`xei fix`: the mends that diagnostics offer, applied."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path

import click

from xei_lang.cli.diff import echo_diff
from xei_lang.cli.files import count, protocol_files
from xei_lang.cli.mend import Checked, Repaired, mend
from xei_lang.cli.options import Options, compiling
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.session import request_for
from xei_lang.cli.write_file import rewrite_text
from xei_lang.diagnostics import Applicability, Diagnostics, Source
from xei_lang.diagnostics.render.terminal import visible
from xei_lang.pipeline import FRONT, PassResult, compile_request
from xei_lang.syntax.reading import read_source

_BOM = b"\xef\xbb\xbf"
_SAFE: tuple[Applicability, ...] = ("safe",)
_ANY: tuple[Applicability, ...] = ("safe", "unsafe")


@click.command("fix")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="PATH...")
@click.option("--unsafe", is_flag=True, help="Apply also what may not be what was meant; look at it.")
@click.option("--diff", is_flag=True, help="Write nothing; print what would change.")
@compiling
def command(*, paths: tuple[Path, ...], unsafe: bool, diff: bool, options: Options) -> None:
    """Mend protocols: apply the fixes that `xei check` offers.

    Only those are applied that keep what was meant, unless --unsafe is given. What is left is shown.

    Example: xei fix protocols/
    """
    files = protocol_files(paths)
    said: Diagnostics = ()
    mended = 0
    for file in files:
        source, problems = read_source(file, str(file))
        sources: dict[str, Source] = {}
        if source is not None:
            repaired = mend(source, lambda text: _check(text, options), _ANY if unsafe else _SAFE)
            written = _deliver(file, source, repaired, diff=diff, quiet=options.quiet)
            problems = (*problems, *repaired.end.said, *written)
            sources[source.file] = repaired.end.source
            mended += len(repaired.fixed)
        chosen = tuple(item for item in problems if not options.quiet or item.severity == "error")
        show(chosen, sources, options.color)
        said = (*said, *problems)
    if not options.quiet:
        errors = sum(item.severity == "error" for item in said)
        left = f"{count(errors, 'error')} left"
        click.echo(f"{count(len(files), 'file')}: {count(mended, 'fix')} {_verb(diff)}, {left}", err=True)
    sys.exit(exit_code(said))


def _verb(diff: bool) -> str:
    return "to apply" if diff else "applied"


def _check(source: Source, options: Options) -> Checked:
    faults = math.inf

    def watch(result: PassResult) -> None:
        nonlocal faults
        if result.pass_name == "parse" and result.made.module is not None:
            faults = sum(item.severity == "error" for item in result.diagnostics)

    request = replace(request_for(source, options, allow_unmapped=True), open_bindings=True)
    outcome = compile_request(request, FRONT, watch)
    return Checked(source, faults, outcome.diagnostics)


def _deliver(file: Path, source: Source, repaired: Repaired, *, diff: bool, quiet: bool) -> Diagnostics:
    """Write or print the mended text, and say what was mended."""
    end = repaired.end.source
    if not repaired.fixed:
        return ()
    if diff:
        echo_diff(source.file, source.text, end.text)
    elif refused := rewrite_text(file, end.text, bom=file.read_bytes().startswith(_BOM)):
        return refused
    for text, diagnostic in repaired.fixed if not quiet else ():
        line = text.line_number(diagnostic.span.start) if diagnostic.span else 1
        done = "would fix" if diff else "fixed"
        click.echo(visible(f"{done} {text.file}:{line}: {diagnostic.message}"), err=True)
    return ()
