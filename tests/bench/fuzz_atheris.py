"""Bad input, guided by coverage, for as long as one likes: python tests/bench/fuzz_atheris.py [options]

Needs `pip install atheris`, which has wheels for Linux; it is in no extra, for the tests do without it. Bytes
become a protocol that is changed in places, a text of its own, or a CSV table that a protocol imports; the
front end must meet all of them without an exception. Options are those of libFuzzer: -max_total_time=600
stops after ten minutes, -runs=100000 after so many texts.
"""

from __future__ import annotations

import sys
from pathlib import Path

import atheris  # pyright: ignore[reportMissingImports]

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

with atheris.instrument_imports(include=["xei_lang"]):
    from tests.check.checking import protocol
    from tests.check.test_hostile_files import CELLS, HEADS, check_with
    from tests.syntax.test_fuzz import PIECES, TEXTS, front


def text_of(data: bytes) -> str:
    """A text from the fuzzer's bytes: free, or a right protocol with pieces put into it."""
    given = atheris.FuzzedDataProvider(data)
    if given.ConsumeBool():
        return given.ConsumeUnicodeNoSurrogates(4_000)
    text = TEXTS[given.ConsumeIntInRange(0, len(TEXTS) - 1)]
    for _ in range(given.ConsumeIntInRange(1, 8)):
        begin = given.ConsumeIntInRange(0, len(text))
        end = min(len(text), begin + given.ConsumeIntInRange(0, 20))
        put = PIECES[given.ConsumeIntInRange(0, len(PIECES) - 1)]
        text = text[:begin] + put + text[end:]
    return text


IMPORTING = f'import table "plan.csv" as plan\n{protocol("for row in plan { wait 1 s }")}'


def table_of(given: atheris.FuzzedDataProvider) -> str:
    """A CSV text from the fuzzer's bytes: heads and cells, some of them free, and whatever parts them."""
    parts = (*HEADS, *CELLS, ",", ",", "\n", "\r\n", ";")
    found: list[str] = []
    for _ in range(given.ConsumeIntInRange(0, 40)):
        free = given.ConsumeIntInRange(0, 4) == 0
        found.append(
            given.ConsumeUnicodeNoSurrogates(6) if free else parts[given.ConsumeIntInRange(0, len(parts) - 1)]
        )
    return "".join(found)


def test_one(data: bytes) -> None:
    """What libFuzzer calls. A first byte below 64 is a table."""
    if data[:1] and data[0] < 64:
        check_with(IMPORTING, {"plan.csv": table_of(atheris.FuzzedDataProvider(data[1:]))})
    else:
        front(text_of(data))


if __name__ == "__main__":
    atheris.Setup(sys.argv, test_one)
    atheris.Fuzz()
