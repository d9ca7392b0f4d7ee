"""`xei run`: carry a protocol out, goal by goal, and stop at the first failure."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

import click

from xei_lang.cli.exit_codes import RUN_STOPPED, WRONG_USAGE
from xei_lang.cli.options import Options, WorldOptions, compiling, grounding
from xei_lang.cli.session import Session, open_session
from xei_lang.cli.write_file import place_refused
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.trace import TraceEvent
from xei_lang.pipeline import ALL, Handoffs, PassResult
from xei_lang.runtime.executors import AVAILABLE
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.runtime.answers import Answers
    from xei_lang.runtime.perception import Perception

_ELSEWHERE = ("choose another place with --trace",)


@click.command("run")
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--executor",
    type=click.Choice(AVAILABLE),
    default="dry-run",
    show_default=True,
    help="Who carries it out.",
)
@click.option("--trace", "trace_path", type=click.Path(path_type=Path), help="Write the trace (JSON Lines).")
@click.option(
    "--answers",
    "answers_path",
    type=click.Path(path_type=Path),
    help="JSON with the answers to `confirm` steps, by step id or by text.",
)
@click.option(
    "--speed",
    type=click.FloatRange(0.0, 1.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Fraction of the planned speed.",
)
@click.option(
    "--pose-service",
    "pose_service",
    metavar="URL",
    help="Who is asked where things are when a goal perceives.",
)
@click.option(
    "--perceived",
    type=click.Path(path_type=Path),
    multiple=True,
    help="What is seen at each goal that perceives, in order: a scene file, or a picture for the service.",
)
@grounding
@compiling
def command(
    *,
    file: Path,
    executor: str,
    trace_path: Path | None,
    answers_path: Path | None,
    speed: float,
    pose_service: str | None,
    perceived: tuple[Path, ...],
    world: WorldOptions,
    options: Options,
) -> None:  # fmt: skip
    """Execute a protocol, write its trace, and stop on the first failure.

    Example: xei run protocols/put_on_rack.xei --trace trace.jsonl
    """
    if math.isnan(speed):
        raise click.BadParameter("nan is no speed", param_hint="--speed")
    session = open_session(file, options, allow_unmapped=True)
    answers, problems = _answers(answers_path)
    if trace_path is not None:
        problems = (*place_refused(trace_path, "--trace", made=False), *problems)
    code = session.show(problems)
    if code:
        sys.exit(code)
    session = session.grounded_by(world)

    def watch(result: PassResult) -> None:
        # Before motion is planned, which may take minutes, and long before the robot waits for an answer.
        if result.pass_name == "lower" and not result.failed:
            _stop_where_not_asked(session, answers, result)

    made = session.compile(ALL, watch)
    from xei_lang.cli.perceived import perception_of

    assert made.timed is not None
    assert made.profile is not None
    perception, problems = perception_of(
        made.timed, made.profile, perceived, pose_service, world.token_file, color=options.color
    )
    code = session.show(problems)
    if code:
        sys.exit(code)
    sys.exit(_run(session, made, executor, trace_path, answers, speed, perception))


def _run(
    session: Session,
    made: Handoffs,
    executor: str,
    trace_path: Path | None,
    answers: Answers,
    speed: float,
    perception: Perception | None,
) -> int:
    from xei_lang.cli.deliver import Compiled
    from xei_lang.runtime.run import run

    inputs = Compiled.of(session.source, made).run_inputs()
    try:
        with trace_path.open("w", encoding="utf-8") if trace_path is not None else nullcontext() as trace:
            result = run(inputs, executor, answers, _recorder(trace), speed, perception)
    except OSError as error:
        if trace_path is None:
            raise
        # A run whose record is lost does not go on: whoever looks for what was done would find too little.
        reason = (error.strerror or str(error)).lower()
        session.show((Diagnostic("XEI0101", f"`{trace_path}` cannot be written: {reason}", help=_ELSEWHERE),))
        return WRONG_USAGE
    session.show(result.diagnostics)
    if not session.options.quiet:
        stage = f" at {result.failed_stage}" if result.failed_stage else ""
        done = f"{result.goals_done} goals, {result.duration_s:.1f} s"
        click.echo(f"{executor}: {result.status}{stage} after {done}", err=True)
    return 0 if result.status == "succeeded" else RUN_STOPPED


def _answers(path: Path | None) -> tuple[Answers, Diagnostics]:
    from xei_lang.runtime.answers import Answers, read_answers

    written, problems = Answers(), ()
    if path is not None:
        source, problems = read_source(path, str(path))
        if source is not None:
            written, problems = read_answers(source)
    return replace(written, ask=_ask if sys.stdin.isatty() else None), problems


def _stop_where_not_asked(session: Session, answers: Answers, lowered: PassResult) -> None:
    from xei_lang.runtime.answers import check_answers

    assert lowered.made.graph is not None
    code = session.show(check_answers(answers, lowered.made.graph))
    if code:
        sys.exit(code)


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
