"""The rules of a skill's contract, one by one: states that something has, values that go together."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from xei_lang.diagnostics import Diagnostic, did_you_mean
from xei_lang.profiles.checks.rule_kinds import (
    STATES,
    Kind,
    go_together,
    kind_of,
    kind_of_state,
    listed,
    states_of,
    subject_of,
)
from xei_lang.profiles.model import Profile, SkillRule, SkillSpec
from xei_lang.syntax import ast

FUNCTIONS = ("zip", "len", "sum", "min", "max", "ceil", "chunks", "pairs", "product", "shuffle")
"""What else than a state can be called in an expression."""

_ORDERED = ("<", "<=", ">", ">=")


def check_rules(profile: Profile) -> Iterator[Diagnostic]:
    """States that no fitting object has (XEI0626), and values that do not go together (XEI0628)."""
    for skill in profile.bank.skills:
        for rule in chain(skill.requires, skill.ensures):
            calls = [node for node in ast.walk(rule.predicate) if isinstance(node, ast.CallExpr)]
            found = [fault for call in calls for fault in _state(profile, skill, call)]
            yield from found or _values(profile, skill, rule)
            if not calls and _constant(skill, rule):
                yield Diagnostic(
                    "XEI0628",
                    f"`{rule.text}` is no condition: it says nothing of any argument",
                    rule.span,
                    label="holds always, or never",
                    help=("take it out, or say which state of an argument is meant",),
                )
        yield from (_no_condition(rule, "`requires` says what holds before") for rule in _changes(skill))


def _constant(skill: SkillSpec, rule: SkillRule) -> bool:
    names = [node.id for node in ast.walk(rule.predicate) if isinstance(node, ast.Name)]
    return not any(skill.arg(name) for name in names)


def _changes(skill: SkillSpec) -> Iterator[SkillRule]:
    return (rule for rule in skill.requires if isinstance(rule.predicate, ast.Update))


def _no_condition(rule: SkillRule, note: str) -> Diagnostic:
    return Diagnostic(
        "XEI0628",
        f"`{rule.text}` is no condition",
        rule.span,
        label="expected something that is true or false",
        notes=(note,),
    )


def _state(profile: Profile, skill: SkillSpec, call: ast.CallExpr) -> Iterator[Diagnostic]:
    """Whether what is called is a state, and a state of such a thing."""
    name, subject = call.function, subject_of(skill, call)
    if not isinstance(name, ast.Name) or name.id in FUNCTIONS or subject is None:
        return
    if name.id in STATES:
        wanted = STATES[name.id][0]
        if subject.type != wanted:
            what = "an arm" if wanted == "Arm" else "an object"
            yield Diagnostic(
                "XEI0628",
                f"`{name.id}` is a state of {what}, and `{subject.name}` is none",
                call.args[0].span,
                label=f"expected an argument of type {wanted}, found {subject.type}",
            )
        return
    things = states_of(profile, subject) if subject.type == "object" else ()
    if subject.type == "object" and not things:
        return
    known = dict.fromkeys(state.name for item in things for state in item.states)
    if name.id not in known:
        near = did_you_mean(name.id, [*known, *STATES])
        shown = ", ".join(f"`{state}`" for state in known)
        yield Diagnostic(
            "XEI0626",
            f"`{name.id}` is a state that nothing given for `{subject.name}` has",
            name.span,
            label=f"expected a state of what is `{subject.roles_text or subject.type}`",
            notes=(f"such objects have the states {shown}",) if known else ("such objects have no states",),
            help=(f"did you mean `{near[0]}`?",)
            if near
            else ("give an object of these roles the state in `states`, or ask for other roles",),
        )


def _values(profile: Profile, skill: SkillSpec, rule: SkillRule) -> Iterator[Diagnostic]:
    """Whether the two sides of each comparison, sum and change can be compared, added and set."""
    node = rule.predicate
    kind = None if isinstance(node, ast.Update) else kind_of(profile, skill, node)
    if kind is not None and kind.sort != "Bool":
        yield _no_condition(rule, f"it is {kind.text}")
    for part in ast.walk(node):
        if isinstance(part, ast.Update):
            yield from _change(profile, skill, part)
        elif isinstance(part, (ast.Compare, ast.Binary)):
            sums = isinstance(part, ast.Binary)
            if not sums or part.op in ("+", "-"):
                yield from _pair(profile, skill, part.left, part.right, part)


def _change(profile: Profile, skill: SkillSpec, node: ast.Update) -> Iterator[Diagnostic]:
    target = kind_of_state(profile, skill, node.target) if isinstance(node.target, ast.CallExpr) else None
    if not isinstance(node.target, ast.CallExpr):
        yield Diagnostic(
            "XEI0628",
            "only a state can be set",
            node.target.span,
            label="expected a state, such as `at(object)`",
        )
    elif target is not None and node.op != ":=" and target.sort not in ("quantity", "contents"):
        yield Diagnostic(
            "XEI0628",
            f"nothing can be added to or taken from `{_text(node.target)}`",
            node.span,
            label=f"expected `:=`: it is {target.text}",
        )
    else:
        yield from _pair(profile, skill, node.target, node.value, node)


def _pair(
    profile: Profile,
    skill: SkillSpec,
    left: ast.Expression,
    right: ast.Expression,
    node: ast.Compare | ast.Binary | ast.Update,
) -> Iterator[Diagnostic]:
    one, other = kind_of(profile, skill, left), kind_of(profile, skill, right)
    if one is None or other is None:
        return
    if node.op in _ORDERED and "quantity" not in (one.sort, other.sort):
        words = f"`{node.op}` compares amounts, and {one.text} is none"
        yield Diagnostic("XEI0628", words, node.span, label="expected `==` or `!=`")
    elif not go_together(one, other):
        message = f"{other.text} stands where {one.text} is expected"
        yield Diagnostic("XEI0628", message, right.span, label=f"expected {one.text}, found {other.text}")
    else:
        for state, said, asked, place in ((one, other, left, right), (other, one, right, left)):
            yield from _word(state, said, asked, place, profile)


def _word(
    state: Kind, said: Kind, asked: ast.Expression, place: ast.Expression, profile: Profile
) -> Iterator[Diagnostic]:
    """Whether a word is one that the state on the other side, `asked`, can have."""
    if said.sort not in ("word", "choice"):
        return
    known = {
        "states": state.words,
        "hand": ("nothing", *(item.name for item in profile.objects)),
        "whereabouts": (*profile.bank.arms, "either", *(item.name for item in profile.objects)),
        "choice": state.words,
    }.get(state.sort)
    wrong = [word for word in said.words if known is not None and word not in known]
    if not wrong or known is None:
        return
    near = did_you_mean(wrong[0], known)
    what = f"`{_text(asked)}`" if isinstance(asked, ast.CallExpr) else "this argument"
    yield Diagnostic(
        "XEI0626",
        f"`{wrong[0]}` is not a value of {what}",
        place.span,
        label=f"expected {_EXPECTED.get(state.sort) or listed(state.words)}",
        help=(f"did you mean `{near[0]}`?",) if near else (),
    )


_EXPECTED = {
    "hand": "an argument that is an object, or `nothing`",
    "whereabouts": "an argument that is a Place or an arm",
}


def _text(call: ast.CallExpr) -> str:
    inner = ", ".join(arg.value.id for arg in call.args if isinstance(arg.value, ast.Name))
    return f"{call.function.id if isinstance(call.function, ast.Name) else '...'}({inner})"
