"""The YAML file of a map, as ROS map_server and Nav2's map_server read and write it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from xei_lang.profiles.schema.values import Fraction01, Model, Text


class MapServerModel(Model):
    """`resolution` is metres a pixel; `origin` the pose (x, y, yaw) of the lower left pixel's outer corner in
    the map's frame, m and rad. A pixel's chance of being occupied is (255 - value) / 255, or value / 255
    where `negate` is 1.
    """

    image: Text
    resolution: Annotated[float, Field(gt=0, le=10)]
    origin: Annotated[list[float], Field(min_length=3, max_length=3)]
    negate: Literal[0, 1]
    occupied_thresh: Fraction01
    free_thresh: Fraction01
    mode: Literal["trinary", "scale", "raw"] = "trinary"
