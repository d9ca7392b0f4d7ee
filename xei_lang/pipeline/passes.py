"""The passes in order. Each takes what the ones before it made, and hands on one representation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostics
from xei_lang.pipeline.handoffs import Handoffs, Pass, Request

if TYPE_CHECKING:
    from xei_lang.inputs import Outside
    from xei_lang.profiles.model import Profile


def outside_of(request: Request) -> Outside:
    """What the compilation reads besides its own text: files, profiles, and what of them is known."""
    from xei_lang.inputs import Inputs, Outside

    own = Outside(Inputs(request.cache), Path(request.source.file), request.profile_folder)
    return request.outside or own


def _parse(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """Text to `Module`."""
    module, said = outside_of(request).parse(request.source)
    return replace(made, module=module), said


def _load_profile(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """The profile that the protocol names, from its compiled form where that is current.

    A file of procedures names none; where the project has only one, it is checked with that.
    """
    from xei_lang.check import is_library, profile_name

    assert made.module is not None
    named, library = profile_name(made.module), is_library(made.module)
    profile, said = outside_of(request).profile(named, library=library)
    return replace(made, profile=profile), said


def _check(request: Request, made: Handoffs) -> tuple[Handoffs, Diagnostics]:
    """`Module` to `SkillPlan`: names, types, roles, expansion."""
    from xei_lang.check import CheckOptions, check_module
    from xei_lang.profiles.sources import profile_sources
    from xei_lang.syntax.loading import RecordedFiles

    assert made.module is not None
    assert made.profile is not None
    outside = outside_of(request)
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
    from xei_lang.motion.verify import (
        RobotDescription,
        VerifyOptions,
        check_durations,
        to_diagnostics,
        verify_timed,
    )
    from xei_lang.profiles.open import robot_texts

    assert made.profile is not None
    assert made.plan is not None
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
    late = check_durations(made.plan, made.graph, made.timed, made.profile.bank)
    return replace(made, timed=replace(made.timed, margins=margins), verified=report.checked), (*said, *late)


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
