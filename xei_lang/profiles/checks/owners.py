"""Parts that the robot lacks (XEI0645): of a skill's owner, and of the lines of its template."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.goals import GoalKind
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import Profile
from xei_lang.profiles.trees import Trees

PARTS: Mapping[GoalKind, str] = MappingProxyType(
    {
        "slide_move": "slide",
        "nav_to_pose": "base",
        "perceive": "perception",
        "set_do": "io",
        "confirm": "person",
        "instrument": "instrument",
    }
)
"""The part that performs a goal, where it is no arm."""

_OF_ARMS = ("arm", "gripper")
OWNERS = (*_OF_ARMS, *PARTS.values())
"""Everything that skills may belong to."""


def check_owners(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Owners that need an arm where there is none, and goals whose part is not among the owners."""
    bank = profile.bank
    yield from _arms(profile, trees)
    for index, owner in enumerate(bank.owners):
        if owner not in OWNERS:
            span = trees.development.span_of("robot", "owners", index)
            yield unknown("a part that carries out goals", owner, OWNERS, span)
    prismatic = any(joint.kind == "prismatic" for joint in profile.robot.joints)
    for skill in bank.skills:
        needs_arm = skill.owner in _OF_ARMS and not bank.arms
        if needs_arm or (skill.owner == "slide" and not prismatic):
            lacks = "has no arms" if needs_arm else "has no joint that slides"
            yield Diagnostic(
                "XEI0645",
                f"`{skill.name}` belongs to the {skill.owner}, and the robot {lacks}",
                trees.of_skill(skill.name, "owner"),
                label=f"this robot {lacks}",
                help=("name the part in `robot`, or take the skill out of the bank",),
            )
        for line in skill.template:
            part = PARTS.get(line.kind, "")
            if part and part not in bank.owners:
                yield Diagnostic(
                    "XEI0645",
                    f"`{line.kind}` in the template of `{skill.name}` needs a part that the robot lacks",
                    line.span,
                    label=f"`{part}` is not among the robot's `owners`",
                    help=(f"add `{part}` to `owners` if the robot has it, or leave the line out",),
                )


def _arms(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Arms without a tool on the robot, or named twice."""
    arms, carried = profile.bank.arms, dict(profile.calibration.robot_frames)
    for index, arm in enumerate(arms):
        span = trees.development.span_of("robot", "arms", index)
        if arm in arms[:index]:
            yield Diagnostic("XEI0621", f"`{arm}` names two arms", span, label="named again here")
        elif f"{arm}_tool" not in carried:
            yield Diagnostic(
                "XEI0645",
                f"nothing says where the tool of the {arm} arm is",
                span,
                label=f"`robot_frames` has no `{arm}_tool`",
                help=(f"add `{arm}_tool` to `robot_frames` in the calibration, or leave the arm out",),
            )
