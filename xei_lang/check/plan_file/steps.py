"""The steps of a plan against the skill bank, by the checker of calls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from xei_lang.check.calls import CheckedCall
from xei_lang.check.context import Context
from xei_lang.check.effects import apply_effects, resources_of
from xei_lang.check.initial import initial_state
from xei_lang.check.measure import LOWER, UPPER
from xei_lang.check.plan_file.expressions import AsExpression
from xei_lang.check.plan_file.statements import check_statement
from xei_lang.check.report import listed
from xei_lang.check.scope import Scope, Usage
from xei_lang.check.state import State
from xei_lang.diagnostics import Source, Span
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.skill_plan import Argument, RunValue, SkillPlan, Step
from xei_lang.profiles.model import SkillSpec
from xei_lang.syntax.ast import Arg, Call, Name

_PERSON = "person"


class StepChecker:
    """Checks the steps in their order, and keeps what is known along the way."""

    def __init__(self, context: Context, source: Source, root: JsonNode) -> None:
        self._context = context
        self._nodes = root.items["skill_calls"].elements
        self._scope = Scope(Usage())
        self._state = initial_state(context.registry)
        self._said_state = "initial_state" in root.items
        self._types = {
            (skill.name, spec.name): spec.type
            for skill in context.registry.skills.values()
            for spec in skill.args
        }

    def check(self, plan: SkillPlan, order: Sequence[int]) -> tuple[Step, ...]:
        """The steps in this order, with what the skill bank says of them."""
        if self._said_state:
            self._state = State(self._context.registry.arms)
            self._state.set_all((fact.variable, fact.subject, fact.value) for fact in plan.initial_state)
        return tuple(self._step(plan.steps[number], self._nodes[number]) for number in order)

    def _step(self, step: Step, node: JsonNode) -> Step:
        if "state_before" not in node.items:
            step = replace(step, state_before=self._state.facts())
        if not step.duration_s[0] <= step.duration_s[1]:
            self._context.reporter.report(
                "XEI0322",
                "the shortest time of a step is longer than its longest",
                node.items["duration_s"].span,
                "expected the shorter time first",
            )
        return self._skill(step, node) if step.skill else self._statement(step, node)

    def _skill(self, step: Step, node: JsonNode) -> Step:
        checked = self._called(step, node)
        self._owner_agrees(step, node)
        if checked is None:
            return step
        skill, values = checked.skill, checked.values
        self._resources_agree(step, node, skill, checked)
        said = {argument.name: argument for argument in step.args}
        arguments = tuple(_argument(found, said.get(found.name)) for found in checked.arguments)
        limits = tuple(item for item in step.args if step.kind == "measure" and item.name in (LOWER, UPPER))
        arguments = (*arguments, *limits)
        apply_effects(checked.effects, values, self._state)
        return replace(
            step,
            args=arguments,
            owner=skill.owner,
            duration_s=step.duration_s if "duration_s" in node.items else skill.duration_s,
            resources=step.resources if "resources" in node.items else resources_of(skill, values),
        )

    def _called(self, step: Step, node: JsonNode) -> CheckedCall | None:
        """The call that a step is; where arguments are measured, for both ends of what they can be."""
        named = node.items["skill"]
        callee = Name(str(named.value)[:200], named.span)
        args = node.get("args")
        measured = args is not None and any("measured" in item.items for item in args.items.values())
        found: CheckedCall | None = None
        for end in ("upper", "lower") if measured else ("lower",):
            given: list[Arg] = []
            for name, item in args.items.items() if args else ():
                if step.kind == "measure" and name in (LOWER, UPPER):
                    continue  # the limits of the reading, which are no arguments of its skill
                value = AsExpression(end).of(item, self._types.get((callee.id, name)))
                assert args is not None
                if value is None:
                    return None
                given.append(Arg(Name(name[:200], args.keys[name]), value, item.span))
            call = Call(callee, tuple(given), node.span)
            found = self._context.calls.check(call, self._scope, self._state)
        return found

    def _owner_agrees(self, step: Step, node: JsonNode) -> None:
        skill = self._context.registry.skills.get(step.skill)
        if skill is not None and "owner" in node.items and step.owner != skill.owner:
            self._differs(
                f"`{skill.name}` is performed by `{skill.owner}`, not by `{step.owner[:80]}`",
                node.items["owner"].span,
                f"expected `{skill.owner}`",
                skill.span,
            )

    def _resources_agree(self, step: Step, node: JsonNode, skill: SkillSpec, checked: CheckedCall) -> None:
        needed = resources_of(skill, checked.values) if step.kind == "skill" else ()
        missing = tuple(name for name in needed if name not in step.resources)
        if "resources" in node.items and missing:
            self._differs(
                f"`{skill.name}` also occupies {listed(missing)}",
                node.items["resources"].span,
                f"expected {listed(needed)}",
                skill.span,
            )

    def _differs(self, message: str, span: Span, label: str, rule: Span) -> None:
        reporter = self._context.reporter
        help_ = ("leave the key out: the skill bank knows it",)
        reporter.report("XEI0216", message, span, label, notes=(reporter.rule(rule),), help=help_)

    def _statement(self, step: Step, node: JsonNode) -> Step:
        """A step without a skill; a person and the parts of the robot are all that can own it."""
        owners = self._context.registry.owners
        if step.owner not in (*owners, _PERSON, ""):
            self._context.reporter.report(
                "XEI0204",
                f"this robot has no `{step.owner[:80]}`",
                node.items["owner"].span,
                f"this robot has {listed(owners, 12)}",
            )
        check_statement(step.kind, node, self._context, self._state)
        if step.kind != "confirm":
            return step
        resources = step.resources if "resources" in node.items else (_PERSON,)
        return replace(step, owner=step.owner or _PERSON, resources=resources)


def _argument(found: Argument, said: Argument | None) -> Argument:
    """What was found, but where it is from as the plan says, and what is measured as it stands there."""
    if said is None:
        return found
    value = said.value if isinstance(said.value, RunValue) else found.value
    return replace(found, value=value, source=said.source, span=said.span)
