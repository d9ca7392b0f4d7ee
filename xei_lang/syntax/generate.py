"""Making the parse tables: lark analyses the grammar, and what it found is put into plain values.

This leans on lark's internals (its pinned version is tested): rules, the integer parse table, terminals.
"""

from __future__ import annotations

from typing import Any

from lark import Lark
from lark.lexer import PatternStr

from xei_lang.syntax.tables import STARTS, Rule, Tables


def make_tables(grammar: str, *, strict: bool = False) -> Tables:
    """Analyse a grammar; `strict` makes lark raise GrammarError or LexError on any conflict or collision."""
    lark = _analyse(grammar, strict)
    table: Any = lark.parser.parser._parse_table
    rules: dict[Any, int] = {rule: index for index, rule in enumerate(lark.rules)}
    numbers = _state_numbers(table)
    actions: list[dict[str, int]] = [{} for _ in numbers]
    gotos: list[dict[str, int]] = [{} for _ in numbers]
    for state, number in numbers.items():
        for symbol, (kind, argument) in sorted(table.states[state].items()):
            target = numbers[argument] if kind.name == "Shift" else -1 - rules[argument]
            (actions if _is_terminal(symbol) else gotos)[number][str(symbol)] = target
    words, signs, patterns = _terminals(lark)
    return Tables(
        rules=tuple(_rule(rule) for rule in lark.rules),
        actions=tuple(actions),
        gotos=tuple(gotos),
        start_states={start: numbers[table.start_states[start]] for start in STARTS},
        end_states={start: numbers[table.end_states[start]] for start in STARTS},
        patterns=patterns,
        words=words,
        signs=signs,
        ignored=tuple(sorted(str(name) for name in lark.ignore_tokens)),
    )


def _analyse(grammar: str, strict: bool) -> Any:
    """Untyped on purpose: what is read from it are internals that lark does not annotate."""
    return Lark(
        grammar,
        parser="lalr",
        lexer="contextual",
        start=list(STARTS),
        keep_all_tokens=True,
        maybe_placeholders=True,
        strict=strict,
    )


def _state_numbers(table: Any) -> dict[int, int]:
    """The states numbered as they are met from the starts on: lark's own numbers differ from run to run."""
    numbers: dict[int, int] = {}
    waiting = [table.start_states[start] for start in STARTS]
    for state in waiting:
        if state not in numbers:
            numbers[state] = len(numbers)
            shifts = sorted(
                (str(symbol), target)
                for symbol, (kind, target) in table.states[state].items()
                if kind.name == "Shift"
            )
            waiting.extend(target for _, target in shifts)
    return numbers


def _is_terminal(symbol: str) -> bool:
    return symbol.isupper() or symbol.startswith("$")


def _rule(rule: Any) -> Rule:
    is_helper = rule.origin.name.startswith("_") and not rule.alias
    size = len(rule.expansion)
    parts = _parts(rule)
    passes = bool(rule.options.expand1) and not rule.alias and parts == ((0, False),)
    return Rule(
        origin=str(rule.origin.name),
        action="" if is_helper or passes else str(rule.alias or rule.origin.name),
        size=size,
        passes=passes,
        plain=parts == tuple((index, False) for index in range(size)),
        parts=parts,
    )


def _parts(rule: Any) -> tuple[tuple[int, bool], ...]:
    """Where each child comes from. lark's `empty_indices` has True for an option that is left out here."""
    parts: list[tuple[int, bool]] = []
    present = 0
    symbols = list(rule.expansion)
    for is_missing in rule.options.empty_indices or [False] * len(symbols):
        if is_missing:
            parts.append((-1, False))
        else:
            symbol = symbols[present]
            parts.append((present, not symbol.is_term and symbol.name.startswith("_")))
            present += 1
    assert present == len(symbols)
    return tuple(parts)


def _terminals(lark: Any) -> tuple[dict[str, str], dict[str, str], tuple[tuple[str, str], ...]]:
    words: dict[str, str] = {}
    signs: dict[str, str] = {}
    patterns: list[tuple[int, int, str, str]] = []
    for terminal in lark.terminals:
        text = terminal.pattern.value
        if not isinstance(terminal.pattern, PatternStr):
            pattern = terminal.pattern
            patterns.append((-terminal.priority, -pattern.max_width, str(terminal.name), pattern.to_regexp()))
        elif text.isalpha():
            words[str(text)] = str(terminal.name)
        else:
            signs[str(text)] = str(terminal.name)
    ordered = tuple((name, expression) for _, _, name, expression in sorted(patterns))
    return dict(sorted(words.items())), dict(sorted(signs.items())), ordered
