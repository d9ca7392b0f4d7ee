"""What of a calibration profile nobody has measured, and how to."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.profiles.model import Placeholder, Status
from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.yaml_tree import Node


def build_placeholders(model: CalibrationProfile, root: Node) -> Iterator[Placeholder]:
    """Everything that nobody has measured, in the order of the file's sections."""
    for status, measure, path in _facts(model):
        if status == "placeholder":
            yield Placeholder(".".join(path), measure, root.key_span(*path))


def _facts(model: CalibrationProfile) -> Iterator[tuple[Status, str, tuple[str, ...]]]:
    """The status of each calibrated fact, how to measure it, and where it stands."""
    for name, frame in model.frames.items():
        yield frame.status, frame.method, ("frames", name)
    for name, station in model.stations.items():
        yield station.status, "drive there and record the base's pose", ("stations", name)
    for arm, carry in model.carry.items():
        yield carry.status, "hold each kind of object there and look", ("carry", arm)
    yield model.base.docking.status, "measure it over repeated drives", ("base", "docking")
    yield model.table.status, model.table.method, ("table",)
    files = (model.map.yaml, model.map.image, model.map.sha256)
    yield "placeholder" if None in files else model.map.status, "build and record a map", ("map",)
    yield model.apriltags.status, "stick the tags on and measure their places", ("apriltags",)
    for name, camera in model.cameras.items():
        yield camera.status, "calibrate its intrinsics", ("cameras", name)
    for name, lidar in model.lidars.items():
        yield lidar.status, "confirm its mount and topics", ("lidars", name)
