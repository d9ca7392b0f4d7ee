"""Numbers of a skill bank that cannot be meant: empty ranges, defaults outside of them, negative sizes."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import ArgSpec, OperationDefault, Profile, SkillSpec
from xei_lang.profiles.trees import Trees
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import NUMBER


def check_quantities(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Ranges and defaults of arguments, and operation parameters of skills and objects.

    Operation parameters are magnitudes: a template says the direction, with a minus before an angle's name.
    """
    for skill in profile.bank.skills:
        for arg in skill.args:
            yield from _range(skill, arg, trees)
            yield from _word(profile, skill, arg, trees)
        yield from _negative(skill.parameters)
    for item in profile.objects:
        yield from _negative(item.grasp)


def _range(skill: SkillSpec, arg: ArgSpec, trees: Trees) -> Iterator[Diagnostic]:
    lower, upper = arg.min, arg.max
    if lower is not None and upper is not None:
        if lower.dimension != upper.dimension:
            return
        if lower > upper:
            yield Diagnostic(
                "XEI0610",
                f"nothing lies between {lower} and {upper}",
                arg.span,
                label="`min` is more than `max`",
                help=("write the smaller one as `min`",),
            )
            return
    default = arg.default
    if arg.type in ("Int", "Float") and isinstance(default, int | float):
        default = Quantity(Fraction(str(default)), NUMBER, "")
    if not isinstance(default, Quantity):
        return
    below = lower is not None and lower.dimension == default.dimension and default < lower
    above = upper is not None and upper.dimension == default.dimension and default > upper
    if below or above:
        yield Diagnostic(
            "XEI0610",
            f"the default of `{arg.name}`, {default}, is {'below' if below else 'above'} its own range",
            trees.of_skill(skill.name, "args", arg.name, "default"),
            label=f"expected {f'at least {lower}' if below else f'at most {upper}'}",
            help=("whoever leaves the argument out would get what nobody may ask for",),
        )


def _word(profile: Profile, skill: SkillSpec, arg: ArgSpec, trees: Trees) -> Iterator[Diagnostic]:
    if not isinstance(arg.default, str) or arg.type not in ("Arm", "choice"):
        return
    known = (*profile.bank.arms, "either") if arg.type == "Arm" else arg.choices
    if arg.default not in known:
        span = trees.of_skill(skill.name, "args", arg.name, "default")
        yield unknown(f"a value of `{arg.name}`", arg.default, known, span)


def _negative(parameters: tuple[OperationDefault, ...]) -> Iterator[Diagnostic]:
    for parameter in parameters:
        if isinstance(parameter.value, Quantity) and parameter.value.value < 0:
            yield _below_zero(parameter.name, parameter.value, parameter.span)


def _below_zero(name: str, value: Quantity, span: Span) -> Diagnostic:
    return Diagnostic(
        "XEI0610",
        f"`{name}` is negative: {value}",
        span,
        label="expected 0 or more",
        notes=("an operation parameter is a size; which way it goes is the template's to say",),
        help=(f"write `{name}: {str(value).lstrip('-')}`",),
    )
