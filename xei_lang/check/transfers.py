"""What skills do to volumes: `volume(source) -= volume` and the like, among what they ensure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from typing import Literal

from xei_lang.check import arithmetic
from xei_lang.check.state import State
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, ListValue, ObjectValue, Val, number
from xei_lang.check.volumes import NEVER_SAID, WRONG
from xei_lang.diagnostics import Label, Span
from xei_lang.profiles.model import SkillSpec
from xei_lang.quantity import DimensionError
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Binary, CallExpr, Expression, Name, Number, QuantityLit, Unary, Update

_VOLUME = "volume"


@record
class Transfer(Shown):
    """`volume(subject) op value`, the subject being the name of an argument."""

    subject: str
    op: Literal[":=", "+=", "-="]
    value: Expression

    @property
    def amount(self) -> str | None:
        """The name of the argument that says how much is added or taken, where one alone does."""
        return self.value.id if self.op != ":=" and isinstance(self.value, Name) else None


def transfers_of(skill: SkillSpec) -> tuple[Transfer, ...]:
    """What a skill does to volumes, in the order of the skill bank."""
    found: list[Transfer] = []
    for rule in skill.ensures:
        update = rule.predicate
        if not isinstance(update, Update) or not isinstance(update.target, CallExpr):
            continue
        function, args = update.target.function, update.target.args
        if isinstance(function, Name) and function.id == _VOLUME and len(args) == 1:
            subject = args[0].value
            if isinstance(subject, Name):
                found.append(Transfer(subject.id, update.op, update.value))
    return tuple(found)


def apply_transfers(
    transfers: Sequence[Transfer], args: Mapping[str, Val | None], state: State, skill: str, at: Span
) -> None:
    """Bring the volumes from before a step to after it. Every value is that from before the step."""
    values = [_evaluate(transfer.value, args, state) for transfer in transfers]
    is_wrong = POISON in args.values()
    for transfer, value in zip(transfers, values, strict=True):
        subject = args.get(transfer.subject)
        things = subject.items if isinstance(subject, ListValue) else (subject,)
        shares = value.items if isinstance(value, ListValue) else (value,) * len(things)
        if len(shares) != len(things):
            shares = (POISON,) * len(things)
        for thing, share in zip(things, shares, strict=True):
            if isinstance(thing, ObjectValue):
                before = state.volumes.get(thing.name)
                wrong = share is POISON and is_wrong and before is not NEVER_SAID
                if wrong:
                    state.set_volume(thing.name, WRONG)
                else:
                    _change(thing.name, transfer.op, share, state, skill, at)


def _change(name: str, op: str, share: Val, state: State, skill: str, at: Span) -> None:
    before = state.volumes.get(name)
    if (before is NEVER_SAID or before is WRONG) and op != ":=":
        return
    after = share if op == ":=" else _combine(op[0], before.value, share)
    words = "leaves a volume that is not known" if after is POISON else f"leaves {show(after)}"
    state.set_volume(name, before.then(after, Label(at, f"`{skill}` {words} in `{name}`")))


def _combine(op: str, left: Val, right: Val) -> Val:
    if left is POISON or right is POISON:
        return POISON
    try:
        return arithmetic.combine(op, left, right)
    except (DimensionError, ArithmeticError, TypeError):
        return POISON


def _evaluate(node: Expression, args: Mapping[str, Val | None], state: State) -> Val:  # noqa: PLR0911
    """The value of a skill bank's expression over the arguments; POISON for what has none."""
    match node:
        case Name():
            value = args.get(node.id)
            return POISON if value is None else value
        case QuantityLit():
            return node.value
        case Number():
            return number(node.value)
        case Unary(op="-"):
            value = _evaluate(node.operand, args, state)
            return arithmetic.negate(value) if arithmetic.is_numeric(value) else POISON
        case Binary():
            return _combine(node.op, _evaluate(node.left, args, state), _evaluate(node.right, args, state))
        case CallExpr(function=Name(id=function)) if len(node.args) == 1:
            return _called(function, _evaluate(node.args[0].value, args, state), state)
        case _:
            return POISON


def _called(function: str, value: Val, state: State) -> Val:
    if function == _VOLUME and isinstance(value, ObjectValue):
        return state.volumes.get(value.name).value
    if isinstance(value, ListValue) and function == "len":
        return len(value.items)
    if isinstance(value, ListValue) and function == "sum" and value.items:
        return reduce(lambda left, right: _combine("+", left, right), value.items)
    return POISON
