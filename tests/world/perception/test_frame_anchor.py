"""The table from its tags: how well it is found, and when it is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.world.perception.render import render
from tests.world.perception.views import (
    DISTORTION,
    T_optical_frame,
    bench,
    camera,
    error_of,
    optics,
    random_view,
    table_tags,
)
from xei_lang.profiles.model import TagLayout
from xei_lang.world.perception.detect_tags import TagDetection, detect_tags
from xei_lang.world.perception.frame_anchor import FrameAnchor, anchor_frame
from xei_lang.world.perception.look import Sighting, look, verify
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, pose_of
from xei_lang.world.perception.refusal import Refused


def layout() -> TagLayout:
    return bench().calibration.apriltags


def seen_from(T, *, tags=None, told=None, distortion=(), seed=0):
    """What is made of an image of `tags` by one who believes in the layout `told`."""
    lens = optics(distortion)
    image = render(tags or table_tags(), T, lens, seed=seed)
    return anchor_frame(detect_tags(image, lens, "tag36h11"), told or layout(), "table", lens)


@pytest.mark.parametrize("distortion", [(), DISTORTION])
def test_the_table_is_found_to_half_a_millimetre_and_a_tenth_of_a_degree(distortion):
    random = np.random.default_rng(4)
    errors, squares = [], []
    for seed in range(20):
        T = random_view(random)
        found = seen_from(T, distortion=distortion, seed=seed)
        assert isinstance(found, FrameAnchor), found
        errors.append(error_of(found.T_camera_frame, T))
        apart = (T_CAMERA_OPTICAL @ pose_of(T)).inverse() @ found.T_camera_frame
        motion = np.concatenate([apart.position_m, 2 * np.array(apart.quaternion[:3])])
        squares.append(motion @ np.linalg.solve(found.covariance, motion))
    millimetres, degrees = np.percentile(errors, 95, axis=0)
    assert millimetres < 0.5
    assert degrees < 0.1
    # The covariance is no boast: the squared error in its measure stays about the 6 that it should be.
    assert 0.5 < np.mean(squares) < 9.0


def test_one_tag_is_too_few():
    found = seen_from(T_optical_frame(0.7, 50, 0), tags=table_tags()[:1])
    assert isinstance(found, Refused)
    assert (found.reason, found.tag_ids) == ("too_few_tags", (4,))


@pytest.mark.parametrize("distance_m", [0.7, 1.2])
@pytest.mark.parametrize("elevation_deg", [75, 80, 84, 88])
def test_one_tag_is_never_anchored_with_the_wrong_tilt(distance_m, elevation_deg):
    (tag,) = told_tags = table_tags()[:1]
    told = replace(layout(), minimum_tags=1)
    T = T_optical_frame(distance_m, elevation_deg, 0, told_tags)
    for seed in range(3):
        found = seen_from(T, tags=(tag,), told=told, seed=seed)
        if isinstance(found, Refused):
            assert found.reason == "ambiguous"
        else:
            assert error_of(found.T_camera_frame, T)[1] < 3.0
    if distance_m > 1.0:
        assert isinstance(found, Refused)


def test_tags_printed_smaller_are_noticed():
    small = tuple(replace(tag, size_m=0.9 * tag.size_m) for tag in table_tags())
    found = seen_from(T_optical_frame(0.9, 55, 10), tags=small)
    assert isinstance(found, Refused)
    assert found.reason == "wrong_tag_size"
    assert "50 mm is 45.0 mm" in found.message


def test_a_tag_that_was_moved_is_noticed_and_named():
    first, *others = table_tags()
    x, y, z = first.T_frame_tag.position_m
    moved = replace(first, T_frame_tag=replace(first.T_frame_tag, position_m=(x, y + 0.01, z)))
    found = seen_from(T_optical_frame(0.9, 55, 10), tags=(moved, *others))
    assert isinstance(found, Refused)
    assert found.reason == "residual"


def test_a_tag_twice_is_refused():
    first, *others = table_tags()
    copy = replace(others[0], id=first.id)
    found = seen_from(T_optical_frame(0.9, 55, 10), tags=(first, copy, *others[1:]))
    assert isinstance(found, Refused)
    assert (found.reason, found.tag_ids) == ("duplicate_tags", (first.id,))


def test_foreign_tags_are_left_aside_and_named_where_there_are_no_others():
    first, second, *others = table_tags()
    T = T_optical_frame(0.9, 55, 10)
    foreign = replace(first, id=200)
    assert isinstance(seen_from(T, tags=(foreign, second, *others)), FrameAnchor)
    found = seen_from(T, tags=(foreign,))
    assert isinstance(found, Refused)
    assert (found.reason, found.tag_ids) == ("unknown_tags", (200,))


def test_a_mirrored_image_is_called_so():
    image = render(table_tags(), T_optical_frame(0.9, 55, 10), optics())
    found = look(image[:, ::-1], layout(), camera(), "table")
    assert isinstance(found, Refused)
    assert found.reason == "mirrored"


@pytest.mark.parametrize(
    ("image", "reason"),
    [
        (np.zeros((720, 1280), np.uint8), "no_contrast"),
        (np.full((720, 1280, 3), 255, np.uint8), "no_contrast"),
        (np.zeros((480, 640), np.uint8), "wrong_size"),
        (np.zeros((0, 0), np.uint8), "no_image"),
        (np.zeros((720, 1280, 2), np.uint8), "no_image"),
        (np.full((720, 1280), np.nan), "no_image"),
        (np.full((720, 1280), 7.0), "no_image"),
        (np.zeros((720, 1280), np.complex128), "no_image"),
    ],
)
def test_an_image_of_no_use_is_refused(image, reason):
    found = look(image, layout(), camera(), "table")
    assert isinstance(found, Refused)
    assert found.reason == reason


def test_an_image_too_small_for_any_tag_is_refused():
    tiny = replace(camera(), width=16, height=12)
    found = look(np.zeros((12, 16), np.uint8), layout(), tiny, "table")
    assert isinstance(found, Refused)
    assert found.reason == "no_image"


def test_noise_alone_shows_no_tag():
    image = np.random.default_rng(0).integers(0, 256, (720, 1280), dtype=np.uint8)
    found = look(image, layout(), camera(), "table")
    assert isinstance(found, Sighting)
    assert found.detections == ()
    assert [one.reason for _, one in found.frames if isinstance(one, Refused)] == ["no_tags"]


def test_sixteen_bits_colour_and_floats_say_the_same():
    image = render(table_tags(), T_optical_frame(0.9, 55, 10), optics())
    forms = (image, image.astype(np.uint16) * 256, np.repeat(image[:, :, None], 3, axis=2), image / 255.0)
    found = [look(form, layout(), camera(), "table") for form in forms]
    corners = [[tag.corners_px.tobytes() for tag in one.detections] for one in found]
    assert corners[0]
    assert all(one == corners[0] for one in corners)


def test_any_corners_give_an_answer_and_no_exception():
    random = np.random.default_rng(8)
    lens = optics()
    ids = [tag.id for tag in table_tags()]
    for _ in range(60):
        chosen = random.choice(ids, random.integers(1, 5), replace=False)
        corners = random.uniform(-50, 1300, (len(chosen), 4, 2))
        if random.random() < 0.3:
            corners[:] = corners[:, :1]
        detections = [TagDetection(int(k), place) for k, place in zip(sorted(chosen), corners, strict=True)]
        found = anchor_frame(detections, layout(), "table", lens)
        assert isinstance(found, Refused)


def test_the_head_camera_sees_its_tables_from_their_stations():
    for frame in ("table", "table_b"):
        tags = tuple(tag for tag in layout().tags if tag.frame == frame)
        nominal = FrameAnchor(frame, pose_of(np.eye(4)), (), (), 0.0, np.eye(6), 1.0)
        verified = verify(bench(), camera(), nominal)
        assert verified is not None
        # With the camera's pose taken for the frame's, what is found is the camera in the base.
        T_optical = (
            T_CAMERA_OPTICAL.inverse() @ verified.T_base_frame.inverse() @ verified.expected_T_base_frame
        )
        T = np.array(T_optical.matrix())
        found = look(render(tags, T, optics()), layout(), camera(), frame)
        assert isinstance(found, Sighting)
        ((name, anchor),) = found.frames
        assert name == frame
        assert isinstance(anchor, FrameAnchor), anchor
        assert len(anchor.tag_ids) >= 3
        again = verify(bench(), camera(), anchor)
        assert again is not None
        assert again.deviation.within
        assert again.deviation.position_m < 1e-3
