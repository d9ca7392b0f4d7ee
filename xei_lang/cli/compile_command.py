"""`xei compile`: the whole way from text to a bundle, or to one representation on the way."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click

from xei_lang.cli.emit import EMITTED, emit
from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.handoff_lines import handoff_line, line
from xei_lang.cli.options import cache_folder, compiling, pairs, wants_color
from xei_lang.cli.progress import Bar
from xei_lang.cli.report import exit_code, show
from xei_lang.diagnostics import Source
from xei_lang.pipeline import ALL, Outcome, PassResult, Request, compile_request
from xei_lang.syntax.reading import read_source


@click.command("compile")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path),
              help="Where to write: a folder for the bundle, a file with --emit.  [default: build/NAME, or stdout]")
@click.option("--emit", "stage", type=click.Choice(EMITTED), help="Print or write one representation only.")
@click.option("--print-after", type=click.Choice([step.name for step in ALL]), metavar="PASS",
              help="Print what a pass made, in its text form, to stderr.")
@click.option("--time-passes", is_flag=True, help="Print how long each pass took, as JSON, to stderr.")
@click.option("--allow-unmapped", is_flag=True, help="Compile although something asked for cannot be done.")
@click.option("--strict", is_flag=True, help="Refuse a profile with placeholders that block a real deployment.")
@click.option("--rate", "rate_hz", type=click.FloatRange(1.0, 1000.0), default=100.0, show_default=True,
              help="Samples a second in timed.json.")
@compiling
def command(
    file: Path,
    output: Path | None,
    stage: str | None,
    print_after: str | None,
    time_passes: bool,
    allow_unmapped: bool,
    strict: bool,
    rate_hz: float,
    profile: Path | None,
    bindings: tuple[str, ...],
    params: tuple[str, ...],
    seed: int,
    color: str,
    quiet: bool,
) -> None:
    """Compile a protocol to a bundle of timed, verified motion.

    Example: xei compile protocols/put_on_rack.xei
    """  # fmt: skip
    colored = wants_color(color)
    source, problems = read_source(file, str(file))
    if source is None:
        show(problems, {}, colored)
        sys.exit(exit_code(problems))
    request = Request(
        source, profile, cache_folder(), pairs("--bind", bindings), pairs("--param", params),
        allow_unmapped=allow_unmapped, strict=strict, seed=seed, rate_hz=rate_hz,
        progress=None if quiet else Bar(),
    )  # fmt: skip
    passes = ALL[: needed(stage)]
    seconds: dict[str, float] = {}

    def watch(result: PassResult) -> None:
        seconds[result.pass_name] = result.seconds
        show(result.diagnostics, {source.file: source}, colored)
        if stage is None and not quiet:
            click.echo(handoff_line(result), err=True)
        if print_after == result.pass_name and not result.failed:
            click.echo(text_after(result), err=True, nl=False)

    outcome = compile_request(request, passes, watch)
    if time_passes:
        _print_times(seconds)
    if outcome.stopped_at is not None:
        sys.exit(exit_code(outcome.diagnostics) or INPUT_HAS_ERRORS)
    sys.exit(_write(request, outcome, source, stage, output, colored, quiet))
