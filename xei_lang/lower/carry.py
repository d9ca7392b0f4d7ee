"""Named configurations and hands that hold something.

A named configuration turns the hands as it likes, and what is open would be spilled. So it is for empty hands
only: an arm that holds an object goes to its carry pose instead, upright all the way. A cap holds nothing: it
may be tilted.
"""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import JointTarget, MoveTo, Parameter, PathKind
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.draft import Draft, contacts
from xei_lang.lower.hand import SIDES
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Held, Scene
from xei_lang.profiles.model import CarryPose, NamedState, Profile


def states_of(profile: Profile, name: str, side: Side | None) -> tuple[NamedState, ...]:
    """The states of groups that a configuration's name stands for; with a side, only that arm's."""
    states = tuple(state for state in profile.robot.states if state.name == name)
    return states if side is None else tuple(state for state in states if state.group == f"{side}_arm")


def holding(states: tuple[NamedState, ...], scene: Scene, profile: Profile) -> tuple[Side, ...]:
    """The arms among the states' groups whose hands hold something that may not be tilted."""
    return tuple(
        side
        for side in SIDES
        if side in scene.held and not _is_cap(profile, scene.held[side].object)
        if any(item.group == f"{side}_arm" for item in states)
    )


def _is_cap(profile: Profile, name: str) -> bool:
    known = profile.object(name)
    return known is not None and known.thread is not None


def to_configuration(
    states: tuple[NamedState, ...],
    scene: Scene,
    profile: Profile,
    side: Side | None = None,
    path: PathKind = "free",
    keep_upright: bool = False,
    speed_fraction: float = 1.0,
) -> tuple[Draft, ...]:
    """The move of everything that the states name to them, arms that hold something left out; none where
    nothing is left.

    The target is the union of the groups' states, and each group is a resource.
    """
    busy = tuple(f"{arm}_arm" for arm in holding(states, scene, profile))
    left = tuple(state for state in states if state.group not in busy)
    if not left:
        return ()
    target = JointTarget(left[0].name, tuple(joint for state in left for joint in state.joints))
    action = MoveTo(target, side, path, keep_upright, speed_fraction)
    resources = tuple(state.group for state in left)
    return (Draft("move_to", action, resources, scene, (), contacts(scene, scene)),)


def to_carry_poses(
    states: tuple[NamedState, ...], scene: Scene, profile: Profile, span: Span, speed_fraction: float = 1.0
) -> tuple[Draft, ...]:
    """The moves of the arms that hold something, one after the other, to where they carry it.

    Raises Refusal (XEI0716) where the calibration profile has no carry pose for such an arm; `span` are the
    words that ask for the configuration.
    """
    return tuple(
        _carry(arm, states[0].name, scene, profile, span, speed_fraction)
        for arm in holding(states, scene, profile)
    )


def _carry(
    arm: Side, instead_of: str, scene: Scene, profile: Profile, span: Span, speed_fraction: float
) -> Draft:
    held, pose = scene.held[arm], profile.calibration.carry_pose(arm)
    if pose is None:
        refuse(
            "XEI0716",
            f"it is not known where the {arm} hand carries `{held.object}`",
            span,
            f"expected an empty {arm} hand, or a carry pose for it",
            (held.since,),
            notes=(f"the configuration `{instead_of}` is for empty hands: it would tilt `{held.object}`",),
            help=(f"set `{held.object}` down first, or state `carry: {arm}:` in the calibration profile",),
        )
    target = ToolTarget(held.family.id, _T_base_carried(pose, held), turn_reference=held.family.symmetric)
    action = MoveTo(target, arm, "free", keep_upright=True, speed_fraction=speed_fraction)
    why = Parameter(
        "carry_pose",
        f"({', '.join(f'{value * 1000:g}' for value in pose.position_m)}) mm",
        "computed",
        f"the {arm} hand holds `{held.object}`, which is carried upright instead of going to `{instead_of}`",
        pose.span,
    )
    allowed = contacts(scene, scene, arm)
    return Draft("move_to", action, (f"{arm}_arm", "slide"), scene, (why,), allowed)


def _T_base_carried(pose: CarryPose, held: Held) -> Pose:
    """The held object at its carry pose, turned towards the base as it was when it was grasped."""
    return Pose(pose.position_m, held.T_base_grasped.quaternion)
