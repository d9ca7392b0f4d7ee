"""`manifest.json`: what a bundle was made from, what is in it, and what keeps it off a real robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from xei_lang.doctor import Blocker
from xei_lang.doctor.forms import blocker_json, readiness_json
from xei_lang.ir.forms.canonical import Json

FORMAT = "xei-bundle"
VERSION = 1

TOOLS = ("numpy", "networkx", "ompl", "pin", "rosbags", "scipy", "toppra")


@dataclass(frozen=True, slots=True)
class Manifest:
    """All of a manifest but the hashes of the bundle's own files.

    `inputs` maps the source, each file of the profile and the robot's description, by relative paths, to the
    SHA-256 of their bytes.
    """

    protocol: str
    profile: str
    xei_version: str
    inputs: Mapping[str, str]
    seed: int
    tools: Mapping[str, str]
    blockers: tuple[Blocker, ...]

    def to_json(self, files: Mapping[str, str]) -> dict[str, Json]:
        """The manifest with the SHA-256 of each file of the bundle; no clock and no absolute path in it."""
        return {
            "format": FORMAT,
            "version": VERSION,
            "xei_version": self.xei_version,
            "protocol": self.protocol,
            "profile": self.profile,
            "seed": self.seed,
            "tools": dict(sorted(self.tools.items())),
            "inputs": dict(sorted(self.inputs.items())),
            "readiness": readiness_json(self.blockers),
            "blockers": [blocker_json(item) for item in self.blockers],
            "files": dict(sorted(files.items())),
        }


def tool_versions() -> dict[str, str]:
    """The installed versions of the libraries that shape a bundle's content."""
    versions: dict[str, str] = {}
    for tool in TOOLS:
        try:
            versions[tool] = version(tool)
        except PackageNotFoundError:
            versions[tool] = "missing"
    return versions
