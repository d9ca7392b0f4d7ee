"""A client of the pose service that believes nothing: bounded in time and size, and checked against the
registry and the request.

This is a border of xei: it speaks over the network and looks at the clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import httpx
from pydantic import BaseModel, ValidationError

from xei_lang.ir.forms.canonical import Json, line
from xei_lang.world.perception.contract import (
    HealthModel,
    ModelsModel,
    ObjectsModel,
    PoseResponseModel,
)
from xei_lang.world.perception.hang_up import hung_up_after
from xei_lang.world.perception.pose_request import PoseRequest, PoseResponse
from xei_lang.world.perception.registry import RegisteredObject, Registry
from xei_lang.world.perception.replies import Reply, garbage, http_fault, unlike
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.perception.wire import put_json, registered_of, request_json, response_of

_Model = TypeVar("_Model", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class Limits:
    """What a service is allowed: seconds for one call with all its tries, tries, and bytes of an answer.

    A try that gave a 429, a 5xx or a dropped connection is followed by another after `backoff_s`, which
    doubles each time; one that ran out of time is not.
    """

    call_s: float = 20.0
    connect_s: float = 3.0
    tries: int = 4
    backoff_s: float = 0.1
    answer_bytes: int = 4_000_000


@dataclass(frozen=True, slots=True)
class PoseClient:
    """A pose service at `url` (`http://127.0.0.1:8765`); `token` where it asks for one.

    Neither proxies of the environment nor redirections are followed: pictures of a lab go where they are
    sent.
    """

    url: str
    token: str | None = None
    limits: Limits = Limits()
    sleep: Callable[[float], None] = time.sleep

    def health(self, registry: Registry) -> HealthModel | ServiceFault:
        """Whether the service is there, ready, and speaks for this registry."""
        found = self._asked("GET", "/health", None, HealthModel)
        if isinstance(found, ServiceFault):
            return found
        if found.registry_sha256 != registry.sha256:
            return unlike(self.url, found.registry_sha256, registry.sha256)
        if found.status != "ready":
            detail = f": {found.detail}" if found.detail else ""
            return ServiceFault("failed", f"the pose service at {self.url} is not ready{detail}",
                                "wait until it is, or look at what it says itself")  # fmt: skip
        return found

    def models(self) -> ModelsModel | ServiceFault:
        """What answers there."""
        return self._asked("GET", "/models", None, ModelsModel)

    def objects(self) -> Registry | ServiceFault:
        """The registry that the service has, whichever it is."""
        found = self._asked("GET", "/objects", None, ObjectsModel)
        return found if isinstance(found, ServiceFault) else _registry(found)

    def put_object(self, item: RegisteredObject) -> Registry | ServiceFault:
        """Make the service know an object so, and return its registry then."""
        found = self._asked("PUT", f"/objects/{item.name}", put_json(item), ObjectsModel)
        return found if isinstance(found, ServiceFault) else _registry(found)

    def poses(self, request: PoseRequest) -> PoseResponse | ServiceFault:
        """The answer to a request, of its form and to this request; no pose in it has been believed yet."""
        found = self._asked("POST", "/v1/poses", request_json(request), PoseResponseModel)
        if isinstance(found, ServiceFault):
            return found
        if found.request_id != request.request_id:
            theirs = f"answered request `{found.request_id[:60]}`"
            message = f"the pose service at {self.url} {theirs}, and was asked `{request.request_id}`"
            return ServiceFault("other_request", message, "restart it: it mixes up its callers")
        return response_of(found)

    def _asked(self, method: str, path: str, body: Json, form: type[_Model]) -> _Model | ServiceFault:
        reply = self._call(method, path, None if body is None else line(body).encode())
        if isinstance(reply, ServiceFault):
            return reply
        try:
            return form.model_validate_json(reply.body)
        except ValidationError as error:
            return garbage(self.url, method, path, form, error)

    def _call(self, method: str, path: str, body: bytes | None) -> Reply | ServiceFault:
        ends = time.monotonic() + self.limits.call_s
        fault: ServiceFault | None = None
        with self._session() as session:
            for attempt in range(self.limits.tries):
                pause = self.limits.backoff_s * 2**attempt
                fault = None
                reply = self._try(session, method, path, body, ends)
                if isinstance(reply, Reply) and reply.is_success:
                    return reply
                if isinstance(reply, Reply):
                    fault, pause = http_fault(self.url, reply), max(pause, reply.retry_after_s)
                else:
                    fault = reply
                again = fault.reason in ("unreachable", "dropped", "busy", "failed")
                if not again or attempt + 1 == self.limits.tries or time.monotonic() + pause > ends:
                    return fault
                self.sleep(pause)
        return fault or self._slow()

    def _session(self) -> httpx.Client:
        headers = {"Accept": "application/json", "Accept-Encoding": "identity"}
        if self.token is not None:
            headers["Authorization"] = f"Bearer {self.token}"
        # Each try has a connection of its own: one that the service is about to close looks like a fault.
        fresh = httpx.Limits(max_keepalive_connections=0)
        return httpx.Client(headers=headers, trust_env=False, follow_redirects=False, limits=fresh)

    def _try(
        self, session: httpx.Client, method: str, path: str, body: bytes | None, ends: float
    ) -> Reply | ServiceFault:
        left = ends - time.monotonic()
        if left <= 0:
            return self._slow()
        timeout = httpx.Timeout(left, connect=min(self.limits.connect_s, left))
        headers = {} if body is None else {"Content-Type": "application/json"}
        url = self.url.rstrip("/") + path
        try:
            with hung_up_after(left) as trace, session.stream(
                method, url, content=body, headers=headers, timeout=timeout, extensions={"trace": trace}
            ) as answer:  # fmt: skip
                return self._read(answer, ends)
        except (httpx.InvalidURL, httpx.UnsupportedProtocol, UnicodeError):
            return ServiceFault("unreachable", f"`{self.url}` is no address of a pose service",
                                "give one such as http://127.0.0.1:8765")  # fmt: skip
        except httpx.HTTPError as error:
            return self._broken_off(error, ends)

    def _broken_off(self, error: httpx.HTTPError, ends: float) -> ServiceFault:
        if isinstance(error, httpx.ConnectTimeout | httpx.ConnectError):
            return self._away()
        if isinstance(error, httpx.TimeoutException) or time.monotonic() >= ends:
            return self._slow()
        message = f"the pose service at {self.url} dropped the connection: {type(error).__name__}"
        return ServiceFault("dropped", message, "look at what it says itself; it may have ended")

    def _read(self, answer: httpx.Response, ends: float) -> Reply | ServiceFault:
        bound = self.limits.answer_bytes
        stated = answer.headers.get("content-length", "0")
        if answer.headers.get("content-encoding", "identity") != "identity":
            return ServiceFault("garbage", f"the pose service at {self.url} packed its answer, unasked",
                                "turn compression off: what it unpacks to is not known before")  # fmt: skip
        parts: list[bytes] = []
        size = int(stated) if stated.isascii() and stated.isdigit() else 0
        if size <= bound:
            size = 0
            for part in answer.iter_raw():
                size += len(part)
                parts.append(part)
                if size > bound:
                    break
                if time.monotonic() > ends:
                    return self._slow()
        if size > bound:
            message = f"the pose service at {self.url} answers with more than {bound / 1e6:g} MB"
            return ServiceFault("too_large", message, "ask for fewer objects, or mend the service")
        return Reply(answer.status_code, b"".join(parts), answer.headers.get("retry-after", ""))

    def _slow(self) -> ServiceFault:
        message = f"the pose service at {self.url} did not answer within {self.limits.call_s:g} s"
        return ServiceFault("slow", message, "look at its load, or give it more time")

    def _away(self) -> ServiceFault:
        message = f"no pose service answers at {self.url}"
        help_ = "start it: `xei perception serve`, and give the address that it prints"
        return ServiceFault("unreachable", message, help_)


def _registry(model: ObjectsModel) -> Registry:
    return Registry(tuple(registered_of(item) for item in model.objects))
