"""Texts of about 100 kB that are made to cost much: by the trouble that each makes for the front end."""

from __future__ import annotations

import random
from collections.abc import Iterator

SIZE = 100_000
_STEP = "  a{i}: pour(source=b, target=c, volume=2 mL) within 30 s\n"


def nasty_texts(size: int = SIZE) -> Iterator[tuple[str, str]]:
    """Name and text of each, about `size` characters long; the same at each call."""
    yield from _lost_signs(size)
    yield from _one_thing(size)
    yield from _deep(size)
    yield from _slips(size)
    yield from _wide(size)
    yield from _random(size)


def _filled(size: int, unit: str, before: str = "protocol p {\n", after: str = "}\n") -> str:
    """Units one after the other, each with its number for `{i}`."""
    one = len(unit.replace("{i}", "1000"))
    return before + "".join(unit.replace("{i}", str(i)) for i in range(size // one)) + after


def _lost_signs(size: int) -> Iterator[tuple[str, str]]:
    whole = _filled(size, _STEP)
    yield "commas lost", whole.replace(",", "")
    yield "brackets lost", whole.replace(")", "")
    yield "brackets twice", whole.replace("(", "((")
    yield "a quote before each value", whole.replace("=", '="')
    yield "habits", whole.replace("mL", "ml;")
    yield "colons for equals", whole.replace("=", ":")
    yield "one line without commas", whole.replace("\n", " ").replace(",", "")
    yield "one line", whole.replace("\n", " ")
    yield "one mistake late", whole.removesuffix("}\n") + "  pour(source=b target=c)\n}\n"
    yield "a brace lost early", _filled(size, _STEP, "protocol p {\n  do {\n    home()\n", "}\n")


def _one_thing(size: int) -> Iterator[tuple[str, str]]:
    for name, unit in (
        ("opening braces", "{"),
        ("closing braces", "}"),
        ("braces apart", "{ "),
        ("pairs of braces", "{}"),
        ("strays", "$"),
        ("slashes", "//"),
        ("odd spaces", " \u00a0"),
        ("empty lines", "\n"),
        ("carriage returns", "\r"),
        ("NULs", "\0"),
        ("texts on one line", '"a" '),
        ("open texts", '"\n'),
        ("words", "word "),
        ("keywords", "for in wait repeat "),
        ("numbers", "1 "),
        ("digits", "9"),
        ("dots", "."),
        ("escapes", "\x1b[31m"),
    ):
        yield name, unit * (size // len(unit))
        yield f"{name} in a protocol", "protocol p {\n" + unit * (size // len(unit))
    yield "one long text", 'protocol p { note "' + "a" * size + '" }'
    yield "one long open text", 'protocol p { note "' + "a, " * (size // 3)
    yield "escapes in a text", 'protocol p { note "' + "\\q" * (size // 2) + '" }'
    yield "one long name", "protocol p { " + "a" * size + "() }"
    yield "one long number", "protocol p { wait " + "9" * size + " s }"
    yield "comments", _filled(size, "# comment {i}\n")
    yield "documentation", "## a line\n" * (size // 10) + "protocol p { }\n"
    yield "a document before many", "## first\n\n" + _filled(size, "  object o{i}: movable\n")
    yield "imports", "".join(f'import "f{i}.xei"\n' for i in range(size // 18)) + "protocol p { wait 1 s }\n"


def _deep(size: int) -> Iterator[tuple[str, str]]:
    for name, unit in (
        ("do", "do {"),
        ("do on lines", "do {\n"),
        ("if", "if a {\n"),
        ("for", "for i in 1 .. 9 { "),
        ("parallel", "parallel { { "),
    ):
        yield f"{name}, nested without end", "protocol p {" + unit * (size // len(unit))
        half = size // (len(unit) + unit.count("{"))
        yield (
            f"{name}, nested and closed",
            "protocol p {" + unit * half + "}" * (half * unit.count("{")) + "}",
        )
    for name, opening, closing in (
        ("round brackets", "(", ")"),
        ("square brackets", "[", "]"),
        ("calls", "f(", ")"),
        ("both brackets", "([", "])"),
        ("comprehensions", "[a for b in ", "]"),
    ):
        half = size // (len(opening) + len(closing))
        yield f"{name} without end", "protocol p { let x = " + opening * half
        yield f"{name} closed", "protocol p { let x = " + opening * half + "1" + closing * half + " }"
    yield "not", "protocol p { let x = " + "not " * (size // 4) + "true }"
    yield "minus", "protocol p { let x = " + "-" * size + "1 }"
    yield "else if", "protocol p { if a { } " + "else if a { } " * (size // 14) + "else"
    yield "else if, closed", "protocol p { if true { } " + "else if true { } " * (size // 17) + " }"
    yield "indented", "protocol p {\n" + "\n".join(" " * (i % 400) + "do {" for i in range(size // 204))
    yield "indented steps", "protocol p {\n" + "\n".join(" " * (i % 400) + "f()" for i in range(size // 204))


def _slips(size: int) -> Iterator[tuple[str, str]]:
    for name, unit in (
        ("a word for a value", "  wait = 1\n  home()\n"),
        ("no value", "  wait\n"),
        ("a comma too many", "  pour(source=a,, target=b)\n"),
        ("no bracket", "  pour(source=a, target=b\n"),
        ("misspelt words", "  repat 3 times { home() }\n"),
        ("a lost brace", "  do {\n    home()\n\n"),
        ("a brace too many", "  home() }\n"),
        ("an `=` too many", "  let x{i} == 1\n"),
        ("units of others", "  wait 10 minutes\n"),
        ("an `else` alone", "  else { home() }\n"),
        ("nearly statements", "  parm x{i} 1\n"),
    ):
        yield f"each line: {name}", _filled(size, unit)
    yield "a list of slips", "protocol p { let x = [" + "1 " * (size // 2)
    yield "a list of operators", "protocol p { let x = [" + "1, * " * (size // 5) + "] }"


def _wide(size: int) -> Iterator[tuple[str, str]]:
    yield "a long sum", "protocol p { let x = 1" + " + 1" * (size // 4) + " }"
    yield "a long `and`", "protocol p { let x = true" + " and true" * (size // 9) + " }"
    yield "a long list", "protocol p { let x = [1" + ", 1" * (size // 3) + "] }"
    yield "a long chain of dots", "protocol p { let x = a" + ".a" * (size // 2) + " }"
    yield "a long chain of indices", "protocol p { let x = a" + "[1]" * (size // 3) + " }"
    yield "many arguments", "protocol p { home(" + ", ".join(f"a{i}=1" for i in range(size // 9)) + ") }"
    yield "unknown names", _filled(size, "  require unknown_{i} > 1\n")
    yield "unknown skills", _filled(size, "  skil_{i}(a=1)\n")
    yield "unknown labels", _filled(size, "  wait 1 s after lable_{i}\n")
    yield "labels of one name", _filled(size, "  a: wait 1 s\n")
    yield "names of one name", _filled(size, "  let x = 1\n")
    yield "values on values", _filled(size, "  let x{i} = x{i} + 1\n")
    yield "steps after each other", _filled(size, "  s{i}: wait 1 s after s{i}\n")
    yield "procedures", _filled(size, "procedure p{i}() { wait 1 s }\n", "", "protocol p { wait 1 s }\n")
    yield (
        "calls of calls",
        "".join(f"procedure p{i}() {{ p{i + 1}() p{i + 1}() }}\n" for i in range(size // 40))
        + "protocol p { p0() }\n",
    )
    yield "turns without end", _filled(size, "  repeat 1000000000 times { wait 1 s }\n")
    yield (
        "loops in loops",
        _filled(size, "  for i in 1 .. 9999 { for j in 1 .. 9999 { for k in 1 .. 9999 { let x = i } } }\n"),
    )
    doubled = "  let x0 = [1, 2]\n" + "".join(f"  let x{i + 1} = [x{i}, x{i}]\n" for i in range(size // 25))
    yield "lists that double", "protocol p {\n" + doubled + "}\n"
    nest = "[a for a in 1 .. 999 for b in 1 .. 999 for c in 1 .. 999]"
    yield "comprehensions that multiply", _filled(size, "  let x{i} = " + nest + "\n")
    inner = "[[[[a for a in 1 .. 999] for b in 1 .. 999] for c in 1 .. 999] for d in 1 .. 999]"
    yield "comprehensions in each other", _filled(size, "  let x{i} = " + inner + "\n")
    yield (
        "powers",
        "protocol p {\n  let x0 = 10\n"
        + "".join(f"  let x{i + 1} = x{i} * x{i}\n" for i in range(size // 25))
        + "}\n",
    )


def _random(size: int) -> Iterator[tuple[str, str]]:
    for seed in range(3):
        rng = random.Random(seed)
        yield f"random bytes {seed}", rng.randbytes(size).decode("latin-1")
        signs = "{}()[],:;=.'\"# \n\tabc019"
        yield f"random signs {seed}", "".join(rng.choices(signs, k=size))
        pieces = [
            "for ",
            "in ",
            "wait ",
            "1 s ",
            "{ ",
            "}\n",
            "(",
            ") ",
            ", ",
            "x ",
            "= ",
            "let ",
            "if ",
            '"a" ',
            "\n",
        ]
        yield f"random pieces {seed}", "".join(rng.choices(pieces, k=size // 3))
        lines = [line + "\n" for line in _filled(size, _STEP).split("\n")]
        at = rng.sample(range(1, len(lines) - 1), len(lines) // 20)
        for index in at:
            line = lines[index]
            cut = rng.randrange(3, len(line) - 1)
            lines[index] = line[:cut] + rng.choice('{}()[],="$x1 ') + line[cut + 1 :]
        yield f"a slip in each 20 lines {seed}", "".join(lines)
