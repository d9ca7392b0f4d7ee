"""Answers of people to `confirm`: written down beforehand, or asked for at a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span, did_you_mean, has_errors
from xei_lang.ir.forms.json_reader import read_json
from xei_lang.ir.goals import Confirm, MotionGoalGraph

_SHOWN = 6


@dataclass(frozen=True, slots=True)
class Answers:
    """`given` maps a step id or the text of a question to yes or no, `written` to where that stands; `ask` is
    the terminal, if any.
    """

    given: Mapping[str, bool] = field(default_factory=dict[str, bool])
    ask: Callable[[str], bool | None] | None = None
    written: Mapping[str, Span] = field(default_factory=dict[str, Span])

    def answer(self, step_id: str, text: str) -> bool | None:
        """Yes, no, or None where nobody can say; a step id wins over a text, both win over the terminal."""
        if step_id in self.given:
            return self.given[step_id]
        if text in self.given:
            return self.given[text]
        return self.ask(text) if self.ask else None


def read_answers(source: Source) -> tuple[Answers, Diagnostics]:
    """The answers of a JSON object such as `{"confirm#1": true}`; with errors, none."""
    root, said = read_json(source)
    if root is None or has_errors(said):
        return Answers(), said
    if root.kind != "object":
        message = f"`{source.file}` is no JSON object of answers"
        label = f"expected an object, found {_A[root.kind]}"
        return Answers(), (Diagnostic("XEI0916", message, root.span, label, help=(_EXAMPLE,)),)
    wrong = tuple(
        Diagnostic(
            "XEI0916",
            f"the answer to `{key}` is neither true nor false",
            item.span,
            "expected `true` or `false`",
            help=(_EXAMPLE,),
        )
        for key, item in root.items.items()
        if item.kind != "boolean"
    )
    given = {} if wrong else {key: item.value is True for key, item in root.items.items()}
    return Answers(given, written=root.keys), wrong


def check_answers(answers: Answers, graph: MotionGoalGraph) -> Diagnostics:
    """Answers to what the plan does not ask (XEI0917): one of them may be meant for a question that it asks,
    which would stop the run half way.
    """
    return tuple(_unasked(answers, graph))


def _unasked(answers: Answers, graph: MotionGoalGraph) -> Iterator[Diagnostic]:
    asked = [(goal.step_id, goal.action.text) for goal in graph.goals if isinstance(goal.action, Confirm)]
    known = [name for question in asked for name in question]
    steps = {goal.step_id for goal in graph.goals}
    for key in answers.given:
        if key not in known:
            label = (
                "a step that asks nothing"
                if key in steps
                else "no step has this id, and no question this text"
            )
            yield Diagnostic(
                "XEI0917",
                f"`{key}` is answered, and the plan does not ask it",
                answers.written.get(key),
                label,
                help=(_meant(key, known, asked),),
            )


def _meant(key: str, known: list[str], asked: list[tuple[str, str]]) -> str:
    near = did_you_mean(key, known)
    if near:
        return f"did you mean {' or '.join(f'`{name}`' for name in near)}?"
    if not asked:
        return "the plan asks nothing: leave the answer out"
    shown = ", ".join(f"`{step_id}` ({text})" for step_id, text in asked[:_SHOWN])
    more = f" and {len(asked) - _SHOWN} more" if len(asked) > _SHOWN else ""
    return f"the plan asks {shown}{more}"


_A: Mapping[str, str] = MappingProxyType(
    {"array": "a list", "string": "a text", "number": "a number", "boolean": "true or false", "null": "null"}
)
_EXAMPLE = 'write an object of step ids or questions, as in `{"confirm#1": true}`'
