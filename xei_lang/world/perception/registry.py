"""The registry of a lab: the objects that a pose service may speak of, and one hash for all of them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace

from xei_lang.ir.forms.canonical import Json, line
from xei_lang.ir.forms.geometry_json import primitive
from xei_lang.ir.geometry import Vec3
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.perception.pose_request import MeshInfo


@dataclass(frozen=True, slots=True)
class RegisteredObject:
    """An object as a pose service knows it.

    `mesh.sha256` is that of its mesh file, in the file's unit; an object without one has the hash of its
    primitives in the form of `scene.json`, on one line, in metres.
    """

    name: str
    roles: tuple[str, ...]
    skills: tuple[str, ...]
    mesh: MeshInfo


@dataclass(frozen=True, slots=True)
class Registry:
    """All objects, sorted by name."""

    objects: tuple[RegisteredObject, ...]

    def find(self, name: str) -> RegisteredObject | None:
        """The object of this name, or None."""
        return next((item for item in self.objects if item.name == name), None)

    def put(self, item: RegisteredObject) -> Registry:
        """The registry with this object in the place of the one of its name, if there is one."""
        others = [known for known in self.objects if known.name != item.name]
        return replace(self, objects=tuple(sorted([*others, item], key=lambda known: known.name)))

    @property
    def sha256(self) -> str:
        """SHA-256 of all that the registry says; two labs with the same objects have the same."""
        return _sha256([_json(item) for item in self.objects])


def registry_of(profile: Profile) -> Registry:
    """The registry of a profile: its objects and those of the room."""
    return Registry(tuple(_registered(item) for item in sorted(profile.objects, key=_name)))


def _registered(item: LabObject) -> RegisteredObject:
    mesh = next((model for model in item.models if model.what == "mesh"), None)
    sha256 = mesh.sha256 if mesh else _sha256([primitive(part) for part in item.geometry])
    info = MeshInfo(sha256, mesh.units if mesh else "m", item.size_m)
    return RegisteredObject(item.name, item.roles, item.skills, info)


def _json(item: RegisteredObject) -> Json:
    size: Vec3 = item.mesh.size_m
    return {
        "name": item.name,
        "roles": list(item.roles),
        "skills": list(item.skills),
        "mesh": {"sha256": item.mesh.sha256, "units": item.mesh.units, "size_m": list(size)},
    }


def _name(item: LabObject) -> str:
    return item.name


def _sha256(value: Json) -> str:
    return hashlib.sha256(line(value).encode()).hexdigest()
