"""`xei explain`: the page of a diagnostic's code, or what codes there are."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterator

import click

from xei_lang.diagnostics import CATALOGUE, did_you_mean
from xei_lang.diagnostics.catalogue import RANGES
from xei_lang.resources import resource_path

_WIDEST = 100


@click.command("explain")
@click.argument("code", required=False)
@click.option("--quiet", is_flag=True, help="Print what was asked for only; it is never more.")
@click.option(
    "--color",
    type=click.Choice(["auto", "always", "never"]),
    default="auto",
    show_default=True,
    help="Print headings bold.",
)
def command(*, code: str | None, quiet: bool, color: str) -> None:
    """Say more about a diagnostic: what it means, why it is one, an example and its fix.

    Without a code, all codes are listed.

    Example: xei explain XEI0302
    """
    if code is None:
        click.echo("\n".join(_listing()))
        return
    known = code.upper()
    if known not in CATALOGUE:
        near = did_you_mean(known, CATALOGUE)
        hint = f"did you mean `{near[0]}`?" if near else "`xei explain` lists all codes"
        raise click.BadParameter(f"there is no code `{code}`; {hint}", param_hint="CODE")
    from xei_lang.cli.page_text import page_text

    page = resource_path(f"docs/errors/{known}.md").read_text(encoding="utf-8")
    width = min(_WIDEST, shutil.get_terminal_size().columns)
    bold = color == "always" or (color == "auto" and "NO_COLOR" not in os.environ and sys.stdout.isatty())
    click.echo(page_text(page, max(20, width), bold), nl=False, color=bold)


def _listing() -> Iterator[str]:
    for index, (prefix, about) in enumerate(RANGES.items()):
        yield f"{'' if index == 0 else chr(10)}{prefix}xx  {about}"
        for code, entry in CATALOGUE.items():
            if code.startswith(prefix):
                yield f"  {code}  {entry.title}"
