"""What a template leaves in the hands, and where it leaves objects, against what its skill ensures (XEI0647).

The checker believes `ensures`, and the run the template: where they differ, a protocol is checked for another
state than the robot is in.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.checks.rule_facts import Fact, facts_of, key_of
from xei_lang.profiles.model import SkillSpec, TemplateStep
from xei_lang.record import Record, record
from xei_lang.syntax import ast

NOTHING = "nothing"


@record
class Outcome(Record):
    """What is known of the hands before a template and after it, by arm, and of where objects are left.

    `taken` is the last line that takes or lets go, by arm and by object. `unclear` says that what the skill
    requires leaves the hands open.
    """

    begun: Mapping[str, str]
    held: Mapping[str, str]
    left: Mapping[str, str]
    taken: Mapping[str, TemplateStep]
    unclear: bool


def names_hands(skill: SkillSpec, arms: Sequence[str]) -> bool:
    """Whether each line that takes or lets go names an arm and an object; one that does not is told of."""
    known = (*arms, *(arg.name for arg in skill.args if arg.type == "Arm"))
    lines = [line for line in skill.template if line.kind in ("attach", "detach")]
    return all(
        line.field("arm") in known and skill.arg(str(line.field("object")).partition(".")[0]) is not None
        for line in lines
    )


def check_outcome(skill: SkillSpec, outcome: Outcome) -> Iterator[Diagnostic]:
    """What is certain of a template whose lines follow each other, whatever the arguments are."""
    hands, places = _said(skill, "holding"), _said(skill, "at")
    for arm in (arg.name for arg in skill.args if arg.type == "Arm"):
        facts, line = hands.get(arm, ()), outcome.taken.get(arm)
        if not facts and line is not None and outcome.held[arm] != outcome.begun.get(arm):
            yield _unsaid(skill, arm, line, outcome.held[arm])
        if len(facts) == 1 and _differs(skill, facts[0], arm, outcome):
            yield _hand(skill, arm, facts[0], outcome.held.get(arm), line)
    for thing, place in outcome.left.items():
        facts = places.get(thing, ())
        if len(facts) == 1 and skill.arg(place) and skill.arg(_word(facts[0])) and _word(facts[0]) != place:
            yield _place(skill, thing, facts[0], place, outcome.taken[thing])


def _said(skill: SkillSpec, state: str) -> Mapping[str, tuple[Fact, ...]]:
    """What `ensures` says of a state, by its argument; two different values are told elsewhere."""
    found: dict[str, tuple[Fact, ...]] = {}
    updates = [rule.predicate for rule in skill.ensures if isinstance(rule.predicate, ast.Update)]
    set_to = [
        Fact(key, "==", node.value, node.span, "ensures")
        for node in updates
        if node.op == ":=" and (key := key_of(node.target)) is not None
    ]
    for fact in (*set_to, *facts_of(skill.ensures, "ensures")):
        known = [_word(one) for one in found.get(fact.key[1], ())]
        if fact.key[0] == state and fact.op == "==" and _word(fact) and _word(fact) not in known:
            found[fact.key[1]] = (*found.get(fact.key[1], ()), fact)
    return found


def _word(fact: Fact) -> str:
    return fact.value.id if isinstance(fact.value, ast.Name) else ""


def _differs(skill: SkillSpec, fact: Fact, arm: str, outcome: Outcome) -> bool:
    """Whether a hand is surely left otherwise; one object of the lab may be what an argument stands for."""
    word, held = _word(fact), outcome.held.get(arm)
    if held is None:
        return not outcome.unclear
    return word != held and (NOTHING in (word, held) or skill.arg(word) is not None)


def _unsaid(skill: SkillSpec, arm: str, line: TemplateStep, held: str) -> Diagnostic:
    does, label = (
        ("lets go of", "lets go of it last here")
        if held == NOTHING
        else ("takes", "keeps what it takes here")
    )
    thing = line.field("object")
    says = f'say `ensures: ["holding({arm}) := {held}"]`'
    is_part = skill.arg(held) is None and held != NOTHING
    return Diagnostic(
        "XEI0647",
        f"the template of `{skill.name}` {does} `{thing}`, and `ensures` does not say so",
        line.span,
        label=label,
        notes=(_BELIEVED,),
        help=("let go of it again with `detach`" if is_part else says,),
    )


def _hand(skill: SkillSpec, arm: str, fact: Fact, held: str | None, line: TemplateStep | None) -> Diagnostic:
    ensured = f"holds {_shown(_word(fact))}"
    left = f"`{arm}` {'as it was' if line is None else 'empty' if held == NOTHING else f'with `{held}`'}"
    labels = () if line is None else (Label(line.span, "what the template does last with this hand"),)
    mend = f"add a line `{'detach' if _word(fact) == NOTHING else 'attach'}`"
    instead = "take this out of `ensures`" if line is None else f"say `holding({arm}) := {held}`"
    return Diagnostic(
        "XEI0647",
        f"`{skill.name}` ensures that `{arm}` {ensured}, and its template leaves {left}",
        fact.span,
        label="not what the template leaves",
        labels=labels,
        notes=(_BELIEVED,),
        help=(f"{mend} to the template, or {instead}",),
    )


def _place(skill: SkillSpec, thing: str, fact: Fact, place: str, line: TemplateStep) -> Diagnostic:
    ensured = f"`{thing}` is at `{_word(fact)}`"
    return Diagnostic(
        "XEI0647",
        f"`{skill.name}` ensures that {ensured}, and its template leaves it at `{place}`",
        fact.span,
        label="not where the template leaves it",
        labels=(Label(line.span, f"left at `{place}`"),),
        notes=(_BELIEVED,),
        help=(f"say `at({thing}) := {place}`, or let the line end there",),
    )


def _shown(word: str) -> str:
    return NOTHING if word == NOTHING else f"`{word}`"


_BELIEVED = "protocols are checked by what a skill ensures, and run by its template"
