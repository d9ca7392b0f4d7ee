"""Listening: a socket of our own, so that its port is known before anyone is told of it, and a clean end."""

from __future__ import annotations

import ipaddress
import socket

import uvicorn
from starlette.types import ASGIApp

GRACE_S = 3


def is_loopback(host: str) -> bool:
    """Whether an address or name is this machine's own and reached from nowhere else."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def bound_socket(host: str, port: int) -> socket.socket:
    """A socket that already takes connections. Raises OSError where that cannot be."""
    family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    made = socket.socket(family, kind, protocol)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind(address)
        made.listen(64)
    except OSError:
        made.close()
        raise
    return made


def url_of(made: socket.socket) -> str:
    """The address that the socket listens at."""
    host, port = made.getsockname()[:2]
    shown = f"[{host}]" if ":" in str(host) else str(host)
    return f"http://{shown}:{port}"


def server_of(app: ASGIApp) -> uvicorn.Server:
    """The server of an app; what is being answered when it is to end is finished within `GRACE_S`."""
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        lifespan="off",
        limit_concurrency=16,
        timeout_keep_alive=5,
        timeout_graceful_shutdown=GRACE_S,
        h11_max_incomplete_event_size=65536,
        http="h11",
        ws="none",
        loop="asyncio",
        server_header=False,
    )
    return uvicorn.Server(config)


def serve(app: ASGIApp, made: socket.socket) -> None:
    """Serve until SIGINT or SIGTERM. Raises KeyboardInterrupt after a clean end by SIGINT."""
    server_of(app).run(sockets=[made])
