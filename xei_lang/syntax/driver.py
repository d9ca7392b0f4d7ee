"""The LALR(1) machine: shifts tokens and calls the builder at each reduction. It builds no tree of its own.

lark has such a machine too; this one lets a word be a keyword only where that keyword may really follow
(lark's contextual lexer asks the merged state, which also admits keywords of other contexts), keeps no line
counters, and needs no import of lark.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from xei_lang.syntax.lexer import COMMENT, WORD, Scanner, Token
from xei_lang.syntax.tables import END, Tables

Reduction = Callable[[list[Any]], Any]


class WrongTokenError(Exception):
    """The first token that cannot follow."""

    def __init__(self, token: Token) -> None:
        super().__init__(token.kind)
        self.token = token


class Driver:
    """Tables and scanner for one grammar; holds nothing of a parse, so one serves any number of them."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.scanner = Scanner(tables)

    def parse(self, tokens: Iterable[Token], start: str, builder: Any, comments: list[Token]) -> Any:
        """The value that `builder` makes of the tokens, the last of which is END.

        The method `on_<rule>` of the builder gets a rule's children as a list. Comments are appended to
        `comments` as they are met. Raises WrongTokenError at the first wrong token.
        """
        tables = self.tables
        rules, actions, gotos = tables.rules, tables.actions, tables.gotos
        reductions = [_reduction(builder, rule.action) for rule in rules]
        end_state = tables.end_states[start]
        states = [tables.start_states[start]]
        values: list[Any] = []
        for token in tokens:
            kind = token.kind
            if kind == COMMENT:
                comments.append(token)
                continue
            if kind == WORD and token.text in tables.words:
                kind = self._word_kind(states, token.text)
            while True:
                action = actions[states[-1]].get(kind)
                if action is None:
                    raise WrongTokenError(token._replace(kind=kind))
                if action >= 0:
                    states.append(action)
                    values.append(token)
                    break
                rule = rules[-1 - action]
                if rule.passes:
                    states[-1] = gotos[states[-2]][rule.origin]
                else:
                    size = rule.size
                    taken = values[-size:] if size else []
                    del values[len(values) - size :], states[len(states) - size :]
                    if not rule.plain:
                        taken = _spliced(taken, rule.parts)
                    values.append(reductions[-1 - action](taken))
                    states.append(gotos[states[-1]][rule.origin])
                if kind == END and states[-1] == end_state:
                    return values[-1]
        raise AssertionError("the tokens end without END")

    def _word_kind(self, states: list[int], word: str) -> str:
        """Whether a word that may be a keyword is one here, or a name. Where both could be shifted, it is."""
        keyword = self.tables.words[word]
        here = self.tables.actions[states[-1]]
        action = here.get(keyword)
        if action is None:
            is_keyword = WORD not in here
        else:
            is_keyword = action >= 0 or WORD not in here or self._may_follow(states, keyword, None)
        return keyword if is_keyword else WORD

    def _may_follow(self, states: list[int], kind: str, end_state: int | None) -> bool:
        rules, actions, gotos = self.tables.rules, self.tables.actions, self.tables.gotos
        pushed: list[int] = []
        depth = len(states)
        while True:
            top = pushed[-1] if pushed else states[depth - 1]
            action = actions[top].get(kind)
            if action is None:
                return False
            if action >= 0:
                return True
            rule = rules[-1 - action]
            dropped = min(rule.size, len(pushed))
            del pushed[len(pushed) - dropped :]
            depth -= rule.size - dropped
            pushed.append(gotos[pushed[-1] if pushed else states[depth - 1]][rule.origin])
            if kind == END and pushed[-1] == end_state:
                return True


def _reduction(builder: Any, action: str) -> Reduction:
    return getattr(builder, f"on_{action}") if action else _children


def _children(children: list[Any]) -> list[Any]:
    return children


def _spliced(children: list[Any], parts: tuple[tuple[int, bool], ...]) -> list[Any]:
    """Children with the lists of helpers laid out flat.

    The first list is extended, not copied: repetitions grow to the left, and copying would cost the square of
    their length.
    """
    if parts[0] == (0, True):
        result: list[Any] = children[0]
        parts = parts[1:]
    else:
        result = []
    for index, is_spliced in parts:
        if index < 0:
            result.append(None)
        elif is_spliced:
            result.extend(children[index])
        else:
            result.append(children[index])
    return result
