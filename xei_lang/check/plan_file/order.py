"""The order of a plan's steps: each id once, references that lead somewhere, nothing waits for itself."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence

from xei_lang.check.report import Reporter, guess, meant
from xei_lang.diagnostics import Label, Span, did_you_mean
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_read import STATEMENTS, step_kind
from xei_lang.ir.skill_plan import Step, TimeConstraint

_SHOWN = 6


def check_references(root: JsonNode, known: dict[str, Span], reporter: Reporter) -> None:
    """Report ids that two steps have, and references to steps that are not in the plan."""
    for step in root.items["skill_calls"].elements:
        node = step.items["step_id"]
        first = known[str(node.value)]
        if first != node.span:
            reporter.report(
                "XEI0209",
                f"two steps have the id `{_short(node)}`",
                node.span,
                "a second step of this id",
                labels=(Label(first, "the first one"),),
                help=("give each step an id of its own",),
            )
    for node in _references(root):
        if node.value not in known:
            near = did_you_mean(str(node.value)[:200], known)
            reporter.report(
                "XEI0211",
                f"there is no step `{_short(node)}`",
                node.span,
                "no step of this plan has this id",
                help=meant(near),
                fix=guess(node.span, near),
            )


def check_bounds(constraints: Sequence[TimeConstraint], reporter: Reporter) -> None:
    """Report bounds on time that nothing can meet."""
    for constraint in constraints:
        if constraint.lower_s > constraint.upper_s:
            reporter.report(
                "XEI0322",
                f"nothing takes at least {constraint.lower_s:g} s and at most {constraint.upper_s:g} s",
                constraint.span,
                "expected `lower_s` below `upper_s`",
            )


def in_order(steps: Sequence[Step], root: JsonNode, reporter: Reporter) -> tuple[int, ...]:
    """Indices of the steps so that each follows those that it is after, and else as they stand.

    Steps that wait for each other are reported, and come last.
    """
    index = {step.step_id: number for number, step in reversed(list(enumerate(steps)))}
    waits = [{index[name] for name in step.after if name in index} for step in steps]
    followers: list[list[int]] = [[] for _ in steps]
    for number, before in enumerate(waits):
        for earlier in before:
            followers[earlier].append(number)
    left = [len(before) for before in waits]
    ready = [number for number, count in enumerate(left) if not count]
    order: list[int] = []
    while ready:
        number = heapq.heappop(ready)
        order.append(number)
        for follower in sorted(followers[number]):
            left[follower] -= 1
            if not left[follower]:
                heapq.heappush(ready, follower)
    rest = [number for number, count in enumerate(left) if count]
    if rest:
        _report_circle(_circle(rest[0], waits, set(rest)), steps, root, reporter)
    return (*order, *rest)


def _circle(start: int, waits: Sequence[set[int]], rest: set[int]) -> list[int]:
    """Steps each of which waits for the next one, and the last for the first."""
    path, place = [start], {start: 0}
    while True:
        following = min(waits[path[-1]] & rest)
        if following in place:
            return path[place[following] :]
        place[following] = len(path)
        path.append(following)


def _report_circle(circle: Sequence[int], steps: Sequence[Step], root: JsonNode, reporter: Reporter) -> None:
    nodes = [root.items["skill_calls"].elements[number] for number in circle]
    names = [f"`{_short(node.items['step_id'])}`" for node in nodes]
    shown = " after ".join((*names[:_SHOWN], *(["..."] if len(names) > _SHOWN else []), names[0]))
    alone = len(circle) == 1
    reporter.report(
        "XEI0211",
        f"step {names[0]} is after itself" if alone else f"steps wait for each other: {shown}",
        _after_span(nodes[0], steps[circle[1 % len(circle)]].step_id),
        "this leads round in a circle",
        labels=tuple(
            Label(_after_span(node, steps[circle[(i + 1) % len(circle)]].step_id), "and this one waits too")
            for i, node in enumerate(nodes[:_SHOWN])
            if i
        ),
    )


def _after_span(step: JsonNode, name: str) -> Span:
    after = step.get("after")
    named = next((item.span for item in after.elements if item.value == name), None) if after else None
    return named or step.items["step_id"].span


def _references(root: JsonNode) -> Iterator[JsonNode]:
    for step in root.items["skill_calls"].elements:
        for key in ("after", "needs"):
            listed = step.get(key)
            yield from listed.elements if listed else ()
        own, args = STATEMENTS.get(step_kind(step)), step.get("args")
        named = args.get(own[0]) if args and own and own[1] == "Step" else None
        if named is not None and named.kind == "string":
            yield named
    for key, names in (
        ("constraints", ("from_step", "to_step")),
        ("unmapped_requests", ("after_step",)),
        ("safety_notes", ("after_step",)),
    ):
        items = root.get(key)
        for item in items.elements if items else ():
            yield from (
                item.items[name] for name in names if name in item.items and item.items[name].kind == "string"
            )


def _short(node: JsonNode) -> str:
    text = str(node.value)
    return text if len(text) <= 80 else f"{text[:77]}..."
