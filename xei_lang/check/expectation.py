"""Why a value must be of a type, kept with each check so that a message can say it."""

from __future__ import annotations

from xei_lang.check.value_words import a
from xei_lang.diagnostics import Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import TypeExpr


@record
class Expectation(Shown):
    """`what` takes a `type`: "`volume` of `pour`" takes a Volume, by the rule written at `rule`.

    `lists` counts the `List[...]` around the type; `roles` and `choices` narrow an object and a choice.
    """

    what: str
    type: str
    rule: Span | None = None
    roles: TypeExpr | None = None
    choices: tuple[str, ...] = ()
    lists: int = 0

    @property
    def noun(self) -> str:
        """What is taken, with its article: "a Volume", "a list of Volumes", "one of left, right"."""
        if self.lists:
            return f"a list of {_PLURALS.get(self.type, self.type + 's')}"
        if self.choices:
            return f"one of {', '.join(self.choices)}"
        return _NOUNS.get(self.type) or a(self.type)

    @property
    def item(self) -> Expectation:
        """The same expectation of a member of the list."""
        return Expectation(
            f"each of {self.what}", self.type, self.rule, self.roles, self.choices, self.lists - 1
        )


_NOUNS = {
    "object": "an object",
    "Place": "a place",
    "Pose": "a pose",
    "Station": "a station",
    "Arm": "an arm",
    "Int": "a whole number",
    "Float": "a number",
}
_PLURALS = {"object": "objects", "Place": "places", "Pose": "poses", "Station": "stations", "Arm": "arms"}
