"""A compilation: passes that run in order, until one has errors.

A failure can always be named by its handoff: a pass adds its value, or stops with diagnostics.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from xei_lang.diagnostics import Diagnostics, has_errors
from xei_lang.pipeline.handoffs import Handoffs, Outcome, Pass, PassResult, Progress, Request
from xei_lang.pipeline.passes import ALL, FRONT, outside_of

__all__ = [
    "ALL", "FRONT", "Handoffs", "Outcome", "Pass", "PassResult", "Progress", "Request", "check_request",
    "compile_request",
]  # fmt: skip


def compile_request(
    request: Request,
    passes: tuple[Pass, ...],
    watch: Callable[[PassResult], None] = lambda _result: None,
) -> Outcome:
    """Run the passes in order, until one has errors. `watch` sees each pass as it ends."""
    return _run(request, Handoffs(), passes, watch)


def check_request(request: Request) -> Diagnostics:
    """Run the passes of `FRONT`, beyond errors of the grammar as well.

    What could be read of the file is then checked, and of that is said what has nothing to do with the rest.
    A `.json` file is a plan that came from elsewhere.
    """
    if request.source.file.endswith(".json"):
        return _check_plan(request)
    outcome = compile_request(request, FRONT)
    module = outcome.made.module
    if outcome.stopped_at != FRONT[0].name or module is None:
        return outcome.diagnostics
    from xei_lang.syntax.trust import trusted

    later = _run(request, outcome.made, FRONT[1:], lambda _result: None)
    return (*outcome.diagnostics, *trusted(later.diagnostics, request.source, module.damaged))


def _check_plan(request: Request) -> Diagnostics:
    """A plan's JSON form against the profile that it names; one that names none, against the only one."""
    from xei_lang.check.plan_file import check_plan, read_plan_text
    from xei_lang.profiles.sources import profile_sources

    text, said = read_plan_text(request.source)
    if text is None:
        return said
    named = text.profile
    profile, found = outside_of(request).profile(named, library=named is None)
    if profile is None:
        return (*said, *found)
    _, checked = check_plan(text, request.source, profile, profile_sources(profile))
    return (*said, *found, *checked)


def _run(
    request: Request, made: Handoffs, passes: tuple[Pass, ...], watch: Callable[[PassResult], None]
) -> Outcome:
    said: Diagnostics = ()
    for step in passes:
        started = time.perf_counter()
        made_next, diagnostics = step.run(request, made)
        failed = has_errors(diagnostics) or getattr(made_next, step.adds) is None
        said = (*said, *diagnostics)
        watch(PassResult(step.name, made_next, diagnostics, time.perf_counter() - started, failed))
        if failed:
            return Outcome(made_next, said, step.name)
        made = made_next
    return Outcome(made, said, None)
