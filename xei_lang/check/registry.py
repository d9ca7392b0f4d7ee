"""What a profile offers, by name: asked for at every step, so it is looked up and not searched."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.profiles.model import LabObject, Profile, SkillSpec
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Role, TypeExpr, walk


@record
class Registry(Shown):
    """Objects, stations, skills, arms, frames and roles of one profile."""

    objects: Mapping[str, LabObject]
    stations: tuple[str, ...]
    skills: Mapping[str, SkillSpec]
    arms: tuple[str, ...]
    owners: tuple[str, ...]
    frames: tuple[str, ...]
    roles: frozenset[str]

    @staticmethod
    def of(profile: Profile) -> Registry:
        """The registry of a loaded profile. A role is known when an object has it or a skill asks for it."""
        skills = {skill.name: skill for skill in profile.bank.skills}
        roles = {role for thing in profile.objects for role in thing.roles}
        for skill in profile.bank.skills:
            for argument in skill.args:
                if argument.roles is not None:
                    roles.update(role_names(argument.roles))
        return Registry(
            {thing.name: thing for thing in profile.objects},
            tuple(station.name for station in profile.calibration.stations),
            skills,
            profile.bank.arms,
            profile.bank.owners,
            _frames(profile),
            frozenset(roles),
        )


def _frames(profile: Profile) -> tuple[str, ...]:
    """`world`, what the calibration profile gives a place in it, and what the robot carries."""
    calibration = profile.calibration
    carried = (name for name, _ in calibration.robot_frames)
    return tuple(dict.fromkeys(("world", *(frame.name for frame in calibration.frames), *carried)))


def role_names(expression: TypeExpr) -> tuple[str, ...]:
    """Every role that an expression mentions, in order of its text."""
    return tuple(node.id for node in walk(expression) if isinstance(node, Role))
