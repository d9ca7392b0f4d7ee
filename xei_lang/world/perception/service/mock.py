"""The backend `mock`: the truth, read from a world, with seeded noise on it. For integration without eyes."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass

import numpy as np

from xei_lang.ir.geometry import Pose, Primitive
from xei_lang.ir.world import World
from xei_lang.world.perception.pose_request import Mode
from xei_lang.world.perception.registry import RegisteredObject, Registry
from xei_lang.world.perception.service.backend import Estimate, Shot, Unable, rows_of
from xei_lang.world.perception.silhouette import silhouette
from xei_lang.world.transforms import lookup

POSITION_STD_M = 0.0005
ROTATION_STD_RAD = math.radians(0.1)


@dataclass(frozen=True, slots=True)
class MockBackend:
    """Objects where a world has them, as far as the picture's camera would see them.

    The same request gives the same noise: it is drawn from `seed`, the request's id and the object's name.
    """

    world: World
    seed: int = 0
    position_std_m: float = POSITION_STD_M
    rotation_std_rad: float = ROTATION_STD_RAD
    name: str = "mock"
    modes: tuple[Mode, ...] = ("register", "track")
    needs_masks: bool = False

    @property
    def version(self) -> str:
        """The backend with its seed."""
        return f"mock 1 seed {self.seed}"

    def ready(self, registry: Registry) -> str | None:
        """It always is."""
        return None

    def put(self, item: RegisteredObject) -> Unable | None:
        """Nothing is to be learnt: an object that the world does not have is never found."""
        return None

    def estimate(self, shot: Shot) -> tuple[Estimate, ...] | Unable:
        """The true poses with noise; an unknown output frame cannot be answered."""
        frame = shot.request.picture.output_frame
        if frame != "world" and self.world.frame(frame) is None:
            return Unable(422, f"the frame `{frame[:60]}` is none of this lab")
        T_output_world = lookup(self.world, frame, "world").T_target_source
        return tuple(self._one(shot, query.object_id, T_output_world) for query in shot.request.queries)

    def _one(self, shot: Shot, name: str, T_output_world: Pose) -> Estimate:
        item = self.world.find(name)
        if item is None:
            return Estimate(name, "no_object")
        T_output_object = T_output_world @ self.world.T_world_object(name)
        if not _in_view(shot, item.geometry, T_output_object):
            return Estimate(name, "no_object")
        noisy = T_output_object @ self._noise(shot.request.request_id, name)
        spread = [self.position_std_m**2] * 3 + [self.rotation_std_rad**2] * 3
        covariance = tuple(tuple(float(value) for value in row) for row in np.diag(spread))
        return Estimate(name, "ok", rows_of(noisy), item.confidence, covariance)

    def _noise(self, request_id: str, name: str) -> Pose:
        digest = hashlib.sha256(f"{self.seed}\n{request_id}\n{name}".encode()).digest()
        draw = np.random.default_rng(int.from_bytes(digest[:8], "big")).normal(size=6)
        x, y, z = (float(value) for value in draw[:3] * self.position_std_m)
        roll, pitch, yaw = (float(value) for value in draw[3:] * self.rotation_std_rad)
        return Pose.from_rpy((x, y, z), (roll, pitch, yaw))


def _in_view(shot: Shot, shape: tuple[Primitive, ...], T_output_object: Pose) -> bool:
    T_camera_object = shot.request.picture.T_output_camera.inverse() @ T_output_object
    return silhouette(shape, T_camera_object, shot.optics) is not None
