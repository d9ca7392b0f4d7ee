"""Maps of a lab with the bench's two stations, and copies of the bench's profile that have one."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from tests.world.bench import BENCH
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.map_files import map_sha256
from xei_lang.profiles.model import Profile
from xei_lang.world.map.grid import FREE, OCCUPIED, OccupancyGrid
from xei_lang.world.map.write_map import image_bytes, yaml_text

RESOLUTION_M = 0.05
NONE = "  yaml: null\n  image: null\n  sha256: null\n  status: placeholder\n"


def room(lower=(-1.5, -3.5), upper=(1.5, 1.5)) -> OccupancyGrid:
    """A room of free floor with walls of two cells about it. Its corners are in the map's frame, m."""
    width, height = (round((upper[k] - lower[k]) / RESOLUTION_M) for k in (0, 1))
    cells = np.full((height, width), FREE, dtype=np.int8)
    cells[:2], cells[-2:], cells[:, :2], cells[:, -2:] = (OCCUPIED,) * 4
    return OccupancyGrid(cells, RESOLUTION_M, (*lower, 0.0))


def with_box(
    grid: OccupancyGrid, x: tuple[float, float], y: tuple[float, float], value=OCCUPIED
) -> OccupancyGrid:
    """The same with an upright box that spans these coordinates of the map's frame, m."""
    cells = grid.cells.copy()
    (r0, c0), (r1, c1) = grid.cells_at(np.array([[x[0], y[0]], [x[1], y[1]]]) + 1e-6)
    cells[r0:r1, c0:c1] = value
    return OccupancyGrid(cells, grid.resolution_m, grid.origin)


def mapped_lab(folder: Path, grid: OccupancyGrid) -> Path:
    """A copy of the bench's profile whose map this is."""
    lab = Path(shutil.copytree(BENCH, folder / "lab"))
    (lab / "map").mkdir()
    yaml, image = yaml_text(grid, "lab.pgm").encode(), image_bytes(grid)
    (lab / "map" / "lab.yaml").write_bytes(yaml)
    (lab / "map" / "lab.pgm").write_bytes(image)
    calibration = lab / "calibration_profile.yaml"
    text = calibration.read_text(encoding="utf-8")
    assert NONE in text
    stated = (
        f"  yaml: map/lab.yaml\n  image: map/lab.pgm\n  sha256: {map_sha256(yaml, image)}\n"
        '  status: measured\n  measured_on: "2026-11-20"\n'
    )
    calibration.write_text(text.replace(NONE, stated), encoding="utf-8")
    return lab


def loaded(folder: Path) -> Profile:
    profile, said = load_profile(folder, None)
    assert profile is not None, said
    return profile
