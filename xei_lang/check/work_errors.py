"""What is said of instruments that are started, ended or touched wrongly."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from xei_lang.check.report import Reporter, listed
from xei_lang.check.touch import Touch
from xei_lang.check.works import Work
from xei_lang.diagnostics import Fix, Label, Span
from xei_lang.ir.skill_plan import Step as PlanStep
from xei_lang.profiles.model import SkillSpec
from xei_lang.syntax.ast import Module, Name, Parallel, Start, Step, StepRef, walk

_DONE = {"await": "awaited", "stop": "stopped", "leave": "left", "pause": "paused"}
_RULE = "rule: every `start` ends in exactly one `await`, `stop` or `leave`"


def never_ended(reporter: Reporter, work: Work) -> None:
    """A start that no step ends."""
    if work.label:
        name = work.label if "#" in work.step_id else work.step_id
        help = f"end it by `await {name}` or `stop {name}`; `leave {name}` lets it outlive the protocol"
    else:
        help = f"give it a label, `start work: {work.skill.name}(...)`, and end it by `await work`"
    reporter.report(
        "XEI0340",
        f"{work.words} is started and never ended",
        work.span,
        "started here",
        labels=_calls(reporter, work),
        notes=(_RULE,),
        help=(help,),
    )


def ended_before(
    reporter: Reporter, work: Work, named: StepRef, kind: str, before: Span | None, fix: Fix | None
) -> None:
    """An end, or a pause, of what has ended already; or of what was started in the other branch.

    `fix` takes the step away, where that changes nothing else.
    """
    if before is None:
        torn(reporter, work, None, named.span)
        return
    same = before.start <= named.span.start < before.end and before.file == named.span.file
    ends = () if same else (Label(before, "ended here"),)
    reporter.report(
        "XEI0341",
        f"{work.words} is {_DONE[kind]} after it has ended",
        named.span,
        "ended here in each turn" if same else "has ended by then",
        labels=(Label(work.span, "started here"), *ends),
        notes=(_RULE,),
        help=("leave this step out" if not same else "start it in the loop, or end it behind the loop",),
        fix=None if same else fix,
    )


def torn(reporter: Reporter, work: Work, end: Span | None, at: Span | None) -> None:
    """A start, or an end, that only one branch of a choice has; `at` is a later end."""
    what, help = "started", "start it before the choice, or end it in the branch that starts it"
    if end is not None:
        what, help = "ended", "end it behind the choice, or in each of its branches"
    others = (Label(end, "ended here, in one branch"),) if end is not None else ()
    here = () if at is None else (Label(work.span, "started here"),)
    reporter.report(
        "XEI0342",
        f"{work.words} is {what} in only one branch of a choice",
        at or work.span,
        "may have ended before" if at and end else "may not have started" if at else "started here",
        labels=(*here, *others, *_calls(reporter, work)),
        notes=(_RULE,),
        help=(help,),
    )


def not_started(
    reporter: Reporter,
    named: StepRef,
    words: str,
    kind: str,
    steps: Sequence[PlanStep],
    works: Sequence[Work],
) -> None:
    """An end of a step, called `words`, that is no start."""
    spans = dict.fromkeys(step.span for step in steps)
    inside = tuple(work.step_id for work in works if work.step_id.startswith((f"{words}.", f"{words}[")))
    names = tuple(dict.fromkeys(work.step_id for work in works if "#" not in work.step_id))
    help = inside or names
    reporter.report(
        "XEI0343",
        f"`{words}` is {_DONE[kind]}, and was not started",
        named.span,
        "expected the label of a `start`",
        labels=() if inside else tuple(Label(span, f"`{words}` ends by itself") for span in spans)[:2],
        help=(f"what was started before: {listed(help)}",) if help else ("begin it with `start`",),
    )


def too_early(reporter: Reporter, named: StepRef, kind: str, module: Module) -> bool:
    """Report an end of what is only started later, or in another branch; False where nothing is."""
    if not isinstance(named, Name):
        return False
    found = next(_starts(module, named.id), None)
    if found is None:
        return False
    later = found.span.start > named.span.start
    if not later and not _apart(module, found.span, named.span):
        return False
    reporter.report(
        "XEI0343",
        f"`{named.id}` is {_DONE[kind]} before it is started"
        if later
        else f"`{named.id}` is {_DONE[kind]} in another branch than it is started in",
        named.span,
        "has not started by then" if later else "may not have started by then",
        labels=(Label(found.span, "started here"),),
        help=("move it behind the start",)
        if later
        else ("end it in the same branch, or behind all of them",),
    )
    return True


def already(reporter: Reporter, work: Work, instrument: str, span: Span) -> None:
    """An instrument that is started, or used, while it works."""
    same = work.span.start <= span.start < work.span.end and work.span.file == span.file
    left = "it was left to itself, so nothing more can be done with it" if work.left else ""
    help = left or (
        f"end it first, by `await {work.label}`" if work.label else "give the first start a label, and end it"
    )
    reporter.report(
        "XEI0344",
        f"`{instrument}` already works",
        span,
        "started again, in the next turn or call" if same else "cannot do this as well",
        labels=() if same else (Label(work.span, "works since here"),),
        notes=(reporter.rule(work.skill.span),),
        help=(help,),
    )


def touched(reporter: Reporter, work: Work, touch: Touch) -> None:
    """A step that touches what an instrument holds while it works."""
    rule = work.skill.occupies_span or work.skill.span
    name = work.label
    ways = f"behind `await {name}`, or inside of `pause {name} {{ }}`" if name else "before it is started"
    reporter.report(
        "XEI0345",
        f"`{touch.thing}` is touched while {work.words} goes on",
        touch.span,
        touch.how if touch.thing != touch.held else f"is held by {work.words}",
        labels=(Label(work.span, f"`{work.skill.name}` holds `{touch.held}` from here on"),),
        notes=(f"{reporter.rule(rule)}, `{work.skill.name}` is not `touchable` while it works",),
        help=("do this before the start" if work.left else f"do this {ways}",),
    )


def not_startable(reporter: Reporter, callee: Name, skill: SkillSpec | None, known: tuple[str, ...]) -> None:
    """A `start` of what does not work on its own."""
    if skill is None:
        label = "a procedure; its steps happen one by one"
    elif skill.returns is not None:
        label = "gives a value back, which `measure` takes"
    else:
        label = f"done by `{skill.owner}`, not by an instrument on its own"
    reporter.report(
        "XEI0346",
        f"`{callee.id}` cannot be started",
        callee.span,
        label,
        notes=(reporter.rule(skill.span),) if skill else (),
        help=(
            f"what can be started: {listed(known, 12)}" if known else "no skill of this robot can be started",
        ),
    )


def paused(reporter: Reporter, work: Work, named: StepRef, kind: str) -> None:
    """An end, or a second pause, inside of a pause."""
    assert work.paused is not None
    head = Span(work.paused.file, work.paused.start, work.paused.start + len("pause"))
    reporter.report(
        "XEI0347",
        f"{work.words} is {_DONE[kind]} inside of its pause",
        named.span,
        "is paused here",
        labels=(Label(head, "paused from here to the end of the block"), Label(work.span, "started here")),
        help=("move it behind the block of `pause`",),
    )


def _calls(reporter: Reporter, work: Work) -> tuple[Label, ...]:
    return tuple(
        Label(call.span, f"in this call of `{call.procedure}`")
        for call in reversed(work.origin)
        if call not in reporter.calls
    )


def _starts(module: Module, name: str) -> Iterator[Step]:
    for node in walk(module):
        if isinstance(node, Step) and isinstance(node.action, Start) and node.label and node.label.id == name:
            yield node


def _apart(module: Module, one: Span, other: Span) -> bool:
    """Whether two places stand in different branches of one `parallel`."""
    for node in walk(module):
        if isinstance(node, Parallel):
            places = [[_in(branch.span, span) for branch in node.branches] for span in (one, other)]
            if any(places[0]) and any(places[1]) and places[0] != places[1]:
                return True
    return False


def _in(outer: Span, inner: Span) -> bool:
    return outer.file == inner.file and outer.start <= inner.start and inner.end <= outer.end
