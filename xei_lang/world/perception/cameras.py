"""The cameras of a profile: which one an image is of, and what each hangs on."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic, did_you_mean
from xei_lang.profiles.model import Camera, Profile

_CODE = "XEI0680"


def camera_named(profile: Profile, name: str | None) -> Camera | Diagnostic:
    """The camera of this name; without a name the only one. Else a diagnostic that lists those there are."""
    cameras = profile.calibration.cameras
    if not cameras:
        help_ = "describe it under `cameras` of `calibration_profile.yaml`"
        return Diagnostic(_CODE, "the profile has no camera", help=(help_,))
    known = ", ".join(f"`{one.name}`" for one in cameras)
    if name is None:
        if len(cameras) == 1:
            return cameras[0]
        message = f"`{profile.name}` has {len(cameras)} cameras, and it is not said whose image this is"
        return Diagnostic(_CODE, message, help=(f"name one of {known} with `--camera`",))
    found = next((one for one in cameras if one.name == name), None)
    if found is not None:
        return found
    near = did_you_mean(name, [one.name for one in cameras])
    help_ = f"did you mean `{near[0]}`?" if near else f"its cameras are {known}"
    return Diagnostic(_CODE, f"`{profile.name}` has no camera `{name}`", help=(help_,))


def camera_at(profile: Profile, frame: str) -> str:
    """The name of the camera whose body's frame this is; of several in one frame all, else the frame's."""
    names = [one.name for one in profile.calibration.cameras if one.frame == frame]
    return " or ".join(names) or frame


def is_carried(profile: Profile, camera: Camera) -> bool:
    """Whether the robot carries the camera about; one that hangs on `world` stays where it is."""
    links = dict(profile.calibration.robot_frames)
    parents = {one.name: one.parent for one in profile.calibration.frames}
    name = camera.frame
    while name in parents and name not in links:
        name = parents[name]
    return name in links
