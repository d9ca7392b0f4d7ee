"""Masks cut out of depth: of what MuJoCo renders, each thing by itself, and none that is a guess."""

from __future__ import annotations

import numpy as np
import pytest

from tests.world.perception.pictures import rendered
from xei_lang.world.perception.optics import Optics
from xei_lang.world.perception.pictures import colour_image, depth_image
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.segment import assign, propose, table_points
from xei_lang.world.perception.service.backend import Shot
from xei_lang.world.perception.service.masks import proposed_masks
from xei_lang.world.perception.silhouette import silhouette

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")


def shot(*names: str, depth=None) -> Shot:
    scene = rendered()
    request = scene.request(*names)
    optics = Optics.of_intrinsics(scene.picture.intrinsics)
    image = colour_image(scene.picture.rgb_png, optics.size_px)
    given = depth_image(scene.picture.depth_png16, optics.size_px, scene.picture.depth_scale_m)
    assert not isinstance(image, str) and not isinstance(given, str)
    return Shot(request, optics, image, given if depth is None else depth, {})


def proposed(*names: str, depth=None):
    registry = registry_of(rendered().lab)
    items = [registry.find(name) for name in names]
    return proposed_masks(shot(*names, depth=depth), items, rendered().lab).masks


def drawn(name: str) -> np.ndarray:
    """Where the object is seen, by its silhouette and what stands before it."""
    scene, taken = rendered(), shot(name)
    T = scene.picture.T_output_camera.inverse() @ scene.truth.T_world_object(name)
    seen = silhouette(scene.lab.object(name).geometry, T, taken.optics)
    rows, columns = seen.pixels.T
    shown = np.abs(taken.depth_m[rows, columns] - seen.depths_m) < 0.005
    mask = np.zeros(taken.depth_m.shape, dtype=bool)
    for down in range(seen.step):
        for right in range(seen.step):
            mask[rows[shown] + down, columns[shown] + right] = True
    return mask


def overlap(a: np.ndarray, b: np.ndarray) -> float:
    return float((a & b).sum() / (a | b).sum())


@pytest.mark.parametrize("name", ["wipe_1", "heater_block"])
def test_what_stands_free_is_cut_out_by_its_size(name):
    masks = proposed(name)
    assert list(masks) == [name]
    assert overlap(masks[name], drawn(name)) > 0.85


def test_two_of_one_size_are_not_told_apart():
    assert proposed("rack_1", "rack_2") == {}
    # A beaker that is in the picture too is about as large as the bottle.
    assert proposed("bottle_1") == {}


def test_what_is_not_there_gets_no_mask():
    assert proposed("table_b") == {}


def test_the_bare_table_and_no_depth_at_all_propose_nothing():
    flat = shot("bottle_1").depth_m.copy()
    T = rendered().picture.T_output_camera
    lab = rendered().lab
    taken = shot("bottle_1")
    table = rendered().truth.T_world_frame("table").inverse() @ T
    points = table_points(flat, taken.optics, table)
    bare = np.where(np.abs(points[..., 2]) < 0.005, flat, np.nan)
    assert propose(bare, table_points(bare, taken.optics, table), lab.calibration.table_bounds_m, 0.01) == ()
    assert proposed("bottle_1", depth=np.full(flat.shape, np.nan)) == {}


def test_sizes_decide_only_where_they_are_sure():
    taken = shot("bottle_1")
    table = rendered().truth.T_world_frame("table").inverse() @ rendered().picture.T_output_camera
    points = table_points(taken.depth_m, taken.optics, table)
    found = propose(taken.depth_m, points, rendered().lab.calibration.table_bounds_m, 0.01)
    wipe, block = (0.070, 0.060, 0.030), (0.130, 0.090, 0.085)
    assert [one is not None for one in assign(found, [wipe, block])] == [True, True]
    assert assign(found, [wipe, wipe, block])[:2] == (None, None)
    assert assign(found, [(0.5, 0.5, 0.5)]) == (None,)
    assert assign((), [wipe]) == (None,)
    assert assign(found, []) == ()
    sizes = [int(one.mask.sum()) for one in found]
    assert sizes == sorted(sizes, reverse=True)
