"""`xei map`: the map that the base drives by, built from recorded scans and looked at."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.lab import open_lab
from xei_lang.cli.map_files import Target, deliver
from xei_lang.cli.options import wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.write_file import write_bytes
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.profiles.model import Profile
from xei_lang.syntax.reading import decode_source

if TYPE_CHECKING:
    from xei_lang.world.map.recording import Scans

MAX_RECORDING_BYTES = 500_000_000


@click.group("map")
def command() -> None:
    """Build the map that the base drives by, and look at it.

    Example: xei map build drive.jsonl --write
    """


@command.command("build")
@click.argument("recording", type=click.Path(path_type=Path), metavar="RECORDING")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="The folder for the map's files; with --write the profile's `map` if not given.",
)
@click.option("--name", default="lab", show_default=True, help="What the files are called.")
@click.option(
    "--resolution",
    type=click.FloatRange(0.005, 1.0),
    default=0.05,
    show_default=True,
    help="Metres a cell.",
)
@click.option("--write", is_flag=True, help="Name the map in the profile; one it named goes to the history.")
@click.option("--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several.")
@click.option("--quiet", is_flag=True, help="Print the lines and errors only.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def build(
    *,
    recording: Path,
    output: Path | None,
    name: str,
    resolution: float,
    write: bool,
    profile: str | None,
    quiet: bool,
    color: str,
) -> None:
    """Build a map from recorded lidar scans and the poses that they were taken at.

    Writes a map of ROS map_server (YAML and PGM), and prints the lines of `calibration_profile.yaml` that
    name it. Another map of the same name is not replaced. A line of the recording has the form of `xei schema
    scans`; a folder is read as a rosbag2 with the lidar's scans and tf.

    Example: xei map build drive.jsonl --write
    """
    colored = wants_color(color)
    if Path(name).name != name or name.startswith("."):
        raise click.BadParameter("a name without folders", param_hint="--name")
    if output is None and not write:
        raise click.UsageError("say where the map goes: -o, --output FOLDER, or --write")
    lab = open_lab(profile, colored)
    target = Target(lab, output or Path(lab.folder) / "map", name, write, quiet, colored)
    if write and not target.is_inside:
        raise click.BadParameter("with --write a folder of the profile", param_hint="--output")
    sys.exit(_build(recording, target, resolution))


def _build(path: Path, target: Target, resolution_m: float) -> int:
    from xei_lang.world.map.build_map import build_map

    lab, colored = target.lab, target.colored
    scans = _bag(path, lab, colored) if path.is_dir() else _lines(path, lab, colored)
    if isinstance(scans, int):
        return scans
    if not target.quiet:
        click.echo(f"{len(scans.poses)} scans of `{scans.lidar}`, of {len(scans.angles_rad)} rays", err=True)
    grid = build_map(scans, resolution_m)
    if isinstance(grid, Diagnostic):
        return _show((grid,), colored)
    if not target.quiet:
        from xei_lang.world.map.picture import size_text

        click.echo(size_text(grid), err=True)
    return _show(deliver(grid, scans.recorded_on, target), colored)


def _bag(path: Path, lab: Profile, colored: bool) -> Scans | int:
    """The scans of a rosbag2, or the exit code after saying why not."""
    from xei_lang.world.map.bag import read_bag

    found = read_bag(path, lab)
    return _show((found,), colored) if isinstance(found, Diagnostic) else found


def _lines(path: Path, lab: Profile, colored: bool) -> Scans | int:
    """The scans of a file of JSON Lines, or the exit code after saying why not."""
    from xei_lang.profiles.map_files import read_limited
    from xei_lang.world.map.recording import read_scans

    data = read_limited(path, MAX_RECORDING_BYTES)
    if isinstance(data, str):
        return _show((Diagnostic("XEI0101", f"`{path}` {data}"),), colored)
    source, said = decode_source(data, str(path), MAX_RECORDING_BYTES)
    if source is None:
        return _show(said, colored)
    scans, said = read_scans(source, lab)
    if scans is None:
        show(said, {source.file: source}, colored)
        return exit_code(said)
    return scans


@command.command("show")
@click.option("--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Draw the map with stations and drives: a PNG file.",
)
@click.option("--quiet", is_flag=True, help="Print the summary and errors only.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def show_map(*, profile: str | None, output: Path | None, quiet: bool, color: str) -> None:
    """Say what the profile's map shows: its size, how the base stands at each station, and every drive.

    The exit code is 1 where the map cannot be used or speaks against the profile.

    Example: xei map show -o lab.png
    """
    colored = wants_color(color)
    lab = open_lab(profile, colored)
    named = lab.calibration.map
    if named is None or not named.is_named:
        keys = ("yaml", "image", "sha256")
        gaps = [f"`{key}`" for key in keys if named is not None and not getattr(named, key)]
        started = 0 < len(gaps) < len(keys)
        what = f"`map` without {' and '.join(gaps)}" if started else "no map"
        message = f"the profile `{lab.name}` has {what}"
        help_ = "record a drive, and see `xei map build --help`"
        if started:
            help_ = f"name the files of one map, with their digest: {', '.join(keys)}; or {help_}"
        show((Diagnostic("XEI0665", message, named.span if named else None, help=(help_,)),), {}, colored)
        sys.exit(INPUT_HAS_ERRORS)
    from xei_lang.world.ground import ground
    from xei_lang.world.map.deployed import look_at_map

    world, said = ground(lab)
    if world is None:
        sys.exit(_show(said, colored))
    seen = look_at_map(lab, world)
    show(seen.diagnostics, {}, colored)
    if seen.floor is not None:
        from xei_lang.world.map.picture import picture_png, summary

        click.echo(summary(lab, world, seen, seen.floor), nl=False)
        failed = write_bytes(output, picture_png(lab, world, seen, seen.floor)) if output else ()
        if failed:
            sys.exit(_show(failed, colored))
        if output and not quiet:
            click.echo(f"drawn to {output}", err=True)
    sys.exit(INPUT_HAS_ERRORS if seen.faults else 0)


def _show(said: Diagnostics, colored: bool) -> int:
    show(said, {}, colored)
    return exit_code(said)
