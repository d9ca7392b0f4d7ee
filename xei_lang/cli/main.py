"""The program `xei`: finds the command, and turns what escapes into words and an exit code."""

from __future__ import annotations

import errno
import gc
import importlib
import os
import sys
from typing import NoReturn

import click

from xei_lang import __version__
from xei_lang.cli.exit_codes import INTERRUPTED, OUR_BUG, WRONG_USAGE

COMMANDS = {
    "check": "Check protocols without moving anything.",
    "compile": "Compile a protocol to a bundle of timed, verified motion.",
    "run": "Execute a protocol and write its trace.",
    "fmt": "Format protocols.",
    "fix": "Apply the fixes of diagnostics.",
    "doctor": "Say what blocks a real deployment.",
    "world": "Show where everything is, and who said so.",
    "perception": "Find tags and tables in an image, or serve poses of objects.",
    "calibrate": "Solve a camera's place from a recording.",
    "map": "Build the map that the base drives by, and look at it.",
    "explain": "Say more about a diagnostic's code.",
    "schema": "Print the JSON Schema of a form.",
}

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


class _Commands(click.Group):
    """Loads a command's module only when it is asked for: `xei check` must not pay for motion planning."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"xei_lang.cli.{cmd_name}_command")
        command: click.Command = module.command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.command(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="xei")
def main() -> None:
    """Compile laboratory protocols to safe, timed robot motion.

    Example: xei compile protocols/put_on_rack.xei
    """


def run(argv: list[str] | None = None) -> None:
    """Entry point of the console script. Never shows a traceback for something that the user did."""
    # What a start makes (classes, tables, a tree) it keeps: to search it for cycles again and again is
    # a tenth of a small check. The search begins where there is more than that.
    gc.set_threshold(200_000)
    try:
        main.main(args=argv, prog_name="xei", standalone_mode=False)
    except click.exceptions.Exit as stop:
        sys.exit(stop.exit_code)
    except click.ClickException as mistake:
        mistake.show()
        sys.exit(mistake.exit_code)
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted: nothing was left half-written", err=True)
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        # The reader went away (`xei ... | head`): the rest is of no use to anyone.
        sys.stderr.close()
        sys.exit(0)
    except Exception as bug:
        if isinstance(bug, OSError) and bug.filename is None and bug.errno in _FULL:
            _stop_where_output_is_full(bug)
        _report_bug(bug)
        sys.exit(OUR_BUG)


def _stop_where_output_is_full(error: OSError) -> NoReturn:
    click.echo(f"error: standard output cannot be written: {(error.strerror or '').lower()}", err=True)
    # What is still kept for it would be refused once more at the end.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(WRONG_USAGE)


def _report_bug(bug: Exception) -> None:
    from xei_lang.cli.bug import bug_lines

    for line in bug_lines(bug):
        click.echo(line, err=True)
