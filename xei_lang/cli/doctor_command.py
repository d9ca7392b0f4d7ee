"""`xei doctor`: what keeps a profile off a real deployment, and what to do about each."""

from __future__ import annotations

import sys
from datetime import date
from pathlib import Path

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.lab import optional, profile_folder
from xei_lang.cli.options import wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.diagnostics import Diagnostics, has_errors
from xei_lang.doctor import Blocker, deployment_blockers, deployment_warnings
from xei_lang.doctor.faults import fault_blockers
from xei_lang.profiles.compiled import default_cache
from xei_lang.profiles.files import shown_path
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile


@click.command("doctor")
@click.option(
    "--profile", metavar="NAME|FOLDER", help="The profile to look at; needed where there are several."
)
@click.option("--pose-service", metavar="URL", help="Ask this pose service whether it serves this profile.")
@click.option("--token-file", type=click.Path(path_type=Path), help="A file with the token that it asks for.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
@click.option("--quiet", is_flag=True, help="Print nothing but errors; the exit code tells.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def command(
    *,
    profile: str | None,
    pose_service: str | None,
    token_file: Path | None,
    form: str,
    quiet: bool,
    color: str,
) -> None:
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
    blockers = fault_blockers(said) if loaded is None else deployment_blockers(loaded, date.today())
    if loaded is not None and pose_service is not None:
        blockers += _of_service(loaded, pose_service, token_file, colored=wants_color(color))
    warnings = deployment_warnings(loaded) if loaded is not None else ()
    if not quiet:
        show(warnings, {}, wants_color(color))
        click.echo(_rendered(form, folder, blockers, warnings), nl=False)
    sys.exit(INPUT_HAS_ERRORS if blockers or loaded is None else 0)


def _of_service(profile: Profile, url: str, token_file: Path | None, *, colored: bool) -> tuple[Blocker, ...]:
    optional("xei_lang.world.perception.client", colored)
    from xei_lang.cli.pose_service import read_token
    from xei_lang.doctor.pose_service import pose_service_blockers
    from xei_lang.world.perception.client import Limits, PoseClient

    token, said = read_token(token_file)
    if said:
        show(said, {}, colored)
        sys.exit(exit_code(said))
    return pose_service_blockers(profile, PoseClient(url, token, Limits(call_s=5.0)))


def _rendered(form: str, folder: Path, blockers: tuple[Blocker, ...], warnings: Diagnostics) -> str:
    from xei_lang.doctor.forms import to_json, to_text
    from xei_lang.doctor.places import places_of
    from xei_lang.ir.forms.canonical import dumps
    from xei_lang.profiles.sources import folder_sources

    places = places_of(blockers, shown_path(folder), folder_sources(folder))
    if form == "json":
        return dumps(to_json(blockers, places, warnings))
    return to_text(folder.name, blockers, places)
