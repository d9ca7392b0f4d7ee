"""The world as a table: a line an object, where it is, who said so, and from where it can be reached."""

from __future__ import annotations

from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.model import Profile
from xei_lang.world.reach import StationReach, arm_reaches, reached_from

_HEAD = ("object", "place", "frame", "pose", "confidence", "said by", "within reach")


def to_table(world: World, profile: Profile) -> str:
    """A line an object, sorted by name; a pose is that of the bottom's centre in the frame."""
    arms = arm_reaches(profile)
    rows: list[tuple[str, ...]] = [_HEAD]
    for item in world.objects:
        known = profile.object(item.name)
        far = () if known is None or known.system else reached_from(profile, arms, _middle(world, item))
        reach = "" if known is not None and known.system else reach_text(far)
        rows.append(
            (
                item.name,
                item.place or "-",
                item.frame_id,
                pose_text(item.T_frame_object),
                f"{item.confidence:g}",
                dict(item.provenance).get("pose", ""),
                reach or "-",
            )
        )
    widths = [max(len(row[column]) for row in rows) for column in range(len(_HEAD))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def reach_text(reach: tuple[StationReach, ...]) -> str:
    """`bench_a: left, right; bench_b: left`, or `no arm` where nothing is."""
    return "; ".join(f"{one.station}: {', '.join(one.arms)}" for one in reach) or "no arm"


def _middle(world: World, item: WorldObject) -> tuple[float, float, float]:
    return world.T_world_object(item.name).apply((0.0, 0.0, item.size_m[2] / 2))
