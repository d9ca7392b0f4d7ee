"""A room in MuJoCo, a base with a ring of range finders that drives in it, and what they record."""

from __future__ import annotations

import json
import math
from functools import cache
from itertools import pairwise

import mujoco
import numpy as np

from xei_lang.world.map.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

RAYS = 360
RANGE_MAX_M = 12.0
LIDAR_X, LIDAR_Z = 0.30, 0.20
"""The bench's lidar in `robot_base`, m."""

ROOM = (-2.02, -3.63, 2.03, 2.42)
WALL_M = 0.1
LEG_M = 0.06
LEGS = ((0.6, -0.6), (0.6, 0.6), (1.3, -0.6), (1.3, 0.6))
BOX = (-1.6, 0.8, -1.1, 1.4)
"""x and y of the lower and of the upper corner, m."""


def boxes() -> list[tuple[float, float, float, float]]:
    """What stands in the room, as rectangles (x0, y0, x1, y1): four walls, legs of a table, a box."""
    x0, y0, x1, y1 = ROOM
    w, h = WALL_M, LEG_M / 2
    walls = [(x0 - w, y0 - w, x1 + w, y0), (x0 - w, y1, x1 + w, y1 + w)]
    walls += [(x0 - w, y0, x0, y1), (x1, y0, x1 + w, y1)]
    return [*walls, *((x - h, y - h, x + h, y + h) for x, y in LEGS), BOX]


def _geom(x0: float, y0: float, x1: float, y1: float) -> str:
    pos, half = f"{(x0 + x1) / 2} {(y0 + y1) / 2} 0.5", f"{(x1 - x0) / 2} {(y1 - y0) / 2} 0.5"
    return f'<geom type="box" pos="{pos}" size="{half}"/>'


def model() -> mujoco.MjModel:
    geoms = "".join(_geom(*box) for box in boxes())
    sites = "".join(
        f'<site name="ray{k}" pos="{LIDAR_X} 0 {LIDAR_Z}" zaxis="{math.cos(a):.12f} {math.sin(a):.12f} 0"/>'
        for k, a in enumerate(np.linspace(-math.pi, math.pi, RAYS, endpoint=False))
    )
    sensors = "".join(f'<rangefinder site="ray{k}" cutoff="{RANGE_MAX_M}"/>' for k in range(RAYS))
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody>{geoms}<body name="base" mocap="true">'
        f'<geom type="box" size="0.37 0.31 0.1" pos="0 0 0.1" contype="0" conaffinity="0"/>{sites}'
        f"</body></worldbody><sensor>{sensors}</sensor></mujoco>"
    )


def drive(count: int) -> list[tuple[float, float, float]]:
    """Poses of the base along a loop through the room, m and rad."""
    corners = [(-1.2, 0.2), (0.0, 0.2), (0.0, 1.7), (0.0, -0.3), (-1.2, -1.5), (-1.2, -2.8), (1.2, -2.8),
               (1.2, -1.4), (-0.4, -1.4), (-1.2, 0.2)]  # fmt: skip
    legs = list(pairwise(corners))
    lengths = [math.dist(a, b) for a, b in legs]
    poses = []
    ends = np.cumsum(lengths)
    for along in np.linspace(0.0, sum(lengths), count, endpoint=False):
        index = int(np.searchsorted(ends, along, side="right"))
        (ax, ay), (bx, by) = legs[index]
        t = 1.0 - float(ends[index] - along) / lengths[index]
        poses.append((ax + t * (bx - ax), ay + t * (by - ay), math.atan2(by - ay, bx - ax)))
    return poses


@cache
def recorded(count: int, noise_m: float = 0.0, seed: int = 1) -> str:
    """The lines of a recording of `count` scans along the loop."""
    simulated, random = model(), np.random.default_rng(seed)
    data = mujoco.MjData(simulated)
    step = 2 * math.pi / RAYS
    head = {"version": 1, "recorded_on": "2026-11-20", "lidar": "base", "angle_min_rad": -math.pi,
            "angle_increment_rad": step, "range_min_m": 0.1, "range_max_m": RANGE_MAX_M}  # fmt: skip
    lines = [json.dumps(head)]
    for index, (x, y, yaw) in enumerate(drive(count)):
        data.mocap_pos[0] = (x, y, 0.0)
        data.mocap_quat[0] = (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
        mujoco.mj_forward(simulated, data)
        ranges = data.sensordata + noise_m * random.standard_normal(RAYS)
        seen = [None if raw < 0 or raw >= RANGE_MAX_M else round(float(one), 4)
                for raw, one in zip(data.sensordata, ranges, strict=True)]  # fmt: skip
        lines.append(json.dumps({"stamp_s": index / 10, "base": [x, y, yaw], "ranges_m": seen}))
    return "\n".join(lines) + "\n"


def truth(grid: OccupancyGrid) -> OccupancyGrid:
    """What the cells of a grid really are: occupied where something stands in them, free inside the room."""
    height, width = grid.shape
    cells = np.full((height, width), UNKNOWN, dtype=np.int8)
    column, row = np.meshgrid(np.arange(width), np.arange(height))
    lower = np.stack([column, row], axis=-1) * grid.resolution_m + np.array(grid.origin[:2])
    upper = lower + grid.resolution_m
    x0, y0, x1, y1 = ROOM
    inside = (upper > (x0, y0)).all(axis=-1) & (lower < (x1, y1)).all(axis=-1)
    cells[inside] = FREE
    for bx0, by0, bx1, by1 in boxes():
        hit = (upper > np.array([bx0, by0]) + 1e-9).all(axis=-1) & (lower < np.array([bx1, by1]) - 1e-9).all(
            axis=-1
        )
        cells[hit] = OCCUPIED
    return OccupancyGrid(cells, grid.resolution_m, grid.origin)
