"""`stop "message"`: the run ends here. What follows in its block is never reached, and a branch that ends so
says nothing of the state after it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.plan_builder import Where
from xei_lang.check.scope import Scope
from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import Argument
from xei_lang.syntax.ast import Member, Note, Step, StopRun, Unmapped, walk
from xei_lang.syntax.ast import Name as NameNode

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def stop(expander: Expander, step: Step, node: StopRun, where: Where) -> None:
    """Add the step at which the run ends, with its message."""
    text = Argument("message", node.message.value, "String", "call", node.message.span)
    expander.plan.add(step, "stop", where, expander.state.facts(), args=(text,))
    expander.state.ended = node.span


def pass_over(expander: Expander, member: Member, scope: Scope, where: Where) -> None:
    """A statement that is never reached, which is said once for each `stop`; notes and gaps are kept."""
    ended = expander.state.ended
    assert ended is not None
    for node in walk(member):
        if isinstance(node, NameNode):
            scope.find(node.id)
    if isinstance(member, Note | Unmapped):
        expander.plan.remark(member, where.origin)
    elif ended not in expander.told_ends:
        expander.told_ends.add(ended)
        expander.context.reporter.report(
            "XEI0505",
            "this is never reached",
            member.span,
            "what follows a `stop` does not happen",
            labels=(Label(ended, "the run ends here"),),
            help=("remove it, or stop only on a condition, with `if`",),
        )
