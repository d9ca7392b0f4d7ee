"""`xei perception`: what cameras see."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from xei_lang.cli.lab import open_lab, optional
from xei_lang.cli.options import PROFILE_WORLD, wants_color
from xei_lang.cli.report import exit_code, show
from xei_lang.cli.worlds import observed_in
from xei_lang.diagnostics import Diagnostic, Diagnostics, has_errors
from xei_lang.profiles.model import Camera, Profile
from xei_lang.world.perception.cameras import camera_named

MAX_IMAGE_BYTES = 100_000_000


@click.group("perception")
def command() -> None:
    """Look at images with the calibrated cameras of a profile, or serve poses of its objects.

    Example: xei perception detect bench.png
    """


@command.command("detect")
@click.argument("image", type=click.Path(path_type=Path), metavar="IMAGE")
@click.option(
    "--camera", "camera_name", metavar="NAME", help="Whose image it is; needed where there are several."
)
@click.option("--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
@click.option("--quiet", is_flag=True, help="Print what was found and errors only.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def detect(
    *, image: Path, camera_name: str | None, profile: str | None, form: str, quiet: bool, color: str
) -> None:
    """Find AprilTags in an image, and say where the tables stand.

    The base is taken to stand at the station of each table, where it carries the camera. The exit code is 0
    where every table that is seen stands within the tolerance that the profile states for it, else 1.

    Example: xei perception detect bench.png --format json
    """
    colored = wants_color(color)
    lab = open_lab(profile, colored)
    camera = camera_named(lab, camera_name)
    said: Diagnostics
    if isinstance(camera, Diagnostic):
        said = (camera,)
    else:
        said = _detect(image, lab, camera, form, quiet=quiet, colored=colored)
    show(said, {}, colored)
    sys.exit(exit_code(said))


@command.command("serve")
@click.option("--profile", metavar="NAME|FOLDER", help="The profile; needed where there are several.")
@click.option(
    "--backend",
    type=click.Choice(["mock", "apriltag", "foundationpose"]),
    default="apriltag",
    show_default=True,
    help="What finds objects: the world as it is believed to be, tags in the image, or another process.",
)
@click.option("--world", "named", default=PROFILE_WORLD, show_default=True, metavar="profile|FILE",
              help="What `mock` takes for the truth: the priors, or a scene file over them.")  # fmt: skip
@click.option("--seed", type=int, default=0, show_default=True, help="Of the noise of `mock`.")
@click.option("--upstream", metavar="URL", help="The process that `foundationpose` asks.")
@click.option("--host", default="127.0.0.1", show_default=True)
@click.option(
    "--port", type=click.IntRange(0, 65535), default=0, show_default=True, help="0 is any free one."
)
@click.option(
    "--token-file",
    type=click.Path(path_type=Path),
    help="A file with the token that callers must give; needed for any host but this machine's own.",
)
@click.option("--quiet", is_flag=True, help="Print the address and errors only.")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
def serve(
    *,
    profile: str | None,
    backend: str,
    named: str,
    seed: int,
    upstream: str | None,
    host: str,
    port: int,
    token_file: Path | None,
    quiet: bool,
    color: str,
) -> None:
    """Run a pose service until Ctrl-C, and print its address.

    It finds objects of the profile in pictures that are sent to it; `xei schema pose_request` and `xei schema
    pose_response` are its contract.

    Example: xei perception serve --backend mock
    """
    colored = wants_color(color)
    lab = open_lab(profile, colored)
    optional("xei_lang.world.perception.service.app", colored)
    optional("xei_lang.world.perception.service.listen", colored)
    optional("xei_lang.world.perception.client", colored)
    from xei_lang.cli.pose_service import read_token, serve_poses
    from xei_lang.world.ground import ground

    token, said = read_token(token_file)
    seen, problems = observed_in(named, lab)
    said = (*said, *problems)
    world = None
    if not has_errors(said):
        world, problems = ground(lab, seen)
        said = (*said, *(item for item in problems if world is None))
    if world is not None:
        said = serve_poses(lab, world, backend=backend, host=host, port=port, token=token, seed=seed,
                           upstream=upstream, quiet=quiet)  # fmt: skip
    show(said, {}, colored)
    sys.exit(exit_code(said))


def _detect(
    image: Path, lab: Profile, camera: Camera, form: str, *, quiet: bool, colored: bool
) -> Diagnostics:
    optional("xei_lang.world.perception.look", colored)
    from xei_lang.world.perception.findings import findings, to_json, to_text
    from xei_lang.world.perception.image import decode_image
    from xei_lang.world.perception.look import look

    if not quiet:
        click.echo(f"looking through `{camera.name}` at tags of {lab.calibration.apriltags.family}", err=True)
    data = _read(image)
    if isinstance(data, Diagnostic):
        return (data,)
    pixels = decode_image(data)
    if pixels is None:
        return (Diagnostic("XEI0680", f"`{image}` is no image that can be read", help=("save it as PNG",)),)
    station = next(one for one in lab.calibration.stations if one.name == lab.calibration.start_station)
    seen = look(pixels, lab.calibration.apriltags, camera, station.ground_frame)
    found = findings(seen, lab, camera)
    if form == "json":
        from xei_lang.ir.forms.canonical import dumps

        click.echo(dumps(to_json(found, image.name, camera.name)), nl=False)
    else:
        click.echo(to_text(found), nl=False)
    return found.diagnostics


def _read(image: Path) -> bytes | Diagnostic:
    try:
        size = image.stat().st_size
        if size > MAX_IMAGE_BYTES:
            return Diagnostic("XEI0680", f"`{image}` is larger than {MAX_IMAGE_BYTES // 1_000_000} MB")
        return image.read_bytes()
    except (OSError, ValueError) as error:
        reason = "does not exist" if isinstance(error, FileNotFoundError) else "cannot be read"
        return Diagnostic("XEI0101", f"`{image}` {reason}", help=("name a PNG or JPEG file",))
