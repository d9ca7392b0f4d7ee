"""Masks for queries that came without one: what the depth image shows to stand on a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.perception.optics import Array
from xei_lang.world.perception.registry import RegisteredObject
from xei_lang.world.perception.segment import assign, propose, table_points
from xei_lang.world.perception.service.backend import Shot
from xei_lang.world.transforms import lookup

CLEARANCE_M = 0.01
"""What is lower over the table counts as the table: noise of the depth, and tags and paper on it."""


def proposed_masks(shot: Shot, items: Sequence[RegisteredObject], profile: Profile) -> Shot:
    """The shot with a mask for each object that has none and that exactly one thing on the table can be."""
    open_items = [item for item in items if item.name not in shot.masks]
    state = start_state(profile)
    world = World(frame_tree(profile, state), (), state)
    table = _table_in_view(shot, profile, world) if open_items else None
    if table is None:
        return shot
    points = table_points(shot.depth_m, shot.optics, table)
    proposals = propose(shot.depth_m, points, profile.calibration.table_bounds_m, CLEARANCE_M)
    chosen = assign(proposals, [item.mesh.size_m for item in open_items])
    added = {item.name: one.mask for item, one in zip(open_items, chosen, strict=True) if one is not None}
    return replace(shot, masks={**shot.masks, **added})


def _table_in_view(shot: Shot, profile: Profile, world: World) -> Pose | None:
    """`T_table_camera` of the station's table whose top most pixels show; None where none does."""
    picture = shot.request.picture
    if picture.output_frame != "world" and world.frame(picture.output_frame) is None:
        return None
    counted: list[tuple[int, Pose]] = []
    frames = dict.fromkeys(station.ground_frame for station in profile.calibration.stations)
    thinned = shot.depth_m[::8, ::8]
    for frame in frames:
        T = lookup(world, frame, picture.output_frame).T_target_source @ picture.T_output_camera
        points = table_points(shot.depth_m, shot.optics, T)[::8, ::8]
        counted.append((_on_top(points, thinned, profile), T))
    most, T_table_camera = max(counted, key=lambda one: one[0], default=(0, None))
    return T_table_camera if most > 0 else None


def _on_top(points: Array, depth: Array, profile: Profile) -> int:
    lower, upper = (np.array(bound) for bound in profile.calibration.table_bounds_m)
    with np.errstate(invalid="ignore"):
        inside = ((points[..., :2] >= lower[:2]) & (points[..., :2] <= upper[:2])).all(axis=2)
        return int((inside & np.isfinite(depth) & (np.abs(points[..., 2]) < CLEARANCE_M)).sum())
