"""TimedPlan: for each goal a time-parameterised joint trajectory, exact and sampled, and when it runs."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import GoalKind
from xei_lang.ir.skill_plan import Side

Row = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Knots:
    """The exact trajectory `q(t) = path(s(t))`, with t counted from the goal's start.

    `path` is piecewise polynomial in s: on `[breaks[i], breaks[i+1]]`, with `u = s - breaks[i]`, joint j is
    at `sum_k coefficients[i][k][j] * u**k`. `s` is piecewise quadratic in t: on `[times_s[i], times_s[i+1]]`,
    with `w = t - times_s[i]`, `s = s_i + ds_i * w + dds_i * w**2 / 2` (constant path acceleration, TOPP-RA).
    Lengths: `breaks` P+1, `coefficients` P, `times_s`, `s`, `ds` N+1, `dds` N.
    """

    breaks: Row
    coefficients: tuple[tuple[Row, ...], ...]
    times_s: Row
    s: Row
    ds: Row
    dds: Row


@dataclass(frozen=True, slots=True)
class Samples:
    """The trajectory sampled in time: rows of one value a joint (rad or m, per s, per s2).

    `times_s` count from the plan's start.
    """

    times_s: Row
    positions: tuple[Row, ...]
    velocities: tuple[Row, ...]
    accelerations: tuple[Row, ...]


@dataclass(frozen=True, slots=True)
class Attachment:
    """An object that moves with a link while a goal runs."""

    object: str
    link: str
    T_link_object: Pose


@dataclass(frozen=True, slots=True)
class Placement:
    """Where an object stands in the base frame of the goal's epoch once the goal has ended."""

    object: str
    T_base_object: Pose


@dataclass(frozen=True, slots=True)
class TimedGoal:
    """A goal with its time and, where it moves joints, its trajectory.

    `attached` holds while the goal runs; `placed` is what a detach left behind; `tool` is the pose that the
    tool of `arm` ends at, in the base frame, and `choice` names the member of the family that was chosen.
    """

    id: str
    step_id: str
    kind: GoalKind
    resource: str
    resources: tuple[str, ...]
    epoch: int
    start_s: float
    end_s: float
    joints: tuple[str, ...] = ()
    samples: Samples | None = None
    knots: Knots | None = None
    attached: tuple[Attachment, ...] = ()
    allowed_contacts: tuple[tuple[str, str], ...] = ()
    placed: tuple[Placement, ...] = ()
    arm: Side | None = None
    tool: Pose | None = None
    choice: str = ""
    planner: str = ""


@dataclass(frozen=True, slots=True)
class JointLimit:
    """Planning limits of one joint: rad, rad/s, rad/s2, N m.

    For the slide and the fingers: m, m/s, m/s2, N.
    """

    joint: str
    lower: float
    upper: float
    velocity: float
    acceleration: float
    torque: float


@dataclass(frozen=True, slots=True)
class Margin:
    """How near a plan came to a limit: 1.0 of a ratio is at the limit; a clearance is in metres."""

    name: str
    value: float
    where: str
    goal_id: str
    time_s: float


@dataclass(frozen=True, slots=True)
class TimedPlan:
    """The schedule: goals sorted by `start_s`, from the joint positions `start`, under `limits`."""

    start: tuple[tuple[str, float], ...]
    limits: tuple[JointLimit, ...]
    goals: tuple[TimedGoal, ...]
    duration_s: float
    margins: tuple[Margin, ...]
    seed: int
    rate_hz: float = 100.0
    solvers: tuple[tuple[str, str], ...] = ()
