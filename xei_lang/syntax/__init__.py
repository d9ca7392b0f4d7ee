"""From the text of a protocol to its syntax tree."""

from __future__ import annotations

from xei_lang.syntax.parser import (
    Parser,
    parse_expression,
    parse_module,
    parse_predicate,
    parse_role_expression,
)
from xei_lang.syntax.reading import read_source

__all__ = [
    "Parser",
    "parse_expression",
    "parse_module",
    "parse_predicate",
    "parse_role_expression",
    "read_source",
]
