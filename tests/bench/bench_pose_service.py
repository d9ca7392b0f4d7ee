"""Tables and racks grounded from rendered pixels through the pose service: accuracy, and what HTTP adds.

Run by hand: `python tests/bench/bench_pose_service.py` (20 pictures); `--small` (1 picture) only shows that
it still runs. Pictures are 1280 x 720, rendered by MuJoCo, with the second rack pushed about by up to 15 mm
and 3 degrees. The baseline of a round trip is the service's own time for the same request.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.world.perception.mujoco_bench import egl_missing, take_picture  # noqa: E402
from tests.world.perception.pictures import STAMP_NS, lab, truth  # noqa: E402
from tests.world.perception.serving import served  # noqa: E402
from xei_lang.ir.geometry import Pose  # noqa: E402
from xei_lang.ir.world import World  # noqa: E402
from xei_lang.world.perception.client import PoseClient  # noqa: E402
from xei_lang.world.perception.observe import Seen, ask_for, judge  # noqa: E402
from xei_lang.world.perception.registry import registry_of  # noqa: E402
from xei_lang.world.perception.service.apriltag import AprilTagBackend  # noqa: E402
from xei_lang.world.perception.service.handle import Desk  # noqa: E402
from xei_lang.world.perception.service_fault import ServiceFault  # noqa: E402

NAMES = ("table", "rack_1", "rack_2")


def pushed(seed: int) -> World:
    """The bench with its second rack somewhat elsewhere."""
    random = np.random.default_rng(seed)
    x, y = (float(value) for value in random.uniform(-0.015, 0.015, 2))
    push = Pose.from_rpy((x, y, 0.0), (0.0, 0.0, float(np.radians(random.uniform(-3, 3)))))
    return replace(truth(), objects=tuple(
        replace(item, T_frame_object=item.T_frame_object @ push) if item.name == "rack_2" else item
        for item in truth().objects
    ))  # fmt: skip


def main(count: int) -> None:
    missing = egl_missing()
    if missing is not None:
        print(missing)
        return
    rows: dict[str, list[tuple[float, float]]] = {name: [] for name in NAMES}
    times_ms: list[tuple[float, float, float]] = []
    registry = registry_of(lab())
    with served(Desk(lab(), AprilTagBackend(lab()))) as url:
        client = PoseClient(url)
        for seed in range(count):
            world = pushed(seed)
            picture = take_picture(lab(), world, lab().calibration.cameras[0], stamp_ns=STAMP_NS, seed=seed)
            request = ask_for(picture, registry, NAMES, request_id=f"r{seed}", session_id="bench")
            start = time.perf_counter()
            answer = client.poses(request)
            asked = time.perf_counter()
            assert not isinstance(answer, ServiceFault), answer
            seen = judge(url, lab(), request, answer, now_ns=STAMP_NS)
            judged = time.perf_counter()
            assert isinstance(seen, Seen), seen
            times_ms.append((1e3 * (asked - start), answer.processing_ms, 1e3 * (judged - asked)))
            for item in seen.observations.items:
                assert item.T_frame_object is not None
                apart = world.T_world_object(item.name).inverse() @ item.T_frame_object
                turned = np.degrees(2.0 * np.linalg.norm(apart.quaternion[:3]))
                rows[item.name].append((1e3 * float(np.linalg.norm(apart.position_m)), float(turned)))
    for name, errors in rows.items():
        worst = np.max(errors or [(np.nan, np.nan)], axis=0)
        print(
            f"{name:<8} believed {len(errors):3}/{count}   at most {worst[0]:.3f} mm {worst[1]:.4f} deg off"
        )
    round_trip, own, held = np.median(times_ms, axis=0)
    print(f"round trip {round_trip:.0f} ms, {own:.0f} ms of it the service; held against it {held:.0f} ms")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true")
    main(1 if parser.parse_args().small else 20)
