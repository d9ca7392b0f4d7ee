"""From the text of a protocol to its syntax tree."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.syntax.reading import read_source

if TYPE_CHECKING:
    from xei_lang.syntax.parser import (
        Parser,
        parse_expression,
        parse_module,
        parse_predicate,
        parse_role_expression,
    )

__all__ = [
    "Parser",
    "parse_expression",
    "parse_module",
    "parse_predicate",
    "parse_role_expression",
    "read_source",
]


def __getattr__(name: str) -> object:
    # The parser and the tree take longer to import than a check of an unchanged file takes (PEP 562).
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from xei_lang.syntax import parser

    return getattr(parser, name)
