"""What the rules of a contract say for certain of one state: that it is or is not a value, or lies between
bounds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from xei_lang.diagnostics import Span
from xei_lang.profiles.model import SkillRule, SkillSpec
from xei_lang.quantity import Quantity
from xei_lang.record import Record, record
from xei_lang.syntax import ast

Key = tuple[str, str]
"""A state and the argument that it is of: `("cap", "object")`."""

_MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}


@record
class Fact(Record):
    """`state(subject) op value`, where `value` is written in a rule; `span` is the whole comparison.

    `source` is the part of the contract that says so: `requires` or `ensures`.
    """

    key: Key
    op: str
    value: ast.Expression
    span: Span
    source: str

    @property
    def text(self) -> str:
        """The state as it is written."""
        return f"{self.key[0]}({self.key[1]})"


def key_of(node: ast.Expression) -> Key | None:
    """The state that an expression is, or None."""
    if isinstance(node, ast.CallExpr) and isinstance(node.function, ast.Name) and len(node.args) == 1:
        subject = node.args[0].value
        return (node.function.id, subject.id) if isinstance(subject, ast.Name) else None
    return None


def facts_of(rules: Iterable[SkillRule], source: str) -> Iterator[Fact]:
    """The comparisons that must hold: those of a rule, and of both sides of an `and`."""
    waiting = [rule.predicate for rule in rules]
    while waiting:
        node = waiting.pop(0)
        if isinstance(node, ast.BoolOp) and node.op == "and":
            waiting[:0] = [node.left, node.right]
        elif isinstance(node, ast.Compare):
            left, right = key_of(node.left), key_of(node.right)
            if left is not None:
                yield Fact(left, node.op, node.right, node.span, source)
            elif right is not None:
                yield Fact(right, _MIRRORED[node.op], node.left, node.span, source)


def rule_out(skill: SkillSpec, one: Fact, other: Fact) -> bool:
    """Whether two facts of one state cannot both hold, whatever is given for the arguments."""
    if ast.equal_up_to_spans(one.value, other.value):
        return frozenset((one.op, other.op)) in _OPPOSITES
    if one.op == other.op == "==" and _differ(skill, one.value, other.value):
        return True
    return _apart(skill, one, other) or _apart(skill, other, one)


_OPPOSITES = frozenset(
    frozenset(pair) for pair in (("==", "!="), ("==", "<"), ("==", ">"), ("<", ">"), ("<", ">="), (">", "<="))
)


def _differ(skill: SkillSpec, one: ast.Expression, other: ast.Expression) -> bool:
    """Whether two values are surely not the same: two words, or `nothing` and an object."""
    for first, second in ((one, other), (other, one)):
        if isinstance(first, ast.Name) and skill.arg(first.id) is None and isinstance(second, ast.Name):
            arg = skill.arg(second.id)
            return first.id != second.id and (arg is None or (arg.type == "object" and first.id == "nothing"))
    if isinstance(one, ast.Bool) and isinstance(other, ast.Bool):
        return one.value != other.value
    return False


def _apart(skill: SkillSpec, low: Fact, high: Fact) -> bool:
    """Whether the one fact keeps a quantity above all that the other admits."""
    least, most = bounds(skill, low.value)[0], bounds(skill, high.value)[1]
    if low.op not in ("==", ">", ">=") or high.op not in ("==", "<", "<=") or least is None or most is None:
        return False
    strict = low.op == ">" or high.op == "<"
    return least > most or (strict and least == most)


def bounds(skill: SkillSpec, node: ast.Expression) -> tuple[Fraction | None, Fraction | None]:
    """The least and the most that a value can be, in SI units; None where nothing bounds it."""
    match node:
        case ast.QuantityLit():
            return node.value.value, node.value.value
        case ast.Number():
            return Fraction(node.value), Fraction(node.value)
        case ast.Name():
            arg = skill.arg(node.id)
            if arg is not None:
                return _value(arg.min), _value(arg.max)
        case _:
            pass
    return None, None


def _value(quantity: Quantity | None) -> Fraction | None:
    return None if quantity is None else quantity.value
