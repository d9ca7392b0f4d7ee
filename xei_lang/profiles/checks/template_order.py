"""Templates whose lines cannot follow each other (XEI0644), as far as that is certain without objects; what
others leave behind is held against their skills.
"""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.checks.contradictions import contradictions_of
from xei_lang.profiles.checks.rule_facts import facts_of
from xei_lang.profiles.checks.template_outcome import NOTHING, Outcome, check_outcome, names_hands
from xei_lang.profiles.model import Profile, SkillSpec, TemplateStep
from xei_lang.syntax import ast

_BEGUN = ("arc", "screw", "raster")
"""Stated paths: they begin where the line before them has led the tool."""


def check_template_order(profile: Profile) -> Iterator[Diagnostic]:
    """Every template from its first line to its last, and where nothing is wrong so far, what it leaves."""
    for skill in profile.bank.skills:
        walk = _Walk(skill)
        faults = tuple(walk.faults())
        yield from faults
        if not faults and names_hands(skill, profile.bank.arms) and not any(contradictions_of(skill)):
            yield from check_outcome(skill, walk.outcome())


class _Walk:
    """What is known of the hands while the lines are gone through: who holds what, and whose jaws closed."""

    def __init__(self, skill: SkillSpec) -> None:
        self.skill = skill
        facts = list(facts_of(skill.requires, "requires"))
        self.held = {
            fact.key[1]: fact.value.id
            for fact in facts
            if fact.key[0] == "holding" and fact.op == "==" and isinstance(fact.value, ast.Name)
            if fact.value.id == NOTHING or skill.arg(fact.value.id) is not None
        }
        self.unclear = any(isinstance(rule.predicate, (ast.BoolOp, ast.Unary)) for rule in skill.requires)
        self.begun = dict(self.held)
        self.left: dict[str, str] = {}
        self.taken: dict[str, TemplateStep] = {}
        self.closed: set[str] = set()
        self.led: set[str] = set()

    def faults(self) -> Iterator[Diagnostic]:
        for line in self.skill.template:
            arm, thing = str(line.field("tool") or line.field("arm") or ""), str(line.field("object") or "")
            if arm and (thing or line.kind not in ("attach", "detach")):
                yield from self.fault(line, arm, thing)
                self.follow(line, arm, thing)

    def fault(self, line: TemplateStep, arm: str, thing: str) -> Iterator[Diagnostic]:
        """What the lines before this one leave it without."""
        holds = self.held.get(arm)
        if line.kind == "attach" and holds == thing:
            yield self.say(line, f"`{thing}` is taken twice", "in the hand already", "leave the line out")
        elif line.kind == "attach" and holds not in (None, NOTHING):
            label = f"the hand holds `{holds}`"
            yield self.say(line, f"`{thing}` is taken by a full hand", label, "detach the other one first")
        elif line.kind == "attach" and arm not in self.closed:
            help_ = f"write `close_gripper: {{arm: {arm}, width: grasp_width}}` before it"
            yield self.say(
                line, f"`{thing}` is taken by open jaws", f"`{arm}` was not closed before this line", help_
            )
        elif line.kind == "detach" and holds != thing and not (holds is None and self.unclear):
            help_ = f'ask for it: `requires: ["holding({arm}) == {thing}"]`, or attach it before'
            label = (
                "nothing says that the hand holds it" if holds is None else f"the hand holds {_shown(holds)}"
            )
            yield self.say(line, f"`{thing}` is let go and is not in the hand", label, help_)
        elif line.kind == "move_to" and line.field("path") in _BEGUN and arm not in self.led:
            help_ = "lead the tool to where the path begins, with a `move_to` before it"
            yield self.say(
                line, f"a path `{line.field('path')}` begins nowhere", "no line leads the tool there", help_
            )

    def follow(self, line: TemplateStep, arm: str, thing: str) -> None:
        """What the line changes."""
        if thing:
            self.taken[arm] = self.taken[thing] = line
        match line.kind:
            case "close_gripper":
                self.closed.add(arm)
            case "open_gripper":
                self.closed.discard(arm)
            case "attach":
                self.begun.setdefault(arm, NOTHING)
                self.held[arm] = thing
                self.left[thing] = arm
            case "detach":
                self.held[arm] = NOTHING
                self.left[thing] = str(line.field("at"))
            case "move_to" if line.field("at") is not None:
                self.led.add(arm)
            case _:
                pass

    def outcome(self) -> Outcome:
        """What is known once all lines are gone through."""
        return Outcome(self.begun, self.held, self.left, self.taken, self.unclear)

    def say(self, line: TemplateStep, what: str, label: str, help_: str) -> Diagnostic:
        message = f"in the template of `{self.skill.name}` {what}"
        return Diagnostic("XEI0644", message, line.span, label=label, help=(help_,))


def _shown(holds: str) -> str:
    return NOTHING if holds == NOTHING else f"`{holds}`"
