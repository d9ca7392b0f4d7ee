"""Which link of an arm carries what its hand holds, by the word of the plan."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.verify.robot import Robot


def stated_links(
    plan: TimedPlan, robot: Robot, tools: Mapping[Side, str]
) -> dict[tuple[str, str, Side], str]:
    """For every goal, object and arm, the link of that arm that the plan next says carries the object."""
    links: dict[tuple[str, str, Side], str] = {}
    following: dict[tuple[str, Side], str] = {}
    for goal in reversed(plan.goals):
        following.update(((item.object, _side(robot, tools, item.link)), item.link) for item in goal.attached)
        links.update(((goal.id, *key), link) for key, link in following.items())
    return links


def _side(robot: Robot, tools: Mapping[Side, str], link: str) -> Side:
    """The arm that a link belongs to: the one whose tool shares most joints with it."""
    columns = set(robot.columns(link)) if link in robot.links else set[int]()
    return max(sorted(tools), key=lambda side: len(columns.intersection(robot.columns(tools[side]))))
