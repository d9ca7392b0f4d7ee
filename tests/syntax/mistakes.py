"""Slips of the hand, put into protocols that are right, and how well the parser finds them.

    python -m tests.syntax.mistakes [-v]

prints the rates, and with -v where something went wrong. A slip changes one place of one line so that the
text no longer follows the grammar; a change that leaves it valid is drawn anew. It is found if a diagnostic
points into its line. A brace that is dropped leaves no line of its own: it is found if the diagnostic points
at its line, or at the next written line above or below. A diagnostic is spurious if it points at no slip, or
at one that another has told of.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tests.syntax import corpus
from xei_lang.diagnostics import Source
from xei_lang.syntax import Parser

PARSER = Parser()
PROTOCOLS = Path(__file__).parents[2] / "protocols"
SEED = 20
_TOKEN = re.compile(r'#[^\n]*|"[^"\n]*"|\d+(?:\.\d+)?|\w+|\.\.|[=!<>:+-]=|[^\s\w]')
_KEYWORDS = [
    "for",
    "in",
    "times",
    "wait",
    "let",
    "require",
    "measure",
    "repeat",
    "parallel",
    "if",
    "else",
    "do",
    "keep",
    "pause",
    "start",
    "await",
    "stop",
    "confirm",
    "unmapped",
    "because",
    "note",
    "profile",
    "param",
    "object",
    "given",
    "contains",
    "of",
    "within",
    "after",
    "by",
    "until",
    "unordered",
    "protocol",
]
_INSERTED = ["=", ",", ")", "(", "]", ":", "..", "==", "5", "x", '"a"', "*", "]", "@", "%", "'", "?", "$"]


@dataclass(frozen=True)
class Slip:
    """A mistake: what kind it is, and the lines (from 1) where telling of it is right."""

    kind: str
    line: int
    first: int
    last: int


@dataclass
class Score:
    """What was found of what was there."""

    slips: int = 0
    found: int = 0
    spurious: int = 0
    files: int = 0


def programs(rng: random.Random, count: int) -> list[str]:
    """Valid programs: those of the project, and others put together from the constructs of the corpus."""
    fixed = [corpus.WHOLE, *(path.read_text() for path in sorted(PROTOCOLS.glob("*.xei")))]
    found: list[str] = []
    while len(found) < count:
        text = fixed[len(found)] if len(found) < len(fixed) else _composed(rng)
        if not is_wrong(text.split("\n")):
            found.append(text)
    return found


def _composed(rng: random.Random) -> str:
    members = list(corpus.MEMBERS.values())
    body: list[str] = []
    for _ in range(rng.randint(6, 14)):
        chosen = rng.choice(members)
        if chosen.startswith("#"):
            chosen = "# a comment\nhome()"
        body += (
            _laid_out(chosen, 1)
            if rng.random() < 0.6
            else [f"  {part.strip()}" for part in chosen.split("\n")]
        )
        if rng.random() < 0.3:
            inner = [line for _ in range(rng.randint(1, 3)) for line in _laid_out(_step(rng), 2)]
            body += [
                f"  {rng.choice(['do {', 'for i in 1 .. 8 {', 'if ready {', 'repeat 3 times {'])}",
                *inner,
                "  }",
            ]
    return "\n".join(["xei 1", "", "protocol p {", '  profile "openarm_bench"', *body, "}", ""])


def _step(rng: random.Random) -> str:
    names = ["call", "within", "wait", "measure", "for", "repeat until", "else if", "parallel", "let", "keep"]
    return corpus.MEMBERS[rng.choice(names)]


def _laid_out(member: str, depth: int) -> list[str]:
    """The lines of a member with each block spread over lines, as the formatter has it."""
    spread = re.sub(r"\{ *", "{\n", member)
    spread = re.sub(r" *\}", "\n}", spread).replace("\n\n", "\n")
    spread = re.sub(r"\} +(?!else|within|after)", "}\n", spread)
    lines: list[str] = []
    for line in (part.strip() for part in spread.split("\n")):
        if not line:
            continue
        depth -= line.startswith("}")
        lines.append("  " * depth + line)
        depth += line.count("{") - (line.count("}") - line.startswith("}"))
    return lines


def _pick(rng: random.Random, line: str, fits: Callable[[re.Match[str]], bool]) -> re.Match[str] | None:
    tokens = [match for match in _TOKEN.finditer(line) if match[0][0] != "#" and fits(match)]
    return rng.choice(tokens) if tokens else None


def _cut(line: str, match: re.Match[str] | None, new: str) -> str | None:
    return None if match is None else line[: match.start()] + new + line[match.end() :]


def _drop_sign(rng: random.Random, line: str) -> str | None:
    return _cut(line, _pick(rng, line, lambda m: m[0] in tuple("()[],:=.") or m[0] == ".."), "")


def _drop_word(rng: random.Random, line: str) -> str | None:
    return _cut(line, _pick(rng, line, lambda m: m[0][0].isalnum()), "")


def _twice(rng: random.Random, line: str) -> str | None:
    match = _pick(rng, line, lambda m: m[0] not in "{}")
    return _cut(line, match, f"{match[0]} {match[0]}") if match else None


def _misspelt(rng: random.Random, line: str) -> str | None:
    match = _pick(rng, line, lambda m: m[0] in _KEYWORDS)
    if match is None:
        return None
    word = match[0]
    at = rng.randrange(len(word))
    return _cut(
        line, match, rng.choice([word[:at] + word[at + 1 :], word[:at] + word[at] * 2 + word[at + 1 :]])
    )


def _swapped(rng: random.Random, line: str) -> str | None:
    tokens = [match for match in _TOKEN.finditer(line) if match[0][0] not in "#{}"]
    if len(tokens) < 2:
        return None
    at = rng.randrange(len(tokens) - 1)
    left, right = tokens[at], tokens[at + 1]
    middle = line[left.end() : right.start()]
    return line[: left.start()] + right[0] + middle + left[0] + line[right.end() :]


def _put_in(rng: random.Random, line: str) -> str | None:
    match = _pick(rng, line, lambda m: m[0] not in "{}")
    return _cut(line, match, f"{match[0]} {rng.choice(_INSERTED)}") if match else None


def _quote(rng: random.Random, line: str) -> str | None:
    at = [index for index, char in enumerate(line.split("#", maxsplit=1)[0]) if char == '"']
    if not at:
        return None
    index = rng.choice(at)
    return line[:index] + line[index + 1 :]


def _other_sign(rng: random.Random, line: str) -> str | None:
    match = _pick(rng, line, lambda m: m[0] in tuple("()[],:="))
    if match is None:
        return None
    return _cut(line, match, rng.choice([sign for sign in "()[],:=;" if sign != match[0]]))


def _brace(rng: random.Random, line: str) -> str | None:
    return _cut(line, _pick(rng, line, lambda m: m[0] in "{}"), "")


_HABITS = (
    (r"\b(\d+) uL", r"\1 ul"),
    (r"\b(\d+) mL", r"\1 \u00b5L"),
    (r"\b(\d+) min", r"\1 minutes"),
    (r"\b(\d+) degC", "\\1 \u00b0C"),
    (r" times\b", ""),
    (r" and ", " && "),
    (r"\)$", ");"),
    (r"(\(\w+)=", r"\1: "),
    (r"else if", "elif"),
    (r"wait (?=\d)", "wait for "),
    (r'"(\w+)"', r"'\1'"),
)


def _habit(rng: random.Random, line: str) -> str | None:
    fitting = [(old, new) for old, new in _HABITS if re.search(old, line)]
    if not fitting:
        return None
    old, new = rng.choice(fitting)
    return re.sub(old, new.replace("\\u00b5", "\u00b5"), line, count=1)


KINDS: dict[str, Callable[[random.Random, str], str | None]] = {
    "dropped sign": _drop_sign,
    "dropped word": _drop_word,
    "token twice": _twice,
    "misspelt keyword": _misspelt,
    "swapped tokens": _swapped,
    "token put in": _put_in,
    "dropped quote": _quote,
    "wrong sign": _other_sign,
    "habit": _habit,
    "dropped brace": _brace,
}


def is_wrong(lines: list[str]) -> bool:
    """Whether these lines do not follow the grammar."""
    return bool(PARSER.module(Source("t.xei", "\n".join(lines)))[1])


def slip(rng: random.Random, lines: list[str], kind: str, taken: frozenset[int] = frozenset()) -> Slip | None:
    """Put one slip of a kind into the lines, outside of the lines that are taken; None if none fits."""
    for _ in range(60):
        index = rng.randrange(len(lines))
        if index in taken:
            continue
        changed = KINDS[kind](rng, lines[index])
        if changed is None or changed == lines[index]:
            continue
        before, lines[index] = lines[index], changed
        if is_wrong(lines):
            first, last = (
                (_written(lines, index, -1), _written(lines, index, 1)) if "brace" in kind else (index, index)
            )
            return Slip(kind, index + 1, first + 1, last + 1)
        lines[index] = before
    return None


def _written(lines: list[str], index: int, step: int) -> int:
    index += step
    while 0 < index < len(lines) - 1 and not lines[index].strip():
        index += step
    return max(0, min(index, len(lines) - 1))


def score(lines: list[str], slips: list[Slip], scores: dict[str, Score]) -> list[str]:
    """Parse, and match what is said with the slips; gives what matches none, and what was missed."""
    source = Source("t.xei", "\n".join(lines))
    _, said = PARSER.module(source)
    waiting = list(slips)
    notes: list[str] = []
    scores["all"].files += 1
    for diagnostic in said:
        assert diagnostic.span is not None
        line = source.line_number(diagnostic.span.start)
        near = sorted(waiting, key=lambda s: abs(s.line - line))
        match = next((s for s in near if s.first <= line <= s.last), None)
        if match is None:
            scores["all"].spurious += 1
            notes.append(f"spurious {line}: {diagnostic.message}")
            continue
        waiting.remove(match)
    for one in slips:
        for key in (one.kind, "all"):
            scores[key].slips += 1
            scores[key].found += one not in waiting
    return notes + [f"missed {one}" for one in waiting]


def measure(
    mistakes: int, files: int, seed: int = SEED
) -> tuple[dict[str, Score], list[tuple[str, list[str]]]]:
    """The scores of so many files with so many mistakes each, and the texts where something went wrong."""
    rng = random.Random(seed)
    scores = {name: Score() for name in (*KINDS, "all")}
    bad: list[tuple[str, list[str]]] = []
    kinds = list(KINDS)
    for number, text in enumerate(programs(rng, files)):
        lines = text.split("\n")
        slips: list[Slip] = []
        for turn in range(mistakes):
            kind = kinds[(number + turn * 3) % len(kinds)]
            taken = frozenset(one.line - 1 for one in slips)
            made = None
            while made is None:
                made = _alone(rng, text.split("\n"), lines, kind, taken)
                kind = rng.choice(kinds)
            slips.append(made)
        notes = score(lines, slips, scores)
        if notes:
            bad.append(("\n".join(lines), notes))
    return scores, bad


def _alone(
    rng: random.Random, whole: list[str], lines: list[str], kind: str, taken: frozenset[int]
) -> Slip | None:
    """A slip that is a mistake by itself, made in the right text and carried over to the one with others."""
    made = slip(rng, whole, kind, taken)
    if made is not None:
        lines[made.line - 1] = whole[made.line - 1]
    return made


def main() -> int:
    """Print the rates."""
    import sys

    for title, mistakes, files in (("one mistake", 1, 200), ("five mistakes", 5, 100)):
        scores, bad = measure(mistakes, files)
        total = scores["all"]
        print(f"{title} in each of {files} files")
        for name, one in scores.items():
            if one.slips:
                print(f"  {name:18} {one.found:4} of {one.slips:4} found ({one.found / one.slips:.1%})")
        print(f"  spurious           {total.spurious:4} ({total.spurious / total.files:.3f} a file)")
        if "-v" in sys.argv:
            for text, notes in bad:
                numbered = "\n".join(f"{i:3} {line}" for i, line in enumerate(text.split("\n"), 1))
                print(numbered, *notes, sep="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
