"""What a plan says is known, as far as names go: hands hold objects, objects are in hands or at places."""

from __future__ import annotations

from xei_lang.check.context import Context
from xei_lang.check.plan_file.expressions import AsExpression
from xei_lang.check.report import meant
from xei_lang.check.scope import Scope, Usage
from xei_lang.check.state import EITHER, NOTHING
from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.forms.json_tree import JsonNode


def check_facts(root: JsonNode, context: Context) -> None:
    """Report hands, objects and places of the initial state that there are not, and of each step's state."""
    arms = (*context.registry.arms, EITHER)
    known: dict[str, tuple[str, ...]] = {"holding": arms, "at": tuple(context.registry.objects)}
    seen: set[tuple[str, str, object]] = set()
    states = [step.get("state_before") for step in root.items["skill_calls"].elements]
    for state in (root.get("initial_state"), *states):
        for variable, subjects in known.items():
            facts = state.get(variable) if state else None
            if facts is None:
                continue
            for subject, item in facts.items.items():
                if (variable, subject, item.value) not in seen:
                    seen.add((variable, subject, item.value))
                    _fact(facts, subject, subjects, item, context)


def _fact(facts: JsonNode, subject: str, subjects: tuple[str, ...], item: JsonNode, context: Context) -> None:
    if subject not in subjects:
        near = did_you_mean(subject[:200], subjects)
        context.reporter.report(
            "XEI0202",
            f"`{subject[:80]}` is not known here",
            facts.keys[subject],
            "no object or hand has this name",
            help=meant(near),
        )
    for value in item.elements if item.kind == "array" else [item]:
        node = AsExpression("lower").of(value, None)
        if node is not None and value.value not in (*context.registry.arms, EITHER, NOTHING):
            context.evaluator.value(node, Scope(Usage()))
