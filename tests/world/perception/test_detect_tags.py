"""Corners in rendered images against the truth, and against another detector."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.world.perception.render import Sensor, render
from tests.world.perception.second_opinion import second_detector
from tests.world.perception.views import DISTORTION, T_optical_frame, optics, table_tags
from xei_lang.world.perception.detect_tags import CORNERS, detect_tags
from xei_lang.world.perception.optics import matrix_of


def true_corners(tag, T, lens):
    flat = tag.size_m * np.hstack([CORNERS, np.zeros((4, 1))])
    M = T @ matrix_of(tag.T_frame_tag)
    return lens.project(flat @ M[:3, :3].T + M[:3, 3])[0]


@pytest.mark.parametrize("family", ["tag16h5", "tag25h9", "tag36h11"])
def test_corners_are_named_as_apriltag_publishes_its_tags(family):
    lens, tags = optics(), table_tags()
    T = T_optical_frame(0.7, 60, 20)
    image = render(tags, T, lens, family=family)
    seen = detect_tags(image, lens, family)
    with second_detector(family) as detect:
        others = detect(image)
    assert [found.id for found in seen] == [tag.id for tag in tags]
    for found, tag in zip(seen, tags, strict=True):
        assert np.abs(found.corners_px - true_corners(tag, T, lens)).max() < 0.25
        # A family with few bits is also read out of noise: of several of one id, the nearest is meant.
        apart = [np.abs(found.corners_px - one.corners_px).max() for one in others if one.id == found.id]
        assert min(apart) < 0.8


@pytest.mark.parametrize("distortion", [(), DISTORTION])
def test_corners_are_known_to_a_few_hundredths_of_a_pixel(distortion):
    lens, tags = optics(distortion), table_tags()
    errors = []
    for seed, view in enumerate([(0.6, 80, 0), (0.8, 60, 30), (1.0, 45, -30), (1.2, 50, 10)]):
        T = T_optical_frame(*view)
        seen = {found.id: found for found in detect_tags(render(tags, T, lens, seed=seed), lens, "tag36h11")}
        errors += [seen[tag.id].corners_px - true_corners(tag, T, lens) for tag in tags if tag.id in seen]
    errors = np.concatenate(errors)
    assert len(errors) >= 4 * 12
    assert np.sqrt((errors**2).sum(axis=1).mean()) < 0.1
    assert np.abs(errors.mean(axis=0)).max() < 0.05


@pytest.mark.parametrize("sensor", [Sensor(blur_px=0.0), Sensor(blur_px=1.2), Sensor(noise=12.0),
                                    Sensor(paper=120.0, ink=60.0, background=90.0)])  # fmt: skip
def test_blur_noise_and_dim_light_are_borne(sensor):
    lens, tags = optics(), table_tags()
    T = T_optical_frame(0.8, 60, 0)
    seen = detect_tags(render(tags, T, lens, sensor=sensor), lens, "tag36h11")
    assert [found.id for found in seen] == [tag.id for tag in tags]
    errors = np.concatenate(
        [found.corners_px - true_corners(tag, T, lens) for found, tag in zip(seen, tags, strict=True)]
    )
    assert np.sqrt((errors**2).sum(axis=1).mean()) < 0.25


def test_a_tag_that_is_turned_is_the_same_tag():
    lens = optics()
    (tag,) = table_tags()[:1]
    T = T_optical_frame(0.6, 60, 0, (tag,))
    for quarter in range(4):
        turned = replace(tag, T_frame_tag=tag.T_frame_tag @ quarter_turns(quarter))
        (found,) = detect_tags(render((turned,), T, lens), lens, "tag36h11")
        assert found.id == tag.id
        assert np.abs(found.corners_px - true_corners(turned, T, lens)).max() < 0.3


def test_the_same_image_gives_the_same_bytes():
    lens = optics()
    image = render(table_tags(), T_optical_frame(0.9, 55, 10), lens)
    first, second = (detect_tags(image, lens, "tag36h11") for _ in range(2))
    assert [found.corners_px.tobytes() for found in first] == [found.corners_px.tobytes() for found in second]


def quarter_turns(count):
    from xei_lang.ir.geometry import Pose

    return Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, count * np.pi / 2))
