"""Grounding from a scene file: 100 objects read, validated and merged, beside reading the YAML alone.

Run by hand: `python tests/bench/bench_ground.py`; `--small` only shows that it still runs. The bench's racks
are multiplied, with their tubes, each thing is seen a little off, and the file is what a recording would be.
Baselines in the same run: PyYAML's own loaders on the same text, with no places, no
model, no units and no world.
"""

from __future__ import annotations

import argparse
import dataclasses
import gc
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from xei_lang.diagnostics import Source, has_errors  # noqa: E402
from xei_lang.ir.geometry import Pose  # noqa: E402
from xei_lang.profiles.load import load_profile  # noqa: E402
from xei_lang.profiles.model import LabObject, Profile  # noqa: E402
from xei_lang.world.ground import ground  # noqa: E402
from xei_lang.world.sources.scene_file import SceneFileSource  # noqa: E402
from xei_lang.world.sources.scene_text import scene_text  # noqa: E402

FULL, SMALL = 100, 20


def lab_of(count: int) -> Profile:
    """The bench with so many objects: further racks, full of tubes, in rows behind each other."""
    profile, found = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None, found
    system = [item for item in profile.objects if item.system]
    rack, tube = profile.object("rack_1"), profile.object("tube_1")
    assert rack is not None
    assert tube is not None
    objects: list[LabObject] = []
    while len(objects) + len(system) < count:
        number = len(objects) // 13
        spread = Pose((0.15 + 0.3 * (number // 4), -0.4 + 0.27 * (number % 4), 0.0))
        objects.append(_named(rack, f"rack_{number}x", "", "", spread))
        keys = [f"{row}{column}" for row in "ABC" for column in range(1, 5)]
        objects += [
            _named(tube, f"tube_{number}x{key.lower()}", f"rack_{number}x", key, Pose()) for key in keys
        ]
    kept = sorted([*system, *objects[: count - len(system)]], key=lambda item: item.name)
    wide = dataclasses.replace(profile.calibration, workspace_bounds_m=((-9.0, -9.0, -9.0), (9.0, 9.0, 9.0)))
    return dataclasses.replace(profile, objects=tuple(kept), calibration=wide)


def _named(item: LabObject, name: str, holder: str, key: str, pose: Pose) -> LabObject:
    assert item.prior is not None
    kind = "slot" if key else ""
    prior = dataclasses.replace(
        item.prior,
        in_object=holder,
        in_key=key,
        in_kind=kind,
        frame="" if key else "table",
        T_frame_object=pose,
    )
    return dataclasses.replace(item, name=name, aliases=(), prior=prior)


def timed_ms(work: Callable[[], object], repeats: int) -> tuple[float, float]:
    """Median and 95th percentile of CPU time."""
    times: list[float] = []
    for _ in range(repeats):
        start = time.thread_time()
        work()
        times.append(1e3 * (time.thread_time() - start))
    times.sort()
    return statistics.median(times), times[min(len(times) - 1, int(0.95 * len(times)))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true")
    small = parser.parse_args().small
    count, repeats = (SMALL, 3) if small else (FULL, 50)
    gc.set_threshold(200_000)  # as the program has it
    profile = lab_of(count)
    believed, _ = ground(profile)
    assert believed is not None
    text = scene_text(believed, profile).replace(", 0.0 m]", ", 0.002 m]")
    source = SceneFileSource(Source("scene.yaml", text))

    def read_and_ground() -> None:
        observed, said = source.observe(profile)
        assert observed is not None, said
        world, found = ground(profile, (observed,))
        assert world is not None, found
        assert not has_errors(found)

    observed, _ = source.observe(profile)
    assert observed is not None
    seen = (observed,)
    rows = [
        ("scene file to world", read_and_ground),
        ("  of it reading and validating", lambda: source.observe(profile)),
        ("  of it merging and settling", lambda: ground(profile, seen)),
        ("priors alone", lambda: ground(profile)),
        ("yaml.load with CSafeLoader", lambda: yaml.load(text, Loader=yaml.CSafeLoader)),
        ("yaml.safe_load", lambda: yaml.safe_load(text)),
    ]
    print(f"{count} objects, {len(text)} characters, CPU time of one thread, {repeats} runs")
    for name, work in rows:
        median, p95 = timed_ms(work, repeats)
        print(f"{name:<32} median {median:7.2f} ms   p95 {p95:7.2f} ms")


if __name__ == "__main__":
    main()
