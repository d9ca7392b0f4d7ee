"""What stands before the service: who may ask, how often, and how much they may send.

Plain ASGI, so that a body is counted while it comes in, and not read any further than it may be long.
"""

from __future__ import annotations

import hmac
import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "[::1]"})


@dataclass(frozen=True, slots=True)
class GateLimits:
    """Bytes of a body, seconds in which it must have come, requests at once and a second."""

    body_bytes: int = 32_000_000
    body_s: float = 20.0
    burst: int = 40
    rate_hz: float = 20.0


@dataclass(slots=True)
class Bucket:
    """A token bucket: `burst` requests at once, `rate_hz` of them come back each second."""

    burst: int
    rate_hz: float
    clock: Callable[[], float] = time.monotonic
    level: float = field(init=False)
    at: float = field(init=False)

    def __post_init__(self) -> None:
        self.level, self.at = float(self.burst), self.clock()

    def wait_s(self) -> float:
        """0 where a request may pass, which then counts; else how long until one may."""
        now = self.clock()
        self.level = min(float(self.burst), self.level + (now - self.at) * self.rate_hz)
        self.at = now
        if self.level < 1.0:
            return (1.0 - self.level) / self.rate_hz
        self.level -= 1.0
        return 0.0


class Gate:
    """An ASGI app that lets requests through to another, or answers them itself."""

    def __init__(self, app: ASGIApp, token: str | None, limits: GateLimits) -> None:
        self._app = app
        self._token = token
        self._limits = limits
        self._bucket = Bucket(limits.burst, limits.rate_hz)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:  # noqa: D102
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value for name, value in scope["headers"]}
        wait_s = self._bucket.wait_s()
        if wait_s > 0.0:
            seconds = str(math.ceil(wait_s)).encode()
            await _answer(send, 429, "too many requests", [(b"retry-after", seconds)])
        elif not self._may_ask(headers):
            await _answer(send, 401, "this service wants its token, as `Authorization: Bearer ...`")
        elif self._token is None and not _is_loopback(headers.get("host", b"")):
            await _answer(send, 403, "this service is asked by names of this machine only")
        elif _length(headers.get("content-length", b"0")) > self._limits.body_bytes:
            await _answer(send, 413, self._too_much())
        else:
            await self._let_in(scope, receive, send)

    async def _let_in(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Read the whole body, counting, before the app is asked: it never sees one that is too large."""
        parts: list[bytes] = []
        size, ends = 0, time.monotonic() + self._limits.body_s
        while True:
            message = await receive()
            if message["type"] == "http.disconnect":
                return
            part: bytes = message.get("body", b"")
            size += len(part)
            parts.append(part)
            if size > self._limits.body_bytes:
                await _answer(send, 413, self._too_much())
                return
            if not message.get("more_body", False):
                break
            if time.monotonic() > ends:
                await _answer(send, 408, "the body came too slowly")
                return
        whole: Message | None = {"type": "http.request", "body": b"".join(parts), "more_body": False}

        async def once() -> Message:
            nonlocal whole
            if whole is None:
                return await receive()
            message, whole = whole, None
            return message

        await self._app(scope, once, send)

    def _may_ask(self, headers: dict[str, bytes]) -> bool:
        if self._token is None:
            return True
        given = headers.get("authorization", b"")
        return hmac.compare_digest(given, b"Bearer " + self._token.encode())

    def _too_much(self) -> str:
        return f"a request may have {self._limits.body_bytes // 1_000_000} MB"


def _is_loopback(host: bytes) -> bool:
    """Whether a `Host` header names this machine: a page in a browser that was led here names another."""
    name = host.decode("latin-1").lower()
    if not name.endswith("]"):
        name = name.rpartition(":")[0] or name
    return name in LOOPBACK_NAMES


def _length(text: bytes) -> int:
    return int(text) if text.isdigit() and len(text) < 19 else 0


async def _answer(
    send: Send, status: int, message: str, headers: list[tuple[bytes, bytes]] | None = None
) -> None:
    body = json.dumps({"error": message}).encode()
    given = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    # What is still to come of the body is not read: the connection ends with this answer.
    given += [(b"connection", b"close"), *(headers or [])]
    await send({"type": "http.response.start", "status": status, "headers": given})
    await send({"type": "http.response.body", "body": body})
