"""The parts of a protocol planned one after the other, each from where the one before it has ended; a part
may be gone back to.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.goals import MotionGoal
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.ahead import look_ahead
from xei_lang.motion.sequence.assemble import Untimed, time_motion
from xei_lang.motion.sequence.blame import blame_timing
from xei_lang.motion.sequence.blame_carry import refuse_tilted
from xei_lang.motion.sequence.blame_way import blame_path
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import Failure
from xei_lang.motion.sequence.fixed import plan_fixed
from xei_lang.motion.sequence.group import plan_group
from xei_lang.motion.sequence.meeting import taken_from
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.runs import awaited
from xei_lang.motion.sequence.sections import Part
from xei_lang.motion.sequence.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class _Begun:
    """How things stand before a part, and how many goals were planned by then."""

    now: Snapshot
    planned: int


class Course:
    """What is planned so far: `motions` and `timed` in one order, up to before the part `index`."""

    def __init__(self, context: Context, parts: tuple[Part, ...], start: Snapshot) -> None:
        self.context, self.parts, self.now = context, parts, start
        self.index = 0
        self.motions: list[Motion] = []
        self.timed: list[TimedGoal] = []
        self._begun: list[_Begun] = []
        self._together: set[int] = set()
        self._failed: tuple[int, Failure, int] | None = None

    def advance(self) -> Diagnostic | Failure | None:
        """Plan and time the next part; what stands in its way where that fails."""
        self._begun[self.index :] = [_Begun(self.now, len(self.timed))]
        motions = self._plan_part()
        if not isinstance(motions, tuple):
            return motions
        for planned in motions:
            start_s = self.timed[-1].end_s if self.timed else 0.0
            motion = awaited(planned, self.motions, self.timed, start_s)
            goal = time_motion(self.context, motion, start_s)
            if isinstance(goal, Untimed):
                return blame_timing(self.context, goal)
            self.timed.append(goal)
            self.motions.append(motion)
        self.now, self.index = motions[-1].after, self.index + 1
        return None

    def go_back(self, failure: Failure) -> bool:
        """Go back to where the other hand took what the failed part takes from it, to choose the two grasps
        together; False where that was tried, or nothing is handed over.
        """
        origin = taken_from(self.parts, self.index)
        if origin is None or self.index in self._together:
            return False
        self._together.add(self.index)
        self._failed = (self.index, failure, len(self.timed))
        begun = self._begun[origin]
        self.index, self.now = origin, begun.now
        del self.timed[begun.planned :], self.motions[begun.planned :]
        return True

    def told(self, failed: Diagnostic | Failure) -> tuple[Diagnostic | Failure, int]:
        """What to tell of a failure, and how many goals were planned by then: of the first attempt where
        the second has come no farther.
        """
        if self._failed is not None and self.index <= self._failed[0]:
            return self._failed[1:]
        return failed, len(self.timed)

    def _plan_part(self) -> tuple[Motion, ...] | Diagnostic | Failure:
        context, part, now = self.context, self.parts[self.index], self.now
        if isinstance(part, MotionGoal):
            motion = plan_fixed(context, part, now)
            return blame_path(context, part, motion, now) if isinstance(motion, PathBlocked) else (motion,)
        tilted = refuse_tilted(context, part, now)
        if tilted is not None:
            return tilted
        meeting = any(self.index < taker for taker in self._together)
        ahead = look_ahead(context, part, self.parts[self.index + 1 :], now, meeting)
        return plan_group(context, part, now, ahead)
