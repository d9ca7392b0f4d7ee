"""`xei fmt`: protocols in the one style."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import click

from xei_lang.cli.diff import echo_diff
from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.files import count, protocol_files
from xei_lang.cli.options import wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.write_file import rewrite_text
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.render.terminal import visible
from xei_lang.syntax.format import Formatter
from xei_lang.syntax.reading import MAX_BYTES, decode_source, read_source

_STDIN = Path("-")


@dataclass(frozen=True, slots=True, eq=False)
class _Formatted:
    """What a file holds, what it should hold (None where it has errors), and what is wrong with it."""

    file: Path
    before: bytes
    source: Source | None
    text: str | None
    said: Diagnostics

    @property
    def changes(self) -> bool:
        return self.text is not None and self.text.encode() != self.before


@click.command("fmt")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="PATH...")
@click.option("--check", is_flag=True, help="Write nothing; exit with 1 if a file is not formatted.")
@click.option("--diff", is_flag=True, help="Write nothing; print what would change.")
@click.option("--quiet", is_flag=True, help="Print errors only.")
@click.option(
    "--color",
    type=click.Choice(["auto", "always", "never"]),
    default="auto",
    show_default=True,
    help="Colour messages.",
)
def command(*, paths: tuple[Path, ...], check: bool, diff: bool, quiet: bool, color: str) -> None:
    """Format protocols: layout only, never the meaning, with every comment.

    A folder stands for all .xei files below it; `-` formats standard input to standard output. A file with
    errors of syntax is left as it is.

    Example: xei fmt protocols/
    """
    if _STDIN in paths and len(paths) > 1:
        raise click.BadParameter("`-` stands alone", param_hint="PATH")
    formatter = Formatter()
    done: list[_Formatted] = []
    said: Diagnostics = ()
    for file in paths if paths == (_STDIN,) else protocol_files(paths):
        found = _format(file, formatter)
        problems = (*found.said, *(_print(found, check, diff) if check or diff else _write(found)))
        chosen = tuple(item for item in problems if not quiet or item.severity == "error")
        show(chosen, {found.source.file: found.source} if found.source else {}, wants_color(color))
        done.append(found)
        said = (*said, *problems)
    if not quiet and (check or paths != (_STDIN,)):
        click.echo(_summary(done, written=not (check or diff)), err=True)
    would_change = check and any(found.changes for found in done)
    sys.exit(exit_code(said) or (INPUT_HAS_ERRORS if would_change else 0))


def _format(file: Path, formatter: Formatter) -> _Formatted:
    if file == _STDIN:
        before = sys.stdin.buffer.read()
        source, said = decode_source(before, "<stdin>", MAX_BYTES)
    else:
        source, said = read_source(file, str(file))
        before = b"" if source is None else file.read_bytes()
    if source is None:
        return _Formatted(file, before, None, None, said)
    text, found = formatter.format(source)
    return _Formatted(file, before, source, text, (*said, *found))


def _print(found: _Formatted, check: bool, diff: bool) -> Diagnostics:
    """Say that a file would change, and how."""
    if found.changes and found.text is not None and found.source is not None:
        if check:
            click.echo(f"{visible(found.source.file)} is not formatted", err=True)
        if diff:
            echo_diff(found.source.file, found.before.decode(), found.text)
    return ()


def _write(found: _Formatted) -> Diagnostics:
    if found.text is None:
        return ()
    if found.file == _STDIN:
        click.echo(found.text.encode(), nl=False)
        return ()
    return rewrite_text(found.file, found.text) if found.changes else ()


def _summary(done: list[_Formatted], *, written: bool) -> str:
    changed = sum(found.changes for found in done)
    failed = sum(found.text is None for found in done)
    parts = [f"{count(changed, 'file')} {'formatted' if written else 'not formatted'}"]
    parts.append(f"{len(done) - changed - failed} as they should be")
    if failed:
        parts.append(f"{count(failed, 'file')} with errors left as they are")
    return ", ".join(parts)
