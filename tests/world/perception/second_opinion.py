"""Tags as pupil-apriltags sees them, with corners in our order and our pixels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pupil_apriltags

from xei_lang.world.perception.detect_tags import TagDetection


@contextmanager
def second_detector(family: str = "tag36h11") -> Iterator[Callable[[np.ndarray], tuple[TagDetection, ...]]]:
    """A detector of one thread at full resolution."""
    detector = pupil_apriltags.Detector(families=family, nthreads=1, quad_decimate=1.0, refine_edges=True)

    def detect(gray: np.ndarray) -> tuple[TagDetection, ...]:
        found = sorted(detector.detect(gray), key=lambda one: one.tag_id)
        # Theirs go counter-clockwise from the bottom left corner, with pixels counted from their corner.
        return tuple(TagDetection(one.tag_id, one.corners[::-1] - 0.5) for one in found)

    try:
        yield detect
    finally:
        # Its destructor frees the families before the detector that still reads them, which now and then ends
        # the process (pupil-labs/apriltags issues 34 and 46). Without a pointer it frees nothing.
        detector.tag_detector_ptr = None
