"""Constructs of the language that this version reads but does not compile: each refused at its keyword, by
its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from xei_lang.check.functions import not_yet
from xei_lang.check.paths import blocks
from xei_lang.check.plan_builder import Where
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope
from xei_lang.check.values import POISON
from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import (
    Action,
    Keep,
    Measure,
    Step,
    StopRun,
)

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander

_WORDS: Mapping[type, tuple[str, str]] = {
    StopRun: ("stop", "`stop` with a message, ending the run,"),
    Keep: ("keep", "`keep`, a condition that holds throughout a block,"),
    Measure: ("measure", "`measure`, a value known only when it runs,"),
}


def refuse(reporter: Reporter, node: Action) -> None:
    """Report a construct at its keyword."""
    word, shown = _WORDS[type(node)]
    not_yet(reporter, shown, Span(node.span.file, node.span.start, node.span.start + len(word)))


def look_inside(expander: Expander, step: Step, scope: Scope, where: Where) -> None:
    """Check what a refused construct holds, for the mistakes in it, and declare what it names."""
    action = step.action
    if isinstance(action, Measure):
        expander.context.calls.check(action.call, scope, expander.state)
        scope.declare(action.name, "measurement", POISON, expander.context.reporter)
    for block in blocks(action):
        expander.named_block(step, block, scope, where)
