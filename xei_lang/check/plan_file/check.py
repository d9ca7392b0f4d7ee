"""`plan.json` to SkillPlan: its JSON, its form, its steps and their order, each value against the skill bank.

Every stage goes on with what the one before found whole, so that one run says of all mistakes.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from xei_lang.check.binding import CheckOptions
from xei_lang.check.context import Context, make_context
from xei_lang.check.plan_file.facts import check_facts
from xei_lang.check.plan_file.in_json import first_ones, in_json
from xei_lang.check.plan_file.meanwhile import check_meanwhile
from xei_lang.check.plan_file.order import check_bounds, check_references, in_order
from xei_lang.check.plan_file.overlaps import check_overlaps
from xei_lang.check.plan_file.precedence import precedence
from xei_lang.check.plan_file.steps import StepChecker
from xei_lang.check.plan_file.works import check_works
from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Diagnostics, Source, Sources, Span, has_errors
from xei_lang.ir import forms
from xei_lang.ir.forms.json_reader import read_json
from xei_lang.ir.forms.json_schema import Pointer, Violation, violations
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_read import ArgumentType, plan_from_json
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.profiles.model import Profile
from xei_lang.syntax.ast import Module

_LISTS = ("skill_calls", "constraints", "unmapped_requests", "safety_notes")
_NEEDED = (
    "step_id",
    "skill",
    "kind",
    "args",
    "text",
    "from_step",
    "from_end",
    "to_step",
    "to_end",
    "lower_s",
    "upper_s",
)


@dataclass(frozen=True, slots=True, eq=False)
class PlanText:
    """What could be read of a plan's text: `root` follows the plan's schema, for what did not was taken out.

    `steps` are the spans of all step ids that the text has, also of steps that were taken out, `profile` is
    the profile that it names.
    """

    root: JsonNode
    steps: dict[str, Span]
    profile: tuple[str, Span] | None


def read_plan_text(source: Source) -> tuple[PlanText | None, Diagnostics]:
    """The tree of a plan that is still to be checked, with what is wrong in its JSON or its form."""
    root, said = read_json(source)
    if root is None:
        return None, first_ones(said)
    found = tuple(violations(root, _schema(), "XEI0111"))
    said = first_ones((*said, *(item.diagnostic for item in found)))
    ids = _ids(root)
    named = root.get("profile")
    profile = (str(named.value), named.span) if named is not None and named.kind == "string" else None
    whole = _without(root, found)
    return (PlanText(whole, ids, profile) if whole else None), said


def check_plan(
    text: PlanText, source: Source, profile: Profile, sources: Sources
) -> tuple[SkillPlan | None, Diagnostics]:
    """The plan with its values as the skill bank has them; None where there are errors.

    `sources` are the texts of the profile's files. Steps stand in the plan in an order that `after` allows;
    what a step leaves out is its skill's, and what is known before it follows from the steps before.
    """
    module = Module(None, (), (), Span(source.file, 0, 0))
    context = make_context(module, source, profile, CheckOptions(sources=sources))
    plan, said = plan_from_json(text.root, _argument_types(context))
    reporter = Reporter(sources)
    check_references(text.root, text.steps, reporter)
    check_bounds(plan.constraints, reporter)
    check_works(plan.steps, text.root, reporter)
    check_facts(text.root, context)
    order = in_order(plan.steps, text.root, reporter)
    steps = StepChecker(context, source, text.root).check(plan, order)
    known = precedence(steps)
    if known is not None:
        check_overlaps(known, text.root, context.registry, reporter)
        check_meanwhile(known, text.root, context.registry, reporter)
    found = (*said, *reporter.diagnostics, *context.reporter.diagnostics)
    diagnostics = first_ones(in_json(item, source) for item in found)
    if has_errors(diagnostics):
        return None, diagnostics
    return replace(plan, profile=plan.profile or profile.name, steps=steps), diagnostics


def _argument_types(context: Context) -> ArgumentType:
    skills = context.registry.skills.values()
    types = {(skill.name, spec.name): spec.type for skill in skills for spec in skill.args}

    def type_of(skill: str, argument: str) -> str | None:
        return types.get((skill, argument))

    return type_of


@cache
def _schema() -> Any:
    path = Path(forms.__file__).with_name("plan.schema.json")
    return json.loads(path.read_text(encoding="utf-8"))


def _ids(root: JsonNode) -> dict[str, Span]:
    steps = root.get("skill_calls")
    ids = [step.get("step_id") for step in steps.elements] if steps is not None else []
    found: dict[str, Span] = {}
    for item in ids:
        if item is not None and isinstance(item.value, str):
            found.setdefault(item.value, item.span)
    return found


def _without(root: JsonNode, found: tuple[Violation, ...]) -> JsonNode | None:
    """The tree without what violates the schema; None where no list of steps is left.

    Of a step only the key is taken out that is wrong, unless the step cannot be understood without it.
    """
    pointers = {item.pointer for item in found}
    keys = {pointer[0] for pointer in pointers if pointer and (pointer[0] not in _LISTS or len(pointer) == 1)}
    if root.kind != "object" or "skill_calls" not in root.items or "skill_calls" in keys:
        return None
    items = {key: item for key, item in root.items.items() if key not in keys}
    for name in _LISTS:
        if name in items:
            inside = {pointer[1:] for pointer in pointers if len(pointer) > 1 and pointer[0] == name}
            items[name] = replace(items[name], elements=_whole(items[name].elements, inside))
    return replace(root, items=items)


def _whole(members: list[JsonNode], wrong: set[Pointer]) -> list[JsonNode]:
    lost = {pointer[0] for pointer in wrong if len(pointer) == 1 or pointer[1] in _NEEDED}
    dropped: dict[str | int, set[str | int]] = {}
    for pointer in wrong:
        dropped.setdefault(pointer[0], set()).update(pointer[1:2])
    kept = [(index, member) for index, member in enumerate(members) if index not in lost]
    return [_but(member, dropped.get(index, set())) for index, member in kept]


def _but(node: JsonNode, keys: set[str | int]) -> JsonNode:
    return replace(node, items={key: item for key, item in node.items.items() if key not in keys})
