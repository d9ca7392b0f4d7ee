"""Files of objects, from validated models: read, measured, and made a shape of where the profile asks.

Nothing heavy is imported for a profile that names no file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose, Shape
from xei_lang.profiles.files import ProfileFiles
from xei_lang.profiles.model import Asset
from xei_lang.profiles.schema.assets import (
    CloudFileModel,
    CloudShapeModel,
    FileModel,
    MeshFileModel,
    MeshShapeModel,
)
from xei_lang.profiles.schema.usage import ObjectModel
from xei_lang.profiles.vectors import pose
from xei_lang.profiles.yaml_tree import Node, Path

if TYPE_CHECKING:
    from xei_lang.profiles.assets.measure import Measured, Stated
    from xei_lang.profiles.assets.points import Points
    from xei_lang.profiles.assets.told import Named

What = Literal["mesh", "point_cloud"]
KINDS: tuple[What, ...] = ("mesh", "point_cloud")


@dataclass(slots=True)
class AssetReader:
    """The meshes and point clouds of a profile while it is built; what several objects name is read once."""

    files: ProfileFiles
    read: dict[tuple[str, str], Points | str] = field(default_factory=dict[tuple[str, str], "Points | str"])

    def points(self, named: Named, found: list[Diagnostic]) -> Points | None:
        """The points of a file, or None with why in `found`."""
        from xei_lang.profiles.assets.locate import read_asset
        from xei_lang.profiles.assets.told import no_library, unreadable

        data = read_asset(self.files, named.path, named.place)
        if isinstance(data, Diagnostic):
            found.append(data)
            return None
        key = (named.what, named.path)
        if key not in self.read:
            try:
                self.read[key] = _parsed(data, named)
            except ModuleNotFoundError as missing:
                if missing.name != "trimesh":
                    raise
                found.append(no_library(named, missing.name))
                return None
        points = self.read[key]
        if isinstance(points, str):
            found.append(unreadable(named, points))
            return None
        return points


@dataclass(frozen=True, slots=True)
class Shaped:
    """The shape of an object, what it was computed from (empty where it is stated), the files that the object
    names, and those that were read.
    """

    shape: Shape
    computed_from: str
    named: tuple[tuple[str, str | None], ...]
    models: tuple[Asset, ...]


def read_assets(
    model: ObjectModel, stated: Shape | None, root: Node, path: Path, reader: AssetReader,
    found: list[Diagnostic],
) -> Shaped | None:  # fmt: skip
    """The shape of the object at `path` with its files; None, with why in `found`, where it has none.

    `stated` is its shape where the profile gives a primitive; else it is the one around the file that `shape`
    names, which is then a model of the object as well.
    """
    entries = {what: getattr(model.assets, what) or getattr(model.shape, what) for what in KINDS}
    named = tuple((what, entry.file if entry else None) for what, entry in entries.items())
    if stated is not None and not any(entries.values()):
        return Shaped(stated, "", named, ())
    return _measured(model, stated, root, path, reader, found, named)


def _measured(
    model: ObjectModel, stated: Shape | None, root: Node, path: Path, reader: AssetReader,
    found: list[Diagnostic], paths: tuple[tuple[str, str | None], ...],
) -> Shaped | None:  # fmt: skip
    from xei_lang.profiles.assets.measure import Stated

    models: dict[What, Asset] = {}
    computed_from = ""
    for what in KINDS:
        entry: MeshShapeModel | CloudShapeModel | None = getattr(model.shape, what)
        if entry is not None:
            file = _named(what, entry, root, (*path, "shape", what), str(path[-1]))
            one = _measure(file, None, reader, found)
            if one is None or not one.is_placed:
                return None
            stated, computed_from = _computed(file, one, entry)
            models[what] = _asset(file, one, reader)
    assert stated is not None
    known = Stated(stated, root.span_of(*path, "shape"))
    for what in KINDS:
        entry = getattr(model.assets, what)
        if entry is not None:
            file = _named(what, entry, root, (*path, "assets", what), str(path[-1]))
            one = _measure(file, known, reader, found)
            if one is not None:
                models[what] = _asset(file, one, reader)
    return Shaped(stated, computed_from, paths, tuple(models[what] for what in KINDS if what in models))


def _named(what: What, entry: FileModel, root: Node, path: Path, owner: str) -> Named:
    from xei_lang.profiles.assets.told import Named

    placement = None
    if isinstance(entry, MeshFileModel):
        placement = entry.T_object_mesh
    elif isinstance(entry, CloudFileModel):
        placement = entry.T_object_cloud
    return Named(
        owner=owner,
        what=what,
        path=entry.file,
        units=entry.units,
        T_object_file=pose(placement.position, placement.rpy) if placement else Pose(),
        place=root.span_of(*path, "file"),
        units_place=root.span_of(*path, "units"),
        gives_shape=path[-2] == "shape",
    )


def _measure(
    file: Named, stated: Stated | None, reader: AssetReader, found: list[Diagnostic]
) -> Measured | None:
    """The measure of a file. One that is not there is a warning where the object's shape is known anyway."""
    from xei_lang.profiles.assets.locate import is_missing
    from xei_lang.profiles.assets.measure import disagreement, measured
    from xei_lang.profiles.assets.told import is_absent

    if stated is not None and is_missing(reader.files, file.path):
        found.append(is_absent(file, reader.files.shown_path(file.path)))
        return None
    points = reader.points(file, found)
    one = measured(file, points, stated, found) if points is not None else None
    if one is not None and stated is not None:
        found.extend(disagreement(file, one, stated))
    return one


def _computed(file: Named, one: Measured, entry: MeshShapeModel | CloudShapeModel) -> tuple[Shape, str]:
    from xei_lang.profiles.assets.fit import fit
    from xei_lang.profiles.assets.told import WORDS, kind_text

    shape = fit(one.extent, entry.as_)
    thing = file.what.replace("_", " ")
    of = f"{thing} {file.path} in {WORDS[one.units]}"
    return shape, f"computed from {of}, as {kind_text(shape)} around it"


def _asset(file: Named, one: Measured, reader: AssetReader) -> Asset:
    sha256 = dict(reader.files.hashes)[file.path]
    what: What = "mesh" if file.what == "mesh" else "point_cloud"
    x, y, z = (round(side, 6) for side in one.extent.size_m)
    return Asset(what, file.path, sha256, one.units, file.T_object_file, (x, y, z), file.place)


def _parsed(data: bytes, named: Named) -> Points | str:
    if named.what == "mesh":
        from xei_lang.profiles.assets.read_mesh import read_mesh

        return read_mesh(data, named.path)
    from xei_lang.profiles.assets.read_cloud import read_cloud

    return read_cloud(data, named.path)
