"""The work of instruments at one point of the plan: what was started and has not ended."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Call, Value
from xei_lang.profiles.model import SkillSpec
from xei_lang.record import Record, record


@record
class Work(Record):
    """What one `start` began.

    `step_id` is that of the start, which is step number `index` of the plan; `label` is what the text calls
    it (empty without a label), `span` covers the start. `instrument` does it, and `holds` are the objects
    that nothing else may touch meanwhile. `args` are the call's arguments by name, `origin` the calls that
    led there.

    `paused` is where it was paused, `left` says that it may outlive the protocol, `torn` that it has begun or
    ended in only one branch of a choice, `told` that a mistake about it was reported.
    """

    step_id: str
    index: int
    label: str
    span: Span
    skill: SkillSpec
    instrument: str
    holds: tuple[str, ...]
    args: tuple[tuple[str, Value], ...]
    duration_s: tuple[float, float]
    origin: tuple[Call, ...]
    paused: Span | None = None
    left: bool = False
    torn: bool = False
    told: bool = False

    @property
    def words(self) -> str:
        """What to call it in a message: its label, or else its skill."""
        return f"`{self.label or self.skill.name}`"


class Works:
    """The works that go on, by the ids of their starts. A value: each change gives the next one."""

    __slots__ = ("_running",)

    def __init__(self, running: dict[str, Work] | None = None) -> None:
        self._running: dict[str, Work] = running or {}

    def __iter__(self) -> Iterator[Work]:
        return iter(self._running.values())

    def __bool__(self) -> bool:
        return bool(self._running)

    def get(self, step_id: str) -> Work | None:
        """The work that this start began, if it goes on."""
        return self._running.get(step_id)

    def put(self, work: Work) -> Works:
        """With a work that begins, or goes on in another way."""
        return Works({**self._running, work.step_id: work})

    def drop(self, step_id: str) -> Works:
        """Without a work, which has ended."""
        return Works({key: work for key, work in self._running.items() if key != step_id})

    def join(self, other: Works) -> Works:
        """What goes on whichever of two branches was taken; what goes on after only one of them is torn."""
        if self._running is other._running:
            return self
        both = {**self._running, **other._running}
        return Works({key: _joined(work, self.get(key), other.get(key)) for key, work in both.items()})

    def adopt(self, base: Works, branch: Works) -> Works:
        """With what a branch, forked from `base`, has begun, ended or changed."""
        if base._running is branch._running:
            return self
        ended = base._running.keys() - branch._running.keys()
        kept = {key: work for key, work in self._running.items() if key not in ended}
        changed = {key: work for key, work in branch._running.items() if work is not base.get(key)}
        return Works({**kept, **changed})


def _joined(work: Work, one: Work | None, other: Work | None) -> Work:
    if one is None or other is None:
        return replace(work, torn=True)
    return replace(
        one, torn=one.torn or other.torn, told=one.told or other.told, left=one.left and other.left
    )
