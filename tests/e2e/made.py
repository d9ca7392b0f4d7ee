"""Protocols compiled in this process, once each."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from xei_lang.pipeline import ALL, Outcome, Request, compile_request
from xei_lang.syntax.reading import read_source

ROOT = Path(__file__).resolve().parents[2]
PROTOCOLS = tuple(sorted((ROOT / "protocols").glob("*.xei")))


@lru_cache
def compiled(path: Path) -> tuple[Request, Outcome]:
    """The request and everything that came of it."""
    source, said = read_source(path, f"protocols/{path.name}")
    assert source is not None, said
    request = Request(source, profile_folder=ROOT / "profiles")
    return request, compile_request(request, ALL)
