"""Contracts that contradict themselves (XEI0627): what a skill asks for before cannot hold at once, what it
leaves behind is two things, or what holds before rules out what it leaves behind.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.checks.rule_facts import Fact, Key, bounds, facts_of, key_of, rule_out
from xei_lang.profiles.model import Profile, SkillSpec
from xei_lang.syntax import ast


def check_contradictions(profile: Profile) -> Iterator[Diagnostic]:
    """The contract of each skill against itself; only what is certain whatever the arguments are."""
    for skill in profile.bank.skills:
        yield from contradictions_of(skill)


def contradictions_of(skill: SkillSpec) -> Iterator[Diagnostic]:
    """The same of one skill."""
    before = list(facts_of(skill.requires, "requires"))
    yield from _pairs(skill, before)
    changes = [rule.predicate for rule in skill.ensures if isinstance(rule.predicate, ast.Update)]
    yield from _set_twice(changes)
    yield from _hands(skill, changes)
    yield from _below_nothing(skill, before, changes)
    yield from _pairs(skill, _after(skill, before, changes))


def _pairs(skill: SkillSpec, facts: list[Fact]) -> Iterator[Diagnostic]:
    """Facts that rule each other out; of two that hold before, nothing is said again of what holds after."""
    after = any(fact.source == "ensures" for fact in facts)
    for one, other in combinations(facts, 2):
        if one.key != other.key or not rule_out(skill, one, other):
            continue
        if after and one.source == other.source == "requires":
            continue
        when = "before" if other.source == "requires" else "afterwards"
        yield Diagnostic(
            "XEI0627",
            f"what `{skill.name}` says of `{other.text}` {when} cannot hold at once",
            other.span,
            label="contradicts the other",
            labels=(Label(one.span, f"`{one.source}` says this"),),
            help=("take one of the two out, or let it speak of another argument",),
        )


def _after(skill: SkillSpec, before: list[Fact], changes: list[ast.Update]) -> list[Fact]:
    """What holds afterwards: what held and is not changed, what is set, and what `ensures` says besides."""
    changed = {key_of(change.target) for change in changes}
    first: dict[Key, Fact] = {}
    for change in changes:
        key = key_of(change.target)
        if change.op == ":=" and key is not None:
            first.setdefault(key, Fact(key, "==", change.value, change.span, "ensures"))
    return [
        *(fact for fact in before if fact.key not in changed),
        *first.values(),
        *facts_of(skill.ensures, "ensures"),
    ]


def _set_twice(changes: list[ast.Update]) -> Iterator[Diagnostic]:
    """One state that is set to two values, or set and changed besides."""
    first: dict[Key, ast.Update] = {}
    for change in changes:
        key = key_of(change.target)
        if key is None:
            continue
        known = first.setdefault(key, change)
        if known is change or ":=" not in (known.op, change.op):
            continue
        if known.op == change.op and ast.equal_up_to_spans(known.value, change.value):
            continue
        yield Diagnostic(
            "XEI0627",
            f"`{key[0]}({key[1]})` is set to two values",
            change.span,
            label="set again here",
            labels=(Label(known.span, "set first here"),),
            help=("keep the one that holds once the skill is done",),
        )


def _hands(skill: SkillSpec, changes: list[ast.Update]) -> Iterator[Diagnostic]:
    """A hand that is left empty with an object in it, or that holds an object which is left elsewhere."""
    held = {key[1]: change for change in changes if (key := key_of(change.target)) and key[0] == "holding"}
    for change in changes:
        key = key_of(change.target)
        if key is None or key[0] != "at" or change.op != ":=" or not isinstance(change.value, ast.Name):
            continue
        where = change.value.id
        arg = skill.arg(where)
        empty = held.get(where)
        keeps = next((update for update in held.values() if _is_name(update.value, key[1])), None)
        if empty is not None and _is_name(empty.value, "nothing"):
            yield _hand(change, empty, f"`{key[1]}` is left in a hand that is left empty")
        elif keeps is not None and arg is not None and arg.type == "Place":
            yield _hand(change, keeps, f"`{key[1]}` is left at a place and in a hand")


def _is_name(node: ast.Expression, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name


def _hand(change: ast.Update, hand: ast.Update, message: str) -> Diagnostic:
    return Diagnostic(
        "XEI0627",
        message,
        change.span,
        label="where it is afterwards",
        labels=(Label(hand.span, "what the hand holds afterwards"),),
        help=("let `at` be the arm where the hand keeps it, and the place where it lets go",),
    )


def _below_nothing(skill: SkillSpec, before: list[Fact], changes: list[ast.Update]) -> Iterator[Diagnostic]:
    """More taken away than there is: what holds before is surely less than what goes."""
    for change in changes:
        key = key_of(change.target)
        if change.op != "-=" or key is None or key[0] == "temperature":
            continue
        least = bounds(skill, change.value)[0]
        for fact in before:
            if fact.key != key or fact.op not in ("<", "<=", "=="):
                continue
            most = bounds(skill, fact.value)[1]
            same = fact.op == "<" and ast.equal_up_to_spans(fact.value, change.value)
            if same or (
                least is not None
                and most is not None
                and (most < least or (most == least and fact.op == "<"))
            ):
                yield Diagnostic(
                    "XEI0627",
                    f"`{skill.name}` takes more from `{fact.text}` than it asks for",
                    change.span,
                    label="would leave less than nothing",
                    labels=(Label(fact.span, "`requires` admits no more than this"),),
                    help=("ask for at least what is taken: `>=` and the same amount",),
                )
