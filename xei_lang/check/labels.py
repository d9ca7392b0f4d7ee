"""Which steps a label stands for where it can be seen: in its block, and by turns and dots from outside."""

from __future__ import annotations

from xei_lang.check.report import Reporter, meant
from xei_lang.diagnostics import did_you_mean
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Attr, Expression, Index, Name, Number, Range, StepRef


@record
class Extent(Shown):
    """From the first to the last steps that a label covers; several only where some of them may overlap."""

    firsts: tuple[str, ...]
    lasts: tuple[str, ...]


Found = Extent | None
"""What a label leads to: None where it covers no step (an empty block, or something that is not compiled)."""

_Frame = dict[tuple[str, str], Found]


class Labels:
    """Labels seen so far, block in block; a key is a label and the rest of the path (`[2].pour`)."""

    def __init__(self) -> None:
        self._frames: list[_Frame] = [{}]

    def open(self) -> None:
        """A block begins."""
        self._frames.append({})

    def close(self, turn: int | None = None) -> None:
        """A block without a label ends; from outside, what a loop did in a turn is called `label[turn]`."""
        inner = self._frames.pop()
        mark = "" if turn is None else f"[{turn}]"
        for (label, rest), found in inner.items():
            self._frames[-1][label, mark + rest] = found

    def close_named(self, label: str | None, mark: str = "") -> None:
        """A block with a label, or a procedure's body, ends; without a label nothing inside can be seen."""
        inner = self._frames.pop()
        if label is not None:
            for (name, rest), found in inner.items():
                self._frames[-1][label, f"{mark}.{name}{rest}"] = found

    def branch(self) -> Labels:
        """Labels for a branch that sees those so far, and that others do not see before `join`."""
        inner = Labels()
        inner._frames = [*self._frames, {}]
        return inner

    def join(self, branch: Labels) -> None:
        """Take over what a branch named."""
        self._frames[-1].update(branch._frames[-1])

    def add(self, label: str, found: Found, mark: str = "") -> None:
        """A labelled step or block has ended."""
        self._frames[-1][label, mark] = found

    def hide(self) -> Labels:
        """Labels for the body of a procedure, which sees none of its caller's; see `reveal`."""
        return Labels()

    def reveal(self, inner: Labels, label: str | None) -> None:
        """Take over what a procedure's body named, under the label of its call."""
        self._frames.append(inner._frames[0])
        self.close_named(label)

    def knows(self, node: StepRef) -> bool:
        """Whether a reference leads to an earlier step, or is none that could."""
        path = _path(node)
        return path is None or any(path in frame for frame in self._frames)

    def find(self, node: StepRef, reporter: Reporter) -> Found:
        """What a reference to an earlier step covers; None too where there is none, which is reported."""
        path = _path(node)
        if path is None:
            reporter.report(
                "XEI0211",
                "a step is named by its label",
                node.span,
                "expected a label, as `a`, `a[2]`, `a.b`",
            )
            return None
        for frame in reversed(self._frames):
            if path in frame:
                return frame[path]
        known = [label + rest for frame in self._frames for label, rest in frame]
        written = path[0] + path[1]
        turns = [name for name in known if name.startswith(written + "[")]
        help = (
            (f"it stands in a loop: name the turn, `{turns[-1]}`",)
            if turns
            else meant(did_you_mean(written, known))
        )
        reporter.report(
            "XEI0211",
            f"no earlier step is called `{written}`",
            node.span,
            "expected the label of a step that happens before this one",
            help=help,
        )
        return None


def _path(node: Expression | Range) -> tuple[str, str] | None:
    match node:
        case Name():
            return node.id, ""
        case Attr():
            before = _path(node.value)
            return before and (before[0], f"{before[1]}.{node.name.id}")
        case Index(index=Number(value=int() as number)):
            before = _path(node.value)
            return before and (before[0], f"{before[1]}[{number}]")
        case _:
            return None
