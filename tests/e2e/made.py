"""Protocols compiled in this process, once each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from xei_lang.cli.emit import text_after
from xei_lang.pipeline import ALL, Outcome, PassResult, Request, compile_request
from xei_lang.syntax.reading import read_source

ROOT = Path(__file__).resolve().parents[2]
PROTOCOLS = tuple(sorted((ROOT / "protocols").glob("*.xei")))
SMALL = tuple(sorted(Path(__file__).with_name("small").glob("*.xei")))
"""Small protocols that are taken as far as their goals: procedures, loops, branches, imports, tables."""


@dataclass(frozen=True)
class Made:
    """A compilation, watched: what each pass made, and what `--print-after` shows of it."""

    request: Request
    outcome: Outcome
    results: dict[str, PassResult]
    texts: dict[str, str]


@lru_cache
def passes(path: Path) -> Made:
    """Every pass of a protocol's compilation; a small one is not planned."""
    source, said = read_source(path, str(path.relative_to(ROOT)))
    assert source is not None, said
    request = Request(source, profile_folder=ROOT / "profiles", allow_unmapped=path in SMALL)
    results: dict[str, PassResult] = {}
    texts: dict[str, str] = {}

    def watch(result: PassResult) -> None:
        results[result.pass_name] = result
        if not result.failed:
            texts[result.pass_name] = text_after(result, source)

    until = [step.name for step in ALL].index("lower") + 1 if path in SMALL else len(ALL)
    return Made(request, compile_request(request, ALL[:until], watch), results, texts)


def compiled(path: Path) -> tuple[Request, Outcome]:
    """The request and everything that came of it."""
    made = passes(path)
    return made.request, made.outcome
