"""Steps of a plan that no `after` puts in order, and that use the same: the rule of `parallel`."""

from __future__ import annotations

from xei_lang.check.independence import Use, uses_of
from xei_lang.check.plan_file.precedence import Precedence
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.forms.json_tree import JsonNode

_MOST = 200
"""Of so many earlier uses of one thing it is looked whether they may overlap with the next one."""

_Used = tuple[int, Use]


def check_overlaps(order: Precedence, root: JsonNode, registry: Registry, reporter: Reporter) -> None:
    """Report two steps for each thing that steps use which may overlap; a pair of steps is told of once."""
    spans = {node.span: node.items["step_id"].span for node in root.items["skill_calls"].elements}
    last: dict[tuple[str, str], list[_Used]] = {}
    things: set[tuple[str, str]] = set()
    pairs: set[tuple[int, int]] = set()
    for place, step in enumerate(order.steps):
        for use in uses_of(step, registry):
            known = last.setdefault(use.thing, [])
            clash = _clash(known, place, use, order)
            _keep(known, place, use, order)
            if clash is None or use.thing in things:
                continue
            things.add(use.thing)
            if (clash[0], place) not in pairs:
                pairs.add((clash[0], place))
                _report(clash[1], use, spans, reporter)


def _clash(known: list[_Used], place: int, use: Use, order: Precedence) -> _Used | None:
    for other, before in known:
        if not (use.exclusive or before.exclusive) or not order.apart(other, place):
            continue
        if order.together(other, place):
            return other, before
    return None


def _keep(known: list[_Used], place: int, use: Use, order: Precedence) -> None:
    """Add a use, without those before it that can meet nothing which this one does not meet too."""
    conditions = {item.text for item in use.step.when}

    def is_met(other: int, before: Use) -> bool:
        return (
            use.exclusive >= before.exclusive
            and not order.apart(other, place)
            and conditions <= {item.text for item in before.step.when}
        )

    known[:] = [item for item in known if not is_met(*item)][-_MOST:]
    known.append((place, use))


def _report(before: Use, use: Use, spans: dict[Span, Span], reporter: Reporter) -> None:
    first, second = before.step.step_id[:80], use.step.step_id[:80]
    reporter.report(
        "XEI0330",
        f"{use.words} is used by `{first}` and `{second}`, which may overlap",
        spans.get(use.span, use.span),
        f"{use.verb} by `{second}`",
        labels=(Label(spans.get(before.span, before.span), f"{before.verb} by `{first}`"),),
        notes=("rule: what may overlap may touch no object, place, named arm or instrument together",),
        help=(f"let one come after the other: `{first}` in the `after` of `{second}`",),
        about=use.words,
    )
