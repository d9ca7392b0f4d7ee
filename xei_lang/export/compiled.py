"""What a bundle holds: every handoff in its fixed form, the robot, the scene and a recording."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

from xei_lang import __version__
from xei_lang.diagnostics import Source, Sources
from xei_lang.export import scene
from xei_lang.export.bundle import Content
from xei_lang.export.manifest import Manifest, deployment_blockers, tool_versions
from xei_lang.ir.forms import goals_json, plan_json, timed_json
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile


def bundle_contents(
    source: Source, plan: SkillPlan, world: World, graph: MotionGoalGraph, timed: TimedPlan, urdf: str
) -> Mapping[str, Content]:
    """The files of a bundle by relative path, in the order in which they are written."""
    from xei_lang.export.rosbag import write_rosbag

    forms = _forms({source.file: source}, plan, graph, timed)
    return {
        "protocol.xei": source.text.encode(),
        **{name: text.encode() for name, text in forms.items()},
        "scene.json": dumps(scene.to_json(world, graph)).encode(),
        "robot.urdf": urdf.encode(),
        "rosbag": lambda path: write_rosbag(path, timed, forms["plan.json"]),
    }


def plan_hashes(
    sources: Sources, plan: SkillPlan, graph: MotionGoalGraph, timed: TimedPlan
) -> Mapping[str, str]:
    """The SHA-256 of the representations as a bundle holds them, by file name."""
    forms = _forms(sources, plan, graph, timed)
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in forms.items()}


def manifest_of(source: Source, profile: Profile, protocol: str, seed: int) -> Manifest:
    """The manifest but for the hashes of the bundle's own files; inputs are named relative to the bundle or the profile."""
    inputs = {"protocol.xei": hashlib.sha256(source.text.encode()).hexdigest()}
    inputs.update({f"profile/{file}": digest for file, digest in profile.files})
    return Manifest(protocol, profile.name, __version__, inputs, seed, tool_versions(), deployment_blockers(profile))


def _forms(sources: Sources, plan: SkillPlan, graph: MotionGoalGraph, timed: TimedPlan) -> dict[str, str]:
    return {
        "plan.json": dumps(plan_json.to_json(plan, sources)),
        "goals.json": dumps(goals_json.to_json(graph)),
        "timed.json": dumps(timed_json.to_json(timed)),
    }
