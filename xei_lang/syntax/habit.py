"""One miswriting, and what was meant by it."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Edit, Fix, Span


@dataclass(frozen=True, slots=True)
class Habit:
    """A known miswriting at characters `[start, end)`, with the text to put there if that mends it.

    `certain` says that the mend can mean nothing else than what was meant. The text is read on behind
    `through`, or behind the habit itself.
    """

    message: str
    label: str
    start: int
    end: int
    help: tuple[str, ...] = ()
    mend: str | None = None
    certain: bool = True
    through: int = 0

    def fix(self, file: str) -> Fix | None:
        """The mend as an edit."""
        if self.mend is None:
            return None
        edit = Edit(Span(file, self.start, self.end), self.mend)
        return Fix("safe" if self.certain else "unsafe", (edit,))


def instead(written: str, right: str, start: int, advice: str, *, certain: bool = True) -> Habit:
    """A sign or word that another language has, and the one that stands for it here."""
    message = f"`{written}` has no such use here"
    label = f"expected `{right.strip()}`"
    return Habit(message, label, start, start + len(written), (advice,), right, certain)


def short(text: str) -> str:
    """A text as a message can quote it."""
    return text if len(text) <= 40 else text[:37] + "..."
