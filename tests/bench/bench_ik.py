"""Inverse kinematics over reachable random tool poses: the closed form beside pinocchio's iterative solvers.

Run by hand: `python tests/bench/bench_ik.py` (1,000 poses); `--small` (50 poses) only shows that it still
runs. CLIK is pinocchio's own example, damped least squares on `log6`, from up to 20 seeded restarts; LM is
this project's fallback. Both look for one configuration, the closed form returns all postures.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from xei_lang.motion.kinematics import arm_solver  # noqa: E402
from xei_lang.motion.kinematics.numerical import NumericalArm  # noqa: E402
from xei_lang.motion.robot import SIDES, Robot, Side, load_robot  # noqa: E402

SEED = 2008
RESTARTS = 20


@dataclass
class Row:
    """What one solver did: CPU times in ms and configurations found, one entry a pose."""

    name: str
    times_ms: list[float]
    found: list[int]

    def __str__(self) -> str:
        solved = sum(count > 0 for count in self.found) / len(self.found)
        p99 = float(np.percentile(self.times_ms, 99))
        return (
            f"{self.name:<22} solved {solved:7.1%}   median {statistics.median(self.times_ms):8.3f} ms   "
            f"p99 {p99:8.3f} ms   configurations {statistics.mean(self.found):5.1f}"
        )


def measure(
    name: str, solve: Callable[[np.ndarray, float], int], poses: np.ndarray, heights: np.ndarray
) -> Row:
    row = Row(name, [], [])
    for pose, height in zip(poses, heights, strict=True):
        start = time.thread_time()
        row.found.append(solve(pose, float(height)))
        row.times_ms.append(1e3 * (time.thread_time() - start))
    return row


def clik(robot: Robot, side: Side) -> Callable[[np.ndarray, float], int]:
    """Pinocchio's closed-loop inverse kinematics: 1 where it converges within limits, else 0."""
    arm = robot.arm(side)
    frame = robot.model.getFrameId(arm.tool_frame)
    columns = list(arm.q_indices)
    random = np.random.default_rng(SEED)

    def solve(pose: np.ndarray, height: float) -> int:
        goal = pin.SE3(pose)
        q = np.zeros(robot.nq)
        q[robot.slide_index] = height
        for _ in range(RESTARTS):
            q[columns] = random.uniform(robot.lower[columns], robot.upper[columns])
            for _ in range(100):
                pin.framesForwardKinematics(robot.model, robot.data, q)
                iMd = robot.data.oMf[frame].actInv(goal)
                error = pin.log6(iMd).vector
                if np.linalg.norm(error) < 1e-6:
                    return 1
                J = (
                    -pin.Jlog6(iMd.inverse())
                    @ pin.computeFrameJacobian(robot.model, robot.data, q, frame)[:, columns]
                )
                step = -J.T @ np.linalg.solve(J @ J.T + 1e-6 * np.eye(6), error)
                q[columns] = np.clip(q[columns] + step, robot.lower[columns], robot.upper[columns])
        return 0

    return solve


def numerical(robot: Robot, side: Side) -> Callable[[np.ndarray, float], int]:
    solver = NumericalArm(robot, side)
    return lambda pose, height: len(solver.solve(pose, height))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="50 poses instead of 1,000")
    count = 50 if parser.parse_args().small else 1000
    folder = ROOT / "profiles" / "openarm_bench" / "robot"
    texts = [(folder / f"openarm_mobile.{suffix}").read_text(encoding="utf-8") for suffix in ("urdf", "srdf")]
    robot = load_robot(texts[0], texts[1])
    for side in SIDES:
        q = np.random.default_rng(SEED).uniform(robot.lower, robot.upper, (count, robot.nq))
        poses = np.array([robot.T_base_frame(row, robot.arm(side).tool_frame) for row in q])
        heights = q[:, robot.slide_index]
        solver = arm_solver(robot, side)
        print(f"{side} arm, {count} reachable tool poses")
        print(measure(solver.name, lambda pose, height, s=solver: len(s.solve(pose, height)), poses, heights))
        start = time.thread_time()
        many = solver.solve_many(poses, heights)
        spent = 1e3 * (time.thread_time() - start) / count
        solved = sum(len(each) > 0 for each in many) / count
        print(f"{solver.name + ', batch':<22} solved {solved:7.1%}   mean   {spent:8.3f} ms")
        print(measure("pinocchio CLIK", clik(robot, side), poses, heights))
        few = slice(0, max(10, count // 20))
        print(measure("numerical-lm (fallback)", numerical(robot, side), poses[few], heights[few]))


if __name__ == "__main__":
    main()
