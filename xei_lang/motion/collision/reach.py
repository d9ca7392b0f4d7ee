"""Which bodies can ever come near each other, at whatever configuration.

Each pair of a scene costs time when the scene is made and in every question asked of it, and of a laboratory
most is out of an arm's reach. A body is in a ball around the axis that its arm turns about first, or around
itself where no arm moves it; the ball goes up and down with the slide, or stands still.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.collision.bodies import Geometry, ball
from xei_lang.motion.collision.edges import Axis, axes_of
from xei_lang.motion.robot import Array, Robot

Bools = NDArray[np.bool_]
_Ball = tuple[Array, float, bool]
"""Centre (3,) in base_link with all joints at zero, radius in metres, and whether the slide moves it."""


@dataclass(frozen=True, slots=True)
class Reach:
    """How far bodies get on each joint of a robot. `links` are the balls of its own geometry, which comes
    first in any scene.
    """

    robot: Robot
    axes: Mapping[int, Axis]
    links: tuple[_Ball, ...]

    def may_meet(self, geometry: Geometry, near_m: float) -> Bools:
        """Pairs (g, g) that some configuration may bring nearer to each other than `near_m`."""
        others = list(geometry.model.geometryObjects)[len(self.links) :]
        balls = (*self.links, *(_ball(self.robot, self.axes, item) for item in others))
        middle, radius = np.array([item[0] for item in balls]), np.array([item[1] for item in balls])
        lifted = np.array([float(item[2]) for item in balls])
        slide, axis = self.robot.slide_index, np.array(self.robot.slide_axis)
        low, high = (float(limit[slide]) for limit in _travel(self.robot))
        apart = middle[:, None] - middle[None, :]
        # Where the slide moves one of the two, they are as near as it brings them.
        rises = lifted[:, None] - lifted[None, :]
        nearest = rises * np.clip(-rises * (apart @ axis), low, high)
        distance = np.linalg.norm(apart + nearest[:, :, None] * axis, axis=2)
        return distance < radius[:, None] + radius[None, :] + near_m


def reach_of(robot: Robot, links: Any) -> Reach:
    """The reach of a robot with `links`, its geometry model as `robot_links` makes it."""
    axes = axes_of(robot)
    return Reach(robot, axes, tuple(_ball(robot, axes, item) for item in links.geometryObjects))


def _travel(robot: Robot) -> tuple[Array, Array]:
    """The URDF's limits: a slide may stand outside those that planning keeps to."""
    return np.asarray(robot.model.lowerPositionLimit), np.asarray(robot.model.upperPositionLimit)


def _ball(robot: Robot, axes: Mapping[int, Axis], item: Any) -> _Ball:
    """Where a geometry object stays: the bound is that of `edges.py`, followed down to the arm's first
    axis.
    """
    joint, slide = int(item.parentJoint), robot.slide_index + 1
    middle, radius = ball(item)
    if joint == 0:
        return middle, radius, False
    center = axes[joint].rotation @ middle + axes[joint].origin
    if joint == slide:
        return center, radius, True
    reach = float(np.linalg.norm(center - axes[joint].point)) + radius + axes[joint].travel_m
    while (parent := int(robot.model.parents[joint])) not in (0, slide):
        reach += float(np.linalg.norm(axes[joint].point - axes[parent].point)) + axes[parent].travel_m
        joint = parent
    return axes[joint].point, reach, parent == slide
