"""The bench keeps what the rest of the project counts on."""

from __future__ import annotations

from tests.world.bench import bench
from xei_lang.profiles.sources import profile_sources


def test_the_skill_bank_is_the_one_that_protocols_are_written_for():
    signatures = {skill.name: [arg.name for arg in skill.args] for skill in bench().bank.skills}
    assert signatures == {
        "pick": ["object", "arm"],
        "place": ["object", "on", "arm"],
        "insert": ["object", "into", "arm"],
        "move_object": ["object", "to", "arm"],
        "nav_to": ["station"],
        "slide_to": ["height"],
        "look_at": ["target"],
        "open_gripper": ["arm", "width"],
        "close_gripper": ["arm"],
        "set_do": ["output", "value"],
        "read_temperature": ["device"],
        "attach_tip": ["pipette", "tip", "arm"],
        "aspirate": ["pipette", "source", "volume", "arm"],
        "dispense": ["pipette", "target", "volume", "arm"],
        "eject_tip": ["pipette", "waste", "arm"],
        "transfer_sample": ["pipette", "tip", "source", "target", "volume", "waste", "arm"],
        "heat": ["block", "to", "for"],
        "incubate": ["device", "program"],
        "pour": ["source", "target", "volume", "arm"],
        "tap": ["screen", "element", "arm"],
        "swipe": ["screen", "element", "direction", "distance", "arm"],
        "wipe": ["object", "on", "length", "width", "arm"],
        "invert": ["object", "angle", "times", "arm"],
        "shake": ["object", "amplitude", "times", "arm"],
        "handover": ["object", "arm", "to"],
        "run_by_output": ["device", "output", "time"],
        "run_by_screen": ["device", "screen", "element", "time", "arm"],
        "read": ["device", "wavelength"],
        "twist_open": ["object", "hold", "twist"],
        "twist_close": ["object", "hold", "twist"],
    }
    assert all(skill.exposed and skill.phrases and skill.process for skill in bench().bank.skills)


def test_every_joint_is_limited_for_a_reason_below_its_rating():
    limits = {limit.joint: limit for limit in bench().calibration.limits}
    for joint in bench().robot.joints:
        if joint.kind == "fixed" or joint.mimic:
            continue
        limit = limits.pop(joint.name)
        assert limit.reason
        assert limit.velocity <= min(joint.velocity, 2.5)
        assert limit.torque <= joint.effort
    assert not limits


def test_what_nobody_measured_is_named():
    told = [found.item for found in bench().calibration.placeholders]
    for name in (
        "frames.table",
        "frames.camera",
        "stations.bench_a",
        "table",
        "map",
        "apriltags",
        "lidars.base",
    ):
        assert name in told
    assert not any(frame.status == "measured" for frame in bench().calibration.frames)


def test_every_span_cuts_out_what_it_says():
    sources = profile_sources(bench())
    for item in (
        *bench().objects,
        *bench().bank.skills,
        *bench().calibration.frames,
        *bench().calibration.limits,
    ):
        name = getattr(item, "name", None) or item.joint
        assert sources[item.span.file].slice(item.span) == name
    rules = [rule for skill in bench().bank.skills for rule in skill.requires]
    assert rules
    for rule in rules:
        assert sources[rule.span.file].slice(rule.predicate.span) == rule.text
