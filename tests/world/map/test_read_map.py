"""Maps of ROS map_server: what they say, and what is wrong with those that cannot be read."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.world.map.lab import room
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.world.map.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from xei_lang.world.map.read_map import read_grid, read_meta
from xei_lang.world.map.write_map import image_bytes, yaml_text

YAML = yaml_text(room(), "lab.pgm")


def read(yaml: str, image: bytes) -> OccupancyGrid | Diagnostics:
    source = Source("lab.yaml", yaml)
    meta, said = read_meta(source)
    if meta is None:
        return said
    found = read_grid(meta, source, "lab.pgm", image)
    return found if isinstance(found, OccupancyGrid) else (found,)


def grid_of(yaml: str, image: bytes) -> OccupancyGrid:
    found = read(yaml, image)
    assert isinstance(found, OccupancyGrid), found
    return found


def messages(yaml: str, image: bytes) -> str:
    found = read(yaml, image)
    assert not isinstance(found, OccupancyGrid)
    assert {one.code for one in found} == {"XEI0665"}
    return "\n".join(one.message for one in found)


def png(pixels: np.ndarray, mode: str | None = None) -> bytes:
    written = io.BytesIO()
    image = Image.fromarray(pixels)
    (image.convert(mode) if mode else image).save(written, "PNG")
    return written.getvalue()


@given(st.integers(1, 9), st.integers(1, 9), st.randoms(use_true_random=False))
def test_what_is_written_reads_back(height: int, width: int, random) -> None:
    cells = np.array(
        [[random.choice((FREE, OCCUPIED, UNKNOWN)) for _ in range(width)] for _ in range(height)]
    )
    grid = OccupancyGrid(cells.astype(np.int8), 0.05, (-1.25, 3.5, 0.25))
    again = grid_of(yaml_text(grid, "lab.pgm"), image_bytes(grid))
    assert np.array_equal(again.cells, grid.cells)
    assert (again.resolution_m, again.origin) == (grid.resolution_m, grid.origin)


@given(
    st.tuples(st.floats(-50, 50), st.floats(-50, 50), st.floats(-math.pi, math.pi)),
    st.tuples(st.floats(-60, 60), st.floats(-60, 60)),
    st.sampled_from([0.01, 0.05, 0.5]),
)
def test_a_point_lies_within_half_a_cell_of_the_centre_of_its_cell(origin, point, resolution_m) -> None:
    grid = OccupancyGrid(np.zeros((3, 4), dtype=np.int8), resolution_m, origin)
    cell = grid.cells_at(np.array([point]))
    center = grid.centers_of(cell)
    away = grid.to_grid(center) - grid.to_grid(np.array([point]))
    assert np.abs(away).max() <= resolution_m / 2 + 1e-9
    assert np.array_equal(grid.cells_at(center), cell)
    assert np.allclose(grid.to_map(grid.to_grid(np.array([point]))), [point], atol=1e-9)


def test_the_origin_is_the_lower_left_corner_and_its_yaw_turns_the_grid() -> None:
    pixels = np.full((2, 3), 254, dtype=np.uint8)
    pixels[0, 2] = 0  # the upper right pixel
    turned = YAML.replace("[-1.5, -3.5, 0.0]", "[1.0, 2.0, 1.5707963267948966]").replace("0.05", "1.0")
    grid = grid_of(turned, png(pixels))
    assert grid.cells[1, 2] == OCCUPIED and grid.count(OCCUPIED) == 1
    # Columns go along the map's y, rows along its -x.
    assert grid.centers_of(np.array([[1, 2]]))[0] == pytest.approx([1.0 - 1.5, 2.0 + 2.5])


@pytest.mark.parametrize(
    ("mode", "negate", "values"),
    [
        ("trinary", 0, [OCCUPIED, UNKNOWN, UNKNOWN, FREE]),
        ("trinary", 1, [FREE, UNKNOWN, OCCUPIED, OCCUPIED]),
        ("scale", 0, [OCCUPIED, 81, 0, FREE]),
        ("raw", 0, [0, 100, UNKNOWN, UNKNOWN]),
    ],
)
def test_modes_and_negation_are_those_of_map_server(mode: str, negate: int, values: list[int]) -> None:
    yaml = YAML.replace("trinary", mode).replace("negate: 0", f"negate: {negate}")
    pixels = np.array([[0, 111 if mode == "scale" else 100, 205, 255]], dtype=np.uint8)
    expected = [OCCUPIED, round((144 / 255 - 0.196) / 0.454 * 100), 0, FREE] if mode == "scale" else values
    assert grid_of(yaml, png(pixels)).cells[0].tolist() == expected


@pytest.mark.parametrize("mode", ["1", "L", "RGB", "RGBA", "LA", "P", "I;16"])
def test_all_kinds_of_grey_are_read(mode: str) -> None:
    pixels = np.array([[0, 255], [255, 0]], dtype=np.uint8)
    image = png(pixels.astype(np.uint16) * 257) if mode == "I;16" else png(pixels, mode)
    assert grid_of(YAML, image).cells.tolist() == [[FREE, OCCUPIED], [OCCUPIED, FREE]]


def test_what_is_transparent_is_unknown() -> None:
    pixels = np.full((1, 2, 4), 255, dtype=np.uint8)
    pixels[0, 1, 3] = 0
    assert grid_of(YAML, png(pixels)).cells.tolist() == [[FREE, UNKNOWN]]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("resolution: 0.05\n", "", "no `resolution`"),
        ("resolution: 0.05", "resolution: 0", "`resolution`"),
        ("resolution: 0.05", "resolution: -0.05", "`resolution`"),
        ("resolution: 0.05", "resolution: 50 mm", "`resolution`"),
        ("origin: [-1.5, -3.5, 0.0]", "origin: [-1.5, -3.5]", "`origin`"),
        ("origin: [-1.5, -3.5, 0.0]", "origin: [-1.5, -3.5, 90.0]", "more than a turn"),
        ("origin: [-1.5, -3.5, 0.0]", "origin: [-1.5e9, -3.5, 0.0]", "100 km"),
        ("origin: [-1.5, -3.5, 0.0]", "origin: [.nan, 0, 0]", "number"),
        ("free_thresh: 0.196", "free_thresh: 0.7", "not below `occupied_thresh`"),
        ("occupied_thresh: 0.65", "occupied_thresh: 65", "`occupied_thresh`"),
        ("negate: 0", "negate: 2", "`negate`"),
        ("negate: 0", "negate: no", "truth value"),
        ("mode: trinary", "mode: binary", "`mode`"),
        ("mode: trinary", "mode: trinary\nmode: raw", "stands twice"),
        ("mode: trinary", "mood: trinary", "`mood` is not a key"),
        ("image: lab.pgm", "image: *lab", "alias"),
        (YAML, "", "is empty"),
        (YAML, "[1, 2", "not valid YAML"),
    ],
)
def test_a_yaml_file_that_is_none_of_a_map_is_told(old: str, new: str, message: str) -> None:
    assert old in YAML
    assert message in messages(YAML.replace(old, new), image_bytes(room()))


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (b"", "neither PGM nor PNG"),
        (b"P5\n3 3\n255\n\x00", "no image of a map"),
        (b"P5\n-3 3\n255\n\x00", "no image of a map"),
        (b"P5\n0 0\n255\n", "no image of a map"),
        (b"P5\n7000 7000\n255\n", "more than 40 million"),
        (b"P5\n100000 100000\n255\n", "more than 40 million"),
        (b"GIF89a" + bytes(40), "neither PGM nor PNG"),
        (image_bytes(room())[:-50], "no image of a map"),
        (png(np.zeros((9, 9), np.uint8))[:40], "no image of a map"),
    ],
)
def test_an_image_that_is_none_of_a_map_is_told(image: bytes, message: str) -> None:
    assert message in messages(YAML, image)


def test_a_map_larger_than_any_room_is_told_by_its_resolution() -> None:
    yaml = YAML.replace("resolution: 0.05", "resolution: 5.0")
    assert "no room" in messages(yaml, png(np.zeros((1, 600), np.uint8)))
