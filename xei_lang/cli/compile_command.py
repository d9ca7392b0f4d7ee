"""`xei compile`: the whole way from text to a bundle, or to one representation on the way."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.emit import EMITTED, passes_for, text_after, text_of, write_all
from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.handoff_lines import SHOWN, handoff_line
from xei_lang.cli.options import cache_folder, compiling, pairs, wants_color
from xei_lang.cli.progress import Bar
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.write_file import write_text
from xei_lang.diagnostics import Sources
from xei_lang.pipeline import ALL, Outcome, PassResult, Request, compile_request
from xei_lang.syntax.reading import read_source


@click.command("compile")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path),
              help="A folder for the bundle (build/NAME), or with --emit a file (standard output).")
@click.option("--emit", "stage", type=click.Choice(EMITTED), help="Print or write one representation only.")
@click.option("--print-after", type=click.Choice([step.name for step in ALL]), metavar="PASS",
              help="Print what a pass made, as text, to standard error.")
@click.option("--time-passes", is_flag=True, help="Print the seconds that each pass took to standard error.")
@click.option("--allow-unmapped", is_flag=True, help="Compile although something asked for cannot be done.")
@click.option("--strict", is_flag=True, help="Refuse a profile whose placeholders block a real deployment.")
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
) -> None:  # fmt: skip
    """Compile a protocol to a bundle of timed, verified motion.

    Example: xei compile protocols/put_on_rack.xei
    """
    colored = wants_color(color)
    source, problems = read_source(file, str(file))
    if source is None:
        show(problems, {}, colored)
        sys.exit(exit_code(problems))
    bar = Bar()
    request = Request(
        source, profile, cache_folder(), pairs("--bind", bindings), pairs("--param", params),
        allow_unmapped=allow_unmapped, strict=strict, seed=seed, rate_hz=rate_hz, progress=None if quiet else bar,
    )  # fmt: skip
    sources = {source.file: source}
    seconds: dict[str, float] = {}

    def watch(result: PassResult) -> None:
        bar.clear()
        seconds[result.pass_name] = result.seconds
        show(tuple(item for item in result.diagnostics if not quiet or item.severity == "error"), sources, colored)
        if stage is None and not quiet and not result.failed and result.pass_name in SHOWN:
            click.echo(handoff_line(result), err=True)
        if print_after == result.pass_name and not result.failed:
            click.echo(text_after(result), err=True, nl=False)

    outcome = compile_request(request, passes_for(stage), watch)
    if time_passes:
        click.echo("\n".join(f"{name:<8} {took:8.3f} s" for name, took in seconds.items()), err=True)
    if outcome.stopped_at is not None:
        sys.exit(exit_code(outcome.diagnostics) or INPUT_HAS_ERRORS)
    sys.exit(_write(request, outcome, sources, stage, output, colored, quiet))


def _write(
    request: Request, outcome: Outcome, sources: Sources, stage: str | None, output: Path | None, colored: bool, quiet: bool
) -> int:
    """Write what was asked for, and return the exit code."""
    if stage is not None and stage != "bag":
        text = text_of(stage, request, outcome.made)
        if output is None:
            click.echo(text, nl=False)
            return 0
        problems = write_text(output, text)
    else:
        target = output or Path("build") / Path(request.source.file).stem
        problems = write_all(stage, target, request, outcome.made, None if quiet else _say)
    show(problems, sources, colored)
    return exit_code(problems)


def _say(text: str) -> None:
    click.echo(text, err=True)
