"""What a protocol declares and gives before and between its steps, and where that may not stand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check.plan_builder import Where
from xei_lang.check.scope import Scope
from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import Given, GivenContains, Member, ObjectDecl, Param, ProfileDecl

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def declare(expander: Expander, member: Member, scope: Scope, where: Where) -> None:
    """Take in a declaration, or what is given, where it may stand."""
    match member:
        case Param():
            _param(expander, member, scope, where)
        case ObjectDecl():
            expander.context.binder.object(member, scope, expander.state)
        case Given() | GivenContains() if where.origin:
            _misplaced(expander, member.span, "what is given is said by the protocol, not by a procedure")
        case Given():
            expander.context.givens.given(member, scope, expander.state)
        case GivenContains():
            expander.context.givens.contains(member, scope, expander.state)
        case ProfileDecl() if where.origin:
            _misplaced(expander, member.span, "a profile is named by the protocol, not by a procedure")
        case _:
            pass


def _param(expander: Expander, member: Param, scope: Scope, where: Where) -> None:
    if where.origin:
        _misplaced(expander, member.span, "a procedure declares its parameters in parentheses after its name")
    expander.context.binder.param(member, scope, expander.state)


def _misplaced(expander: Expander, span: Span, message: str) -> None:
    expander.context.reporter.report("XEI0212", message, span, "not allowed inside a procedure")
