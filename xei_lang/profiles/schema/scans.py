"""A recording of lidar scans for a map: JSON Lines, the first for the whole, then a line a scan. SI units.

Recordings are written by programs, so numbers stand without units, in metres, radians and seconds, and every
name says which.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from xei_lang.profiles.schema.frames import Day
from xei_lang.profiles.schema.values import Model, Name

Angle = Annotated[float, Field(ge=-7, le=7)]


class ScansModel(Model):
    """The first line: which of the profile's lidars it was, and how its rays lie.

    Ray k goes in the direction `angle_min_rad + k * angle_increment_rad` about the lidar's z, from its x, as
    in sensor_msgs/LaserScan; ranges outside of `range_min_m .. range_max_m` say nothing.
    """

    version: Literal[1]
    recorded_on: Day
    lidar: Name
    angle_min_rad: Angle
    angle_increment_rad: Annotated[float, Field(ge=-1, le=1)]
    range_min_m: Annotated[float, Field(ge=0, le=100)]
    range_max_m: Annotated[float, Field(gt=0, le=1000)]


class ScanModel(Model):
    """A scan: the base's pose (x, y, yaw; m, rad) in the map's frame, as who localised it said, and a range
    for each ray; null where no echo came back.
    """

    stamp_s: Annotated[float, Field(ge=0)]
    base: Annotated[list[float], Field(min_length=3, max_length=3)]
    ranges_m: Annotated[list[Annotated[float, Field(ge=0)] | None], Field(min_length=1, max_length=20000)]
