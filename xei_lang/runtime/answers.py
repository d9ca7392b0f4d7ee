"""Answers of people to `confirm`: written down beforehand, or asked for at a terminal."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, cast

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span


@dataclass(frozen=True, slots=True)
class Answers:
    """`given` maps a step id or the text of a question to yes or no; `ask` is the terminal, if any."""

    given: Mapping[str, bool] = field(default_factory=dict[str, bool])
    ask: Callable[[str], bool | None] | None = None

    def answer(self, step_id: str, text: str) -> bool | None:
        """Yes, no, or None where nobody can say; a step id wins over a text, both win over the terminal."""
        if step_id in self.given:
            return self.given[step_id]
        if text in self.given:
            return self.given[text]
        return self.ask(text) if self.ask else None


def parse_answers(text: str, file: str) -> tuple[Mapping[str, bool], Diagnostics]:
    """The answers of a JSON object such as `{"confirm#1": true}`; diagnostics where it is none."""
    try:
        value: Any = json.loads(text, object_pairs_hook=_once)
    except _TwiceError as error:
        message = f"`{error.args[0]}` is answered twice"
        return {}, (Diagnostic("XEI0916", message, help=("keep the answer that holds",)),)
    except json.JSONDecodeError as error:
        span = Span(file, error.pos, min(error.pos + 1, len(text)))
        return {}, (Diagnostic("XEI0916", f"`{file}` is not JSON", span, label=error.msg.lower()),)
    except RecursionError:
        return {}, (Diagnostic("XEI0916", f"`{file}` is nested too deeply"),)
    if not isinstance(value, dict):
        return {}, (Diagnostic("XEI0916", f"`{file}` is no JSON object of answers", help=(_EXAMPLE,)),)
    answers = cast(dict[str, Any], value)
    wrong = [key for key, item in answers.items() if not isinstance(item, bool)]
    if wrong:
        message = f"the answer to `{wrong[0]}` is neither true nor false"
        return {}, (Diagnostic("XEI0916", message, help=(_EXAMPLE,)),)
    return answers, ()


class _TwiceError(Exception):
    """A key that stands twice; never leaves this module."""


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    for index, (key, _) in enumerate(pairs):
        if any(key == earlier for earlier, _ in pairs[:index]):
            raise _TwiceError(key)
    return dict(pairs)


_EXAMPLE = 'write an object of step ids or questions, as in `{"confirm#1": true}`'
