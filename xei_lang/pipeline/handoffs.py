"""What a compilation is asked, what its passes hand on, and what is said of each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from xei_lang.diagnostics import Diagnostics, Source
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
