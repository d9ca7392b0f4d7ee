"""Scene files: a recorded world in YAML or JSON, read with the place of every fault."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from datetime import datetime

from pydantic import ValidationError

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.profiles.build_objects import vec3
from xei_lang.profiles.faults import explain
from xei_lang.profiles.model import Profile
from xei_lang.profiles.schema.scene_file import SceneFile, SceneObjectModel
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node
from xei_lang.world.sources.identity import objects_sha256
from xei_lang.world.sources.observation import Observation, Observations
from xei_lang.world.sources.rigid import FARTHEST_M, pose_of_matrix, pose_of_quaternion

_FORM = "XEI0652"
_OTHER_REGISTRY = "XEI0653"
_NO_POSE = "XEI0654"


@dataclass(frozen=True, slots=True)
class SceneFileSource:
    """A scene file whose text was read, as a source of the world."""

    text: Source

    @property
    def name(self) -> str:
        """The name that provenance keeps: the file's, without the folders that it lies in."""
        return f"scene_file {self.text.file.rsplit('/', 1)[-1]}"

    def observe(self, profile: Profile, /) -> tuple[Observations | None, Diagnostics]:
        """What the file says of the objects of this profile; None, with all that is wrong with it."""
        root, faults = read_yaml(self.text.file, self.text.text)
        if root is None or faults:
            return None, tuple(_recoded(fault) for fault in faults)
        try:
            model = SceneFile.model_validate(root.plain())
        except ValidationError as error:
            return None, tuple(_recoded(fault) for fault in explain(error, root, SceneFile))
        found = [*_other_registry(model, profile, root), *_stamp_faults(model, root)]
        items = [_observation(name, item, model, root, found) for name, item in model.objects.items()]
        if found:
            return None, tuple(found)
        sha256 = hashlib.sha256(self.text.text.encode()).hexdigest()
        stamp_ns = _nanoseconds(model.stamp)
        seen = tuple(item for item in items if item is not None)
        return Observations(self.name, seen, sha256, stamp_ns, tuple(sorted(model.objects))), ()


def _recoded(fault: Diagnostic) -> Diagnostic:
    """What the reader of profiles says, under the code of scene files."""
    if fault.code == "XEI0611":
        return replace(fault, code=_FORM, message=fault.message.replace("this profile", "this scene file"))
    return replace(fault, code=_FORM)


def _other_registry(model: SceneFile, profile: Profile, root: Node) -> list[Diagnostic]:
    help_ = ("record the scene again, or compile with the profile that it was recorded for",)
    if model.profile != profile.name:
        message = f"the scene was recorded for the profile `{model.profile}`"
        label = f"expected `{profile.name}`"
        return [Diagnostic(_OTHER_REGISTRY, message, root.span_of("profile"), label, help=help_)]
    if model.objects_sha256 != objects_sha256(profile):
        message = f"the scene was recorded for other objects than `{profile.name}` has now"
        notes = ("names, roles, shapes, slots, spots or states have changed since",)
        span = root.span_of("objects_sha256")
        label = f"not the digest of the objects of `{profile.name}`"
        return [Diagnostic(_OTHER_REGISTRY, message, span, label, notes=notes, help=help_)]
    return []


def _stamp_faults(model: SceneFile, root: Node) -> list[Diagnostic]:
    stamps = [(("stamp",), model.stamp)]
    stamps += [(("objects", name, "stamp"), item.stamp) for name, item in model.objects.items()]
    return [
        Diagnostic(_FORM, f"`{stamp}` is no time", root.span_of(*path), "no calendar has it")
        for path, stamp in stamps
        if stamp is not None and _nanoseconds(stamp) is None
    ]


def _observation(
    name: str, model: SceneObjectModel, scene: SceneFile, root: Node, found: list[Diagnostic]
) -> Observation | None:
    path = ("objects", name)
    wrong = _form_fault(name, model)
    if wrong:
        message, label, help_ = wrong
        found.append(Diagnostic(_FORM, message, root.span_of(*path), label, help=(help_,)))
        return None
    pose = _pose(model)
    if isinstance(pose, str):
        key = next(one for one in ("matrix", "quaternion", "position") if getattr(model, one) is not None)
        help_ = "a pose is a rotation and a shift in metres: write what was measured, to four digits or more"
        message = f"`{name}` has no pose: {pose}"
        found.append(Diagnostic(_NO_POSE, message, root.span_of(*path, key), help=(help_,)))
        return None
    return Observation(
        name=name,
        T_frame_object=pose,
        frame_id=model.frame or "",
        confidence=model.confidence,
        states=tuple(model.states.items()),
        size_m=_size(model),
        stamp_ns=_nanoseconds(model.stamp or scene.stamp),
        covariance=tuple(float(value) for value in model.covariance or ()),
        perception_args=tuple(model.perception_args.items()),
        is_absent=model.absent,
        span=root.span_of(*path),
    )


def _form_fault(name: str, model: SceneObjectModel) -> tuple[str, str, str] | None:
    """Message, label and help where the parts of an object do not go together."""
    has_pose = model.position is not None or model.matrix is not None
    turns = [one for one in (model.rpy, model.quaternion, model.matrix) if one is not None]
    if model.absent and (has_pose or turns or model.frame or model.confidence is not None):
        return f"`{name}` is absent and somewhere", "either `absent` or a pose", "keep one of the two"
    if has_pose != (model.frame is not None) or (turns and not has_pose):
        help_ = "write `frame: table` with `position: [0.1 m, 0 m, 0 m]`, or with `matrix`"
        return f"half of the pose of `{name}` is missing", "expected `frame` with a pose", help_
    if len(turns) > 1 or (model.position is not None and model.matrix is not None):
        help_ = "keep one of `rpy`, `quaternion` and `matrix`"
        return f"the pose of `{name}` is given in two ways", "expected one way", help_
    if has_pose and model.confidence is None:
        help_ = "write how far it is to be trusted, such as `confidence: 0.9`"
        return f"`{name}` has a pose and no `confidence`", "expected a `confidence`", help_
    return None


def _pose(model: SceneObjectModel) -> Pose | str | None:
    if model.matrix is not None:
        return pose_of_matrix([[float(value) for value in row] for row in model.matrix])
    if model.position is None:
        return None
    position = vec3(model.position)
    if model.quaternion is not None:
        return pose_of_quaternion(position, [float(value) for value in model.quaternion])
    far = max(abs(value) for value in position)
    if far > FARTHEST_M:
        return f"its position is {far:g} m away: was it meant in millimetres?"
    return Pose.from_rpy(position, vec3(model.rpy))


def _size(model: SceneObjectModel) -> Vec3 | None:
    return vec3(model.size) if model.size is not None else None


def _nanoseconds(stamp: str | None) -> int | None:
    """Nanoseconds since 1970 of a stamp in UTC; None for a date that no calendar has."""
    if stamp is None:
        return None
    whole, _, fraction = stamp.removesuffix("Z").partition(".")
    try:
        seconds = int(datetime.fromisoformat(f"{whole}+00:00").timestamp())
    except ValueError:
        return None
    return seconds * 1_000_000_000 + int(fraction.ljust(9, "0") or "0")
