"""Who is asked during a run: the files of `--perceived`, shown to a pose service where one is named."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xei_lang.cli.lab import optional
from xei_lang.cli.pose_service import read_token
from xei_lang.cli.worlds import password_in, read_request
from xei_lang.diagnostics import Diagnostic, Diagnostics, has_errors
from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.ir.timed import TimedPlan
    from xei_lang.profiles.model import Profile
    from xei_lang.runtime.perception import Perception
    from xei_lang.world.sources import WorldSource


def perception_of(
    timed: TimedPlan,
    profile: Profile,
    files: tuple[Path, ...],
    url: str | None,
    token_file: Path | None,
    *,
    color: bool,
) -> tuple[Perception | None, Diagnostics]:
    """The perception of a run; none where nothing is named. Each goal that perceives has its file, in the
    order of their starts. Exits where a service is to be asked and the libraries for that are missing.
    """
    if not files:
        if url is not None:
            message = "a pose service finds things in pictures: name one with `--perceived` for each look"
            raise click.UsageError(message)
        return None, ()
    looks = [goal for goal in timed.goals if goal.kind == "perceive"]
    goals = [goal.id for goal in sorted(looks, key=lambda goal: goal.start_s)]
    if len(goals) != len(files):
        return None, (_count(len(goals), len(files)),)
    if url is None:
        return _scenes(dict(zip(goals, files, strict=True)))
    optional("xei_lang.world.perception.recorded", color)
    secret = password_in(url)
    return (
        (None, secret)
        if secret
        else _pictures(dict(zip(goals, files, strict=True)), url, token_file, profile)
    )


def _scenes(files: dict[str, Path]) -> tuple[Perception | None, Diagnostics]:
    from xei_lang.runtime.perception import RecordedScenes
    from xei_lang.world.sources.scene_file import SceneFileSource

    sources: dict[str, WorldSource] = {}
    problems: Diagnostics = ()
    for goal, file in files.items():
        text, said = read_source(file, str(file))
        problems = (*problems, *said)
        if text is not None:
            sources[goal] = SceneFileSource(text)
    return (None if has_errors(problems) else RecordedScenes(sources)), problems


def _pictures(
    files: dict[str, Path], url: str, token_file: Path | None, profile: Profile
) -> tuple[Perception | None, Diagnostics]:
    from xei_lang.world.perception.client import PoseClient
    from xei_lang.world.perception.pose_request import PoseRequest
    from xei_lang.world.perception.recorded import RecordedPictures

    token, problems = read_token(token_file)
    requests: dict[str, PoseRequest] = {}
    for goal, file in files.items():
        request, said = read_request(file, url, profile)
        problems = (*problems, *said)
        if request is not None:
            requests[goal] = request
    if has_errors(problems):
        return None, problems
    return RecordedPictures(PoseClient(url.rstrip("/"), token), requests), problems


def _count(goals: int, files: int) -> Diagnostic:
    looks = "never looks" if goals == 0 else f"looks {goals} time{'s' if goals > 1 else ''}"
    message = f"the plan {looks}, and `--perceived` says {files} time{'s' if files > 1 else ''} what is seen"
    note = "`xei compile --print-after lower` shows which goals look, and at what"
    help_ = "give one `--perceived` for each goal that perceives, in their order"
    return Diagnostic("XEI0942", message, notes=(note,), help=(help_,))
