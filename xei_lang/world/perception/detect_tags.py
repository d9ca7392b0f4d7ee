"""AprilTags in an image: ids and corners, by OpenCV's detector with corners of our own.

OpenCV stores each family turned by half a turn against AprilTag's published images, and its corners are those
of its picture. Here corners are named on the tag as AprilTag publishes it.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from xei_lang.world.perception.edges import refine_corners
from xei_lang.world.perception.image import Gray
from xei_lang.world.perception.optics import Array, Optics

_DICTIONARIES = {
    "tag16h5": (cv2.aruco.DICT_APRILTAG_16h5, 6),
    "tag25h9": (cv2.aruco.DICT_APRILTAG_25h9, 7),
    "tag36h11": (cv2.aruco.DICT_APRILTAG_36h11, 8),
}
"""OpenCV's dictionary of each family, and how many modules wide its black square is."""

CORNERS = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
"""Corners of a tag of size 1 in its own frame (x right, y up), in the order of `TagDetection.corners_px`."""


@dataclass(frozen=True, slots=True, eq=False)
class TagDetection:
    """A tag that was seen: `corners_px` (4, 2) are its top left, top right, bottom right and bottom left
    corner, as one sees it upright.
    """

    id: int
    corners_px: Array


def detect_tags(gray: Gray, optics: Optics, family: str) -> tuple[TagDetection, ...]:
    """All tags of a family, sorted by id and then by place; without any, an empty tuple.

    An id may come twice: what that means is for the caller to say. KeyError for a family that is unknown.
    """
    dictionary, modules = _DICTIONARIES[family]
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(dictionary), _parameters())
    found, ids, _ = detector.detectMarkers(gray)
    if len(found) == 0:
        return ()
    rough = np.array(found, dtype=np.float64).reshape(-1, 4, 2)
    numbers = np.asarray(ids).reshape(-1)
    order = np.lexsort((rough[:, 0, 1], rough[:, 0, 0], numbers))
    corners = refine_corners(gray, rough[order], optics, modules)
    upright = np.roll(corners, 2, axis=1)
    return tuple(
        TagDetection(int(number), place) for number, place in zip(numbers[order], upright, strict=True)
    )


def _parameters() -> cv2.aruco.DetectorParameters:
    parameters = cv2.aruco.DetectorParameters()
    # Two window sizes find the quads that more of them would; each costs a threshold of the whole image.
    parameters.adaptiveThreshWinSizeMin = 5
    parameters.adaptiveThreshWinSizeMax = 21
    parameters.adaptiveThreshWinSizeStep = 16
    parameters.minMarkerPerimeterRate = 0.03
    # A code must be read nearly without error: a wrong id puts the table somewhere else.
    parameters.errorCorrectionRate = 0.3
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_NONE
    return parameters
