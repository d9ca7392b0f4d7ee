"""What becomes of a compilation: the files of a bundle, and what a run is handed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass

from xei_lang import __version__
from xei_lang.diagnostics import Source
from xei_lang.doctor import deployment_blockers
from xei_lang.export import scene
from xei_lang.export.bundle import Content
from xei_lang.export.manifest import Manifest, tool_versions
from xei_lang.ir.forms import goals_json, plan_json, timed_json
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.pipeline import Handoffs
from xei_lang.profiles.model import Profile
from xei_lang.profiles.open import robot_texts
from xei_lang.runtime.handoffs import Handoffs as RunInputs
from xei_lang.world.sources import Observations


@dataclass(frozen=True, slots=True)
class Compiled:
    """A compilation that went the whole way: every handoff is there."""

    source: Source
    imported: tuple[Source, ...]
    profile: Profile
    plan: SkillPlan
    world: World
    graph: MotionGoalGraph
    timed: TimedPlan
    observed: tuple[Observations, ...] = ()

    @staticmethod
    def of(source: Source, made: Handoffs, observed: tuple[Observations, ...] = ()) -> Compiled:
        """The handoffs of `xei_lang.pipeline.ALL`, none of which may be missing."""
        assert made.profile is not None
        assert made.plan is not None
        assert made.world is not None
        assert made.graph is not None
        assert made.timed is not None
        return Compiled(
            source, made.imported, made.profile, made.plan, made.world, made.graph, made.timed, observed
        )

    def forms(self) -> dict[str, str]:
        """The plans in their fixed forms, by the file names that they have in a bundle."""
        return {
            "plan.json": dumps(plan_json.to_json(self.plan, {self.source.file: self.source})),
            "goals.json": dumps(goals_json.to_json(self.graph)),
            "timed.json": dumps(timed_json.to_json(self.timed)),
        }

    def bundle_contents(self) -> Mapping[str, Content]:
        """The files of a bundle by relative path, in the order in which they are written."""
        from xei_lang.export.rosbag import write_rosbag

        forms, (urdf, _) = self.forms(), robot_texts(self.profile)
        return {
            "protocol.xei": self.source.text.encode(),
            **{name: text.encode() for name, text in forms.items()},
            "scene.json": dumps(scene.to_json(self.world, self.graph)).encode(),
            "robot.urdf": urdf.encode(),
            "rosbag": lambda path: write_rosbag(path, self.timed, forms["plan.json"]),
        }

    def manifest(self, seed: int) -> Manifest:
        """The manifest but for the hashes of the bundle's files; no input is named by an absolute path.

        Imported files and tables are named as seen from the protocol, files of the profile from its folder.
        """
        here = os.path.dirname(self.source.file)
        inputs = {"protocol.xei": _sha256(self.source.text)}
        inputs.update(
            {
                f"import/{os.path.relpath(file.file, here or '.')}": _sha256(file.text)
                for file in self.imported
            }
        )
        inputs.update({f"profile/{file}": digest for file, digest in self.profile.files})
        inputs.update({_world_name(seen.source): seen.sha256 for seen in self.observed})
        blockers = deployment_blockers(self.profile)
        return Manifest(
            self.plan.protocol, self.profile.name, __version__, inputs, seed, tool_versions(), blockers
        )

    def run_inputs(self) -> RunInputs:
        """What a run is handed: the same representations, with the hashes of their forms in a bundle."""
        hashes = {name: _sha256(text) for name, text in self.forms().items()}
        urdf, _ = robot_texts(self.profile)
        return RunInputs(self.plan, self.graph, self.timed, self.world, self.profile, urdf, hashes)


def _world_name(source: str) -> str:
    """`world/scene_file/monday.yaml`, `world/pose_service/127.0.0.1:8765`."""
    kind, _, name = source.partition(" ")
    return f"world/{kind}/{name.partition('://')[2] or name}"


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
