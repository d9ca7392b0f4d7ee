"""The posture from which a bench is worked: empty hands `ready`, the slide at the station's height.

The robot goes there before anything else, and again after every drive: what lies between is a drive's
transport pose.
"""

from __future__ import annotations

from xei_lang.ir.goals import SlideMove
from xei_lang.ir.world import World
from xei_lang.lower.carry import states_of, to_configuration
from xei_lang.lower.draft import Draft, contacts
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile, SceneOrigin, TemplateStep

STEP_ID = "scene_origin"
_SAME = 1e-9


def scene_origin(scene: Scene, world: World, profile: Profile, station: SceneOrigin) -> tuple[Draft, ...]:
    """The motion before anything else, from wherever the robot woke up; what already is in place is left out.

    The slide goes first where that takes the arms up, away from the bench, and last where it takes them down.
    Raises Refusal (XEI0701) where the robot's description has no `ready`.
    """
    now = dict(world.robot.joints)
    arms, slide = _arms_ready(scene, profile, station), _slide(scene, station)
    rise_m = station.slide_m - now.get("slide_joint", 0.0)
    ready = profile.robot.state("ready")
    away = any(abs(now.get(name, 0.0) - value) > _SAME for name, value in ready)
    ordered = ((rise_m > _SAME, (slide,)), (away, arms), (rise_m < -_SAME, (slide,)))
    return tuple(draft for wanted, drafts in ordered if wanted for draft in drafts)


def arrival(
    scene: Scene, profile: Profile, station: SceneOrigin, template: tuple[TemplateStep, ...]
) -> tuple[Draft, ...]:
    """The motion after a drive: the slide, then the arms whose hands are empty, as far as the skill's own
    template does not say otherwise. While a hand holds something the slide stays, and with it the carry pose.
    """
    kinds = [line.kind for line in template]
    after = kinds[kinds.index("nav_to_pose") + 1 :]
    slide = () if scene.held else (_slide(scene, station),)
    drafts = (*slide, *_arms_ready(scene, profile, station))
    return tuple(draft for draft in drafts if draft.kind not in after)


def _slide(scene: Scene, station: SceneOrigin) -> Draft:
    return Draft("slide_move", SlideMove(station.slide_m), ("slide",), scene, (), contacts(scene, scene))


def _arms_ready(scene: Scene, profile: Profile, station: SceneOrigin) -> tuple[Draft, ...]:
    """Empty hands go to `ready`; one that holds something stays where it has carried it."""
    states = states_of(profile, "ready", None)
    if not states:
        refuse(
            "XEI0701",
            "the robot's description has no configuration `ready`",
            station.span,
            "needed before this station is worked at",
            notes=(f"rule: {profile.bank.srdf}",),
        )
    return to_configuration(states, scene, profile)
