"""`xei run`: carry a protocol out, goal by goal, and stop at the first failure."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TextIO

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS, RUN_STOPPED, WRONG_USAGE
from xei_lang.cli.options import cache_folder, compiling, pairs, wants_color
from xei_lang.cli.progress import Bar
from xei_lang.cli.report import exit_code, show
from xei_lang.diagnostics import Diagnostic, Diagnostics, Sources
from xei_lang.ir.trace import TraceEvent
from xei_lang.pipeline import ALL, Handoffs, PassResult, Request, compile_request
from xei_lang.syntax.reading import read_source


@click.command("run")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--executor", default="dry-run", show_default=True, metavar="NAME", help="Who carries it out: dry-run.")
@click.option("--trace", "trace_path", type=click.Path(path_type=Path), help="Write the trace, as JSON Lines.")
@click.option("--answers", "answers_path", type=click.Path(path_type=Path),
              help="JSON with the answers to `confirm` steps, by step id or by text.")
@click.option("--speed", type=click.FloatRange(0.0, 1.0, min_open=True), default=1.0, show_default=True,
              help="Fraction of the planned speed.")
@compiling
def command(
    file: Path,
    executor: str,
    trace_path: Path | None,
    answers_path: Path | None,
    speed: float,
    profile: Path | None,
    bindings: tuple[str, ...],
    params: tuple[str, ...],
    seed: int,
    color: str,
    quiet: bool,
) -> None:  # fmt: skip
    """Execute a protocol, write its trace, and stop on the first failure.

    Example: xei run protocols/put_on_rack.xei --trace trace.jsonl
    """
    colored = wants_color(color)
    source, problems = read_source(file, str(file))
    if source is None:
        show(problems, {}, colored)
        sys.exit(exit_code(problems))
    sources = {source.file: source}
    bar = Bar()
    request = Request(
        source, profile, cache_folder(), pairs("--bind", bindings), pairs("--param", params),
        allow_unmapped=True, seed=seed, progress=None if quiet else bar,
    )  # fmt: skip

    def watch(result: PassResult) -> None:
        bar.clear()
        show(tuple(item for item in result.diagnostics if not quiet or item.severity == "error"), sources, colored)

    outcome = compile_request(request, ALL, watch)
    if outcome.stopped_at is not None:
        sys.exit(exit_code(outcome.diagnostics) or INPUT_HAS_ERRORS)
    sys.exit(_run(outcome.made, executor, trace_path, answers_path, speed, sources, colored, quiet))


def _run(
    made: Handoffs,
    executor: str,
    trace_path: Path | None,
    answers_path: Path | None,
    speed: float,
    sources: Sources,
    colored: bool,
    quiet: bool,
) -> int:
    from xei_lang.export.compiled import plan_hashes
    from xei_lang.profiles.open import robot_texts
    from xei_lang.runtime.answers import Answers
    from xei_lang.runtime.handoffs import Handoffs as RunInputs
    from xei_lang.runtime.run import run

    given, problems = _answers(answers_path)
    if problems:
        show(problems, sources, colored)
        return exit_code(problems)
    assert made.plan and made.graph and made.timed and made.world and made.profile
    urdf, _ = robot_texts(made.profile)
    hashes = plan_hashes(sources, made.plan, made.graph, made.timed)
    inputs = RunInputs(made.plan, made.graph, made.timed, made.world, made.profile, urdf, hashes)
    answers = Answers(given, _ask if sys.stdin.isatty() else None)
    try:
        trace = trace_path.open("w", encoding="utf-8") if trace_path is not None else None
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        show((Diagnostic("XEI0101", f"`{trace_path}` cannot be written: {reason}"),), sources, colored)
        return WRONG_USAGE
    try:
        result = run(inputs, executor, answers, _recorder(trace), speed)
    finally:
        if trace is not None:
            trace.close()
    show(result.diagnostics, sources, colored)
    if not quiet:
        stage = f" at {result.failed_stage}" if result.failed_stage else ""
        click.echo(f"{executor}: {result.status}{stage} after {result.goals_done} goals, {result.duration_s:.1f} s", err=True)
    return 0 if result.status == "succeeded" else RUN_STOPPED


def _answers(path: Path | None) -> tuple[Mapping[str, bool], Diagnostics]:
    from xei_lang.runtime.answers import parse_answers

    if path is None:
        return {}, ()
    source, problems = read_source(path, str(path))
    return ({}, problems) if source is None else parse_answers(source.text, source.file)


def _ask(text: str) -> bool | None:
    return click.confirm(f"{text}. Is that so?", err=True)


def _recorder(trace: TextIO | None) -> Callable[[TraceEvent], None]:
    from xei_lang.ir.forms.trace_json import to_line

    def record(event: TraceEvent) -> None:
        if trace is not None:
            # Line by line, so that a killed run leaves everything up to the kill.
            trace.write(to_line(event) + "\n")
            trace.flush()

    return record
