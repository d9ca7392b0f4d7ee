"""The table from its tags in rendered images: accuracy and time, beside pupil-apriltags on the same images.

Run by hand: `python tests/bench/bench_tags.py` (200 images); `--small` (6 images) only shows that it still
runs. Images are 1280 x 720, of the bench's four tags before the head camera, from 0.6 to 1.2 m and 35 to 85
degrees above the table, with blur, noise and, for half of them, distortion. Both detectors use one thread;
the pose is the same joint one from either's corners, so that corners and their time are what is compared.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.world.perception.render import render  # noqa: E402
from tests.world.perception.second_opinion import second_detector  # noqa: E402
from tests.world.perception.views import DISTORTION, bench, error_of, optics, random_view, table_tags  # noqa: E402
from xei_lang.world.perception.detect_tags import TagDetection, detect_tags  # noqa: E402
from xei_lang.world.perception.frame_anchor import FrameAnchor, anchor_frame  # noqa: E402
from xei_lang.world.perception.image import Gray, gray_image  # noqa: E402
from xei_lang.world.perception.optics import Optics  # noqa: E402

SEED = 36
Detect = Callable[[Gray, Optics], tuple[TagDetection, ...]]


@dataclass
class Row:
    """What one detector did: errors (mm, deg) of frames that it anchored, and CPU times (ms) of all."""

    name: str
    detect: Detect
    errors: list[tuple[float, float]] = field(default_factory=list)
    times_ms: list[float] = field(default_factory=list)

    def look(self, image: Gray, lens: Optics, truth: np.ndarray) -> None:
        start = time.thread_time()
        gray = gray_image(image, lens.size_px)
        found = anchor_frame(self.detect(gray, lens), bench().calibration.apriltags, "table", lens)
        self.times_ms.append(1e3 * (time.thread_time() - start))
        if isinstance(found, FrameAnchor):
            self.errors.append(error_of(found.T_camera_frame, truth))

    def __str__(self) -> str:
        millimetres, degrees = np.array(self.errors or [(np.nan, np.nan)]).T
        return (
            f"{self.name:<16} anchored {len(self.errors):3}/{len(self.times_ms)}   position median "
            f"{np.median(millimetres):.3f} p95 {np.percentile(millimetres, 95):.3f} mm   rotation median "
            f"{np.median(degrees):.4f} p95 {np.percentile(degrees, 95):.4f} deg   time median "
            f"{np.median(self.times_ms):5.1f} p95 {np.percentile(self.times_ms, 95):5.1f} ms"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="6 images instead of 200")
    count = 6 if parser.parse_args().small else 200
    cv2.setNumThreads(1)
    random = np.random.default_rng(SEED)
    with second_detector() as pupil:
        rows = [
            Row("xei", lambda gray, lens: detect_tags(gray, lens, "tag36h11")),
            Row("pupil-apriltags", lambda gray, _: pupil(gray)),
        ]
        for index in range(count):
            lens, truth = optics(DISTORTION if index % 2 else ()), random_view(random)
            image = render(table_tags(), truth, lens, seed=index)
            for row in rows:
                row.look(image, lens, truth)
    print(f"{count} images of 1280 x 720, {len(table_tags())} tags of 50 mm, one thread, CPU time")
    print(*rows, sep="\n")


if __name__ == "__main__":
    main()
