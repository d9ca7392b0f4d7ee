"""MotionGoalGraph: what the robot must do, goal by goal, before any motion is planned.

The kinds are closed. Poses are in the base frame of the goal's epoch (every drive starts a new one), so that
a goal never depends on where the base stood before. A goal that aims with the tool names a *family* of tool
poses: the planner chooses one member, and every later goal of the same family keeps that choice until the
hand changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.tool_paths import ToolPath

if TYPE_CHECKING:
    import networkx

GoalKind = Literal[
    "move_to", "open_gripper", "close_gripper", "set_do", "slide_move", "nav_to_pose", "wait", "perceive",
    "confirm", "instrument", "attach", "detach",
]  # fmt: skip
RunEvent = Literal["start", "pause", "resume", "await", "stop"]
PathKind = Literal["free", "linear", "arc", "screw", "raster"]


@dataclass(frozen=True, slots=True)
class JointTarget:
    """A named configuration of the robot description (`home`, `ready`, `transport`): joints in rad and m."""

    name: str
    joints: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class MoveTo:
    """Bring the tool of `arm` (or, for a joint target, the joints it names) to a target.

    `keep_upright` bounds the tilt of what is held; `speed_fraction` scales the velocity limits, in (0, 1].
    `along` says how the tool goes there on an arc or a screw (`Turn`) or a raster (`Raster`); its end is the
    target. `tool_speed_m_s` and `tool_turn_rad_s` bound how fast the tool moves and turns on its way.
    """

    target: ToolTarget | JointTarget
    arm: Side | None = None
    path: PathKind = "free"
    keep_upright: bool = False
    speed_fraction: float = 1.0
    along: ToolPath | None = None
    tool_speed_m_s: float | None = None
    tool_turn_rad_s: float | None = None


@dataclass(frozen=True, slots=True)
class Grip:
    """`open_gripper` or `close_gripper`: bring the gap between the jaws to `opening_m`.

    OpenArm v1 opens from 0 to 0.088 m.
    """

    arm: Side
    opening_m: float
    force_n: float = 0.0


@dataclass(frozen=True, slots=True)
class SetDo:
    """Set a digital output."""

    output: str
    value: bool


@dataclass(frozen=True, slots=True)
class SlideMove:
    """Bring the vertical slide to a height above its lower end."""

    height_m: float


@dataclass(frozen=True, slots=True)
class NavToPose:
    """Drive the base to a station; the next goals belong to the next epoch."""

    station: str
    T_world_base: Pose
    position_tolerance_m: float
    rotation_tolerance_rad: float


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass."""

    duration_s: float


@dataclass(frozen=True, slots=True)
class Perceive:
    """Ground the frame again; until it has run, later goals of its epoch are provisional."""

    frame: str


@dataclass(frozen=True, slots=True)
class Confirm:
    """Hold the run until a person has answered."""

    text: str


@dataclass(frozen=True, slots=True)
class Instrument:
    """A command to an instrument that then works on its own; the goal's parameters are those of the command.

    Work that goes on while other goals happen is a *run*, named by the step that starts it, and `event` is
    what the goal means to it. An `await` lasts until the instrument has worked for `work_s` seconds since the
    end of `start`, the time from `pause` to `resume` left out. A run without an end outlives the plan.
    """

    instrument: str
    command: str
    run: str = ""
    event: RunEvent | None = None
    work_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Attach:
    """From here on the object moves with the hand, and what rides on it too; one in the other hand is then in
    both, until that one detaches. What was fastened on another object rides there no more.
    """

    object: str
    arm: Side
    family: str


@dataclass(frozen=True, slots=True)
class Detach:
    """From here on the object stands at `T_base_object` (turned about z where the family is symmetric).

    Where `place` is a hand (`in_hand`), that hand holds it too by then and goes on holding it there.
    `fastened_to` names the object that it rides on from here on, wherever that goes; empty for none.
    """

    object: str
    arm: Side
    place: str
    T_base_object: Pose
    fastened_to: str = ""


def in_hand(side: Side) -> str:
    """The place of what a hand holds: no name of a profile has a space."""
    return f"{side} hand"


Action = (
    MoveTo | Grip | SetDo | SlideMove | NavToPose | Wait | Perceive | Confirm | Instrument | Attach | Detach
)


@dataclass(frozen=True, slots=True)
class Parameter:
    """An operation parameter of a goal and which source won: `skill`, `computed`, `usage_profile` or `call`.

    `rule` says in words why it is so; `span` is where it is written, None for what was computed.
    """

    name: str
    value: str
    source: Literal["skill", "computed", "usage_profile", "call"]
    rule: str = ""
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class MotionGoal:
    """One goal. `id` is unique in the graph; `resources` name what it occupies (`left_arm`, `slide`, `base`).

    `allowed_contacts` are pairs of body names that may touch while it runs (held object and fingers, object
    and slot).
    """

    id: str
    step_id: str
    kind: GoalKind
    action: Action
    epoch: int
    resources: tuple[str, ...]
    span: Span
    parameters: tuple[Parameter, ...] = ()
    allowed_contacts: tuple[tuple[str, str], ...] = ()
    provisional: bool = False
    min_duration_s: float = 0.0
    max_duration_s: float = float("inf")


@dataclass(frozen=True, slots=True)
class Epoch:
    """A stand of the base: everything between two drives.

    `T_world_base` is nominal, good to the docking tolerance.
    """

    index: int
    station: str
    T_world_base: Pose


@dataclass(frozen=True, slots=True)
class MotionGoalGraph:
    """Goals in a deterministic topological order, with the edges `(before, after)` that they must respect."""

    goals: tuple[MotionGoal, ...]
    edges: tuple[tuple[str, str], ...]
    families: tuple[Family, ...]
    epochs: tuple[Epoch, ...]

    def family(self, family_id: str) -> Family:
        """The family of this id. Raises KeyError where the graph has none (its verifier refuses that)."""
        for family in self.families:
            if family.id == family_id:
                return family
        raise KeyError(family_id)

    def networkx(self) -> networkx.DiGraph[Any]:
        """The graph as networkx: one node a goal id with the goal as its `goal` attribute."""
        import networkx

        graph: networkx.DiGraph[Any] = networkx.DiGraph()
        for goal in self.goals:
            graph.add_node(goal.id, goal=goal)
        graph.add_edges_from(self.edges)
        return graph
