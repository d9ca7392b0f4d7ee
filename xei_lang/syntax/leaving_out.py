"""Leaving out what cannot be mended: on to the next comma, statement or closing brace."""

from __future__ import annotations

from bisect import bisect_left

from xei_lang.syntax.cursor import ITEM, STATEMENT, Cursor, braces
from xei_lang.syntax.layout import begins_line, indent, is_nearly_statement, looks_like_statement
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.stack import Stack
from xei_lang.syntax.tables import END


def leave_out_argument(cursor: Cursor) -> bool:
    """Drop an argument of a call or an item of a list, with its comma."""
    length = len(cursor.done)
    depth = cursor.opened
    if depth is None or depth[0].text == "{":
        return False
    while length and cursor.done[length - 1].token is not depth[0]:
        done = cursor.done[length - 1]
        if done.token.text == "," and done.opened == depth:
            break
        length -= 1
    base = cursor.below(length)
    level = 0
    for index in range(cursor.at, len(cursor.tokens)):
        text = cursor.tokens[index].text
        if text in ("{", "}", "") or (
            looks_like_statement(cursor.tokens, index) and begins_line(cursor.tokens, index, cursor.text)
        ):
            return False
        if level == 0 and text in (",", ")", "]"):
            begin = index + (text == ",")
            if cursor.machine.run(base, cursor.tokens, begin, 3)[1] < 3:
                return False
            cursor.skip(length, begin)
            return True
        level += (text in ("(", "[")) - (text in (")", "]"))
    return False


def leave_out(cursor: Cursor) -> bool:
    """Drop what was begun, or only what follows, and go on where a statement or definition can begin."""
    length = cursor.statement_start()
    stack = cursor.below(length)
    header = _header(cursor, length, stack)
    base = stack
    for token in header:
        stepped = cursor.machine.step(base, token)
        base = base if stepped is None else stepped[0]
    for index in range(cursor.at, len(cursor.tokens)):
        if index > cursor.at and _goes_on(cursor, cursor.stack, index):
            cursor.skip(len(cursor.done), index)
            return True
        if _goes_on(cursor, base, index):
            cursor.skip(length, index)
            return cursor.put_in(header)
        if _stands_outside(cursor, base, index):
            cursor.skip(length, index)
            brace = cursor.tokens[index]
            opening = Token("LBRACE", "{", brace.start, brace.start)
            return cursor.put_in((*header, *_block_header(cursor, length, base, brace), opening))
        if cursor.tokens[index].text == "{":
            alone = index > cursor.at and begins_line(cursor.tokens, index, cursor.text)
            if alone and cursor.machine.shift(cursor.stack, STATEMENT) is not None:
                cursor.skip(len(cursor.done), index)
                cursor.resumed_at = -1
                return True
            block = _block_header(cursor, length, stack, cursor.tokens[index])
            cursor.skip(length, index)
            return cursor.put_in((*header, *block))
    return _close_all(cursor, length)


def _goes_on(cursor: Cursor, stack: Stack, index: int) -> bool:
    """Whether a new statement, or the end of a block, stands at `index` and can follow."""
    token = cursor.tokens[index]
    if token.kind == END:
        return cursor.machine.step(stack, token) is not None
    if token.text != "}" and not (
        begins_line(cursor.tokens, index, cursor.text)
        and (looks_like_statement(cursor.tokens, index) or is_nearly_statement(cursor.tokens, index))
    ):
        return False
    return cursor.machine.run(stack, cursor.tokens, index, 1)[1] == 1


def _stands_outside(cursor: Cursor, stack: Stack, index: int) -> bool:
    """Whether a statement stands outside of all definitions, as behind a brace that closes too early."""
    tokens = cursor.tokens
    return (
        cursor.machine.shift(stack, ITEM) is not None
        and begins_line(tokens, index, cursor.text)
        and indent(tokens[index], cursor.text) > 0
        and looks_like_statement(tokens, index)
    )


def _header(cursor: Cursor, length: int, stack: Stack) -> tuple[Token, ...]:
    """What keeps the block that the dropped part has opened, so that its brace still closes something."""
    outer = cursor.opened_at(length)
    lost = braces(cursor.opened) - braces(outer)
    header: list[Token] = []
    for number in range(lost):
        opening = cursor.tokens[cursor.at]
        header.extend(_block_header(cursor, length, stack, opening) if number == 0 else ())
        header.append(Token("LBRACE", "{", opening.start, opening.start))
    return tuple(header) if lost == 1 else ()


def _block_header(cursor: Cursor, length: int, stack: Stack, brace: Token) -> tuple[Token, ...]:
    """What a block can stand behind, and an `else` behind that; at the top of a file a definition."""
    at = brace.start
    index = bisect_left(cursor.tokens, brace.end, lo=cursor.at, key=lambda token: token.start)
    if cursor.tokens[index].text == "{" and cursor.machine.shift(stack, "PARALLEL") is not None:
        return (Token("PARALLEL", "parallel", at, at),)
    if cursor.machine.shift(stack, "IF") is not None:
        return (Token("IF", "if", at, at), Token("TRUE", "true", at, at))
    name = Token("NAME", f"left_out_{at}", at, at)
    words = [done.token.text for done in cursor.done[length:]]
    if words[:1] == ["protocol"]:
        return (Token("PROTOCOL", "protocol", at, at), name)
    return (
        Token("PROCEDURE", "procedure", at, at),
        name,
        Token("LPAR", "(", at, at),
        Token("RPAR", ")", at, at),
    )


def _close_all(cursor: Cursor, length: int) -> bool:
    """At the end of the file: close what is open, with the statement that was begun left out."""
    cursor.skip(length, len(cursor.tokens) - 1)
    end = cursor.tokens[-1]
    while cursor.opened is not None:
        if not cursor.put_in((Token("RBRACE", "}", end.start, end.start),)):
            return False
    return cursor.machine.step(cursor.stack, end) is not None
