"""Sensors without the topics that a run on hardware listens to."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType

from xei_lang.diagnostics import Span
from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import Profile

TOPICS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "cameras": {
            "rgb": "sensor_msgs/Image in colour",
            "depth": "sensor_msgs/Image, aligned to the colour image",
            "info": "sensor_msgs/CameraInfo",
        },
        "lidars": {"scan": "sensor_msgs/LaserScan"},
    }
)
"""The topics that each kind of sensor must have, and what comes over them."""

_ABSOLUTE = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
"""An absolute ROS 2 topic name (https://design.ros2.org/articles/topic_and_service_names.html)."""


def sensor_blockers(profile: Profile) -> Iterator[Blocker]:
    """Kinds of sensors that the profile does not have, and topics that are missing or no topics."""
    calibration = profile.calibration
    found = {
        "cameras": [(item.name, dict(item.topics), item.span) for item in calibration.cameras],
        "lidars": [(item.name, dict(item.topics), item.span) for item in calibration.lidars],
    }
    for section, sensors in found.items():
        if not sensors:
            yield _blocker(section, "missing", f"describe the robot's {section}: frame, topics", None)
        for name, topics, span in sensors:
            for topic, carries in TOPICS[section].items():
                item = f"{section}.{name}.topics.{topic}"
                if topic not in topics:
                    yield _blocker(item, "missing", f"name the topic of {carries}", span)
                elif not _ABSOLUTE.fullmatch(topics[topic]):
                    measure = f"`{topics[topic]}` is no absolute topic: write it like `/{topic}`"
                    yield _blocker(item, "no topic", measure, span)


def _blocker(item: str, status: str, measure: str, span: Span | None) -> Blocker:
    return Blocker(
        "XEI0689",
        "calibration_profile",
        item,
        status,
        "hardware",
        measure,
        f"{CALIBRATION}:{item}",
        span,
    )
