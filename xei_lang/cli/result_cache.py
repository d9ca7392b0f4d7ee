"""What checks of unchanged files said, kept between runs of `xei check`.

A result is found again only for the same text, the same answers to everything that its check asked of the
disk (imports, tables, the profile: see `xei_lang.inputs`), the same options and working folder, the same
grammar and the same code of xei: the version alone would answer wrongly in a working copy of the project.
The results of one folder's files share one file of the cache, JSON behind its own SHA-256: it holds no code,
and one that is cut, changed or foreign counts as absent, as does one that cannot be read or written.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from pathlib import Path
from typing import Any, cast

from xei_lang.cli.options import Options
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.plain import Plain, from_plain
from xei_lang.inputs import Outside, Question
from xei_lang.profiles.cache_key import code_state, digest_of
from xei_lang.resources import resource_path

MAX_RESULTS = 5_000
"""How many results one file of the cache holds; the oldest make room."""
MAX_SAID = 200
"""A result of more diagnostics is not kept: it will change soon, and is long."""
MAX_BYTES = 64_000_000
"""How large all files of results may be together; those written longest ago make room."""
_NAME = "results-"

Asked = tuple[tuple[Question, str], ...]
"""What a check asked of the disk, with digests of the answers."""

_Shard = dict[str, Any]
"""By file: the digest of its text, questions with their answers, diagnostics in their plain form."""


class ResultCache:
    """The results that one run finds and adds; `write` keeps those that were added."""

    def __init__(self, folder: Path, options: Options) -> None:
        grammar = resource_path("grammar/xei.lark").read_text(encoding="utf-8")
        asked = (str(options.profile), options.bindings, options.params, options.seed)
        self._folder = folder
        self._salt = digest_of(code_state(), grammar, os.getcwd(), asked)
        self._read: dict[str, _Shard] = {}
        self._added: dict[str, _Shard] = {}

    def find(self, source: Source, outside: Outside) -> tuple[Diagnostics, Asked] | None:
        """What a check of this text would say, and what it would ask; None where that is not known."""
        shard = os.path.dirname(source.file)
        if shard not in self._read:
            self._read[shard] = _read(self._path(shard))
        try:
            text, answers, said = self._read[shard][source.file]
            asked = tuple((tuple(question), answer) for question, answer in answers)
            same = text == text_digest(source) and all(
                outside.answer(item) == answer for item, answer in asked
            )
            return (from_plain(said), asked) if same else None
        except (KeyError, TypeError, ValueError):
            return None

    def add(self, file: str, text: str, asked: Asked, said: Plain) -> None:
        """Keep what a check of `file` said, whose text has the digest `text`."""
        if len(said) <= MAX_SAID:
            answers = [[list(question), answer] for question, answer in asked]
            self._added.setdefault(os.path.dirname(file), {})[file] = [text, answers, said]

    def write(self) -> None:
        """Put what was added to the disk, beside what other runs have put there; a fault changes nothing."""
        if not self._added:
            return
        with contextlib.suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            for shard, added in self._added.items():
                path = self._path(shard)
                before = {file: kept for file, kept in _read(path).items() if file not in added}
                _write(path, dict([*before.items(), *added.items()][-MAX_RESULTS:]))
            _evict(self._folder)
        self._added.clear()

    def _path(self, shard: str) -> Path:
        return self._folder / f"{_NAME}{digest_of(self._salt, shard)[:40]}.json"


def text_digest(source: Source) -> str:
    """SHA-256 of a text."""
    return hashlib.sha256(source.text.encode("utf-8")).hexdigest()


def _read(path: Path) -> _Shard:
    try:
        named, _, payload = path.read_bytes().partition(b"\n")
        whole = named == hashlib.sha256(payload).hexdigest().encode()
        kept: object = json.loads(payload) if whole else {}
    except (OSError, ValueError, RecursionError):
        return {}
    return cast(_Shard, kept) if isinstance(kept, dict) else {}


def _write(path: Path, results: _Shard) -> None:
    payload = json.dumps(results, separators=(",", ":")).encode()
    aside = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        aside.write_bytes(hashlib.sha256(payload).hexdigest().encode() + b"\n" + payload)
        os.replace(aside, path)
    except BaseException:
        with contextlib.suppress(OSError):
            aside.unlink(missing_ok=True)
        raise


def _evict(folder: Path) -> None:
    with os.scandir(folder) as entries:
        states = [(entry.stat(), entry.path) for entry in entries if entry.name.startswith(_NAME)]
    total = sum(state.st_size for state, _ in states)
    for state, path in sorted(states, key=lambda item: (item[0].st_mtime_ns, item[1])):
        if total <= MAX_BYTES:
            return
        with contextlib.suppress(OSError):
            os.unlink(path)
        total -= state.st_size
