"""The passes in order. Each takes what the ones before it made, and hands on one representation.

A failure can always be named by its handoff: a pass adds its value, or stops with diagnostics.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostics, Source, has_errors
from xei_lang.record import Shown, record

if TYPE_CHECKING:
    from xei_lang.inputs import Outside
    from xei_lang.ir.goals import MotionGoalGraph
    from xei_lang.ir.skill_plan import SkillPlan
    from xei_lang.ir.timed import TimedPlan
    from xei_lang.ir.world import World
    from xei_lang.motion.verify import Checked
    from xei_lang.profiles.model import Profile
    from xei_lang.syntax.ast import Module
    from xei_lang.world.sources import Observations

Progress = Callable[[str, int, int], None]
"""Called by long passes with the pass's name, how much is done and how much there is."""


@record
class Request(Shown):
    """Everything that a compilation is a function of.

    `outside` is given where several requests share what they read; else each reads for itself. `observed` is
    what sources of the world said, the better ones later; without any, the profile's priors hold.
    """

    source: Source
    profile_folder: Path | None = None
    cache: Path | None = None
    bindings: tuple[tuple[str, str], ...] = ()
    params: tuple[tuple[str, str], ...] = ()
    open_bindings: bool = False
    max_steps: int = 100_000
    allow_unmapped: bool = False
    strict: bool = False
    seed: int = 0
    progress: Progress | None = None
    outside: Outside | None = None
    observed: tuple[Observations, ...] = ()


@record
class Handoffs(Shown):
    """The representations made so far; each pass fills in one."""

    module: Module | None = None
    imported: tuple[Source, ...] = ()
    profile: Profile | None = None
    plan: SkillPlan | None = None
    world: World | None = None
    graph: MotionGoalGraph | None = None
    timed: TimedPlan | None = None
    verified: Checked | None = None


@record
class Pass(Shown):
    """One step of the compilation.

    `name` is what `--print-after` takes, `adds` the field of `Handoffs` that must be there once it has run.
    `run` gives the handoffs with the pass's own added, and what it has to say; it imports its room when it
    runs.
    """

    name: str
    adds: str
    run: Callable[[Request, Handoffs], tuple[Handoffs, Diagnostics]]


@record
class PassResult(Shown):
    """What a pass did, for those who watch: printing, timing, verification between passes."""

    pass_name: str
    made: Handoffs
    diagnostics: Diagnostics
    seconds: float
    failed: bool


@record
class Outcome(Shown):
    """The end of a compilation: what was made, everything that was said, and the pass that stopped it."""

    made: Handoffs
    diagnostics: Diagnostics
    stopped_at: str | None


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
    profile, found = _outside(request).profile(named, library=named is None)
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


def _outside(request: Request) -> Outside:
    from xei_lang.inputs import Inputs, Outside

    own = Outside(Inputs(request.cache), Path(request.source.file), request.profile_folder)
    return request.outside or own


def _parse(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """Text to `Module`."""
    module, said = _outside(request).parse(request.source)
    return replace(made, module=module), said


def _load_profile(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """The profile that the protocol names, from its compiled form where that is current.

    A file of procedures names none; where the project has only one, it is checked with that.
    """
    from xei_lang.check import is_library, profile_name

    assert made.module is not None
    named, library = profile_name(made.module), is_library(made.module)
    profile, said = _outside(request).profile(named, library=library)
    return replace(made, profile=profile), said


def _check(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """`Module` to `SkillPlan`: names, types, roles, expansion."""
    from xei_lang.check import CheckOptions, check_module
    from xei_lang.profiles.sources import profile_sources
    from xei_lang.syntax.loading import RecordedFiles

    assert made.module is not None
    assert made.profile is not None
    outside = _outside(request)
    files = RecordedFiles(outside)
    options = CheckOptions(
        bindings=dict(request.bindings),
        params=dict(request.params),
        open_bindings=request.open_bindings,
        max_steps=request.max_steps,
        sources=profile_sources(made.profile),
        files=files,
        parse=outside.parse,
    )
    profile = _as_observed(request, made.profile)
    plan, said = check_module(made.module, request.source, profile, options)
    return replace(made, plan=plan, imported=files.sources), said


def _as_observed(request: Request, profile: Profile) -> Profile:
    """The profile with what was observed in the place of its priors. Contradictions are told by grounding."""
    if not request.observed:
        return profile
    from xei_lang.world.ground import ground
    from xei_lang.world.sources.believed import as_believed

    world, _ = ground(profile, request.observed)
    return profile if world is None else as_believed(profile, world)


def _admit(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """What a compilation refuses and a check reports: gaps in the plan and, if strict, placeholders."""
    from xei_lang.check.admission import admit

    assert made.plan is not None
    assert made.profile is not None
    return made, admit(made.plan, made.profile, request.allow_unmapped, request.strict)


def _ground(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """Profile and observations to `World`: where everything is, and who said so.

    What the plan uses must be known surely enough, in strict mode by those who looked.
    """
    from xei_lang.world.drives import with_drives
    from xei_lang.world.ground import ground
    from xei_lang.world.use import check_use

    assert made.profile is not None
    assert made.plan is not None
    world, said = ground(made.profile, request.observed)
    if world is not None:
        used = check_use(made.plan, made.profile, world, request.observed, strict=request.strict)
        world, unfit = with_drives(world, made.profile, made.plan)
        said = (*said, *used, *unfit)
    return replace(made, world=world), said


def _lower_goals(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """`SkillPlan` and `World` to `MotionGoalGraph`, by the skills' templates."""
    from xei_lang.lower import imprecise_tasks, lower

    assert made.plan is not None
    assert made.profile is not None
    assert made.world is not None
    graph, said = lower(made.plan, made.profile, made.world)
    return replace(made, graph=graph), (*said, *imprecise_tasks(made.plan, made.profile, made.world))


def _plan(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """`MotionGoalGraph` to `TimedPlan`; the graph changes its arms where the chosen ones cannot."""
    from xei_lang.motion.either_arm import plan_with_either_arm
    from xei_lang.motion.plan import RobotDescription
    from xei_lang.profiles.open import robot_texts

    assert made.profile is not None
    assert made.plan is not None
    assert made.graph is not None
    assert made.world is not None
    report = request.progress
    graph, timed, said = plan_with_either_arm(
        made.plan,
        made.graph,
        made.world,
        made.profile,
        RobotDescription(*robot_texts(made.profile)),
        request.seed,
        None if report is None else lambda done, total: report("motion", done, total),
    )
    return replace(made, graph=graph, timed=timed), said


def _verify(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """`TimedPlan` against everything that it must keep, by code that shares nothing with the planner."""
    from xei_lang.motion.verify import RobotDescription, VerifyOptions, to_diagnostics, verify_timed
    from xei_lang.profiles.open import robot_texts

    assert made.profile is not None
    assert made.timed is not None
    assert made.graph is not None
    assert made.world is not None
    robot = RobotDescription(*robot_texts(made.profile))
    calibration = made.profile.calibration
    options = VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad)
    report = verify_timed(made.timed, made.graph, made.world, robot, calibration.limits, options=options)
    found = {margin.name: margin for margin in (*made.timed.margins, *report.margins)}
    margins = tuple(found[name] for name in sorted(found))
    said = to_diagnostics(report, made.graph)
    return replace(made, timed=replace(made.timed, margins=margins), verified=report.checked), said


FRONT: tuple[Pass, ...] = (
    Pass("parse", "module", _parse),
    Pass("profile", "profile", _load_profile),
    Pass("check", "plan", _check),
)
"""What `xei check` runs."""

ALL: tuple[Pass, ...] = (
    *FRONT,
    Pass("admit", "plan", _admit),
    Pass("ground", "world", _ground),
    Pass("lower", "graph", _lower_goals),
    Pass("motion", "timed", _plan),
    Pass("verify", "verified", _verify),
)
"""The whole way to timed, verified motion."""
