"""One still of a recording, as the solver takes it."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.world.perception.optics import Array


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """`A` (4, 4) is `T_target_parent` by kinematics, `B` (4, 4) is `T_camera_board` as seen.

    For seen tags `points_m` (n, 3) are their corners on the board and `rays` (n, 2) where they were seen,
    undistorted at a depth of 1 m in the optical frame; both are empty where a pose was recorded.
    `number` counts samples from 1, as people do.
    """

    number: int
    A: Array
    B: Array
    points_m: Array
    rays: Array

    @property
    def is_pixels(self) -> bool:
        """Whether tags were recorded, and not a pose."""
        return len(self.rays) > 0
