"""Maps from what MuJoCo's range finders measure, held against what really stands in the room."""

from __future__ import annotations

import json
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_cdt

from tests.world.bench import bench
from tests.world.map.ranging import BOX, LEGS, drive, recorded, truth
from xei_lang.diagnostics import Source
from xei_lang.world.map.build_map import Counted, build_map, count_rays
from xei_lang.world.map.grid import FREE, OCCUPIED, OccupancyGrid
from xei_lang.world.map.recording import Scans, read_scans
from xei_lang.world.map.write_map import image_bytes

RESOLUTION_M = 0.05


def scans_of(text: str) -> Scans:
    scans, said = read_scans(Source("drive.jsonl", text), bench())
    assert scans is not None, said
    return scans


def built(text: str) -> OccupancyGrid:
    grid = build_map(scans_of(text), RESOLUTION_M)
    assert isinstance(grid, OccupancyGrid)
    return grid


def cells_to(mask: np.ndarray) -> np.ndarray:
    """How many cells (king's moves) each cell is away from the next one of the mask."""
    return distance_transform_cdt(~mask, metric="chessboard")


def test_the_map_is_the_room_to_a_cell() -> None:
    grid = built(recorded(300, noise_m=0.01))
    real = truth(grid)
    occupied, free = grid.cells == OCCUPIED, grid.cells == FREE
    taken, open_ = real.cells == OCCUPIED, real.cells == FREE
    # A lidar sees surfaces: of what is solid, the cells beside floor that it has seen.
    surface = taken & (cells_to(free & open_) == 1)
    assert cells_to(taken)[occupied].max() <= 1
    # The far side of the box is never looked at; all others are.
    far_side = grid.cells_at(np.array([[BOX[0], BOX[1]], [BOX[0] + 0.1, BOX[3]]]))
    surface[far_side[0, 0] : far_side[1, 0] + 1, far_side[0, 1] : far_side[1, 1]] = False
    assert cells_to(occupied)[surface].max() <= 1
    # No floor is called free that lies deeper than the first cell of something.
    assert cells_to(open_)[free].max() <= 1
    assert (free & open_).sum() / (free | open_).sum() > 0.98
    assert (cells_to(occupied)[surface] == 0).mean() > 0.9


def test_legs_of_a_table_and_a_box_stand_in_the_map() -> None:
    grid = built(recorded(300, noise_m=0.01))
    for leg in LEGS:
        row, column = grid.cells_at(np.array([leg]))[0]
        assert (grid.cells[row - 1 : row + 2, column - 1 : column + 2] == OCCUPIED).any(), leg
    middle = np.array([[(BOX[0] + BOX[2]) / 2, (BOX[1] + BOX[3]) / 2]])
    assert grid.values_at(grid.cells_at(middle))[0] != FREE


def test_the_same_recording_gives_the_same_bytes_in_any_order() -> None:
    text = recorded(40, noise_m=0.01)
    once = image_bytes(built(text))
    assert image_bytes(built(text)) == once
    head, *lines = text.splitlines()
    backwards = [json.dumps({**json.loads(line), "stamp_s": k}) for k, line in enumerate(reversed(lines))]
    assert image_bytes(built("\n".join([head, *backwards]))) == once


def test_a_person_who_walks_through_does_not_stay() -> None:
    """A thing that a few scans saw and the rest saw through is no wall."""
    head, *lines = recorded(60).splitlines()
    x, y, yaw = drive(60)[0]
    changed = []
    for index, line in enumerate(lines):
        scan = json.loads(line)
        scan["base"] = [x, y, yaw]
        ranges = json.loads(lines[0])["ranges_m"]
        scan["ranges_m"] = [0.8 if index < 5 and 175 <= k < 185 else one for k, one in enumerate(ranges)]
        changed.append(json.dumps(scan))
    grid = built("\n".join([head, *changed]))
    ahead = (x + (0.30 + 0.8) * math.cos(yaw), y + (0.30 + 0.8) * math.sin(yaw))
    assert grid.values_at(grid.cells_at(np.array([ahead])))[0] == FREE


@settings(max_examples=40)
@given(
    st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3.2, 3.2)),
    st.lists(st.tuples(st.floats(-3.2, 3.2), st.floats(0.05, 4.0)), min_size=1, max_size=12),
)
def test_rays_pass_the_cells_that_small_steps_along_them_pass(
    pose: tuple[float, float, float], rays: list[tuple[float, float]]
) -> None:
    angles, ranges = np.array(rays).T
    scans = Scans("2026-11-20", "base", np.array([pose]), angles, ranges[None])
    counted = count_rays(scans, RESOLUTION_M)
    assert isinstance(counted, Counted)
    hits, passed = np.zeros_like(counted.hits), np.zeros_like(counted.passes)
    for angle, length in rays:
        along = np.linspace(0.0, length, 4001)[:, None] * [
            math.cos(angle + pose[2]),
            math.sin(angle + pose[2]),
        ]
        points = (np.array(pose[:2]) + along) / RESOLUTION_M - np.array(counted.corner)
        columns, rows = np.floor(points).astype(int).T
        passed[rows, columns] = 1
        hits[rows[-1], columns[-1]] = 1
    passed[hits > 0] = 0
    # Steps of 1 mm may miss a corner that a ray cuts, and a point on a line belongs to either cell.
    assert (passed > counted.passes + counted.hits).sum() <= len(rays)
    assert ((counted.passes > 0) & (cells_to((passed + hits) > 0) > 1)).sum() == 0
    assert (counted.hits != hits).sum() <= 2 * len(rays) * (np.abs(ranges % RESOLUTION_M) < 1e-9).any()
