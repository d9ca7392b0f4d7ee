"""A grid as the two files of ROS map_server, and as lines of a calibration profile."""

from __future__ import annotations

import numpy as np

from xei_lang.world.map.grid import FREE, OCCUPIED, OccupancyGrid

_BLACK, _WHITE, _GRAY = 0, 254, 205
_OCCUPIED_THRESH, _FREE_THRESH = 0.65, 0.196
"""map_server's own: with them the grey of unknown floor, 205 of 255, is not free."""


def image_bytes(grid: OccupancyGrid) -> bytes:
    """A binary PGM of 8 bits, its first row the map's farthest: black occupied, white free, grey unknown."""
    height, width = grid.shape
    shades = np.full((height, width), _GRAY, dtype=np.uint8)
    shades[grid.cells == FREE] = _WHITE
    shades[grid.cells == OCCUPIED] = _BLACK
    return f"P5\n{width} {height}\n255\n".encode() + shades[::-1].tobytes()


def yaml_text(grid: OccupancyGrid, image: str) -> str:
    """The YAML file; `image` is the image's path, seen from it."""
    x, y, yaw = (round(value, 9) + 0.0 for value in grid.origin)
    return (
        f"image: {image}\n"
        f"resolution: {grid.resolution_m}\n"
        f"origin: [{x}, {y}, {yaw}]\n"
        "negate: 0\n"
        f"occupied_thresh: {_OCCUPIED_THRESH}\n"
        f"free_thresh: {_FREE_THRESH}\n"
        "mode: trinary\n"
    )


def profile_lines(frame: str, folder: str, name: str, sha256: str, measured_on: str) -> str:
    """The section of a calibration profile that names a map's files in `folder` of the profile."""
    below = f"{folder}/" if folder else ""
    return (
        "map:\n"
        f"  frame: {frame}\n"
        f"  yaml: {below}{name}.yaml\n"
        f"  image: {below}{name}.pgm\n"
        f'  sha256: "{sha256}"\n'
        "  status: measured\n"
        f'  measured_on: "{measured_on}"\n'
    )
