"""Recordings whose answer is known: a camera, a board, random motions, and noise."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from xei_lang.world.calibration.sample import Sample
from xei_lang.world.perception.joint_pose import joint_pose
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics, matrix_of


def pose(position, rotvec) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rotvec).as_matrix()
    T[:3, 3] = position
    return T


def random_pose(random: np.random.Generator, reach_m: float = 1.0) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.random(rng=random).as_matrix()
    T[:3, 3] = random.uniform(-reach_m, reach_m, 3)
    return T


def samples_of(
    seed: int,
    count: int,
    *,
    position_m: float = 0.0,
    rotation_rad: float = 0.0,
    turn_rad: float = 0.6,
    axes: int = 3,
) -> tuple[np.ndarray, np.ndarray, list[Sample]]:
    """X, Z and samples of `A X B = Z` whose A turns by `turn_rad` about so many axes; B carries the noise."""
    random = np.random.default_rng(seed)
    X, Z = random_pose(random, 0.3), random_pose(random, 0.8)
    about = np.diag([1.0, 1.0 if axes > 1 else 0.0, 1.0 if axes > 2 else 0.0])
    samples = []
    for number in range(1, count + 1):
        A = pose(random.uniform(-0.4, 0.4, 3), about @ random.normal(0.0, turn_rad, 3))
        B = np.linalg.inv(A @ X) @ Z
        B = pose(B[:3, 3] + random.normal(0.0, position_m, 3), np.zeros(3)) @ pose(
            np.zeros(3), Rotation.from_matrix(B[:3, :3]).as_rotvec()
        )
        B = B @ pose(np.zeros(3), random.normal(0.0, rotation_rad, 3))
        samples.append(Sample(number, A, B, np.empty((0, 3)), np.empty((0, 2))))
    return X, Z, samples


def apart(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """The small motion (6,) on the right of the truth that gives what was found."""
    E = np.linalg.inv(truth) @ found
    return np.concatenate([E[:3, 3], Rotation.from_matrix(E[:3, :3]).as_rotvec()])


BOARD = np.array(
    [
        [x + dx, y + dy, z]
        for x, y, z in ((0.0, 0.0, 0.0), (0.06, 0.0, 0.0), (0.0, 0.06, 0.02))
        for dx, dy in ((-0.02, 0.02), (0.02, 0.02), (0.02, -0.02), (-0.02, -0.02))
    ]
)
"""Corners of three tags of 40 mm on a board that is not flat, so that poses have no second solution."""


def seen_samples(
    seed: int, count: int, *, noise_px: float, focal_px: float = 920.0, eye_in_hand: bool = True
) -> tuple[np.ndarray, np.ndarray, list[Sample]]:
    """X, Z and samples in which a camera sees a board half a metre ahead, with noise on its corners.

    `eye_in_hand` has the board stand still and the hand carry the camera; else the hand carries the board.
    """
    random = np.random.default_rng(seed)
    optical = matrix_of(T_CAMERA_OPTICAL)
    X = pose(random.uniform(-0.1, 0.1, 3), random.uniform(-1, 1, 3))
    Z = pose(random.uniform(-0.1, 0.1, 3), random.uniform(-1, 1, 3))
    if not eye_in_hand:
        X[:3, 3] += (0.5, 0.2, 1.0)
    ahead, facing = np.array([0.0, 0.0, 0.5]), np.array([np.pi, 0.0, 0.0])
    samples = []
    for number in range(1, count + 1):
        # The board faces the camera, more or less, so that A follows from what is to be seen.
        B = pose(random.uniform(-0.08, 0.08, 3) + ahead, random.normal(0, 0.35, 3) + facing)
        A = Z @ np.linalg.inv(X @ optical @ B)
        points = BOARD @ B[:3, :3].T + B[:3, 3]
        rays = points[:, :2] / points[:, 2:] + random.normal(0.0, noise_px, (len(BOARD), 2)) / focal_px
        if noise_px:
            lens = Optics(np.eye(3), np.zeros(5), (1, 1))
            found = joint_pose(BOARD, rays, lens)
            assert found is not None
            B = found.T_optical_frame
        samples.append(Sample(number, A, optical @ B, BOARD, rays))
    return X, Z, samples
