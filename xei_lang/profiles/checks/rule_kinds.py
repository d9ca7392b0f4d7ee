"""What kind of value an expression in a contract has: a quantity, a word of a state, an object, a place.

`None` stands for what is not known here; nothing is said about that.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from xei_lang.profiles.model import ArgSpec, LabObject, Profile, SkillSpec
from xei_lang.profiles.roles import fits
from xei_lang.quantity import TYPE_DIMENSIONS, Dimension
from xei_lang.quantity.dimension import NUMBER, TEMPERATURE, TIME, VOLUME
from xei_lang.record import Record, record
from xei_lang.syntax import ast


@record
class Kind(Record):
    """A sort of value, and of quantities their dimensions, of words the words, of a name the name itself."""

    sort: str
    dimensions: tuple[Dimension, ...] = ()
    words: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """What it is, for a label."""
        match self.sort:
            case "quantity":
                return " or ".join(item.name for item in self.dimensions)
            case "states":
                return listed(self.words)
            case "word":
                return f"`{self.words[0]}`"
            case "hand":
                return "an object or `nothing`"
            case "whereabouts":
                return "a Place or an arm"
            case _:
                return {"object": "an object", "contents": "contents"}.get(self.sort, self.sort)


def listed(words: tuple[str, ...]) -> str:
    """The words that are possible, for a label."""
    return " or ".join(f"`{word}`" for word in words)


STATES: Mapping[str, tuple[str, Kind]] = MappingProxyType(
    {
        "holding": ("Arm", Kind("hand")),
        "at": ("object", Kind("whereabouts")),
        "volume": ("object", Kind("quantity", (VOLUME,))),
        "temperature": ("object", Kind("quantity", (TEMPERATURE,))),
        "age": ("object", Kind("quantity", (TIME,))),
        "contents": ("object", Kind("contents")),
        "upright": ("object", Kind("Bool")),
    }
)
"""The states that everything has: the type of what each is of, and the kind of its value."""


def states_of(profile: Profile, arg: ArgSpec) -> tuple[LabObject, ...]:
    """The objects that may be given for an argument."""
    return tuple(item for item in profile.objects if arg.roles is None or fits(arg.roles, item.roles))


def kind_of_state(profile: Profile, skill: SkillSpec, call: ast.CallExpr) -> Kind | None:
    """The kind of value that a state such as `cap(object)` has."""
    if not isinstance(call.function, ast.Name):
        return None
    if call.function.id in STATES:
        return STATES[call.function.id][1]
    subject = subject_of(skill, call)
    if subject is None:
        return None
    stated = [state for item in states_of(profile, subject) for state in item.states]
    words = dict.fromkeys(word for state in stated if state.name == call.function.id for word in state.values)
    return Kind("states", words=tuple(words)) if words else None


def subject_of(skill: SkillSpec, call: ast.CallExpr) -> ArgSpec | None:
    """The argument whose state is asked for; None where it is something else."""
    if len(call.args) == 1 and isinstance(call.args[0].value, ast.Name):
        return skill.arg(call.args[0].value.id)
    return None


def kind_of(profile: Profile, skill: SkillSpec, node: ast.Expression) -> Kind | None:
    """The kind of value that an expression of a contract has, as far as that is certain."""
    match node:
        case ast.Name():
            arg = skill.arg(node.id)
            return Kind("word", words=(node.id,)) if arg is None else _kind_of_argument(arg)
        case ast.Unary(op="-"):
            return kind_of(profile, skill, node.operand)
        case ast.Binary():
            return _kind_of_sum(profile, skill, node)
        case ast.CallExpr():
            return kind_of_state(profile, skill, node)
        case _:
            return _kind_of_literal(node)


def _kind_of_literal(node: ast.Expression) -> Kind | None:
    match node:
        case ast.QuantityLit():
            return Kind("quantity", (node.value.dimension,))
        case ast.Number():
            return Kind("quantity", (NUMBER,))
        case ast.StringLit():
            return Kind("String")
        case ast.Bool() | ast.Compare() | ast.BoolOp() | ast.Unary():
            return Kind("Bool")
        case _:
            return None


def _kind_of_argument(arg: ArgSpec) -> Kind | None:
    if arg.type in TYPE_DIMENSIONS:
        return Kind("quantity", TYPE_DIMENSIONS[arg.type])
    if arg.type in ("Int", "Float"):
        return Kind("quantity", (NUMBER,))
    if arg.type == "choice":
        return Kind("choice", words=arg.choices)
    return Kind(arg.type)


def _kind_of_sum(profile: Profile, skill: SkillSpec, node: ast.Binary) -> Kind | None:
    left, right = (kind_of(profile, skill, side) for side in (node.left, node.right))
    if left is None or right is None or len(left.dimensions) != 1 or len(right.dimensions) != 1:
        return None
    one, other = left.dimensions[0], right.dimensions[0]
    if node.op in ("+", "-"):
        return left
    if one.point or other.point:
        return None
    return Kind("quantity", (one.times(other, 1 if node.op == "*" else -1),))


def go_together(left: Kind, right: Kind) -> bool:
    """Whether two values can be equal at all; words of a finite state are looked at elsewhere."""
    for one, other in ((left, right), (right, left)):
        match one.sort:
            case "hand" if other.sort in ("object", "word", "hand"):
                return True
            case "whereabouts" if other.sort in ("Place", "Arm", "object", "word", "whereabouts"):
                return True
            case "states" if other.sort in ("word", "states", "choice"):
                return True
            case "choice" if other.sort in ("word", "String"):
                return True
            case _:
                pass
    if left.sort == right.sort == "quantity":
        return any(
            one.difference == other.difference for one in left.dimensions for other in right.dimensions
        )
    sorts = (left.sort, right.sort)
    return left.sort == right.sort or sorts in (("contents", "word"), ("word", "contents"))
