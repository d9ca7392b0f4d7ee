"""Pose services to ask in tests: real ones in a thread or a process, and ones that misbehave."""

from __future__ import annotations

import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from tests.cli.xei import start
from xei_lang.world.perception.service.app import pose_app
from xei_lang.world.perception.service.gate import GateLimits
from xei_lang.world.perception.service.handle import Desk
from xei_lang.world.perception.service.listen import bound_socket, server_of, url_of


@contextmanager
def served(desk: Desk, token: str | None = None, limits: GateLimits | None = None) -> Iterator[str]:
    """A service in a thread, on a free port of loopback."""
    with bound_socket("127.0.0.1", 0) as made:
        server = server_of(pose_app(desk, token, limits or GateLimits(burst=1000, rate_hz=1000.0)))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [made]})
        thread.start()
        try:
            yield url_of(made)
        finally:
            server.should_exit = True
            thread.join()


@contextmanager
def process(folder: Path, *arguments: str) -> Iterator[str]:
    """`xei perception serve` as a user starts it, ended by Ctrl-C, with which it ends cleanly."""
    running = start("perception", "serve", *arguments, cwd=folder)
    assert running.stdout is not None
    url = running.stdout.readline().strip()
    try:
        assert url.startswith("http://"), running.communicate(timeout=30)
        yield url
    finally:
        if running.poll() is None:
            running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=30)
    assert (running.returncode, out) == (0, ""), err
    assert "Traceback" not in err, err


@dataclass
class Rogue:
    """What a misbehaving service was asked, and how much it could send before it was left."""

    url: str
    asked: list[str] = field(default_factory=list)
    sent: int = 0


Behaviour = Callable[[BaseHTTPRequestHandler, Rogue], None]


@contextmanager
def misbehaving(behaviour: Behaviour) -> Iterator[Rogue]:
    """An HTTP server whose every answer is what `behaviour` writes to the connection."""

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self) -> None:
            length = int(self.headers.get("content-length", 0))
            while length > 0:
                length -= len(self.rfile.read(min(length, 1 << 20)))
            rogue.asked.append(f"{self.command} {self.path}")
            self.close_connection = True
            try:
                behaviour(self, rogue)
            except OSError:
                return

        do_POST = do_PUT = do_GET

        def log_message(self, format: str, *args: object) -> None:
            return

    class Server(ThreadingHTTPServer):
        daemon_threads = True

        def handle_error(self, request: object, client_address: object) -> None:
            if not isinstance(sys.exception(), OSError):
                super().handle_error(request, client_address)  # type: ignore[arg-type]

    server = Server(("127.0.0.1", 0), Handler)
    rogue = Rogue(f"http://127.0.0.1:{server.server_address[1]}")
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    try:
        yield rogue
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def nobody() -> str:
    """An address at which nothing listens."""
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        return f"http://127.0.0.1:{made.getsockname()[1]}"
