"""The grammar as the driver needs it: terminals and an LALR(1) table, made by lark once and kept on disk.

lark is imported only to make the table, never to read it back: the import costs more than parsing a protocol.
"""

from __future__ import annotations

import marshal
import os
import sys
import zlib
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import Any

from xei_lang.record import Record, record
from xei_lang.resources import resource_path

STARTS = ("module", "predicate", "expression", "role_expression")
END = "$END"
_FORMAT = 1


@record
class Rule(Record):
    """One production. `parts` holds (index, spliced) of each child; the index -1 stands for a missing option.

    `passes` marks a production whose only child is its value; `action` names the builder's method, or is
    empty for a helper, whose children are spliced into the rule around it. `plain` children need no work.
    """

    origin: str
    action: str
    size: int
    passes: bool
    plain: bool
    parts: tuple[tuple[int, bool], ...]


@record
class Tables(Record):
    """`actions[state][terminal]` is a state to shift to, or `-1 - rule` to reduce by; `gotos` are for rules.

    `patterns` are (name, regular expression) in the order in which to try them, `words` the keywords and
    `signs` the punctuation by their text. `ignored` names patterns that are no tokens.
    """

    rules: tuple[Rule, ...]
    actions: tuple[dict[str, int], ...]
    gotos: tuple[dict[str, int], ...]
    start_states: dict[str, int]
    end_states: dict[str, int]
    patterns: tuple[tuple[str, str], ...]
    words: dict[str, str]
    signs: dict[str, str]
    ignored: tuple[str, ...]


def load_tables(cache_folder: Path | None = None) -> Tables:
    """The tables of `grammar/xei.lark`, from the user's cache where they are there, current and whole.

    A cache that cannot be read or written is no error: the tables are then made anew.
    """
    grammar = resource_path("grammar/xei.lark").read_text(encoding="utf-8")
    path = (cache_folder or _cache_folder()) / "grammar.table"
    key = (_FORMAT, sys.version_info[:3], grammar)
    cached = _read(path, key)
    if cached is not None:
        return cached
    from xei_lang.syntax.generate import make_tables

    tables = make_tables(grammar)
    _write(path, key, tables)
    return tables


def _cache_folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return (Path(base) if base else Path.home() / ".cache") / "xei"
    except RuntimeError:
        return Path(os.devnull)


def _read(path: Path, key: tuple[Any, ...]) -> Tables | None:
    try:
        data = path.read_bytes()
        if int.from_bytes(data[:4], "big") != zlib.crc32(data[4:]):
            return None
        stored_key, rules, *rest = marshal.loads(data[4:])
        return Tables(tuple(Rule(*rule) for rule in rules), *rest) if stored_key == key else None
    except (OSError, ValueError, EOFError, TypeError):
        return None


def _write(path: Path, key: tuple[Any, ...], tables: Tables) -> None:
    _, *rest = (getattr(tables, field.name) for field in fields(Tables))
    rules = tuple(tuple(getattr(rule, field.name) for field in fields(Rule)) for rule in tables.rules)
    payload = marshal.dumps((key, rules, *rest))
    aside = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        aside.write_bytes(zlib.crc32(payload).to_bytes(4, "big") + payload)
        aside.replace(path)
    except OSError:
        with suppress(OSError):
            aside.unlink(missing_ok=True)
