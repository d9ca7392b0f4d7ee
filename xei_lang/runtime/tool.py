"""Where each hand's grasp frame is, for the safety gate. Shares no code with the planner that it guards."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

from xei_lang.ir.geometry import Vec3


class Tools:
    """The robot's tools by the forward kinematics of its URDF (rooted at the base)."""

    def __init__(self, urdf: str, arms: tuple[str, ...]) -> None:
        pin: Any = importlib.import_module("pinocchio")
        self._pin = pin
        self._model: Any = pin.buildModelFromXML(urdf)
        self._data: Any = self._model.createData()
        self._frames = {arm: self._model.getFrameId(f"openarm_{arm}_grasp") for arm in arms}
        self._index: dict[str, int] = {
            name: self._model.joints[self._model.getJointId(name)].idx_q for name in self._model.names[1:]
        }
        self._neutral: Any = pin.neutral(self._model)

    def positions_m(self, joints: Mapping[str, float]) -> dict[str, Vec3]:
        """The position of each arm's grasp frame in the base frame at these joint positions (rad, m)."""
        q = self._neutral.copy()
        for name, value in joints.items():
            if name in self._index:
                q[self._index[name]] = value
        self._pin.forwardKinematics(self._model, self._data, q)
        placed: dict[str, Vec3] = {}
        for arm, frame in self._frames.items():
            x, y, z = self._pin.updateFramePlacement(self._model, self._data, frame).translation
            placed[arm] = (float(x), float(y), float(z))
        return placed
