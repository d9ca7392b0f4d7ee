"""Ending a connection at a time, however slowly its answer comes."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager, suppress
from typing import Any

Trace = Callable[[str, Mapping[str, Any]], None]
"""What httpx tells of the steps of a request (its extension `trace`)."""

_CONNECTED = ("connection.connect_tcp.complete", "connection.start_tls.complete")


@contextmanager
def hung_up_after(seconds: float) -> Generator[Trace, None, None]:
    """A trace for one request, whose connection is shut down once the time is over.

    A time-out of httpx is for one read. The head of an answer is read until it is whole, so that one that
    comes a line a second, or interim answers without end (RFC 9110, 15.2), would never meet it.
    """
    connections: list[socket.socket] = []

    def trace(event: str, told: Mapping[str, Any]) -> None:
        if event in _CONNECTED:
            connections[:] = [told["return_value"].get_extra_info("socket")]

    def hang_up() -> None:
        for connection in connections:
            with suppress(OSError):
                connection.shutdown(socket.SHUT_RDWR)

    timer = threading.Timer(seconds, hang_up)
    timer.daemon = True
    timer.start()
    try:
        yield trace
    finally:
        timer.cancel()
