"""The profiles as the compiler sees them: frozen, in SI units, each part with the place that it was written
at.

These are plain dataclasses so that an unchanged profile is loaded from its compiled form without pydantic.
The pydantic models that validate the YAML files stand in `profiles/schema/`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from xei_lang.profiles.model.bank import (
    MOST_TIMES,
    ArgSpec,
    Repeat,
    ReturnSpec,
    SkillBank,
    SkillRule,
    SkillSpec,
    TemplateStep,
)
from xei_lang.profiles.model.calibration import (
    Calibration,
    Camera,
    CarryPose,
    Lidar,
    MapFiles,
    Placeholder,
    PlanningLimit,
    SceneOrigin,
    Tag,
    TagLayout,
)
from xei_lang.profiles.model.frames import CalibratedFrame, EarlierTransform, Status
from xei_lang.profiles.model.lab import (
    Asset,
    Element,
    FiniteState,
    LabObject,
    Liquid,
    OperationDefault,
    Prior,
    SlotGrid,
    Spot,
    Thread,
    Tip,
)
from xei_lang.profiles.model.robot import NamedState, RobotDescription, RobotJoint
from xei_lang.record import Record, record

__all__ = [
    "MOST_TIMES",
    "ArgSpec",
    "Asset",
    "CalibratedFrame",
    "Calibration",
    "Camera",
    "CarryPose",
    "EarlierTransform",
    "Element",
    "FiniteState",
    "LabObject",
    "Lidar",
    "Liquid",
    "MapFiles",
    "NamedState",
    "OperationDefault",
    "Placeholder",
    "PlanningLimit",
    "Prior",
    "Profile",
    "Repeat",
    "ReturnSpec",
    "RobotDescription",
    "RobotJoint",
    "SceneOrigin",
    "SkillBank",
    "SkillRule",
    "SkillSpec",
    "SlotGrid",
    "Spot",
    "Status",
    "Tag",
    "TagLayout",
    "TemplateStep",
    "Thread",
    "Tip",
]


@record
class Profile(Record):
    """A whole profile folder: all objects sorted by name, the skill bank, the calibration, the robot's
    description.

    `files` maps each file (path relative to the folder) to the SHA-256 of its bytes; `hazards` lists those of
    each liquid.
    """

    name: str
    folder: str
    objects: tuple[LabObject, ...]
    bank: SkillBank
    calibration: Calibration
    incompatible: tuple[tuple[str, str], ...]
    files: tuple[tuple[str, str], ...]
    robot: RobotDescription
    hazards: tuple[tuple[str, tuple[str, ...]], ...] = ()
    _by_name: Mapping[str, LabObject] = field(init=False)

    def __post_init__(self) -> None:
        # The first one of a name, where a profile that is not sound has two.
        by_name = {item.name: item for item in reversed(self.objects)}
        object.__setattr__(self, "_by_name", by_name)

    def object(self, name: str) -> LabObject | None:
        """The object of this name, or None."""
        return self._by_name.get(name)
