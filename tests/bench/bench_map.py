"""A map from a drive's scans, beside a plain one in Python on the same scans; and drives planned by it.

Run by hand: `python tests/bench/bench_map.py` (1,000 scans of 360 rays; the plain one is given 50 of them,
and its time is scaled); `--small` (20 scans) only shows that it still runs. Scans are of MuJoCo's range
finders in a room of 4 x 6 m, cells are of 50 mm. CPU time of one thread.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.world.bench import bench  # noqa: E402
from tests.world.map.ranging import recorded  # noqa: E402
from xei_lang.diagnostics import Source  # noqa: E402
from xei_lang.profiles.open import robot_texts  # noqa: E402
from xei_lang.world.map.build_map import HIT, PASSED, Counted, build_map, count_rays  # noqa: E402
from xei_lang.world.map.drive import Floor, measures, plan_drive  # noqa: E402
from xei_lang.world.map.footprint import Footprint, base_footprint  # noqa: E402
from xei_lang.world.map.grid import OccupancyGrid  # noqa: E402
from xei_lang.world.map.recording import Scans, read_scans  # noqa: E402

RESOLUTION_M = 0.05
PLAIN = 50
ENDS = (
    ((-1.2, 0.2, 0.0), (-1.2, -2.5, -1.57)),
    ((0.0, -1.4, 0.0), (0.0, 1.6, 3.1)),
    ((-1.4, 1.9, 0.0), (-1.4, 0.2, 0.0)),
)
"""A free floor before the base twice, then a box in the way."""


def plain(scans: Scans, count: int) -> dict[tuple[int, int], float]:
    """Log-odds by Bresenham's line, a cell at a time: what one writes first."""
    odds: dict[tuple[int, int], float] = {}
    for index in range(count):
        x, y, yaw = scans.poses[index]
        for angle, length in zip(scans.angles_rad, scans.ranges_m[index], strict=True):
            if math.isnan(length):
                continue
            column, row = math.floor(x / RESOLUTION_M), math.floor(y / RESOLUTION_M)
            last = (
                math.floor((x + length * math.cos(angle + yaw)) / RESOLUTION_M),
                math.floor((y + length * math.sin(angle + yaw)) / RESOLUTION_M),
            )
            dx, dy = abs(last[0] - column), -abs(last[1] - row)
            sx, sy = (1 if last[0] > column else -1), (1 if last[1] > row else -1)
            error = dx + dy
            while (column, row) != last:
                odds[column, row] = odds.get((column, row), 0.0) + PASSED
                twice = 2 * error
                if twice >= dy:
                    error, column = error + dy, column + sx
                if twice <= dx:
                    error, row = error + dx, row + sy
            odds[last] = odds.get(last, 0.0) + HIT
    return odds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="20 scans instead of 1,000")
    count = 20 if parser.parse_args().small else 1000
    text = recorded(count, noise_m=0.01)
    start = time.thread_time()
    scans, said = read_scans(Source("drive.jsonl", text), bench())
    reading_s = time.thread_time() - start
    assert scans is not None, said
    start = time.thread_time()
    grid = build_map(scans, RESOLUTION_M)
    building_s = time.thread_time() - start
    few = min(PLAIN, count)
    start = time.thread_time()
    odds = plain(scans, few)
    plain_s = (time.thread_time() - start) * count / few
    assert isinstance(grid, OccupancyGrid)
    print(f"{count} scans of {scans.ranges_m.shape[1]} rays, {grid.shape[1]} x {grid.shape[0]} cells")
    print(f"read    {reading_s:7.3f} s   ({len(text) / 1e6:.1f} MB of JSON lines)")
    print(f"built   {building_s:7.3f} s")
    print(f"plain   {plain_s:7.3f} s   {plain_s / building_s:.0f} times as long ({few} scans, scaled)")
    counted = count_rays(scans, RESOLUTION_M)
    assert isinstance(counted, Counted)
    cells = np.array(sorted(odds)) - np.array(counted.corner)
    seen = (counted.hits + counted.passes)[cells[:, 1], cells[:, 0]] > 0
    print(f"cells that the plain one touches and this one, too: {100 * seen.mean():.2f} %")
    footprint = base_footprint(bench(), robot_texts(bench())[0])
    assert isinstance(footprint, Footprint)
    for ends in ENDS:
        start = time.thread_time()
        way = plan_drive(Floor(grid, footprint, 0.3, 0.65), *ends)
        drive_s = time.thread_time() - start
        length = f"{measures(way)[0]:.2f} m in {len(way)} poses" if way else "no way"
        print(f"drive   {drive_s:7.3f} s   {length}")


if __name__ == "__main__":
    main()
