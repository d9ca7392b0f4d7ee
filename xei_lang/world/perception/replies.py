"""What an HTTP answer of a pose service is worth before its body is believed."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import BaseModel, ValidationError

from xei_lang.world.perception.contract import ProblemModel
from xei_lang.world.perception.service_fault import ServiceFault
from xei_lang.world.perception.stray_key import stray_key

MAX_PAUSE_S = 10.0


@dataclass(frozen=True, slots=True)
class Reply:
    """A whole answer: its status and body, and what it says of when to come again."""

    status: int
    body: bytes
    retry_after: str

    @property
    def is_success(self) -> bool:
        """Whether the body is what was asked for."""
        return self.status == 200

    @property
    def retry_after_s(self) -> float:
        """Seconds that the service asks for (RFC 9110, 10.2.3, in seconds only), at most `MAX_PAUSE_S`."""
        text = self.retry_after.strip()
        return min(float(text), MAX_PAUSE_S) if text.isascii() and text.isdigit() else 0.0


def http_fault(url: str, reply: Reply) -> ServiceFault:
    """An answer that is no success."""
    said = _said(reply.body)
    where = f"the pose service at {url}"
    if reply.status == 429:
        return ServiceFault("busy", f"{where} has too much to do{said}", "ask less often")
    if reply.status >= 500:
        help_ = "look at what it says itself"
        return ServiceFault("failed", f"{where} failed with status {reply.status}{said}", help_)
    if reply.status in (401, 403):
        return ServiceFault(
            "rejected", f"{where} wants a token{said}", "give the file of its token: `--token-file FILE`"
        )
    message = f"{where} refuses what it was asked, with status {reply.status}{said}"
    return ServiceFault("rejected", message, "compare its contract with `xei schema pose_request`")


def garbage(url: str, method: str, path: str, form: type[BaseModel], error: ValidationError) -> ServiceFault:
    """An answer that is not of its form. A key too many was meant by somebody, so that comes first."""
    where = f"the answer of the pose service at {url} to {method} {path}"
    stray = stray_key(form, error)
    if stray is not None:
        return ServiceFault("garbage", f"{where} {stray[0]}", stray[1])
    first = error.errors(include_input=False, include_url=False)[0]
    place = ".".join(str(part) for part in first["loc"])
    what = f"`{place[:80]}`: {first['msg'][:120]}" if place else str(first["msg"])[:120]
    return ServiceFault(
        "garbage", f"{where} is not of its form: {what}", "compare it with `xei schema pose_response`"
    )


def unlike(url: str, theirs: str, ours: str) -> ServiceFault:
    """A service that speaks for another lab."""
    whose = f"another registry: {theirs[:12]}, and the profile's is {ours[:12]}"
    message = f"the pose service at {url} speaks for {whose}"
    return ServiceFault(
        "other_registry", message, "start it with this profile, or put the objects that differ"
    )


def _said(body: bytes) -> str:
    """The service's own words, as far as they are of the contract; control characters are not passed on."""
    try:
        words = ProblemModel.model_validate_json(body).error
    except ValidationError:
        return ""
    shown = "".join(letter if letter.isprintable() else " " for letter in words[:200])
    return f": {shown}"
