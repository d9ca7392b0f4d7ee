"""`xei check --watch`: checking again whenever something changes that the last check depended on.

Changes are found by asking again: the files' sizes and times, and every question that the checks asked of
the disk. That needs no service of the system, works on network drives, and knows of imports that are still
missing.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from xei_lang.cli.check_run import Checked
from xei_lang.cli.exit_codes import DONE, WRONG_USAGE
from xei_lang.cli.files import count, listed_files, no_files
from xei_lang.cli.options import Options
from xei_lang.inputs import Inputs, Outside

PERIOD_S = 0.25
_SHARE = 20
"""Looking takes at most a twentieth of the time."""
_SETTLE_S = 0.05
"""Whoever saves a file may write it in several goes: a check waits until nothing has moved for so long."""

_States = tuple[tuple[Path, tuple[int, int, int] | None], ...]
_CLEAR = "\x1b[2J\x1b[3J\x1b[H"

Check = Callable[[Sequence[Path]], tuple[int, list[Checked]]]


def watch_files(paths: tuple[Path, ...], options: Options, check: Check) -> int:
    """Check until Ctrl-C, and return the last exit code."""
    code = DONE
    try:
        while True:
            states = _states(paths)
            if sys.stderr.isatty():
                click.echo(_CLEAR, nl=False, err=True)
            code, checked = check([file for file, _ in states]) if states else _nothing(paths)
            sys.stdout.flush()
            if not options.quiet:
                click.echo(f"watching {count(len(states), 'file')}; Ctrl-C ends", err=True)
            _wait(paths, states, checked, options)
    except KeyboardInterrupt:
        return code


def _nothing(paths: tuple[Path, ...]) -> tuple[int, list[Checked]]:
    click.echo(f"error: {no_files(paths)}", err=True)
    return WRONG_USAGE, []


def _wait(paths: tuple[Path, ...], states: _States, checked: Sequence[Checked], options: Options) -> None:
    """Return once something has changed, and has come to rest."""
    took = 0.0
    while True:
        time.sleep(max(PERIOD_S, took * _SHARE))
        started = time.monotonic()
        if _states(paths) != states or not _same_answers(checked, options):
            break
        took = time.monotonic() - started
    before = states
    while (now := _states(paths)) != before:
        before = now
        time.sleep(_SETTLE_S)


def _states(paths: tuple[Path, ...]) -> _States:
    return tuple((file, _state(file)) for file in listed_files(paths))


def _state(file: Path) -> tuple[int, int, int] | None:
    try:
        status = os.stat(file)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _same_answers(checked: Sequence[Checked], options: Options) -> bool:
    inputs = Inputs(None)
    return all(
        Outside(inputs, Path(item.file), options.profile).answer(question) == answer
        for item in checked
        for question, answer in item.asked
    )
