"""Which arm does a step that says `either`: the one that holds the object, else the one that has it nearer
to its side.

"Nearer" looks ahead to where the object is set down, in the base frame that the robot will then have: an
arm that picks well and cannot place is the wrong one. Ties go to the right arm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Side, SkillPlan, StationRef, Step
from xei_lang.lower.hand import SIDES
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.seats import place_text, seat_of
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile, SkillSpec


@dataclass(frozen=True, slots=True)
class Destination:
    """Where a step sets an object down: the step, the place, the arm that it names, and the base pose it
    happens at.
    """

    step_id: str
    place: PlaceRef
    arm: Side | None
    T_world_base: Pose


@dataclass(frozen=True, slots=True)
class Choice:
    """The chosen arm and why."""

    arm: Side
    reason: str


def destinations(
    plan: SkillPlan, index: int, name: str, scene: Scene, profile: Profile
) -> tuple[Destination, ...]:
    """Where the object is set down next, from this step of the plan on: at most one place."""
    T_world_base = scene.epoch.T_world_base
    for step in plan.steps[index:]:
        place = next((item.value for item in step.args if isinstance(item.value, PlaceRef)), None)
        if place is not None and _is_about(step, name):
            return (Destination(step.step_id, place, _explicit_arm(step), T_world_base),)
        T_world_base = _base_after(step, profile, T_world_base)
    return ()


def choose(name: str, ahead: tuple[Destination, ...], scene: Scene, profile: Profile) -> Choice:
    """The arm for a step about the object `name` (empty: about none)."""
    holder = scene.holder(name)
    if holder is not None:
        return Choice(holder, f"it holds `{name}`")
    free: list[Side] = [side for side in SIDES if side not in scene.held]
    if len(free) == 1:
        (busy,) = scene.held
        return Choice(free[0], f"the {busy} hand holds `{scene.held[busy].object}`")
    for item in ahead:
        if item.arm is not None:
            return Choice(item.arm, f"`{item.step_id}` sets it down with it")
    return _nearest(name, ahead, scene, profile)


def arms_of(
    step: Step, spec: SkillSpec, scene: Scene, instead: Side | None, nearest: Callable[[], Choice]
) -> dict[str, Choice]:
    """The arms of a step's arm arguments, by argument: those that it says, else the one that has the object,
    the one that another argument leaves, or the nearest. `instead` takes the place of any that is said.
    """
    names = [argument.name for argument in spec.args if argument.type == "Arm"]
    stated: dict[str, Side] = {name: side for name in names for side in SIDES if step.arg(name) == side}
    arms: dict[str, Choice] = {}
    for name in names:
        others = [Choice(side, "") for other, side in stated.items() if other != name]
        if name not in stated and arms:
            arms[name] = other_than(next(iter(arms.values())))
        elif instead is not None:
            arms[name] = Choice(instead, "the other arm was tried and cannot")
        elif name in stated:
            arms[name] = Choice(stated[name], "")
        else:
            chosen = nearest()
            arms[name] = other_than(others[0]) if others and chosen.arm not in scene.held else chosen
    return arms


def other_than(first: Choice) -> Choice:
    """The second arm of a step that needs two."""
    return Choice("left" if first.arm == "right" else "right", "the other arm of the step")


def _nearest(name: str, ahead: tuple[Destination, ...], scene: Scene, profile: Profile) -> Choice:
    """The arm whose shoulder is nearer, sideways, to the worst of source and destinations."""
    points = _lateral_points(name, ahead, scene, profile)
    if not points:
        return Choice("right", "neither is nearer")
    cost = {side: max(abs(y - shoulder_xy(profile, side)[1]) for _, y in points) for side in SIDES}
    side: Side = "left" if cost["left"] < cost["right"] - 1e-6 else "right"
    where = " and ".join(f"{text} {_side_of(y)}" for text, y in points)
    return Choice(side, f"nearest sideways: {where}")


def _side_of(y: float) -> str:
    return f"{abs(y) * 1000:.0f} mm {'left' if y > 0 else 'right'}"


def _lateral_points(
    name: str, ahead: tuple[Destination, ...], scene: Scene, profile: Profile
) -> list[tuple[str, float]]:
    points: list[tuple[str, float]] = []
    if name in scene.standing:
        points.append((f"`{name}`", scene.T_base_object(name).position_m[1]))
    for item in ahead:
        host, standing = profile.object(item.place.object), scene.standing.get(item.place.object)
        seat = seat_of(item.place, host) if host else None
        if seat is not None and standing is not None and item.place.kind != "surface":
            T_base_seat = item.T_world_base.inverse() @ standing.T_world_object @ seat.T_host_seat
            points.append((f"`{place_text(item.place)}`", T_base_seat.position_m[1]))
    return points


def _is_about(step: Step, name: str) -> bool:
    return any(isinstance(item.value, ObjectRef) and item.value.name == name for item in step.args)


def _explicit_arm(step: Step) -> Side | None:
    return next((side for side in SIDES if step.arg("arm") == side), None)


def _base_after(step: Step, profile: Profile, T_world_base: Pose) -> Pose:
    """The base pose after a step: a step drives where its skill's template has a `nav_to_pose`."""
    spec = profile.bank.skill(step.skill)
    if spec is None or not any(line.kind == "nav_to_pose" for line in spec.template):
        return T_world_base
    name = next((item.value.name for item in step.args if isinstance(item.value, StationRef)), "")
    return next(
        (station.T_world_base for station in profile.calibration.stations if station.name == name),
        T_world_base,
    )
