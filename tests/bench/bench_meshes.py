"""Meshes and point clouds of objects: reading and measuring, beside the library alone; loading a profile.

Run by hand: `python tests/bench/bench_meshes.py`; `--small` only shows that it still runs. Baselines in the
same run: trimesh reading the same bytes with no check of anything, and the small profile of the tests without
a mesh. Imports of the libraries are counted apart, in a process of their own.
"""

from __future__ import annotations

import argparse
import io
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.profiles.assets.bodies import beaker, sampled, stl  # noqa: E402
from tests.profiles.changed import changed_profile  # noqa: E402
from xei_lang.profiles.assets.fit import extent_of, without_strays  # noqa: E402
from xei_lang.profiles.assets.points import Points  # noqa: E402
from xei_lang.profiles.assets.read_cloud import read_cloud  # noqa: E402
from xei_lang.profiles.assets.read_mesh import read_mesh  # noqa: E402
from xei_lang.profiles.load import load_profile  # noqa: E402

FULL, SMALL = (500_000, 1_000_000, 5), (2_000, 2_000, 1)
CUP = "    shape: {cylinder: {diameter: 60 mm, height: 80 mm}}"
MESH = "    shape: {mesh: {file: assets/cup.stl, units: mm}}"
IMPORT = "import sys, time; t = time.process_time(); import NAME; print(time.process_time() - t)"


def stl_of(count: int) -> bytes:
    """A binary STL of so many triangles that share no vertex, the worst case for finding holes."""
    table = np.zeros(count, dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    table["v"] = np.random.default_rng(1).normal(size=(count, 3, 3))
    return bytes(79) + b"x" + struct.pack("<I", count) + table.tobytes()


def xyz_of(count: int) -> bytes:
    """A scan of a beaker with so many points, as text."""
    points = sampled(beaker(60.0, 80.0, 2.0), count, seed=2)
    return "".join(f"{x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points).encode()


def timed(name: str, work: Callable[[], object], repeats: int) -> None:
    """Print the median of the CPU time."""
    times: list[float] = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    print(f"{name:<48} {1e3 * statistics.median(times):9.1f} ms")


def lab(folder: Path, cup: str) -> Path:
    """The small profile whose cup has this shape."""
    folder.mkdir()
    made = changed_profile(folder, f"usage_profile.yaml\n- {CUP}\n+ {cup}")
    (made / "assets").mkdir()
    (made / "assets" / "cup.stl").write_bytes(stl(beaker(60.0, 80.0, 2.0)))
    return made


def import_s(name: str) -> float:
    """CPU time of an import in a process of its own."""
    command = [sys.executable, "-c", IMPORT.replace("NAME", name)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true")
    triangles, points, repeats = SMALL if parser.parse_args().small else FULL
    mesh, cloud = stl_of(triangles), xyz_of(points)
    print(f"CPU time, median of {repeats}; {triangles} triangles, {points} points")
    timed("mesh: read, checked, looked at for holes", lambda: read_mesh(mesh, "a.stl"), repeats)
    timed(
        "  trimesh alone, unchecked",
        lambda: trimesh.load_scene(io.BytesIO(mesh), file_type="stl", process=False),
        repeats,
    )
    timed("point cloud: read and checked", lambda: read_cloud(cloud, "a.xyz"), repeats)
    read = read_cloud(cloud, "a.xyz")
    assert isinstance(read, Points)
    timed(
        "  strays left out and measured",
        lambda: extent_of(without_strays(read.points), is_noisy=True),
        repeats,
    )
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        for number, (name, cup) in enumerate((("a mesh", MESH), ("no mesh", CUP))):
            place, cache = lab(folder / str(number), cup), folder / f"cache{number}"
            assert load_profile(place, cache)[0] is not None
            timed(f"profile with {name}, from its files", lambda p=place: load_profile(p, None), repeats)
            timed("  unchanged", lambda p=place, c=cache: load_profile(p, c), repeats)
    for name in ("numpy", "trimesh"):
        print(f"import {name:<41} {1e3 * import_s(name):9.1f} ms")


if __name__ == "__main__":
    main()
