"""What `volume(thing)` is worth in an expression: what the thing nominally holds at that point."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.expectation import Expectation
from xei_lang.check.values import POISON, ObjectValue, Poison, Val
from xei_lang.check.volumes import WRONG, Amount
from xei_lang.diagnostics import Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import CallExpr, Name

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander
    from xei_lang.check.state import State


@record
class Read(Shown):
    """A volume that was asked for in a branch which may overlap with others."""

    thing: str
    span: Span


class Nominal:
    """Answers what expressions outside of conditions ask of the state: volumes, and nothing else."""

    def __init__(self, expander: Expander) -> None:
        self._expander = expander

    def value(self, function: Name, node: CallExpr, subject: Val) -> Val:
        """The nominal volume; POISON where it is not known, which is reported."""
        reporter = self._expander.context.reporter
        if function.id != "volume":
            reporter.report(
                "XEI0319",
                f"`{function.id}` can only be asked for in a condition",
                function.span,
                "not known as a value",
                help=(f"require it, as in `require {function.id}(...) == ...`",),
            )
            return POISON
        if len(node.args) != 1:
            reporter.report("XEI0319", "`volume` takes one argument", node.span, "as in `volume(tube_1)`")
            return POISON
        expected = Expectation("`volume`", "object")
        state = self._expander.state
        thing = self._expander.context.types.coerce(subject, expected, node.args[0].value, state)
        return self._of(thing, node) if isinstance(thing, ObjectValue) else POISON

    def _of(self, thing: ObjectValue, node: CallExpr) -> Val:
        expander = self._expander
        if expander.overlapping:
            expander.reads.append(Read(thing.name, node.span))
        amount = expander.state.volumes.get(thing.name)
        if isinstance(amount.value, Poison):
            self._unknown(thing, amount, node)
        return amount.value

    def _unknown(self, thing: ObjectValue, amount: Amount, node: CallExpr) -> None:
        expander = self._expander
        is_open = bool(amount.labels) and expander.context.options.open_bindings
        if expander.alone or amount is WRONG or is_open:
            return
        given = f"`given volume({thing.name}) == 0 mL`"
        expander.context.reporter.report(
            "XEI0324",
            f"`volume({thing.name})` is not known here",
            node.span,
            "depends on what is not known before the run" if amount.labels else "nothing says what it holds",
            labels=amount.labels,
            help=() if amount.labels else (f"say before the first step what it holds, as in {given}",),
            about=thing.name,
        )


def check_reads(expander: Expander, reads: list[list[Read]], base: State, states: list[State]) -> None:
    """Report each volume that one branch asks for and another one, which may overlap, changes."""
    changers: dict[str, list[int]] = {}
    for number, state in enumerate(states):
        for name in state.volumes.changed_since(base.volumes):
            changers.setdefault(name, []).append(number)
    for number, asked in enumerate(reads):
        for read in asked:
            other = next((i for i in changers.get(read.thing, ())[:2] if i != number), None)
            if other is not None:
                expander.context.reporter.report(
                    "XEI0324",
                    f"`volume({read.thing})` is not known here, as something that may overlap changes it",
                    read.span,
                    "asked for here",
                    labels=states[other].volumes.get(read.thing).labels[-1:],
                    help=("ask for it before, with `let`, or do the two one after the other",),
                    about=read.thing,
                )
