"""A world as a scene file, so that what was grounded once can be grounded again."""

from __future__ import annotations

from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.model import Profile
from xei_lang.world.sources.identity import objects_sha256


def scene_text(world: World, profile: Profile) -> str:
    """The scene file (YAML) of a world's objects but for those of the system, which do not move.

    Numbers are the shortest that read back as the same; a prior that nobody has looked at is written as it
    is believed, with the prior's confidence.
    """
    lines = [
        "version: 1",
        f"profile: {profile.name}",
        f"objects_sha256: {objects_sha256(profile)}",
        "objects:",
    ]
    placed = {item.name for item in world.objects}
    for item in profile.objects:
        found = world.find(item.name)
        if not item.system and found is not None:
            lines.extend(_object(found))
        elif item.name not in placed and not item.system:
            lines.append(f"  {item.name}: {{absent: true}}")
    if len(lines) == 4:
        lines[-1] = "objects: {}"
    return "\n".join(lines) + "\n"


def _object(item: WorldObject) -> list[str]:
    states = ", ".join(f"{name}: {value}" for name, value in item.states)
    return [
        f"  {item.name}:",
        f"    frame: {item.frame_id}",
        *_pose(item.T_frame_object),
        f"    confidence: {item.confidence!r}",
        *((f"    states: {{{states}}}",) if states else ()),
    ]


def _pose(pose: Pose) -> list[str]:
    position = ", ".join(f"{_plain(value)} m" for value in pose.position_m)
    quaternion = ", ".join(_plain(value) for value in pose.quaternion)
    return [f"    position: [{position}]", f"    quaternion: [{quaternion}]"]


def _plain(value: float) -> str:
    """The shortest text that reads back as the same number, without an exponent."""
    text = repr(value + 0.0)
    return text if "e" not in text else f"{value:.20f}".rstrip("0") + "0"
