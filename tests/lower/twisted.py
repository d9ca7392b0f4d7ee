"""The bench's bottle, opened and closed: its goals, over other sizes, places and strokes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from tests.lower.plans import bench, obj, plan, with_object, with_skill
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.goals import MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.tool_paths import Turn
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.ir.world import World
from xei_lang.lower import lower
from xei_lang.profiles.model import LabObject, OperationDefault, Profile
from xei_lang.quantity import quantity
from xei_lang.world.ground import ground

BOTTLE, CAP = "bottle_2", "bottle_2_cap"
ARMS = {"object": obj(BOTTLE), "hold": "left", "twist": "right"}
BOTH = plan(("twist_open", ARMS), ("twist_close", ARMS))


def known(profile: Profile, name: str) -> LabObject:
    found = profile.object(name)
    assert found is not None
    return found


def grounded(profile: Profile, stands: Pose | None = None) -> World:
    """The profile's world; with a pose, the closed bottle stands there (in `world`)."""
    world, problems = ground(profile)
    assert world is not None, problems
    if stands is None:
        return world
    T_bottle_cap = world.T_world_object(BOTTLE).inverse() @ world.T_world_object(CAP)
    poses = {BOTTLE: stands, CAP: stands @ T_bottle_cap}
    objects = tuple(
        replace(
            item,
            frame_id="world",
            T_frame_object=poses[item.name],
            place="" if item.name == BOTTLE else item.place,
        )
        if item.name in poses
        else item
        for item in world.objects
    )
    return replace(world, objects=objects)


def lowered(
    profile: Profile | None = None, stands: Pose | None = None, steps: SkillPlan = BOTH
) -> MotionGoalGraph:
    profile = profile or bench()[0]
    graph, problems = lower(steps, profile, grounded(profile, stands))
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def turns(graph: MotionGoalGraph, step: str) -> list[tuple[MotionGoal, Turn]]:
    found: list[tuple[MotionGoal, Turn]] = []
    for goal in graph.goals:
        if goal.step_id == step and isinstance(goal.action, MoveTo) and goal.action.path == "screw":
            assert isinstance(goal.action.along, Turn)
            found.append((goal, goal.action.along))
    return found


def reference(goal: MotionGoal) -> Pose:
    assert isinstance(goal.action, MoveTo)
    assert isinstance(goal.action.target, ToolTarget)
    return goal.action.target.T_base_reference


def goal_of(graph: MotionGoalGraph, name: str) -> MotionGoal:
    return next(goal for goal in graph.goals if goal.id == name)


def sized(cap_mm: int, body_mm: int, high_mm: int, lead_um: int, quarters: int) -> Profile:
    """The bench with another bottle and cap, the thread's turns in quarters."""
    profile = bench()[0]
    bottle, cap = known(profile, BOTTLE), known(profile, CAP)
    body, neck = body_mm / 2000, high_mm / 1000
    parts = (
        Primitive(Cylinder(body, neck), Pose((0.0, 0.0, neck / 2))),
        Primitive(Cylinder(cap_mm / 2200, 0.022), Pose((0.0, 0.0, neck + 0.011))),
    )
    mouth = replace(bottle.spots[0], T_object_spot=Pose((0.0, 0.0, neck + 0.002)))
    size = (2 * body, 2 * body, neck + 0.022)
    bottle = replace(
        bottle, shape=Cylinder(body, size[2]), geometry=parts, size_m=size, spots=(mouth,), grasp=()
    )
    shape = Cylinder(cap_mm / 2000, 0.025)
    assert cap.thread is not None
    thread = replace(cap.thread, lead_m=lead_um / 1e6, turns=quarters / 4)
    cap = replace(
        cap,
        shape=shape,
        geometry=(Primitive(shape, Pose((0.0, 0.0, 0.0125))),),
        size_m=(cap_mm / 1000, cap_mm / 1000, 0.025),
        thread=thread,
    )
    return with_object(with_object(profile, BOTTLE, bottle), CAP, cap)


def with_stroke(text: int | Fraction) -> Profile:
    profile = bench()[0]
    skill = profile.bank.skill("twist_open")
    assert skill is not None
    defaults = tuple(
        OperationDefault(item.name, quantity(text, "deg"), item.span) if item.name == "stroke" else item
        for item in skill.parameters
    )
    return with_skill(profile, replace(skill, parameters=defaults))
