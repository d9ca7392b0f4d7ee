"""The frames of a deployment are one tree: every frame hangs on `world`, by itself or through the robot."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import CalibratedFrame, Profile
from xei_lang.profiles.trees import Trees
from xei_lang.profiles.yaml_tree import Node, Path


def check_frames(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
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
            span = trees.calibration.span_of("frames", frame.name, "parent")
            known = [name for name in (*anchors, *frames) if name != frame.name]
            yield unknown("a frame of this profile", frame.parent, known, span, "XEI0630")
        else:
            yield from _circle(frame, frames)
    if "robot_base" not in carried:
        span = trees.calibration.key_span("robot_frames")
        yield Diagnostic(
            "XEI0630", "no frame is the robot's base", span, help=("add `robot_base: base_link`",)
        )
    for name, link in calibration.robot_frames:
        if link not in profile.robot.links:
            span = trees.calibration.span_of("robot_frames", name)
            yield unknown("a link of the robot", link, profile.robot.links, span)
    yield from _named_like_objects(profile, trees.calibration)
    yield from _stations(profile, tuple(frames), trees.calibration)
    yield from _sensors((*anchors, *frames), tuple(item.name for item in profile.objects), trees.calibration)


def _named_like_objects(profile: Profile, tree: Node) -> Iterator[Diagnostic]:
    """Frames with the name of an object that does not stand in them: who asks for one would get the other."""
    named = {name: item for item in profile.objects for name in (item.name, *item.aliases)}
    spans = {frame.name: frame.span for frame in profile.calibration.frames}
    for name, _ in profile.calibration.robot_frames:
        spans.setdefault(name, tree.key_span("robot_frames", name))
    for name, span in spans.items():
        item = named.get(name)
        if item is None or (item.name == name and item.prior is not None and item.prior.frame == name):
            continue
        yield Diagnostic(
            "XEI0621",
            f"`{name}` names two things",
            span,
            label="names a frame here",
            labels=(Label(item.span, "and an object here"),),
            notes=("only an object whose prior stands in a frame, as a table, may share its name",),
            help=("rename one of the two",),
        )


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


def _stations(profile: Profile, frames: tuple[str, ...], tree: Node) -> Iterator[Diagnostic]:
    calibration = profile.calibration
    names = [station.name for station in calibration.stations]
    if calibration.start_station not in names:
        span = tree.span_of("start_station")
        yield unknown("a station of this profile", calibration.start_station, names, span)
    for station in calibration.stations:
        if station.ground_frame not in frames:
            span = tree.span_of("stations", station.name, "ground_frame")
            yield unknown("a calibrated frame", station.ground_frame, frames, span)
    if calibration.map_frame not in frames:
        yield unknown("a calibrated frame", calibration.map_frame, frames, tree.span_of("map", "frame"))


def _sensors(frames: tuple[str, ...], objects: tuple[str, ...], tree: Node) -> Iterator[Diagnostic]:
    """Cameras and lidars stand in frames that exist; tags may also be on an object, in its own frame."""
    tags = tree.find(("apriltags", "tags"))
    for index in range(len(tags.elements)):
        where = ("apriltags", "tags", index, "frame")
        name = str(tree.find(where).scalar)
        if name not in frames and name not in objects:
            known = [*frames, *objects]
            yield unknown("a frame or an object of this profile", name, known, tree.span_of(*where))
    paths: list[Path] = []
    for section in ("cameras", "lidars"):
        sensors = tree.child(section)
        paths += [(section, name, "frame") for name in (sensors.items if sensors else ())]
    for path in paths:
        name = tree.find(path).scalar
        if name not in frames:
            yield unknown("a frame of this profile", str(name), frames, tree.span_of(*path))
