"""Protocols made up at random: every construct, redundant brackets, comments and layout of any kind."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import strategies as st

NAMES = ["tube", "rack_1", "xs", "n2", "of_it", "volume", "cap"]
# `at` and `step` are labels too, but not behind a `given ... contains` or a range: they would go on with it.
LABELS = [*NAMES, "start", "wait", "for", "if", "let", "note", "object", "times", "within_it"]
ARGUMENTS = [*NAMES, "on", "to", "for", "in", "by", "if", "xei"]
ROLES = ["movable", "tube_rack", "fragile", "Volume", "Int"]
NUMBERS = ["0", "1", "8", "007", "2.50", "0.05"]
QUANTITIES = ["2 mL", "2mL", "0.50\t uL", "10  mL/min", "70%", "37 degC", "5 mg/mL", "1.0 h"]
STRINGS = ['""', '"A1"', r'"say \"hi\" \\ there"', '"# no comment"', '"\u00b5 {"', r'"\n"']
COMMENTS = ["#", "# why", "## doc", "##", "#!  odd   ", '# \u00b5L { } " ', "## a, b", "#\ttab\t"]
GAPS = [" ", " ", " ", "\n", "\n\n", "  \n\n\n  ", "\t", "\r\n"]
TIGHT = frozenset("(){}[],")
OPERATORS = [
    (["or"], 1),
    (["and"], 2),
    (["==", "!=", "<=", ">=", "<", ">"], 4),
    (["+", "-"], 5),
    (["*", "/"], 6),
]
Words = list[str]


class Writer:
    """Draws the words of a program; `depth` bounds what stands in each other."""

    def __init__(self, draw: st.DrawFn, depth: int) -> None:
        self._draw = draw
        self._depth = depth

    def pick(self, options: list[str]) -> str:
        return self._draw(st.sampled_from(options))

    def number(self, low: int, high: int) -> int:
        return self._draw(st.integers(low, high))

    def chance(self) -> bool:
        return self._draw(st.booleans())

    def maybe(self, words: Callable[[], Words]) -> Words:
        return words() if self.chance() else []

    def several(
        self, words: Callable[[], Words], low: int = 0, high: int = 3, *, trailing: bool = True
    ) -> Words:
        found: Words = []
        for index in range(self.number(low, high)):
            found += [",", *words()] if index else words()
        return [*found, ","] if found and trailing and self.chance() else found

    # ---- values ----

    def value(self, depth: int, level: int = 1) -> Words:
        """A value that may stand where something must bind as tightly as `level` (see the formatter)."""
        words, own = self._value(depth) if depth else (self._word(), 9)
        pairs = max(int(own < level), self.number(0, 5) - 3)
        return ["("] * pairs + words + [")"] * pairs

    def _word(self) -> Words:
        return [self.pick([*NAMES, *NUMBERS, *QUANTITIES, *STRINGS, "true", "false"])]

    def _value(self, depth: int) -> tuple[Words, int]:
        def inner(level: int = 1) -> Words:
            return self.value(depth - 1, level)

        kind = self.number(0, 12)
        if kind < len(OPERATORS):
            signs, level = OPERATORS[kind]
            left = 5 if level == 4 else level
            right = 5 if level == 4 else level + 1
            return [*inner(left), self.pick(signs), *inner(right)], level
        match kind:
            case 5:
                return ["-", *inner(7)], 7
            case 6:
                return ["not", *inner(3)], 3
            case 7:
                return [*inner(8), ".", self.pick(ARGUMENTS)], 8
            case 8:
                return [*inner(8), "[", *self.iterable(depth - 1), "]"], 8
            case 9:
                return [*inner(8), *self.arguments(depth - 1)], 8
            case 10:
                return ["[", *self.several(inner), "]"], 9
            case 11:
                return ["(", *self.several(inner, 2), ")"], 9
            case _:
                condition = self.maybe(lambda: ["if", *inner()])
                return ["[", *inner(), "for", *self.binding(depth - 1), *condition, "]"], 9

    def binding(self, depth: int) -> Words:
        names = self.several(lambda: [self.pick(NAMES)], 1, trailing=False)
        return [*names, "in", *self.iterable(depth)]

    def iterable(self, depth: int) -> Words:
        return self.range(depth) if self.chance() else self.value(depth)

    def range(self, depth: int) -> Words:
        step = self.maybe(lambda: ["step", *self.value(depth, 5)])
        return [*self.value(depth, 5), "..", *self.value(depth, 5), *step]

    def arguments(self, depth: int) -> Words:
        def argument() -> Words:
            return [*self.maybe(lambda: [self.pick(ARGUMENTS), "="]), *self.value(depth)]

        return ["(", *self.several(argument), ")"]

    def type(self, depth: int, level: int = 1) -> Words:
        kind = self.number(0, 4) if depth else 4
        signs = [("|", 1), ("&", 2)]
        if kind < 2:
            sign, own = signs[kind]
            words = [*self.type(depth - 1, own), sign, *self.type(depth - 1, own + 1)]
        elif kind == 2:
            words, own = ["not", *self.type(depth - 1, 3)], 3
        elif kind == 3:
            words, own = [self.pick(ROLES), "[", *self.type(depth - 1), "]"], 3
        else:
            words, own = [self.pick(ROLES)], 3
        pairs = max(int(own < level), self.number(0, 5) - 4)
        return ["("] * pairs + words + [")"] * pairs

    # ---- statements ----

    def step_ref(self) -> Words:
        words = [self.pick(NAMES)]
        for _ in range(self.number(0, 2)):
            words += [".", self.pick(NAMES)] if self.chance() else ["[", self.pick(["1", "n2"]), "]"]
        return words

    def call(self, depth: int) -> Words:
        return [self.pick(NAMES), *self.arguments(depth)]

    def block(self, depth: int) -> Words:
        body = [word for _ in range(self.number(0, 2)) for word in self.statement(depth)]
        return ["{", *body, "}"]

    def statement(self, depth: int) -> Words:
        match self.number(0, 7):
            case 0:
                others = [word for _ in range(self.number(0, 2)) for word in (",", self.pick(NAMES))]
                return ["let", self.pick(NAMES), *others, "=", *self.value(depth)]
            case 1:
                return ["require", *self.value(depth)]
            case 2:
                return ["unmapped", self.pick(STRINGS), *self.maybe(lambda: ["because", self.pick(STRINGS)])]
            case 3:
                return ["note", self.pick(STRINGS)]
            case _:
                return self.step(depth)

    def step(self, depth: int) -> Words:
        label = self.maybe(lambda: [self.pick(LABELS), ":"])
        action = self.action(depth)
        labelled = ["start", *label, *action[1:]] if action[0] == "start" else [*label, *action]
        clauses = [word for _ in range(max(0, self.number(0, 4) - 2)) for word in self.clause()]
        return [*labelled, *clauses]

    def clause(self) -> Words:
        if self.chance():
            return ["within", *self.value(1, 5), *self.maybe(lambda: ["of", *self.step_ref()])]
        return ["after", *self.step_ref(), *self.maybe(lambda: ["by", *self.range(1)])]

    def action(self, depth: int) -> Words:
        match self.number(0, 14 if depth else 7):
            case 0 | 1:
                return self.call(depth)
            case 2:
                return ["wait", *self.value(depth, 5)]
            case 3:
                return ["start", *self.call(depth)]
            case 4:
                return [self.pick(["await", "stop", "leave"]), *self.step_ref()]
            case 5:
                return [self.pick(["stop", "confirm"]), self.pick(STRINGS)]
            case 6 | 7:
                limits = self.maybe(lambda: ["in", *self.range(1)])
                return ["measure", self.pick(NAMES), ":", *self.type(1), "=", *self.call(depth), *limits]
            case 8:
                return ["pause", *self.step_ref(), *self.block(depth - 1)]
            case 9:
                return ["keep", *self.value(depth), *self.block(depth - 1)]
            case 10:
                return ["do", *self.block(depth - 1)]
            case 11:
                branches = [word for _ in range(self.number(1, 2)) for word in self.block(depth - 1)]
                return ["parallel", "{", *branches, "}"]
            case 12:
                unordered = self.maybe(lambda: ["unordered"])
                return ["for", *self.binding(1), *unordered, *self.block(depth - 1)]
            case 13:
                until = self.maybe(lambda: ["until", *self.value(depth)])
                otherwise = self.maybe(lambda: ["else", *self.block(depth - 1)])
                return ["repeat", *self.value(1, 5), "times", *until, *self.block(depth - 1), *otherwise]
            case _:
                return self.condition(depth)

    def condition(self, depth: int) -> Words:
        words = ["if", *self.value(depth), *self.block(depth - 1)]
        match self.number(0, 2 if depth > 1 else 1):
            case 0:
                return words
            case 1:
                return [*words, "else", *self.block(depth - 1)]
            case _:
                return [*words, "else", *self.condition(depth - 1)]

    # ---- files ----

    def member(self, depth: int) -> Words:
        match self.number(0, 8):
            case 0:
                return ["profile", self.pick(STRINGS)]
            case 1:
                return ["param", *self.formal()]
            case 2:
                binding = self.maybe(lambda: ["=", *self.value(1, 8)])
                return ["object", self.pick(NAMES), ":", *self.type(2), *binding]
            case 3:
                return ["given", *self.value(depth)]
            case 4:
                at = self.maybe(lambda: ["at", *self.value(1, 5)])
                contents = [*self.value(1, 8), "contains", *self.value(1, 5), "of", *self.value(1, 8)]
                return ["given", *contents, *at]
            case _:
                return self.statement(depth)

    def formal(self) -> Words:
        default = self.maybe(lambda: ["=", *self.value(1)])
        limits = self.maybe(lambda: ["in", *self.range(1)])
        return [self.pick(NAMES), ":", *self.type(1), *default, *limits]

    def body(self) -> Words:
        return [
            "{",
            *(word for _ in range(self.number(0, 3)) for word in self.member(self._depth)),
            "}",
        ]

    def item(self) -> Words:
        match self.number(0, 5):
            case 0:
                return ["import", self.pick(STRINGS)]
            case 1:
                return ["import", "table", self.pick(STRINGS), "as", self.pick(NAMES)]
            case 2:
                return ["procedure", self.pick(NAMES), "(", *self.several(self.formal), ")", *self.body()]
            case _:
                return ["protocol", self.pick(NAMES), *self.body()]

    def file(self) -> Words:
        items = [word for _ in range(self.number(0, 2)) for word in self.item()]
        return [*self.maybe(lambda: ["xei", "1"]), *items, "protocol", "last", *self.body()]

    # ---- layout ----

    def gap(self, before: str, after: str) -> str:
        kind = self.number(0, 12)
        if kind == 12:
            lead = self.pick(["", " ", "\n", "\n\n  "])
            return lead + self.pick(COMMENTS) + self.pick(["\n", "\r\n", "\n\n"]) + self.maybe_gap()
        if 0 < kind < 4 and (before in TIGHT or after in TIGHT):
            return ""
        return " " if kind < 10 else self.pick(GAPS)

    def maybe_gap(self) -> str:
        return self.gap("x", "x") if self.number(0, 3) == 0 else ""

    def text(self) -> str:
        words = self.file()
        parts = [self.maybe_gap()]
        for before, after in zip(words, [*words[1:], "}"], strict=True):
            parts += [before, self.gap(before, after)]
        return "".join(parts)


@st.composite
def programs(draw: st.DrawFn) -> str:
    """The text of a file that follows the grammar."""
    return Writer(draw, draw(st.integers(0, 3))).text()
