"""`xei compile`: the whole way from text to a bundle, or to one representation on the way."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.emit import EMITTED, passes_for, text_after, text_of, write_all
from xei_lang.cli.handoff_lines import SHOWN, handoff_line
from xei_lang.cli.options import Options, WorldOptions, compiling, grounding
from xei_lang.cli.session import Session, open_session
from xei_lang.cli.write_file import place_refused, write_text
from xei_lang.pipeline import ALL, Handoffs, PassResult


@click.command("compile")
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="A folder for the bundle (build/NAME), or with --emit a file (standard output).",
)
@click.option("--emit", "stage", type=click.Choice(EMITTED), help="Print or write one representation only.")
@click.option(
    "--print-after",
    type=click.Choice([step.name for step in ALL]),
    metavar="PASS",
    help="Print what a pass made, as text, to standard error.",
)
@click.option("--time-passes", is_flag=True, help="Print the seconds that each pass took to standard error.")
@click.option("--allow-unmapped", is_flag=True, help="Compile although something asked for cannot be done.")
@click.option("--strict", is_flag=True, help="Refuse a profile whose placeholders block a real deployment.")
@grounding
@compiling
def command(
    *,
    file: Path,
    output: Path | None,
    stage: str | None,
    print_after: str | None,
    time_passes: bool,
    allow_unmapped: bool,
    strict: bool,
    world: WorldOptions,
    options: Options,
) -> None:  # fmt: skip
    """Compile a protocol to a bundle of timed, verified motion.

    Example: xei compile protocols/put_on_rack.xei
    """
    passes = passes_for(stage)
    if print_after is not None and print_after not in [step.name for step in passes]:
        raise click.BadParameter(f"`--emit {stage}` does not get as far", param_hint="--print-after")
    session = open_session(file, options, allow_unmapped=allow_unmapped, strict=strict)
    _stop_without_a_place(session, stage, output)
    session = session.grounded_by(world)

    def watch(result: PassResult) -> None:
        if stage is None and not options.quiet and not result.failed and result.pass_name in SHOWN:
            click.echo(handoff_line(result), err=True)
        if print_after == result.pass_name and not result.failed:
            click.echo(text_after(result, session.source), err=True, nl=False)
        if time_passes:
            click.echo(f"{result.pass_name:<8} took {result.seconds:.3f} s", err=True)

    made = session.compile(passes, watch)
    sys.exit(_write(session, made, stage, output))


def _write(session: Session, made: Handoffs, stage: str | None, output: Path | None) -> int:
    """Write what was asked for, and return the exit code."""
    if stage is None or stage == "bag":
        target = _folder(session, output)
        return session.show(write_all(stage, target, session.request, made, session.options.quiet))
    text = text_of(stage, session.request, made)
    if output is None:
        click.echo(text, nl=False)
        return 0
    return session.show(write_text(output, text))


def _folder(session: Session, output: Path | None) -> Path:
    return output or Path("build") / Path(session.source.file).stem


def _stop_without_a_place(session: Session, stage: str | None, output: Path | None) -> None:
    """Planning may take minutes: that its result has no place is said before."""
    if stage is None or stage == "bag":
        from xei_lang.export.bundle import place_refused as bundle_refused

        refused = bundle_refused(_folder(session, output))
    else:
        refused = () if output is None else place_refused(output)
    code = session.show(refused)
    if code:
        sys.exit(code)
