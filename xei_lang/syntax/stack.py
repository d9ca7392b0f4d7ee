"""The LALR(1) machine without values, on stacks that share their lower parts: trying something costs a step.

A stack is a pair of its top state and the stack below. A token that cannot follow leaves no trace, as it
does in the driver, which may have reduced on the wrong token's behalf before it notices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xei_lang.syntax.lexer import WORD, Token
from xei_lang.syntax.tables import END, Tables

Stack = tuple[int, Any]
"""The top state and the Stack below it, which is None at the bottom."""


class Machine:
    """Steps of one grammar's automaton."""

    def __init__(self, tables: Tables, start: str) -> None:
        self.tables = tables
        self.start: Stack = (tables.start_states[start], None)
        self._end_state = tables.end_states[start]
        self._drops = [(rule.size, rule.origin) for rule in tables.rules]

    def shift(self, stack: Stack, kind: str) -> Stack | None:
        """The stack once a terminal is shifted; None where it cannot follow. END leaves the last stack."""
        actions, gotos, drops = self.tables.actions, self.tables.gotos, self._drops
        while True:
            action = actions[stack[0]].get(kind)
            if action is None:
                return None
            if action >= 0:
                return (action, stack)
            size, origin = drops[-1 - action]
            for _ in range(size):
                stack = stack[1]
            stack = (gotos[stack[0]][origin], stack)
            if kind == END and stack[0] == self._end_state:
                return stack

    def step(self, stack: Stack, token: Token) -> tuple[Stack, str] | None:
        """The stack after a token, and the kind that it has there: a keyword where that may stand."""
        if token.kind == WORD and token.text in self.tables.words:
            keyword = self.tables.words[token.text]
            after = self.shift(stack, keyword)
            if after is not None:
                return after, keyword
        after = self.shift(stack, token.kind)
        return None if after is None else (after, token.kind)

    def run(self, stack: Stack, tokens: Sequence[Token], begin: int, most: int) -> tuple[Stack, int]:
        """How many tokens from `begin` on can follow, counted up to `most`; the end counts as all of them."""
        for done in range(most):
            token = tokens[begin + done]
            stepped = self.step(stack, token)
            if stepped is None:
                return stack, done
            stack = stepped[0]
            if token.kind == END:
                break
        return stack, most

    def expected(self, stack: Stack) -> frozenset[str]:
        """The terminals that may really follow."""
        return frozenset(
            kind for kind in self.tables.actions[stack[0]] if self.shift(stack, kind) is not None
        )
