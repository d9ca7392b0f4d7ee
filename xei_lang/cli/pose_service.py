"""What commands share that start a pose service or ask one: addresses, tokens, and starting it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.ir.world import World
    from xei_lang.profiles.model import Profile


def read_token(path: Path | None) -> tuple[str | None, Diagnostics]:
    """The token in a file, or None where no file is named; with errors where it holds none."""
    if path is None:
        return None, ()
    source, problems = read_source(path, str(path))
    if source is None:
        return None, problems
    from xei_lang.world.perception.token_file import token_of

    token = token_of(source.text)
    return (None, (token,)) if isinstance(token, Diagnostic) else (token, ())


def serve_poses(
    profile: Profile,
    world: World,
    *,
    backend: str,
    host: str,
    port: int,
    token: str | None,
    seed: int,
    upstream: str | None,
    quiet: bool,
) -> Diagnostics:
    """Serve until Ctrl-C, with the address on stdout once connections are taken; errors where it cannot."""
    from xei_lang.world.perception.client import PoseClient
    from xei_lang.world.perception.service.app import pose_app
    from xei_lang.world.perception.service.assemble import backend_named
    from xei_lang.world.perception.service.gate import GateLimits
    from xei_lang.world.perception.service.handle import Desk
    from xei_lang.world.perception.service.listen import bound_socket, is_loopback, serve, url_of

    if token is None and not is_loopback(host):
        help_ = "stay on 127.0.0.1, or name a file with a token: `--token-file pose.token`"
        message = f"`{host}` can be reached from elsewhere, and there is no token"
        return (Diagnostic("XEI0698", message, help=(help_,)),)
    if (backend == "foundationpose") != (upstream is not None):
        message = "`--upstream` and the backend `foundationpose` go together"
        help_ = "give the address of the process that runs FoundationPose: `--upstream http://127.0.0.1:8766`"
        return (Diagnostic("XEI0698", message, help=(help_,)),)
    desk = Desk(
        profile, backend_named(backend, profile, world, seed, PoseClient(upstream) if upstream else None)
    )
    missing = desk.backend.ready(desk.registry) if upstream is None else None
    if missing is not None:
        return (Diagnostic("XEI0698", missing, help=("add them to `calibration_profile.yaml`",)),)
    try:
        listening = bound_socket(host, port)
    except OSError as error:
        message = f"{host} port {port} cannot be listened at: {error.strerror or error}"
        return (Diagnostic("XEI0698", message, help=("give another port, or 0 for any that is free",)),)
    with listening:
        click.echo(url_of(listening))
        if not quiet:
            click.echo(
                f"`{backend}` for {profile.name}, {len(desk.registry.objects)} objects; Ctrl-C ends it",
                err=True,
            )
        try:
            serve(pose_app(desk, token, GateLimits()), listening)
        except KeyboardInterrupt:
            if not quiet:
                click.echo("stopped", err=True)
    return ()
