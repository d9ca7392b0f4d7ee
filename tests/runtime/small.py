"""A small real plan: the left hand moves a tube while the right arm gets out of the way, then a drive.

The robot is the one of `profiles/openarm_bench`; everything else is written out here, so that a test can
break exactly one thing.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.goals import (
    Action,
    Attach,
    Confirm,
    Detach,
    Epoch,
    GoalKind,
    Grip,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    Perceive,
    SetDo,
    SlideMove,
    Wait,
)
from xei_lang.ir.skill_plan import Argument, ObjectRef, SkillPlan, Step
from xei_lang.ir.timed import Attachment, JointLimit, Placement, Samples, TimedGoal, TimedPlan
from xei_lang.ir.world import Frame, RobotState, World, WorldObject
from xei_lang.profiles.model import (
    ArgSpec,
    CalibratedFrame,
    Calibration,
    Camera,
    LabObject,
    Placeholder,
    PlanningLimit,
    Profile,
    RobotDescription,
    SceneOrigin,
    SkillBank,
    SkillSpec,
)
from xei_lang.runtime.handoffs import Handoffs

URDF = Path(__file__).parents[2] / "profiles/openarm_bench/robot/openarm_mobile.urdf"
SPAN = Span("protocols/small.xei", 10, 20)
STATIONS = {
    "bench_a": Pose(),
    "bench_b": Pose((0.0, -2.2, 0.0), (0.0, 0.0, -0.70710678118654757, 0.70710678118654757)),
}
START = {
    "slide_joint": 0.15,
    "openarm_left_joint4": 1.2,
    "openarm_left_finger_joint1": 0.0,
    "openarm_right_joint4": 1.2,
}
RANGES = {
    "slide_joint": (0.0, 0.6, 0.1),
    "openarm_left_joint4": (0.0, 2.44, 2.5),
    "openarm_right_joint4": (0.0, 2.44, 2.5),
    "openarm_left_finger_joint1": (0.0, 0.044, 0.06),
}
GRIP = Attachment("tube_1", "openarm_left_grasp", Pose((0.0, 0.0, -0.08)))
FAMILY = "tube_1.side"
ROBOT = RobotDescription("base_link", (), (), ())


def _to(height: float) -> MoveTo:
    return MoveTo(ToolTarget(FAMILY, Pose((0.7, 0.15, height))), "left", "linear")


def _rest(arm: str, joint4: float) -> MoveTo:
    side = "left" if arm == "left" else "right"
    return MoveTo(JointTarget("transport", ((f"openarm_{arm}_joint4", joint4),)), side)


LEFT, FINGER, SLIDE, RIGHT = (
    "openarm_left_joint4",
    "openarm_left_finger_joint1",
    "slide_joint",
    "openarm_right_joint4",
)
# id, step, kind, action, resource, start, end, joint and where it goes
ROWS: tuple[tuple[str, str, GoalKind, Action, str, float, float, str, float], ...] = (
    ("open", "pick#1", "open_gripper", Grip("left", 0.06), "left_gripper", 0.0, 1.0, FINGER, 0.03),
    ("aside", "pick#1", "move_to", _rest("right", 1.6), "right_arm", 0.0, 2.0, RIGHT, 1.6),
    ("approach", "pick#1", "move_to", _to(0.88), "left_arm", 1.0, 2.5, LEFT, 1.65),
    ("close", "pick#1", "close_gripper", Grip("left", 0.017), "left_gripper", 2.5, 3.5, FINGER, 0.0085),
    ("take", "pick#1", "attach", Attach("tube_1", "left", FAMILY), "left_gripper", 3.5, 3.5, "", 0.0),
    ("lift", "pick#1", "move_to", _to(1.01), "left_arm", 3.5, 4.5, LEFT, 2.0),
    ("raise", "slide_to#1", "slide_move", SlideMove(0.25), "slide", 4.5, 6.5, SLIDE, 0.25),
    ("lower", "place#1", "move_to", _to(0.98), "left_arm", 6.5, 7.5, LEFT, 1.65),
    ("release", "place#1", "open_gripper", Grip("left", 0.06), "left_gripper", 7.5, 8.5, FINGER, 0.03),
    (
        "leave",
        "place#1",
        "detach",
        Detach("tube_1", "left", "table", Pose((0.7, 0.15, 0.8))),
        "left_gripper",
        8.5,
        8.5,
        "",
        0,
    ),
    ("light", "set_do#1", "set_do", SetDo("lamp", True), "io", 8.5, 8.5, "", 0.0),
    ("rest", "wait#1", "wait", Wait(1.0), "person", 8.5, 9.5, "", 0.0),
    ("ask", "confirm#1", "confirm", Confirm("is the bench clear?"), "person", 9.5, 9.5, "", 0.0),
    ("fold", "nav_to#1", "move_to", _rest("left", 1.2), "left_arm", 9.5, 10.5, LEFT, 1.2),
    (
        "drive",
        "nav_to#1",
        "nav_to_pose",
        NavToPose("bench_b", STATIONS["bench_b"], 0.08, 0.15),
        "base",
        10.5,
        15.5,
        "",
        0.0,
    ),
    ("look", "nav_to#1", "perceive", Perceive("table_b"), "perception", 15.5, 16.0, "", 0.0),
    ("sink", "slide_to#2", "slide_move", SlideMove(0.2), "slide", 16.0, 18.0, SLIDE, 0.2),
)


def handoffs() -> Handoffs:
    """The whole run, with nothing wrong."""
    timed = _timed()
    goals = tuple(
        MotionGoal(
            row[0],
            row[1],
            row[2],
            row[3],
            1 if row[0] == "sink" else int(row[0] == "look"),
            (row[4],),
            SPAN,
            provisional=row[0] == "sink",
        )
        for row in ROWS
    )
    chain = [row[0] for row in ROWS if row[0] != "aside"]
    graph = MotionGoalGraph(
        goals,
        tuple(pairwise(chain)),
        (Family(FAMILY, "tube_1", (ToolPose("from the side", Pose()),)),),
        tuple(Epoch(index, name, pose) for index, (name, pose) in enumerate(STATIONS.items())),
    )
    names = ("plan.json", "goals.json", "timed.json")
    sha256 = {name: hashlib.sha256(name.encode()).hexdigest() for name in names}
    return Handoffs(_plan(), graph, timed, _world(), profile(), URDF.read_text(), sha256)


def _plan() -> SkillPlan:
    names = tuple(dict.fromkeys(row[1] for row in ROWS))
    tube = Argument("object", ObjectRef("tube_1"), "object", "call", SPAN)
    return SkillPlan(
        "small",
        "openarm_bench",
        tuple(
            Step(
                name,
                "skill" if name[:4] not in ("wait", "conf") else "wait" if name[:4] == "wait" else "confirm",
                SPAN,
                skill=name.split("#")[0],
                args=(tube,) if name[:2] in ("pi", "pl") else (),
            )
            for name in names
        ),
    )


def _samples(start: float, end: float, q0: float, q1: float) -> Samples:
    steps = round((end - start) * 100)
    t = [start + (end - start) * k / steps for k in range(steps + 1)]
    u = [k / steps for k in range(steps + 1)]
    d, span = q1 - q0, end - start
    return Samples(
        tuple(t),
        tuple((q0 + d * (3 * x * x - 2 * x**3),) for x in u),
        tuple((d * 6 * (x - x * x) / span,) for x in u),
        tuple((d * 6 * (1 - 2 * x) / span**2,) for x in u),
    )


def _timed() -> TimedPlan:
    joints = dict(START)
    goals: list[TimedGoal] = []
    for name, step, kind, action, resource, start, end, joint, to in ROWS:
        samples = _samples(start, end, joints[joint], to) if joint else None
        goals.append(
            TimedGoal(
                name,
                step,
                kind,
                resource,
                (resource,),
                1 if name == "sink" else int(name == "look"),
                start,
                end,
                joints=(joint,) if joint else (),
                samples=samples,
                attached=(GRIP,) if name in ("lift", "raise", "lower", "release") else (),
                placed=(Placement("tube_1", action.T_base_object),) if isinstance(action, Detach) else (),
                arm="left"
                if resource.startswith("left")
                else "right"
                if resource.startswith("right")
                else None,
                planner="straight" if samples else "",
            )
        )
        if joint:
            joints[joint] = to
    limits = tuple(JointLimit(name, a, b, v, 10.0, 10.0) for name, (a, b, v) in RANGES.items())
    return TimedPlan(tuple(START.items()), limits, tuple(goals), 18.0, (), 7)


def _world() -> World:
    tube = WorldObject(
        "tube_1",
        Pose((0.2, 0.15, 0.0)),
        "table",
        0.6,
        ("movable",),
        ("pick", "place"),
        (0.017, 0.017, 0.118),
        (Primitive(Cylinder(0.0085, 0.118), Pose((0.0, 0.0, 0.059))),),
        0.0065,
        movable=True,
        provenance=(("pose", "usage_profile"),),
    )
    frames = (
        Frame("table", "world", Pose((0.5, 0.0, 0.75)), "placeholder", 0.003, 0.0087),
        Frame("table_b", "world", Pose((0.0, -2.7, 0.85)), "placeholder", 0.003, 0.0087),
    )
    return World(frames, (tube,), RobotState(tuple(START.items()), "bench_a", Pose()), ("usage_profile",))


def profile() -> Profile:
    """The facts of the deployment that a run uses."""
    frames = tuple(
        CalibratedFrame(name, parent, pose, "placeholder", "", "by choice", 0.003, 0.0087, SPAN)
        for name, parent, pose in (
            ("table", "world", Pose((0.5, 0.0, 0.75))),
            ("table_b", "world", Pose((0.0, -2.7, 0.85))),
            ("camera", "slide", Pose((0.06, 0.0, 0.8))),
        )
    )
    calibration = Calibration(
        frames=frames,
        cameras=(
            Camera("head", "camera", "placeholder", 920.0, 920.0, 640.0, 360.0, 1280, 720, (), (), SPAN),
        ),
        limits=tuple(
            PlanningLimit(name, a, b, v, 10.0, 10.0, "rated", SPAN) for name, (a, b, v) in RANGES.items()
        ),
        stations=tuple(
            SceneOrigin(
                name, (), pose, "placeholder", "table" if name == "bench_a" else "table_b", 0.15, SPAN
            )
            for name, pose in STATIONS.items()
        ),
        start_station="bench_a",
        table_height_m=0.75,
        table_height_status="placeholder",
        table_bounds_m=((0.0, -0.7, 0.0), (0.7, 0.7, 0.6)),
        workspace_bounds_m=((0.2, -0.85, 0.0), (1.1, 0.85, 2.1)),
        map_frame="map",
        docking_position_tolerance_m=0.08,
        docking_rotation_tolerance_rad=0.15,
        base_speed_m_s=0.3,
        base_turn_rad_s=0.65,
        payload_kg=1.0,
        spill_tilt_rad=0.14,
        clearance_m=0.002,
        placeholders=(Placeholder("table.height", "measure the top", SPAN),),
    )
    tube = LabObject(
        "tube_1",
        (),
        ("movable",),
        Cylinder(0.0085, 0.118),
        (),
        (0.017, 0.017, 0.118),
        0.0065,
        (),
        (),
        None,
        (),
        None,
        (),
        (),
        None,
        (("mesh", "assets/tube.stl"), ("point_cloud", None)),
        False,
        SPAN,
    )
    bank = SkillBank(
        "robot/openarm_mobile.urdf", "robot/openarm_mobile.srdf", ("left", "right"), ("arm",), _skills()
    )
    return Profile(
        "openarm_bench", "", (tube,), bank, calibration, (), (("usage_profile.yaml", "0" * 64),), ROBOT
    )


def _skills() -> tuple[SkillSpec, ...]:
    lamp = ArgSpec("output", "choice", None, None, None, None, True, ("lamp", "fan"), SPAN)
    return tuple(
        SkillSpec(
            name,
            "arm",
            "",
            (lamp,) if name == "set_do" else (),
            True,
            (),
            (),
            (0.0, 60.0),
            (),
            "",
            (),
            (),
            (),
            SPAN,
        )
        for name in ("pick", "place", "slide_to", "set_do", "nav_to")
    )


def with_goal(given: Handoffs, goal_id: str, **changes: object) -> Handoffs:
    """The same run with one goal of the graph changed."""
    goals = tuple(replace(goal, **changes) if goal.id == goal_id else goal for goal in given.graph.goals)
    return replace(given, graph=replace(given.graph, goals=goals))


def with_timed(given: Handoffs, goal_id: str, **changes: object) -> Handoffs:
    """The same run with one goal of the timed plan changed."""
    goals = tuple(replace(goal, **changes) if goal.id == goal_id else goal for goal in given.timed.goals)
    return replace(given, timed=replace(given.timed, goals=goals))


def samples_of(given: Handoffs, goal_id: str) -> Samples:
    """The trajectory of a goal."""
    samples = next(goal.samples for goal in given.timed.goals if goal.id == goal_id)
    assert samples is not None
    return samples
