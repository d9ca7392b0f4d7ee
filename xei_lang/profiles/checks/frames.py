"""The frames of a deployment are one tree: every frame hangs on `world`, by itself or through the robot."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import CalibratedFrame, Profile


def check_frames(profile: Profile) -> Iterator[Diagnostic]:
    """Frames without a way to `world`, circles, frames given twice; links, stations and ground frames that do
    not exist.
    """
    calibration = profile.calibration
    carried = dict(calibration.robot_frames)
    frames = {frame.name: frame for frame in calibration.frames}
    anchors = ("world", *carried)
    for frame in calibration.frames:
        if frame.name in anchors:
            yield Diagnostic(
                "XEI0630",
                f"the frame `{frame.name}` has two parents",
                frame.span,
                label="the robot carries it, or it is the root",
                help=("give it another name",),
            )
        elif frame.parent not in anchors and frame.parent not in frames:
            yield unknown("a frame", frame.parent, [*anchors, *frames], frame.span, "XEI0630")
        else:
            yield from _circle(frame, frames)
    if "robot_base" not in carried:
        yield Diagnostic(
            "XEI0630", "`robot_frames` has no `robot_base`", help=("add `robot_base: base_link`",)
        )
    for name, link in calibration.robot_frames:
        if link not in profile.robot.links:
            yield Diagnostic(
                "XEI0620",
                f"the frame `{name}` rides on `{link}`, which is no link of the robot",
                help=unknown("a link", link, profile.robot.links, profile.bank.skills[0].span).help,
            )
    yield from _stations(profile, tuple(frames))


def _circle(frame: CalibratedFrame, frames: dict[str, CalibratedFrame]) -> Iterator[Diagnostic]:
    way = [frame]
    while way[-1].parent in frames:
        parent = frames[way[-1].parent]
        if parent is frame:
            shown = " -> ".join(f"`{item.name}`" for item in (*way, frame))
            if frame.name == min(item.name for item in way):
                labels = tuple(Label(item.span, f"hangs on `{item.parent}`") for item in way[1:])
                yield Diagnostic(
                    "XEI0630",
                    f"frames hang on each other: {shown}",
                    frame.span,
                    labels=labels,
                    label=f"hangs on `{frame.parent}`",
                    help=("hang one of them on `world`",),
                )
            return
        if parent in way:
            return
        way.append(parent)


def _stations(profile: Profile, frames: tuple[str, ...]) -> Iterator[Diagnostic]:
    calibration = profile.calibration
    names = [station.name for station in calibration.stations]
    if calibration.start_station not in names:
        found = (
            unknown("a station", calibration.start_station, names, calibration.stations[0].span)
            if names
            else None
        )
        yield found or Diagnostic(
            "XEI0620", "the calibration profile has no station", help=("add one under `stations`",)
        )
    for station in calibration.stations:
        if station.ground_frame not in frames:
            yield unknown("a frame", station.ground_frame, frames, station.span)
    if calibration.map_frame not in frames:
        yield Diagnostic(
            "XEI0620",
            f"the map's frame `{calibration.map_frame}` is not a frame of this profile",
            help=("known are " + ", ".join(f"`{name}`" for name in frames),),
        )
