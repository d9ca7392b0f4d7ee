"""`xei world`: where everything is before anything moves, and who said so."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.lab import open_lab
from xei_lang.cli.options import WorldOptions, grounding, wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.worlds import observed_by
from xei_lang.cli.write_file import write_text
from xei_lang.diagnostics import Diagnostics, did_you_mean, has_errors
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile

FORMS = ("text", "svg", "json", "scene")

_profile_option = click.option(
    "--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several."
)
_color_option = click.option(
    "--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True
)
_quiet_option = click.option("--quiet", is_flag=True, help="Print what was asked for and errors only.")


@click.group("world")
def command() -> None:
    """Show where everything is before anything moves, and who said so.

    Example: xei world show --world scenes/monday.yaml
    """


@command.command("show")
@_profile_option
@grounding
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMS),
    default="text",
    show_default=True,
    help="A table, a top view, the whole world, or a scene file that `--world` reads.",
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="A file, in place of standard output.")
@_quiet_option
@_color_option
def show_world(
    *, profile: str | None, world: WorldOptions, form: str, output: Path | None, quiet: bool, color: str
) -> None:
    """Print all objects: where they are, who said so, and which arms may reach them from which station.

    Reach is a bound by the lengths of the links: what is beyond it is out of reach.

    Example: xei world show --format svg -o bench.svg
    """
    colored = wants_color(color)
    lab = open_lab(profile, colored)
    grounded = _ground(lab, world, quiet=quiet, colored=colored)
    text = _form(form, grounded, lab)
    if output is None:
        click.echo(text, nl=False)
        return
    problems = write_text(output, text)
    show(problems, {}, colored)
    sys.exit(exit_code(problems))


@command.command("where")
@click.argument("name")
@_profile_option
@grounding
@click.option("--history", is_flag=True, help="What the transforms on the way were before, too.")
@_quiet_option
@_color_option
def where(
    *, name: str, profile: str | None, world: WorldOptions, history: bool, quiet: bool, color: str
) -> None:
    """Print where an object or a frame is, who said so field by field, and how well that is known.

    NAME is the name of an object, one of its aliases, or a frame of the calibration profile.

    Example: xei world where tube_1
    """
    from xei_lang.world.view.frame_text import frame_text
    from xei_lang.world.view.where import object_called, to_text

    colored = wants_color(color)
    lab = open_lab(profile, colored)
    item = object_called(lab, name)
    frames = [frame.name for frame in lab.calibration.frames]
    frames += [frame for frame, _ in lab.calibration.robot_frames]
    if item is None and name not in frames:
        raise click.BadParameter(_unknown(name, frames, lab), param_hint="NAME")
    grounded = _ground(lab, world, quiet=quiet, colored=colored)
    frame = grounded.frame(name)
    if item is not None:
        click.echo(to_text(grounded, lab, item, history=history), nl=False)
    elif frame is not None:
        click.echo(frame_text(grounded, lab, frame, history=history), nl=False)


def _unknown(name: str, frames: list[str], lab: Profile) -> str:
    known = [item.name for item in lab.objects] + [alias for item in lab.objects for alias in item.aliases]
    near = " or ".join(f"`{one}`" for one in did_you_mean(name, known + frames))
    hint = f"did you mean {near}?" if near else "`xei world show` lists all objects"
    return f"`{lab.name}` has no object or frame `{name}`; {hint}"


def _ground(profile: Profile, asked: WorldOptions, *, quiet: bool, colored: bool) -> World:
    """The world that a source and the profile give. Exits, with diagnostics, where they contradict."""
    from xei_lang.world.ground import ground

    observed, said = observed_by(asked, profile, colored)
    world = None
    if not has_errors(said):
        world, found = ground(profile, observed)
        said = (*said, *found)
    shown: Diagnostics = tuple(item for item in said if not quiet or item.severity == "error")
    show(shown, {}, colored)
    if world is None:
        sys.exit(exit_code(said) or INPUT_HAS_ERRORS)
    return world


def _form(form: str, world: World, profile: Profile) -> str:
    if form == "svg":
        from xei_lang.world.view.svg import to_svg

        return to_svg(world, profile)
    if form == "json":
        from xei_lang.ir.forms.canonical import dumps
        from xei_lang.world.view.json_form import to_json

        return dumps(to_json(world, profile))
    if form == "scene":
        from xei_lang.world.sources.scene_text import scene_text

        return scene_text(world, profile)
    from xei_lang.world.view.table import to_table

    return to_table(world, profile)
