"""Drafts into a graph: ids, epochs and edges."""

from __future__ import annotations

from dataclasses import dataclass, field

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family
from xei_lang.ir.goals import Epoch, MotionGoal, MotionGoalGraph
from xei_lang.lower.draft import Draft
from xei_lang.lower.walk import Scene


@dataclass(slots=True)
class Assembly:
    """Collects goals step by step. The goals of a step are a chain; a step starts when the steps it is
    `after` have ended.

    `ends` keeps for each step the goals that must have ended for it to have ended.
    """

    goals: list[MotionGoal] = field(default_factory=list[MotionGoal])
    edges: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])
    families: list[Family] = field(default_factory=list[Family])
    epochs: list[Epoch] = field(default_factory=list[Epoch])
    ends: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])

    def add(
        self,
        step_id: str,
        span: Span,
        *,
        after: tuple[str, ...],
        before: Scene,
        drafts: tuple[Draft, ...],
    ) -> None:
        """Append a step's goals. A goal belongs to the epoch that it starts in."""
        last = tuple(dict.fromkeys(goal for step in after for goal in self.ends.get(step, ())))
        scene = before
        for number, draft in enumerate(drafts, start=1):
            goal = _goal(f"{step_id}/{number}", step_id, span, scene, draft)
            self.goals.append(goal)
            self.edges.extend((earlier, goal.id) for earlier in last)
            last, scene = (goal.id,), draft.scene
            self._note(scene.epoch)
        self.ends[step_id] = last

    def graph(self) -> MotionGoalGraph:
        """The finished graph."""
        return MotionGoalGraph(tuple(self.goals), tuple(self.edges), tuple(self.families), tuple(self.epochs))

    def _note(self, epoch: Epoch) -> None:
        if epoch.index >= len(self.epochs):
            self.epochs.append(epoch)


def _goal(goal_id: str, step_id: str, span: Span, scene: Scene, draft: Draft) -> MotionGoal:
    return MotionGoal(
        goal_id,
        step_id,
        draft.kind,
        draft.action,
        scene.epoch.index,
        draft.resources,
        span,
        draft.parameters,
        draft.contacts,
        scene.provisional,
        draft.min_duration_s,
        draft.max_duration_s,
    )
