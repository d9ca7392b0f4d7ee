"""What a call calls: the skills of the bank that a protocol may call, and why not where it may not."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, listed, meant
from xei_lang.check.units import Unit
from xei_lang.diagnostics import did_you_mean
from xei_lang.profiles.model import SkillSpec
from xei_lang.syntax.ast import Call


class Callees:
    """Finds the skills of calls.

    `units` are the files, each with the procedures that can be called in it, too; where an import could
    not be read there may be more of them than are known.
    """

    def __init__(self, registry: Registry, reporter: Reporter, units: Mapping[str, Unit]) -> None:
        self._registry = registry
        self._reporter = reporter
        self._units = units

    def skill(self, call: Call) -> SkillSpec | None:
        """The skill, if a protocol may call it on this robot; else None, and it is said why."""
        name = call.callee.id
        skill = self._registry.skills.get(name)
        if skill is not None and skill.exposed and skill.owner in self._registry.owners:
            return skill
        callable_skills = tuple(skill.name for skill in self._registry.skills.values() if skill.exposed)
        unit = self._units[call.span.file]
        if skill is None and not unit.complete:
            return None
        if skill is None:
            near = did_you_mean(name, (*callable_skills, *unit.procedures))
            self._reporter.report(
                "XEI0201",
                f"there is no skill `{name}`",
                call.callee.span,
                "neither a skill of this robot nor a procedure of this file",
                help=meant(near) or (f"this robot's skills are {listed(callable_skills, 12)}",),
                fix=guess(call.callee.span, near),
            )
        elif not skill.exposed:
            self._reporter.report(
                "XEI0203",
                f"skill `{name}` cannot be called from a protocol",
                call.callee.span,
                "only other skills use it",
                notes=(self._reporter.rule(skill.span),),
                help=(f"skills that can be called: {listed(callable_skills, 12)}",),
            )
        else:
            self._reporter.report(
                "XEI0204",
                f"this robot has no `{skill.owner}`, which `{name}` needs",
                call.callee.span,
                f"performed by `{skill.owner}`",
                notes=(
                    self._reporter.rule(skill.span),
                    f"this robot has {listed(self._registry.owners, 12)}",
                ),
            )
        return None
