"""`xei doctor`: what keeps a profile off a real deployment, and what to do about each."""

from __future__ import annotations

import sys

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.lab import profile_folder
from xei_lang.cli.options import wants_color
from xei_lang.cli.report import exit_code, show, with_quoted
from xei_lang.diagnostics import Diagnostic, Diagnostics, has_errors
from xei_lang.doctor import Blocker, deployment_blockers
from xei_lang.doctor.faults import fault_blockers
from xei_lang.profiles.compiled import default_cache
from xei_lang.profiles.load import load_profile


@click.command("doctor")
@click.option(
    "--profile", metavar="NAME|FOLDER", help="The profile to look at; needed where there are several."
)
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
@click.option("--quiet", is_flag=True, help="Print nothing but errors; the exit code tells.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def command(*, profile: str | None, form: str, quiet: bool, color: str) -> None:
    """Say what blocks a real deployment, by representation, and how to mend each.

    Exit code 0 where nothing does, else 1.

    Example: xei doctor --profile openarm_bench
    """
    folder, missing = profile_folder(profile)
    if folder is None:
        show(missing, {}, wants_color(color))
        sys.exit(exit_code(missing) or INPUT_HAS_ERRORS)
    loaded, said = load_profile(folder, default_cache())
    if loaded is None and not (form == "json" and has_errors(said)):
        show(said, {}, wants_color(color))
    blockers = fault_blockers(said) if loaded is None else deployment_blockers(loaded)
    if not quiet:
        click.echo(_rendered(form, folder.name, blockers), nl=False)
    sys.exit(INPUT_HAS_ERRORS if blockers or loaded is None else 0)


def _rendered(form: str, name: str, blockers: tuple[Blocker, ...]) -> str:
    from xei_lang.doctor.forms import to_json, to_text
    from xei_lang.ir.forms.canonical import dumps

    if form == "json":
        return dumps(to_json(blockers))
    quoted: Diagnostics = tuple(Diagnostic(item.code, item.item, item.span) for item in blockers)
    return to_text(name, blockers, with_quoted(quoted, {}))
