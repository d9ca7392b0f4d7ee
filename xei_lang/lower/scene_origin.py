"""The motion before anything else: from wherever the robot woke up to a posture from which a bench can be
worked.
"""

from __future__ import annotations

from xei_lang.ir.goals import MoveTo, SlideMove
from xei_lang.ir.world import World
from xei_lang.lower.build_arm import configuration
from xei_lang.lower.draft import Draft
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile, SceneOrigin

STEP_ID = "scene_origin"
_SAME = 1e-9


def scene_origin(scene: Scene, world: World, profile: Profile, station: SceneOrigin) -> tuple[Draft, ...]:
    """Slide to the station's height and both arms to `ready`; what already is there is left out.

    The slide goes first where that takes the arms up, away from the bench, and last where it takes them down.
    Raises Refusal (XEI0701) where the robot's description has no `ready`.
    """
    found = configuration(profile, "ready", None)
    if found is None:
        refuse(
            "XEI0701",
            "the robot's description has no configuration `ready`",
            station.span,
            "needed before this station is worked at",
            notes=(f"rule: {profile.bank.srdf}",),
        )
    target, resources = found
    now = dict(world.robot.joints)
    arms = Draft("move_to", MoveTo(target), resources, scene)
    slide = Draft("slide_move", SlideMove(station.slide_m), ("slide",), scene)
    moves_arms = any(abs(now.get(name, 0.0) - value) > _SAME for name, value in target.joints)
    rise_m = station.slide_m - now.get("slide_joint", 0.0)
    ordered = (slide, arms) if rise_m > 0.0 else (arms, slide)
    wanted = {"move_to": moves_arms, "slide_move": abs(rise_m) > _SAME}
    return tuple(draft for draft in ordered if wanted[draft.kind])
