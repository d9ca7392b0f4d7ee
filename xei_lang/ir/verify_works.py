"""What must hold of the instruments that a plan starts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from xei_lang.ir.skill_plan import Step

ABOUT = ("await", "stop", "leave", "pause", "resume")
ENDS = ("await", "stop", "leave")


def work_problems(steps: Sequence[Step]) -> Iterator[str]:
    """A step that ends, pauses or resumes work follows the `start` that its argument `step` names; each start
    is ended, and only once on any way through the plan; each pause is resumed before the next.
    """
    starts = {step.step_id: index for index, step in enumerate(steps) if step.kind == "start"}
    later: dict[str, list[Step]] = {name: [] for name in starts}
    for index, step in enumerate(steps):
        if step.kind not in ABOUT or (step.kind == "stop" and step.arg("message") is not None):
            continue  # a stop with a message ends the run, and no work
        name = str(step.arg("step"))
        begun = starts.get(name)
        if begun is None or not _follows(steps, begun, index):
            yield f"step `{step.step_id}`: does not follow a start `{name}`"
        else:
            later[name].append(step)
    for name, about in later.items():
        yield from (f"step `{name}`: {problem}" for problem in _course(about))


def _course(about: list[Step]) -> Iterator[str]:
    ends = [step for step in about if step.kind in ENDS]
    if not ends:
        yield "is started and never ended"
    for index, end in enumerate(ends):
        for other in ends[index + 1 :]:
            shared = min(len(end.when), len(other.when))
            if end.when[:shared] == other.when[:shared]:
                yield f"is ended by `{end.step_id}` and by `{other.step_id}`"
    pauses = [step.kind for step in about if step.kind in ("pause", "resume")]
    if pauses != ["pause", "resume"] * (len(pauses) // 2):
        yield "is not paused and resumed in turn"


def _follows(steps: Sequence[Step], start: int, index: int) -> bool:
    """Whether `after` leads from one step back to another, by way of the steps between them."""
    wanted = set(steps[index].after)
    for step in reversed(steps[start:index]):
        if step.step_id not in wanted:
            continue
        if step.step_id == steps[start].step_id:
            return True
        wanted.update(step.after)
    return False
