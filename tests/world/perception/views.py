"""Views of the bench's tags from known poses, and how far a found pose is from the truth."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Camera, Profile, Tag
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics, pose_of

ROOT = Path(__file__).parents[3]
DISTORTION = (0.12, -0.22, 0.001, -0.0008, 0.09)


@cache
def bench() -> Profile:
    profile, said = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None, said
    return profile


def camera(distortion: tuple[float, ...] = ()) -> Camera:
    return replace(bench().calibration.cameras[0], distortion=distortion)


def optics(distortion: tuple[float, ...] = ()) -> Optics:
    return Optics.of(camera(distortion))


def table_tags() -> tuple[Tag, ...]:
    """The tags of the table that the head camera can see."""
    return tuple(tag for tag in bench().calibration.apriltags.tags if tag.frame == "table" and tag.id >= 4)


def T_optical_frame(
    distance_m: float, elevation_deg: float, azimuth_deg: float, tags: tuple[Tag, ...] = ()
) -> np.ndarray:
    """The frame of the tags from a camera that looks at their middle, from so far and so high above them;
    azimuth 0 is the robot's side.
    """
    at = np.mean([tag.T_frame_tag.position_m for tag in tags or table_tags()], axis=0)
    up, around = np.radians(elevation_deg), np.radians(azimuth_deg) + np.pi
    way = np.array([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])
    x = np.cross(-way, (0.0, 0.0, 1.0))
    x /= np.linalg.norm(x)
    R = np.stack([x, np.cross(-way, x), -way])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ (at + distance_m * way)
    return T


def random_view(random: np.random.Generator) -> np.ndarray:
    """From 0.6 to 1.2 m, as a head camera may look at a bench."""
    return T_optical_frame(random.uniform(0.6, 1.2), random.uniform(35, 85), random.uniform(-45, 45))


def error_of(found: Pose, T_optical_frame: np.ndarray) -> tuple[float, float]:
    """Millimetres and degrees from the truth; `found` is in the camera's body frame."""
    apart = (T_CAMERA_OPTICAL @ pose_of(T_optical_frame)).inverse() @ found
    sine = np.linalg.norm(apart.quaternion[:3])
    return 1e3 * float(np.linalg.norm(apart.position_m)), float(np.degrees(2 * np.arcsin(min(sine, 1.0))))
