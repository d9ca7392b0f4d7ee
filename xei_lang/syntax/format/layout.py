"""Where lines break: documents of text and possible breaks, laid out within a width.

The method is that of C. Lindig, "Strictly Pretty" (2000), after P. Wadler, "A prettier printer" (1998): a
group stands on one line if it fits there, else each break of its own is a line break. A comment ends its
line, so what holds one never fits.
"""

from __future__ import annotations

from dataclasses import dataclass

INDENT = 2


@dataclass(frozen=True, slots=True, eq=False)
class Space:
    """A space, unless a line ends or begins here."""


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line break; in a group that fits on one line a space, or with `soft` nothing."""

    soft: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Hard:
    """A line break in any case, unless a line begins here already; with `blank` an empty line as well."""

    blank: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Remark:
    """A comment behind what stands before it, or on a line of its own; its line ends with it."""

    text: str
    own_line: bool


@dataclass(frozen=True, slots=True, eq=False)
class Comma:
    """The comma behind the last of several, there only if they stand on lines of their own."""


@dataclass(frozen=True, slots=True, eq=False)
class Cat:
    """One after the other."""

    parts: tuple[Doc, ...]
    breaks: bool


@dataclass(frozen=True, slots=True, eq=False)
class Nest:
    """Lines that begin inside are indented by so many columns more."""

    doc: Doc
    columns: int
    breaks: bool


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """On one line if it fits."""

    doc: Doc
    breaks: bool


Doc = str | Space | Line | Hard | Remark | Comma | Cat | Nest | Group
"""A text in a document has no space at its ends and no line break."""

SPACE, LINE, SOFT, HARD, BLANK, COMMA = Space(), Line(), Line(soft=True), Hard(), Hard(blank=True), Comma()
EMPTY: Doc = ""


def cat(*parts: Doc) -> Doc:
    """The parts one after the other."""
    return Cat(parts, any(_breaks(part) for part in parts if type(part) is not str))


def spaced(*parts: Doc) -> Doc:
    """The parts with a space between them."""
    return cat(*[doc for part in parts for doc in (SPACE, part)][1:])


def nest(*parts: Doc, columns: int = INDENT) -> Doc:
    """The parts, indented where lines begin in them."""
    doc = cat(*parts)
    return Nest(doc, columns, _breaks(doc))


def group(*parts: Doc) -> Doc:
    """The parts on one line, or each break in them a line break."""
    doc = cat(*parts)
    return Group(doc, _breaks(doc))


def _breaks(doc: Doc) -> bool:
    """Whether it can't stand on one line."""
    if isinstance(doc, Cat | Nest | Group):
        return doc.breaks
    return isinstance(doc, Hard | Remark)


_Entry = tuple[int, bool, Doc]
"""Indentation, whether on one line, and what."""


class _Page:
    """The text so far. Indentation and spaces are written once a text follows: no line ends in them."""

    def __init__(self) -> None:
        self.out: list[str] = []
        self.column = 0
        self.fresh = True
        self._space = False
        self._words_end = 0

    def text(self, text: str, indent: int) -> None:
        if self.fresh:
            self.out.append(" " * indent)
            self.column = indent
            self.fresh = False
        elif self._space:
            self.out.append(" ")
            self.column += 1
        self._space = False
        self.out.append(text)
        self.column += len(text)
        self._words_end = len(self.out)

    def space(self) -> None:
        self._space = not self.fresh

    def line(self) -> None:
        if not self.fresh:
            self.out.append("\n")
            self.column, self.fresh, self._space = 0, True, False

    def remark(self, remark: Remark, indent: int) -> None:
        """A comment behind words goes to their line, although that line may have been ended since."""
        if not remark.own_line and self._words_end and len(self.out) - self._words_end <= self.fresh:
            self.out.insert(self._words_end, f"  {remark.text}")
        else:
            self.line()
            self.text(remark.text, indent)
        self.line()
        self._words_end = 0

    def blank(self) -> None:
        self.line()
        if self.out:
            self.out.append("\n")


def render(doc: Doc, width: int) -> str:
    """The document as text, with lines of at most `width` characters wherever breaks permit."""
    page = _Page()
    stack: list[_Entry] = [(0, False, doc)]
    while stack:
        indent, flat, current = stack.pop()
        match current:
            case str():
                if current:
                    page.text(current, indent)
            case Cat():
                stack.extend((indent, flat, part) for part in reversed(current.parts))
            case Nest():
                stack.append((indent + current.columns, flat, current.doc))
            case Group():
                fits = flat or (
                    not current.breaks and _fits(current.doc, width - max(page.column, indent), stack)
                )
                stack.append((indent, fits, current.doc))
            case Remark():
                page.remark(current, indent)
            case Comma():
                if not flat:
                    page.text(",", indent)
            case _:
                _separate(page, current, flat)
    return "".join(page.out)


def _separate(page: _Page, separator: Space | Line | Hard, flat: bool) -> None:
    match separator:
        case Space():
            page.space()
        case Line():
            if not flat:
                page.line()
            elif not separator.soft:
                page.space()
        case Hard():
            if separator.blank:
                page.blank()
            else:
                page.line()


def _fits(doc: Doc, room: int, behind: list[_Entry]) -> bool:
    """Whether `doc` on one line, with what follows up to the next line break, takes no more than `room`."""
    todo: list[tuple[bool, Doc]] = [(True, doc)]
    rest = len(behind)
    while room >= 0:
        if not todo:
            if rest == 0:
                return True
            rest -= 1
            _, flat, current = behind[rest]
        else:
            flat, current = todo.pop()
        match current:
            case str():
                room -= len(current)
            case Space():
                room -= 1
            case Comma():
                room -= not flat
            case Line() if flat:
                room -= not current.soft
            case Line() | Hard() | Remark():
                return True
            case Cat():
                todo.extend((flat, part) for part in reversed(current.parts))
            case Nest() | Group():
                todo.append((not current.breaks if isinstance(current, Group) else flat, current.doc))
    return False
