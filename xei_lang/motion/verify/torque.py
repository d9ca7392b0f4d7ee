"""Joint torques by recursive Newton-Euler (pinocchio), with gravity and what the hands hold, at every 1 kHz
instant."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.timeline import Held, Phase

pin: Any = importlib.import_module("pinocchio")  # ships no type information


def check_torque(context: Context) -> None:
    """Every joint with a limit, in every phase, moving or still."""
    pools: dict[tuple[Held, ...], Any] = {}
    names = [joint for joint in context.robot.joint_names if joint in context.limits]
    columns = [context.robot.column[joint] for joint in names]
    bounds = np.array([context.limits[joint].torque for joint in names])
    reported: set[tuple[str, str]] = set()
    for phase in context.timeline.phases:
        pool = pools.setdefault(phase.scene.held, None) or _pool(context, phase.scene.held)
        pools[phase.scene.held] = pool
        torque = _torques(pool, phase)[:, columns]
        ratios = np.abs(torque) / bounds
        for column, joint in enumerate(names):
            row = int(np.argmax(ratios[:, column]))
            time, value = float(phase.times[row]), float(abs(torque[row, column]))
            goal = next((g for g in phase.moving if joint in g.joints), None)
            goal = goal or next(iter((*phase.moving, *phase.running, *context.plan.goals)), None)
            if goal is None:
                continue
            context.margin("torque", float(ratios[row, column]), joint, goal.id, time)
            over = ratios[row, column] > context.options.torque_ratio
            if over and (goal.id, joint) not in reported:
                reported.add((goal.id, joint))
                unit = "N" if context.robot.joints[joint].kind == "prismatic" else "N m"
                text = f"`{joint}` needs more torque than it may give"
                context.found(
                    "torque", goal, time, joint, text, value=value, limit=float(bounds[column]), unit=unit
                )


def _torques(pool: Any, phase: Phase) -> Array:
    rows = (np.asfortranarray(rows.T) for rows in (phase.q, phase.v, phase.a))
    torque = np.zeros(phase.q.T.shape, order="F")
    pin.rneaInParallel(1, pool, *rows, torque)
    return torque.T


def _pool(context: Context, held: tuple[Held, ...]) -> Any:
    model = context.robot.model.copy()
    for item in held:
        found = context.world.find(item.object)
        if found is None or found.mass_kg <= 0.0:
            continue
        frame = model.frames[model.getFrameId(item.link)]
        middle = Pose((0.0, 0.0, 0.5 * found.size_m[2]))
        placement = frame.placement * to_se3(item.T_link_object @ middle)
        model.appendBodyToJoint(frame.parentJoint, _box_inertia(found.mass_kg, found.size_m), placement)
    return pin.ModelPool(model, 1)


def _box_inertia(mass_kg: float, size_m: Vec3) -> Any:
    return pin.Inertia.FromBox(mass_kg, *(max(1e-4, size) for size in size_m))


def to_se3(pose: Pose) -> Any:
    """The pose as pinocchio's rigid transform."""
    matrix = np.array(pose.matrix())
    return pin.SE3(matrix[:3, :3], matrix[:3, 3])
