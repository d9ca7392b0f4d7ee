"""The steps of a plan that call no skill: each has one argument, of the type that its statement takes."""

from __future__ import annotations

from xei_lang.check.blank import says_something
from xei_lang.check.context import Context
from xei_lang.check.expectation import Expectation
from xei_lang.check.plan_file.expressions import AsExpression
from xei_lang.check.scope import Scope, Usage
from xei_lang.check.state import State
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_read import STATEMENTS
from xei_lang.ir.skill_plan import StepKind


def check_statement(kind: StepKind, node: JsonNode, context: Context, state: State) -> None:
    """Report arguments that a kind of step does not have, the one that is missing, a wrong value of it."""
    name, type_ = STATEMENTS[kind]
    args = node.get("args")
    if kind == "stop" and args is not None and "message" in args.keys:
        name, type_ = "message", "String"  # it ends the run, and no instrument's work
    for other, span in args.keys.items() if args else ():
        if other != name:
            message = f"`{kind}` has no argument `{other[:80]}`"
            context.reporter.report("XEI0301", message, span, f"expected `{name}`")
    given = args.get(name) if args else None
    if given is None:
        said = node.items["skill"].span
        context.reporter.report("XEI0302", f"`{kind}` needs the argument `{name}`", said, f"`{name}` missing")
        return
    _value(given, f"`{kind}`", type_, context, state)


def _value(node: JsonNode, what: str, type_: str, context: Context, state: State) -> None:
    if type_ == "Step":
        if node.kind != "string":
            context.reporter.report("XEI0305", f"{what} takes the id of a step", node.span, "expected a text")
        return
    for end in ("lower", "upper") if "measured" in node.items else ("lower",):
        value = AsExpression(end).of(node, type_)
        if value is None:
            return
        if type_ == "Time":
            context.clauses.duration(value, what, Scope(Usage()), state)
        else:
            found = context.evaluator.value(value, Scope(Usage()))
            found = context.types.coerce(found, Expectation(what, type_), value, state)
            says_something(found, what, node.span, context.reporter)
