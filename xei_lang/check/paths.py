"""What each step is called: its label, or its skill and a number, in the block that names it.

A labelled block, and the body of a called procedure, begins a name space of its own (`wash[2].pick#1`,
`fill.pour#1`). The blocks of loops, choices and `do` without a label belong to the name space around them,
where steps are numbered in the order of the text. Where two such blocks of one name space use the same
label, the later one is told apart by its block: `for#2.take`. The two branches of one choice may share a
label, since only one of them happens.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Label, Span
from xei_lang.syntax.ast import (
    Await,
    Block,
    Call,
    Confirm,
    Do,
    For,
    If,
    Keep,
    Leave,
    Measure,
    Member,
    Name,
    Parallel,
    Pause,
    Repeat,
    Require,
    Start,
    Step,
    Stop,
    StopRun,
    Wait,
)


def step_names(members: Iterable[Member]) -> Mapping[Span, str]:
    """The name of each step of a name space, by the span of the step."""
    naming = _Naming()
    naming.block(members, "", set())
    return naming.names


def names_of_blocks(blocks: Iterable[Block]) -> Mapping[Span, str]:
    """The names of the steps of several blocks that are one name space; a label's later use is told apart."""
    naming, taken = _Naming(), set[str]()
    for number, block in enumerate(blocks, start=1):
        naming.block(block.statements, str(number), taken)
    return naming.names


class _Naming:
    def __init__(self) -> None:
        self.names: dict[Span, str] = {}
        self._counts: dict[str, int] = {}

    def block(self, members: Iterable[Member], block: str, taken: set[str]) -> None:
        """Name the steps of a block that is no name space itself; `taken` grows by the labels used in it."""
        for member in members:
            if isinstance(member, Require):
                self.names[member.span] = self._count("require")
            if not isinstance(member, Step):
                continue
            name = label_of(member)
            if name is None:
                self._unlabelled(member, taken)
                continue
            label = name.id
            self.names[member.span] = f"{block}.{label}" if label in taken and block else label
            taken.add(label)

    def _unlabelled(self, step: Step, taken: set[str]) -> None:
        action = step.action
        name = self._count(keyword(action))
        self.names[step.span] = name
        if isinstance(action, If):
            self._choice(action, name, taken)
            return
        for inner in blocks(action):
            self.block(inner.statements, name, taken)

    def _choice(self, action: If, name: str, taken: set[str]) -> None:
        """Each branch sees only what was taken before the choice."""
        before = set(taken)
        for branch in blocks(action):
            seen = set(before)
            self.block(branch.statements, name, seen)
            taken |= seen

    def _count(self, word: str) -> str:
        self._counts[word] = self._counts.get(word, 0) + 1
        return f"{word}#{self._counts[word]}"


def label_of(step: Step) -> Name | None:
    """The name by which a step can be referred to: its label, or else what it measures."""
    return step.action.name if step.label is None and isinstance(step.action, Measure) else step.label


def keyword(action: object) -> str:
    """The word by which an action without a label is numbered: the skill that it calls, or its keyword."""
    match action:
        case Call():
            return action.callee.id
        case Start():
            return action.call.callee.id
        case _:
            return KEYWORDS[type(action)]


KEYWORDS: Mapping[type, str] = {
    Await: "await",
    Confirm: "confirm",
    Do: "do",
    For: "for",
    If: "if",
    Keep: "keep",
    Leave: "leave",
    Parallel: "parallel",
    Pause: "pause",
    Repeat: "repeat",
    Start: "start",
    Stop: "stop",
    StopRun: "stop",
    Wait: "wait",
}


def blocks(action: object) -> tuple[Block, ...]:
    """The blocks of an action, in order of the text; an `else if` counts as part of its `if`."""
    match action:
        case Do() | For() | Keep() | Pause():
            return (action.body,)
        case Repeat():
            return (action.body,) if action.otherwise is None else (action.body, action.otherwise)
        case Parallel():
            return action.branches
        case If():
            otherwise = action.otherwise
            rest = (
                blocks(otherwise) if isinstance(otherwise, If) else () if otherwise is None else (otherwise,)
            )
            return (action.body, *rest)
        case _:
            return ()


def check_labels(members: Iterable[Member], reporter: Reporter) -> None:
    """Report labels that are used twice in one block, in this block and all inside it.

    What is measured counts as a label.
    """
    for names in _labels_by_block(members):
        first: dict[str, Name] = {}
        for name in names:
            before = first.setdefault(name.id, name)
            if before is not name:
                reporter.report(
                    "XEI0210",
                    f"the label `{name.id}` is used twice in this block",
                    name.span,
                    "used again here",
                    labels=(Label(before.span, "first used here"),),
                    help=("a label names one step; give one of the two another name",),
                )


def _labels_by_block(members: Iterable[Member]) -> Iterator[list[Name]]:
    waiting: list[Iterable[Member]] = [members]
    while waiting:
        block = waiting.pop()
        labels: list[Name] = []
        for member in block:
            if isinstance(member, Step):
                label = label_of(member)
                if label is not None:
                    labels.append(label)
                waiting.extend(inner.statements for inner in blocks(member.action))
        yield labels
