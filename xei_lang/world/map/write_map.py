"""A grid as the two files of ROS map_server, and as the section of a calibration profile."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.profiles.yaml_edit import edit, plain_at
from xei_lang.profiles.yaml_reader import read_yaml
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


def section_values(frame: str, folder: str, name: str, sha256: str, measured_on: str) -> Mapping[str, str]:
    """The section of a calibration profile that names a map's files in `folder` of the profile: the value of
    each key as YAML on one line.
    """
    below = f"{folder}/" if folder else ""
    return {
        "frame": frame,
        "yaml": f"{below}{name}.yaml",
        "image": f"{below}{name}.pgm",
        "sha256": f'"{sha256}"',
        "status": "measured",
        "measured_on": f'"{measured_on}"',
    }


def profile_lines(values: Mapping[str, str]) -> str:
    """That section as it stands in the file."""
    return "".join(["map:\n", *(f"  {key}: {value}\n" for key, value in values.items())])


def put_in(source: Source, values: Mapping[str, str]) -> str | Diagnostic:
    """The text of a calibration profile with this map in its section; a map that it named before becomes the
    first of the section's history.
    """
    present = plain_at(source, ("map",))
    former = {key: present[key] for key in (*values, "measured_on") if key in present} if present else {}
    written, _ = read_yaml("values", profile_lines(values))
    if written is not None and written.find(("map",)).plain() == former:
        return source.text
    text = edit(source, ("map",), values, former if former.get("sha256") else None)
    if text is not None:
        return text
    help_ = "leave `--write` out, and copy the lines that are printed"
    message = f"the section `map` of `{source.file}` cannot be replaced for sure"
    return Diagnostic("XEI0687", message, notes=(f"`{source.file}` was left as it is",), help=(help_,))
