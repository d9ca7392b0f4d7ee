"""What is fastened rides: a closed bottle is lifted with its cap, and the cap is where its bottle is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.lower.capped import BOTTLE, CAP, cap, capped, capped_profile, grounded
from tests.lower.plans import obj, plan, spot, surface, with_object
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.families import Family, ToolPose
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach
from xei_lang.ir.skill_plan import Side, SkillPlan
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.lower.walk import Held, Scene, Standing
from xei_lang.profiles.model import LabObject, Prior, Profile

CARRY = plan(
    ("pick", {"object": obj(BOTTLE), "arm": "either"}),
    ("place", {"object": obj(BOTTLE), "on": surface("table"), "arm": "either"}),
)


def refusals(steps: SkillPlan, profile: Profile | None = None) -> list[tuple[str, str]]:
    profile = profile or capped()[0]
    graph, problems = lower(steps, profile, grounded(profile))
    assert graph is None or not problems
    return [(item.code, item.message) for item in problems]


def test_a_closed_bottle_is_lifted_and_set_down() -> None:
    profile, world = capped()
    graph, problems = lower(CARRY, profile, world)
    assert graph is not None, problems
    assert problems == ()
    assert verify_goals(graph) == ()
    assert [goal.action.object for goal in graph.goals if isinstance(goal.action, (Attach, Detach))] == [
        BOTTLE,
        BOTTLE,
    ]
    assert not [pair for goal in graph.goals for pair in goal.allowed_contacts if CAP in pair]


def test_what_only_stands_on_a_bottle_still_keeps_it_down() -> None:
    profile = capped()[0]
    loose = replace(cap(_bottle(profile)), thread=None)
    profile = capped_profile(others=(loose,))
    assert refusals(CARRY, profile)[0] == (
        "XEI0712",
        f"`{BOTTLE}` cannot be lifted while `{CAP}` stands on it",
    )


@pytest.mark.parametrize("skill", ["pick", "move_object"])
def test_a_cap_that_is_screwed_on_is_not_lifted_off(skill: str) -> None:
    target = {"to": surface("table")} if skill == "move_object" else {}
    steps = plan((skill, {"object": obj(CAP), **target, "arm": "either"}))
    graph, problems = lower(steps, *capped())
    assert graph is None
    (said,) = problems
    assert said.code == "XEI0727"
    assert said.message == f"`{CAP}` cannot be lifted: it is screwed on `{BOTTLE}`"
    assert said.span == steps.steps[0].args[0].span
    assert any(f"twist_open(object={BOTTLE}" in text for text in said.help)


def test_nor_is_it_while_its_bottle_is_in_the_other_hand() -> None:
    steps = plan(
        ("pick", {"object": obj(BOTTLE), "arm": "right"}), ("pick", {"object": obj(CAP), "arm": "left"})
    )
    assert [code for code, _ in refusals(steps)] == ["XEI0727"]


def test_a_cap_at_rest_is_lifted_like_anything() -> None:
    profile = capped()[0]
    rest = replace(cap(_bottle(profile)), prior=replace(_prior(profile), in_object="table", in_key="bottle"))
    moved = replace(_bottle(profile), prior=replace(_prior(profile), in_object="table", in_key="beaker"))
    profile = capped_profile(others=(rest, moved))
    assert grounded(profile).objects
    graph, problems = lower(plan(("pick", {"object": obj(CAP), "arm": "either"})), profile, grounded(profile))
    assert graph is not None, problems


CAP_AT_MOUTH = {
    "place": (("pick", {"object": obj(CAP), "arm": "right"}), {"on": spot(BOTTLE, "mouth")}),
    "insert": (("pick", {"object": obj(CAP), "arm": "right"}), {"into": spot(BOTTLE, "mouth")}),
    "move_object": (None, {"to": spot(BOTTLE, "mouth")}),
}


@pytest.mark.parametrize("skill", sorted(CAP_AT_MOUTH))
def test_a_cap_that_is_set_on_its_thread_without_turning_is_told(skill: str) -> None:
    before, where = CAP_AT_MOUTH[skill]
    call = (skill, {"object": obj(CAP), **where, "arm": "right"})
    steps, profile = plan(*([before] if before else []), call), unscrewed()
    graph, problems = lower(steps, profile, grounded(profile))
    assert graph is None
    (said,) = problems
    mouth = f'`{BOTTLE}.spot("mouth")`'
    assert (said.code, said.message) == (
        "XEI0729",
        f"`{CAP}` cannot be set down on {mouth}: it is screwed on there",
    )
    assert said.span == steps.steps[-1].args[1].span
    assert said.label == f"closes `{BOTTLE}` by its thread, which `{skill}` does not turn"
    assert any(f"`twist_close(object={BOTTLE}, hold=left, twist=right)`" in text for text in said.help)


def test_what_another_thing_closes_may_take_a_cap_that_does_not_fit_it() -> None:
    """A cap of another vessel just stands on the mouth: it rides on nothing."""
    profile = unscrewed()
    found = profile.object(CAP)
    assert found is not None
    assert found.thread is not None
    stranger = replace(found, thread=replace(found.thread, on_object="beaker_2"))
    profile = with_object(profile, CAP, stranger)
    pick, where = CAP_AT_MOUTH["place"]
    assert pick is not None
    graph, problems = lower(
        plan(pick, ("place", {"object": obj(CAP), **where, "arm": "right"})), profile, grounded(profile)
    )
    assert graph is not None, problems
    (left,) = (goal.action for goal in graph.goals if isinstance(goal.action, Detach))
    assert (left.place, left.fastened_to) == (f'{BOTTLE}.spot("mouth")', "")


def unscrewed() -> Profile:
    """The cap where `beaker_1` else stands, and the bottle open."""
    profile = capped()[0]
    rest = replace(cap(_bottle(profile)), prior=replace(_prior(profile), in_object="table", in_key="beaker"))
    others = tuple(item for item in profile.objects if item.name != "beaker_1")
    return capped_profile(others=(rest,), base=replace(profile, objects=others))


def _bottle(profile: Profile) -> LabObject:
    found = profile.object(BOTTLE)
    assert found is not None
    return found


def _prior(profile: Profile) -> Prior:
    prior = cap(_bottle(profile)).prior
    assert prior is not None
    return prior


# The scene by itself: chains of events, drawn at random.

HERE = Label(Span("a.xei", 0, 1), "here")
FAMILY = Family("f", "any", (ToolPose("m", Pose()),))
Event = Callable[[Scene], Scene]


def held(scene: Scene, name: str) -> Held:
    stands = scene.standing[name]
    pose = stands.T_world_object
    return Held(name, FAMILY, pose, scene.in_base(pose), 0.05, 0.03, 0.0, stands.support, HERE)


def stacked() -> Scene:
    """A bottle, its cap, and a ring that is fastened on the cap."""
    profile = capped()[0]
    ring = replace(cap(_bottle(profile)), name="ring", prior=None, thread=None)
    scene = Scene.of(grounded(capped_profile(others=(ring,))), profile)
    on = scene.standing[CAP]
    pose = on.T_world_object @ Pose((0.0, 0.003, 0.02))
    return replace(scene, standing={**scene.standing, "ring": Standing("ring", pose, "", CAP, None, True)})


turns = st.floats(-math.pi, math.pi)
lengths = st.floats(-2.0, 2.0)
poses = st.builds(
    lambda x, y, z, roll, pitch, yaw: Pose.from_rpy((x, y, z), (roll, pitch, yaw)),
    lengths, lengths, lengths, turns, turns, turns,
)  # fmt: skip


@given(st.lists(st.tuples(st.sampled_from(["left", "right"]), poses, st.booleans()), min_size=1, max_size=6))
def test_wherever_the_bottle_is_set_down_its_cap_sits_as_before(
    events: list[tuple[Side, Pose, bool]],
) -> None:
    scene = start = stacked()
    T_bottle = start.standing[BOTTLE].T_world_object.inverse()
    for side, pose, drives in events:
        scene = scene.attach(side, held(scene, BOTTLE))
        assert not {CAP, "ring"} & set(scene.standing)
        assert [scene.carrier_of(name) for name in (CAP, "ring")] == [BOTTLE, CAP]
        assert scene.riders_of(BOTTLE) == (CAP, "ring")
        scene = scene.drive("bench_b", pose) if drives else scene
        scene = scene.detach(side, Standing(BOTTLE, pose, "", "table", HERE))
        assert not scene.riding
        now = scene.standing[BOTTLE].T_world_object.inverse()
        for name in (CAP, "ring"):
            before, after = (
                T_bottle @ start.standing[name].T_world_object,
                now @ scene.standing[name].T_world_object,
            )
            assert math.dist(before.position_m, after.position_m) < 1e-9
            assert math.dist(before.quaternion, after.quaternion) < 1e-9
    assert scene.carried_by(BOTTLE) == ()
    assert (scene.standing[CAP].place, scene.standing[CAP].support) == (f'{BOTTLE}.spot("mouth")', BOTTLE)


def test_a_hand_that_takes_the_cap_leaves_the_bottle_and_takes_the_ring() -> None:
    scene = stacked().attach("left", held(stacked(), CAP))
    assert BOTTLE in scene.standing
    assert scene.riders_of(BOTTLE) == ()
    assert scene.riders_of(CAP) == ("ring",)
    assert set(scene.riding) == {"ring"}


def test_a_hand_keeps_what_it_stands_around_while_the_other_takes_something_else() -> None:
    scene = stacked().reach("right", BOTTLE)
    assert dict(scene.attach("left", held(scene, CAP)).reached) == {"right": BOTTLE}
    assert dict(scene.attach("left", held(scene, BOTTLE)).reached) == {}
    assert dict(scene.attach("right", held(scene, CAP)).reached) == {}


def test_what_is_forgotten_takes_its_riders_along() -> None:
    scene = stacked()
    assert not {BOTTLE, CAP, "ring"} & set(scene.forget((BOTTLE,)).standing)
    carried = scene.attach("left", held(scene, BOTTLE)).forget((BOTTLE,))
    assert not carried.held
    assert not carried.riding
