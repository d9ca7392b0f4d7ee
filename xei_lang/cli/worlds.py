"""What `--world` names, as a source of the world that is asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.cli.lab import optional
from xei_lang.cli.options import PROFILE_WORLD, WorldOptions
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.profiles.model import Profile
    from xei_lang.world.perception.pose_request import PoseRequest
    from xei_lang.world.sources import Observations

_RECORD = (
    "record what was seen as a scene file (`xei schema scene_file`), or a picture for a pose service: "
    "`--picture FILE` (`xei schema pose_request`)"
)
_TOKEN = "give a token in a file: `--token-file FILE`"


def observed_by(
    asked: WorldOptions, profile: Profile, color: bool
) -> tuple[tuple[Observations, ...], Diagnostics]:
    """What the sources that `--world` names say of a profile's objects, in their order; with errors, nothing
    to be used.

    Exits where a pose service is to be asked and the libraries for that are not installed.
    """
    services = [named for named in asked.sources if _is_service(named)]
    if asked.picture is not None and not services:
        named = asked.sources[-1] if asked.sources else PROFILE_WORLD
        note = f"`--picture` is for a pose service, and `--world` names `{named}`"
        return (), (_no_source(named, note),)
    called = [named if _is_service(named) else Path(named).name for named in asked.sources]
    twice = next((named for k, named in enumerate(called) if named in called[:k]), None)
    if twice is not None:
        note = "two sources have that name, and nobody could tell afterwards which of them said what"
        return (), (_no_source(twice, note, "name each source once, and each file differently"),)
    secret = tuple(said for named in services for said in password_in(named))
    if secret:
        return (), secret
    seen: list[Observations] = []
    said: list[Diagnostic] = []
    for named in asked.sources:
        found, more = (
            _seen_by_service(named, asked, profile, color)
            if _is_service(named)
            else observed_in(named, profile)
        )
        seen.extend(found)
        said.extend(more)
    return tuple(seen), tuple(said)


def _is_service(named: str) -> bool:
    return named.lower().startswith(("http://", "https://"))


def observed_in(named: str, profile: Profile) -> tuple[tuple[Observations, ...], Diagnostics]:
    """What a scene file says of a profile's objects, by its path; `profile` stands for no file at all."""
    if named == PROFILE_WORLD:
        return (), ()
    if "://" in named:
        note = "known are `profile`, the path of a scene file, and the address of a pose service"
        return (), (_no_source(named, note),)
    from xei_lang.world.sources.scene_file import SceneFileSource

    text, problems = read_source(Path(named), named)
    if text is None:
        return (), problems
    seen, said = SceneFileSource(text).observe(profile)
    return (() if seen is None else (seen,)), said


def _seen_by_service(
    url: str, asked: WorldOptions, profile: Profile, color: bool
) -> tuple[tuple[Observations, ...], Diagnostics]:
    """What a pose service finds in a recorded picture, which is taken to be of now, as a scene file is."""
    if asked.picture is None:
        note = "a pose service finds objects in a picture, and there is no `--picture`"
        return (), (_no_source(url, note),)
    optional("xei_lang.world.perception.observe", color)
    request, problems = read_request(asked.picture, url, profile)
    if request is None:
        return (), problems
    from xei_lang.cli.pose_service import read_token
    from xei_lang.world.perception.client import PoseClient
    from xei_lang.world.perception.observe import observe
    from xei_lang.world.perception.service_fault import ServiceFault

    token, problems = read_token(asked.token_file)
    if problems:
        return (), problems
    now_ns = request.picture.stamp_ns
    found = observe(PoseClient(url.rstrip("/"), token), profile, request, now_ns=now_ns)
    if isinstance(found, ServiceFault):
        return (), (found.diagnostic(),)
    return (found.observations,), found.diagnostics


def password_in(url: str) -> Diagnostics:
    """Whether an address holds what must not be kept in plans and traces."""
    if "@" not in url.partition("://")[2].partition("/")[0]:
        return ()
    note = "a user and a password in an address would stand in every plan that is made with it"
    return (_no_source(url.rpartition("@")[2], note, _TOKEN),)


def read_request(picture: Path, url: str, profile: Profile) -> tuple[PoseRequest | None, Diagnostics]:
    """A request of the form `pose_request` about this lab, from its file."""
    from pydantic import ValidationError

    from xei_lang.world.perception.contract import PoseRequestModel
    from xei_lang.world.perception.unfit import unfit
    from xei_lang.world.perception.wire import request_of

    text, problems = read_source(picture, str(picture))
    if text is None:
        return None, problems
    try:
        request = request_of(PoseRequestModel.model_validate_json(text.text))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(step) for step in first["loc"])
        request = f"{place}: {first['msg'].lower()}" if place else first["msg"]
    if isinstance(request, str):
        note = f"`{picture}` is not of the form `pose_request`: {request}"
        return None, (_no_source(url, note),)
    wrong = unfit(profile, request)
    if wrong is not None:
        return None, (_no_source(url, f"`{picture}` is no picture of this lab: {wrong}"),)
    return request, ()


def _no_source(named: str, note: str, help: str = _RECORD) -> Diagnostic:
    return Diagnostic("XEI0663", f"`{named}` cannot be asked where things are", notes=(note,), help=(help,))
