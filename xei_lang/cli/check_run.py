"""Checking files for `xei check`: what is said of each, from the cache, this process or several."""

from __future__ import annotations

import gc
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from xei_lang.cli.bug import ReportedBugError
from xei_lang.cli.options import Options
from xei_lang.cli.result_cache import Asked, ResultCache, text_digest
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.plain import Plain, from_plain, to_plain
from xei_lang.inputs import Inputs, Outside
from xei_lang.profiles.cache_key import default_cache
from xei_lang.record import Shown, record
from xei_lang.syntax.reading import read_source


@record
class Checked(Shown):
    """A file that was checked, by its name in messages.

    `text` is the digest of what was read, empty where nothing could be; `source` may be left out where
    nothing was said.
    """

    file: str
    said: Diagnostics
    source: Source | None
    text: str
    asked: Asked


@record
class Run(Shown):
    """How files are checked: `jobs` is the number of processes, `progress` is told how many are done."""

    options: Options
    jobs: int
    cached: bool
    progress: Callable[[int], None]


def check_file(file: Path, options: Options, inputs: Inputs) -> Checked:
    """Everything that is to be said of one file, found out anew."""
    source, said = read_source(file, str(file))
    if source is None:
        return Checked(str(file), said, None, "", ())
    from xei_lang.cli.session import request_for
    from xei_lang.pipeline import check_request

    outside = Outside(inputs, file, options.profile)
    request = request_for(source, options, allow_unmapped=True)
    said = check_request(replace(request, open_bindings=True, outside=outside))
    return Checked(str(file), said, source, text_digest(source), tuple(outside.asked.items()))


def check_files(files: Sequence[Path], run: Run) -> list[Checked]:
    """All files, in their order. Raises ReportedBugError where a process ends that should not."""
    inputs = Inputs(default_cache())
    cache = ResultCache(default_cache(), run.options) if run.cached else None
    found = {file: known for file in files if cache and (known := _known(file, run.options, inputs, cache))}
    unknown = [file for file in files if file not in found]
    before = len(found)

    def progress(done: int) -> None:
        run.progress(before + done)

    fresh = _fresh(unknown, replace(run, progress=progress), inputs)
    found.update(zip(unknown, fresh, strict=True))
    if cache is not None:
        _keep(fresh, run.options, cache)
    return [found[file] for file in files]


def _keep(fresh: Sequence[Checked], options: Options, cache: ResultCache) -> None:
    """Keep results whose profile and imports are still what they were before they were read."""
    now = Inputs(None)
    for item in fresh:
        outside = Outside(now, Path(item.file), options.profile)
        if item.text and all(outside.answer(question) == answer for question, answer in item.asked):
            cache.add(item.file, item.text, item.asked, to_plain(item.said))
    cache.write()


def _known(file: Path, options: Options, inputs: Inputs, cache: ResultCache) -> Checked | None:
    source, _ = read_source(file, str(file))
    if source is None:
        return None
    outside = Outside(inputs, file, options.profile)
    kept = cache.find(source, outside)
    if kept is None:
        return None
    said, asked = kept
    return Checked(source.file, said, source if said else None, text_digest(source), asked)


def _fresh(files: Sequence[Path], run: Run, inputs: Inputs) -> list[Checked]:
    """The files checked anew; the first one here, so that the processes begin with everything loaded."""
    alone = 1 if run.jobs > 1 and hasattr(os, "fork") else len(files)
    done: list[Checked] = []
    for file in files[:alone]:
        done.append(_lean(check_file(file, run.options, inputs)))
        run.progress(len(done))
    return done + _in_processes(files[alone:], run, inputs) if files[alone:] else done


def _in_processes(files: Sequence[Path], run: Run, inputs: Inputs) -> list[Checked]:
    from xei_lang.cli.workers import WorkerDiedError, in_processes

    def work(item: int) -> Plain:
        found = check_file(files[item], run.options, inputs)
        return [to_plain(found.said), found.text, found.asked]

    gc.freeze()  # what is loaded stays: the processes share its pages as long as nobody searches them
    try:
        plain = in_processes(work, len(files), run.jobs, lambda done: run.progress(done + 1))
    except WorkerDiedError as death:
        raise ReportedBugError(_death(death.how, [files[item] for item in death.items])) from death
    except OSError:
        plain = [work(item) for item in range(len(files))]
    return [
        Checked(str(file), from_plain(said), None, text, asked)
        for file, (said, text, asked) in zip(files, plain, strict=True)
    ]


def _lean(checked: Checked) -> Checked:
    return checked if checked.said else replace(checked, source=None)


def _death(how: str, files: Sequence[Path]) -> list[str]:
    from xei_lang.diagnostics.render.terminal import visible

    names = ", ".join(f"`{visible(str(file))}`" for file in files)
    return [
        f"internal error: a process that checked files {how}",
        *([f"  it was at one of {names}"] if files else []),
        "  if memory ran out, fewer --jobs need less; else please report it with the protocol that caused it",
    ]
