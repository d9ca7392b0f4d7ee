"""What the operations of a template need, and their skill does not give (XEI0648)."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.profiles.checks.names import OPERATION_PARAMETERS
from xei_lang.profiles.checks.operations import DIRECTIONS, OperationWords, of_line
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import ArgSpec, SkillSpec, TemplateStep
from xei_lang.profiles.trees import Trees
from xei_lang.quantity import TYPE_DIMENSIONS


def check_needs(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Each thing that is missing, at the first line that needs it; a swipe's words that are no directions."""
    told: set[str] = set()
    for line in skill.template:
        for field, operation in of_line(line):
            span = trees.of_skill(skill.name, "template", *line.path, line.kind, field)
            for name in (*operation.called, *operation.needs):
                if name not in told and not _given(skill, operation, name):
                    told.add(name)
                    yield _missing(skill, operation, name, (line, field), span)
                elif name not in told:
                    told.add(name)
                    yield from _mistyped(skill, operation, name, trees)


def _given(skill: SkillSpec, operation: OperationWords, name: str) -> bool:
    if skill.arg(name) is not None:
        return True
    return name in operation.needs and any(item.name == name for item in skill.parameters)


def _mistyped(skill: SkillSpec, operation: OperationWords, name: str, trees: Trees) -> Iterator[Diagnostic]:
    """An argument of another type than the operation reads; words may be of any type that has them."""
    arg, type_ = skill.arg(name), operation.called.get(name) or operation.needs[name]
    if arg is not None and type_ == "choice":
        yield from _directions(skill, arg, trees)
    elif arg is not None and type_ in TYPE_DIMENSIONS and arg.type != type_:
        yield Diagnostic(
            "XEI0610",
            f"`{name}` of `{skill.name}` is of type {arg.type}, which is no {type_}",
            arg.span,
            label=f"expected the type {type_}, which `{operation.name}` reads",
            help=(f"write `type: {type_}`, or name the argument otherwise",),
        )


def _missing(
    skill: SkillSpec, operation: OperationWords, name: str, at: tuple[TemplateStep, str], span: Span
) -> Diagnostic:
    line, field = at
    type_ = operation.called.get(name) or operation.needs[name]
    only_called = name in operation.called
    said = (*skill.args, *(() if only_called else skill.parameters))
    near = did_you_mean(name, [item.name for item in said if item.name not in OPERATION_PARAMETERS])
    kind = "choice, choices: [left, right, up, down]" if type_ == "choice" else type_
    mend = f"add the argument `{name}: {{type: {kind}}}`"
    if not only_called:
        mend += f", or `{name}: ...` under `parameters`"
    return Diagnostic(
        "XEI0648",
        f"`{line.field(field)}` in the template of `{skill.name}` needs `{name}`, and nothing gives it",
        span,
        label=f"expected `{name}`, of type {type_}, {_where(only_called)}",
        notes=(f"`{operation.name}` computes its other parameters, and not this one",),
        help=(f"`{near[0]}` is given: did you mean `{name}`?",) if near else (mend,),
    )


def _where(only_called: bool) -> str:
    return "as an argument" if only_called else "as an argument or under `parameters`"


def _directions(skill: SkillSpec, direction: ArgSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Words of a choice that no swipe has; a direction of another type may be anything when it is called."""
    for index, word in enumerate(direction.choices):
        if word not in DIRECTIONS:
            span = trees.of_skill(skill.name, "args", direction.name, "choices", index)
            yield unknown("a direction along a screen", word, DIRECTIONS, span, "XEI0648")
