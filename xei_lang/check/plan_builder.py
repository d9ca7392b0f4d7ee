"""The plan as it grows: steps in their order, their ids, notes and gaps in their places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from xei_lang.check.labels import Extent, Found
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import (
    Argument,
    Call,
    Condition,
    Fact,
    RunValue,
    SafetyNote,
    StepKind,
    TimeConstraint,
    UnmappedRequest,
)
from xei_lang.ir.skill_plan import Step as PlanStep
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Note, Require, Step, Unmapped

_Places = set[tuple[Span, tuple[Call, ...]]]


@record
class Where(Shown):
    """Where in the protocol the checker is.

    `names` are the names of the steps in this name space, `prefix` is its path with the dot,
    `indices` are the turns of the loops between it and here; `turn` counts the turns of all loops around.
    """

    names: Mapping[Span, str]
    prefix: str = ""
    indices: tuple[int, ...] = ()
    turn: tuple[int, ...] = ()
    origin: tuple[Call, ...] = ()
    branch: str = ""
    when: tuple[Condition, ...] = ()
    depth: int = 0

    def path(self, step: Step | Require) -> str:
        """The path of a step here."""
        return f"{self.prefix}{self.names[step.span]}{''.join(f'[{index}]' for index in self.indices)}"

    def in_turn(self, number: int) -> Where:
        """Inside a turn of a loop without a label."""
        return replace(self, indices=(*self.indices, number), turn=(*self.turn, number))

    def in_branch(self, branch: str) -> Where:
        """In a branch that may overlap with others."""
        return replace(self, branch=f"{self.branch}/{branch}" if self.branch else branch)

    def deeper(self) -> Where:
        """One block further in."""
        return replace(self, depth=self.depth + 1)

    def under(self, prefix: str, names: Mapping[Span, str], turn: int | None = None) -> Where:
        """Inside a name space of its own: a labelled block, a turn of a labelled loop."""
        turns = self.turn if turn is None else (*self.turn, turn)
        return replace(self, names=names, prefix=prefix, indices=(), turn=turns)

    def if_so(self, condition: Condition) -> Where:
        """Where something happens only under a condition that is not decided yet."""
        return replace(self, when=(*self.when, condition))


@dataclass(slots=True)
class PlanBuilder:
    """Collects a plan. `tails` are the steps that the next one follows; `full` says that the bound was
    reached.

    `overflow` is the loop that was reported for it, `overlaps` are the ranges of steps that may overlap,
    `skipped` the paths of steps that have nothing to do, by where their calls stand.
    """

    max_steps: int
    steps: list[PlanStep] = field(default_factory=list[PlanStep])
    constraints: list[TimeConstraint] = field(default_factory=list[TimeConstraint])
    unmapped: list[UnmappedRequest] = field(default_factory=list[UnmappedRequest])
    notes: list[SafetyNote] = field(default_factory=list[SafetyNote])
    tails: tuple[str, ...] = ()
    full: bool = False
    overflow: Span | None = None
    overlaps: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])
    skipped: dict[Span, list[str]] = field(default_factory=dict[Span, list[str]])
    _ids: dict[str, int] = field(default_factory=dict[str, int])
    _noted: _Places = field(default_factory=set[tuple[Span, tuple[Call, ...]]])

    def add(
        self,
        node: Step | Require,
        kind: StepKind,
        where: Where,
        state: tuple[Fact, ...],
        *,
        skill: str = "",
        owner: str = "",
        args: tuple[Argument, ...] = (),
        duration_s: tuple[float, float] = (0.0, 0.0),
        resources: tuple[str, ...] = (),
        needs: tuple[str, ...] = (),
    ) -> None:
        """Add a step after the tails, unless the plan is full.

        `needs` are measurements that it reads besides those of its conditions and arguments.
        """
        if len(self.steps) >= self.max_steps:
            self.full = True
            return
        step_id = self._unused(where.path(node))
        self.steps.append(
            PlanStep(
                step_id,
                kind,
                node.span,
                skill,
                owner,
                args,
                duration_s,
                self.tails,
                where.branch,
                where.turn,
                where.when,
                resources,
                state,
                where.origin,
                (),
                _needs(where.when, args, needs),
            )
        )
        self.tails = (step_id,)

    def since(self, count: int) -> Found:
        """What the steps cover that were added since there were `count` of them."""
        if len(self.steps) <= count:
            return None
        if not self.overlaps or self.overlaps[-1][1] <= count:
            return Extent((self.steps[count].step_id,), (self.steps[-1].step_id,))
        covered = self.steps[count:]
        own = {step.step_id for step in covered}
        followed = {before for step in covered for before in step.after}
        return Extent(
            tuple(step.step_id for step in covered if own.isdisjoint(step.after)),
            tuple(step.step_id for step in covered if step.step_id not in followed),
        )

    def skip(self, at: Span, path: str) -> None:
        """Note that a step is left out, as it has nothing to do."""
        self.skipped.setdefault(at, []).append(path)

    def remark(self, node: Note | Unmapped, origin: tuple[Call, ...]) -> None:
        """Keep a note or a gap in its place: once, also where it stands in a loop."""
        if (node.span, origin) in self._noted:
            return
        self._noted.add((node.span, origin))
        after = self.steps[-1].step_id if self.steps else None
        if isinstance(node, Note):
            self.notes.append(SafetyNote(node.text.value, after, node.span))
        else:
            reason = node.reason.value if node.reason else ""
            self.unmapped.append(UnmappedRequest(node.text.value, reason, after, node.span))

    def _unused(self, path: str) -> str:
        """The path itself; only the branches of a choice that is still open can share one."""
        found = path
        while found in self._ids:
            self._ids[path] += 1
            found = f"{path}~{self._ids[path]}"
        self._ids[found] = 1
        return found


def _needs(
    when: tuple[Condition, ...], args: tuple[Argument, ...], others: tuple[str, ...]
) -> tuple[str, ...]:
    """The measuring steps that a step reads, each once, in their order."""
    if not when and not others and not any(isinstance(item.value, (RunValue, tuple)) for item in args):
        return ()
    found = [name for condition in when for name in condition.needs]
    waiting = [item.value for item in reversed(args)]
    while waiting:
        value = waiting.pop()
        if isinstance(value, RunValue):
            found.extend(value.needs)
        elif isinstance(value, tuple):
            waiting.extend(reversed(value))
    return tuple(dict.fromkeys((*found, *others)))
