"""Look: the height of the slide from which a camera that rides on it has an object in its picture.

The camera is a pinhole; what its lens bends lies within the margin that is kept at the picture's border.
What stands or hangs in between, the robot's own arms too, is not looked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NoReturn

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.goals import Parameter
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.in_hands import refuse_unplaced
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task, refuse_template
from xei_lang.profiles.model import Camera, LabObject, Profile, TemplateStep
from xei_lang.quantity import quantity
from xei_lang.quantity.lengths import exact_mm
from xei_lang.world.frames import T_base_link, slide_joint

_STEP_M = 0.01
_NEAREST_M = 0.1
_MARGIN = Fraction(5)


@dataclass(frozen=True, slots=True)
class View:
    """A slide height, in m, and the camera that has the whole object in its picture from there."""

    height_m: float
    camera: Camera


def look_height(task: Task, argument: str, line: TemplateStep) -> tuple[Setting, tuple[Parameter, ...]]:
    """The height of the slide for looking at an object, and what led to it.

    Refuses (XEI0724) where no camera that rides on the slide can have it in its picture from this stand.
    """
    subject = task.argument(argument)
    if not isinstance(subject, ObjectRef):
        refuse_template(line, f"`{argument}` cannot be looked at", "expected an object")
    known, span = task.profile.object(subject.name), task.span_of(argument)
    if known is None or subject.name not in task.scene.standing:
        refuse_unplaced(task.scene, subject.name, span, "looked at")
    margin = _margin(task)
    T_base_object = task.scene.T_base_object(known.name)
    near_m = _station_slide(task)
    view = best_view(task.profile, T_base_object, known.size_m, near_m, margin.si("Fraction"))
    if view is None:
        _refuse_unseen(task, argument, known, margin)
    rule = f"nearest to the station's {exact_mm(near_m)} with `{known.name}` in the picture"
    chosen = computed_length("look_height", view.height_m, rule)
    camera = Parameter("camera", view.camera.name, "computed", "rides on the slide", view.camera.span)
    return chosen, (chosen.provenance(), camera, margin.provenance())


def best_view(
    profile: Profile, T_base_object: Pose, size_m: Vec3, near_m: float, margin: float
) -> View | None:
    """The height nearest to `near_m` from which one of the cameras on the slide sees an object of this size
    whole, `margin` of the picture's width and height away from its border; None where there is none.

    Heights are tried every 10 mm and at both ends of the travel.
    """
    joint = profile.robot.joint(slide_joint(profile))
    link = dict(profile.calibration.robot_frames).get("slide", "")
    if joint is None:
        return None
    heights = sorted(_heights(joint.lower, joint.upper), key=lambda height: (abs(height - near_m), height))
    mounts = [(camera, mount) for camera in profile.calibration.cameras if (mount := _mount(profile, camera))]
    for height_m in heights:
        T_base_slide = T_base_link(profile.robot, link, {joint.name: height_m})
        for camera, T_slide_camera in mounts:
            T_camera_object = (T_base_slide @ T_slide_camera).inverse() @ T_base_object
            if sees(camera, T_camera_object, size_m, margin):
                return View(height_m, camera)
    return None


def sees(camera: Camera, T_camera_object: Pose, size_m: Vec3, margin: float) -> bool:
    """Whether the box of this size, standing on the object's frame, lies in the picture with all corners and
    at least 0.1 m ahead.

    The pose is in the camera's body frame: x forward, y left, z up.
    """
    left, top = margin * camera.width, margin * camera.height
    for x in (-size_m[0] / 2, size_m[0] / 2):
        for y in (-size_m[1] / 2, size_m[1] / 2):
            for z in (0.0, size_m[2]):
                ahead, aside, above = T_camera_object.apply((x, y, z))
                if ahead < _NEAREST_M:
                    return False
                u = camera.cx - camera.fx * aside / ahead
                v = camera.cy - camera.fy * above / ahead
                if not (left <= u <= camera.width - 1 - left and top <= v <= camera.height - 1 - top):
                    return False
    return True


def _heights(lower_m: float, upper_m: float) -> tuple[float, ...]:
    count = math.floor((upper_m - lower_m) / _STEP_M + 1e-9)
    return (*(round(lower_m + k * _STEP_M, 6) for k in range(count + 1)), upper_m)


def _mount(profile: Profile, camera: Camera) -> Pose | None:
    """The camera's pose on the slide, or None where it does not ride there."""
    frames = {frame.name: frame for frame in profile.calibration.frames}
    pose, name = Pose(), camera.frame
    while name in frames:
        pose, name = frames[name].T_parent_frame @ pose, frames[name].parent
    return pose if name == "slide" else None


def _margin(task: Task) -> Setting:
    rule = "room for what the lens bends and for where the object may be off"
    default = Setting("look_margin", quantity(_MARGIN, "%"), "computed", rule, None)
    layers = task.layers()
    merged = layers.written("look_margin") or layers.skill.get("look_margin") or default
    if not 0.0 <= merged.si("Fraction") < 0.5:
        refuse(
            "XEI0702",
            f"`look_margin` of {merged.text} leaves nothing of the picture",
            merged.span or task.step.span,
            "expected 0 % or more and less than 50 %",
        )
    return merged


def _station_slide(task: Task) -> float:
    stations = task.profile.calibration.stations
    return next((item.slide_m for item in stations if item.name == task.scene.epoch.station), 0.0)


def _refuse_unseen(task: Task, argument: str, known: LabObject, margin: Setting) -> NoReturn:
    mounted = [camera for camera in task.profile.calibration.cameras if _mount(task.profile, camera)]
    where = task.scene.epoch.station
    if not mounted:
        found = "no camera of this profile rides on the slide"
    else:
        names = ", ".join(f"`{camera.name}`" for camera in mounted)
        found = f"at no height of the slide is it whole in the picture of {names}"
    refuse(
        "XEI0724",
        f"`{known.name}` cannot be looked at from `{where}`",
        task.span_of(argument),
        found,
        tuple(Label(camera.span, "the camera is stated here") for camera in mounted[:1]),
        notes=(f"the whole object must be in the picture, {margin.text} of it away from the border",),
        help=("move it to where the camera looks, or drive to another station first",),
    )
