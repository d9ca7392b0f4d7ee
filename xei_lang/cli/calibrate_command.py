"""`xei calibrate`: where a camera is mounted, from a recording."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xei_lang.cli.calibration_file import calibration_path, rewrite_calibration
from xei_lang.cli.lab import open_lab, optional
from xei_lang.cli.options import wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.write_file import write_text
from xei_lang.diagnostics import Diagnostics
from xei_lang.profiles.model import Profile
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.world.calibration.hand_eye import HandEye
    from xei_lang.world.calibration.measured import Measured


@click.command("calibrate")
@click.argument("recording", type=click.Path(path_type=Path), metavar="RECORDING")
@click.option("--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="Write the lines to a file, and print none."
)
@click.option(
    "--write", is_flag=True, help="Put the transform into the profile; what it was goes to its history."
)
@click.option("--quiet", is_flag=True, help="Print the lines and errors only.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def command(
    *, recording: Path, profile: str | None, output: Path | None, write: bool, quiet: bool, color: str
) -> None:
    """Solve where a camera is mounted from stills of tags at known joint positions.

    Prints the transform as lines of `calibration_profile.yaml`, with its tolerance, residuals and covariance.
    The recording's form is that of `xei schema recording`.

    Example: xei calibrate hand_eye.yaml --write
    """
    if write and output is not None:
        raise click.UsageError("-o and --write are two places; give one of them")
    colored = wants_color(color)
    lab = open_lab(profile, colored)
    said = _calibrate(recording, lab, output, write=write, quiet=quiet, colored=colored)
    sys.exit(said)


def _calibrate(
    path: Path, lab: Profile, output: Path | None, *, write: bool, quiet: bool, colored: bool
) -> int:
    source, problems = read_source(path, str(path))
    if source is None:
        return _show(problems, colored)
    optional("xei_lang.world.calibration.hand_eye", colored)
    from xei_lang.world.calibration.hand_eye import Unsolved, solve_hand_eye
    from xei_lang.world.calibration.outcome import jump_warning, outcome
    from xei_lang.world.calibration.recording import read_recording

    recording, problems = read_recording(source, lab)
    if recording is None:
        show(problems, {source.file: source}, colored)
        return exit_code(problems)
    if not quiet:
        click.echo(f"{len(recording.samples)} samples of `{recording.camera.name}`", err=True)
    solved = solve_hand_eye(recording.samples, recording.camera.fx)
    if isinstance(solved, Unsolved):
        return _show((solved.diagnostic(),), colored)
    if not quiet:
        click.echo(_summary(solved), err=True)
    measured = outcome(recording, solved)
    if not quiet:
        _show(jump_warning(recording.frame, measured), colored)
    return _show(_deliver(measured, lab, output, write=write, quiet=quiet), colored)


def _deliver(
    measured: Measured, lab: Profile, output: Path | None, *, write: bool, quiet: bool
) -> Diagnostics:
    if output is not None:
        return write_text(output, measured.snippet())
    if not write:
        click.echo(measured.snippet(), nl=False)
        return ()
    from xei_lang.world.calibration.measured import put_in

    changed, problems = rewrite_calibration(lab, lambda source: put_in(source, measured))
    if not problems and not quiet:
        told = "is measured now; what it was is in its history" if changed else "stands there"
        click.echo(f"`frames.{measured.frame}` of {calibration_path(lab)} {told}", err=True)
    return problems


def _summary(solved: HandEye) -> str:
    spread = ", ".join(f"{math.degrees(value):.0f}" for value in solved.spread_rad)
    return (
        f"residuals {solved.noise_text()}; standard deviation {1e3 * solved.position_std_m:.3f} mm and "
        f"{math.degrees(solved.rotation_std_rad):.4f} deg; rotations of {spread} deg about the principal axes"
    )


def _show(said: Diagnostics, colored: bool) -> int:
    show(said, {}, colored)
    return exit_code(said)
