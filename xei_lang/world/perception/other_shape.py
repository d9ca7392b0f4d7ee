"""Whether a pose is of the shape that was asked for, in the unit in which the registry has it."""

from __future__ import annotations

from xei_lang.quantity.lengths import mm
from xei_lang.world.perception.pose_request import ObjectPose, PoseQuery
from xei_lang.world.perception.registry import RegisteredObject
from xei_lang.world.perception.service_fault import PoseRefused, RefusalReason

_SAME = 2.0
"""Boxes around a mesh and around the primitives of its object differ by less than this; units by more."""
_READ = "let the service read the shape in the unit of the registry, and send metres"


def other_shape(item: ObjectPose, query: PoseQuery, known: RegisteredObject | None) -> PoseRefused | None:
    """What is wrong with the shape that a pose is said to be of; None where it is the one that the
    registry has, which is `known`.

    A shape that was read in another unit gives a pose that is off by the same factor, and the depth image
    would only tell that something else stands there.
    """
    if item.mesh.sha256 != query.mesh_sha256:
        words = f"is for another shape than the profile's: {item.mesh.sha256[:12]}"
        return _refused(item, "other_mesh", words, "put the object again: `PUT /objects/{id}`")
    if known is None:
        return None
    if item.mesh.units != known.mesh.units:
        words = f"is for its shape in `{item.mesh.units}`, and the registry has it in `{known.mesh.units}`"
        return _refused(item, "other_units", words, _READ)
    theirs_m, ours_m = max(item.mesh.size_m), max(known.mesh.size_m)
    if theirs_m * _SAME < ours_m or theirs_m > ours_m * _SAME:
        words = f"is for a shape of {mm(theirs_m)} at most, and the registry has one of {mm(ours_m)}"
        return _refused(item, "other_units", words, _READ)
    return None


def _refused(item: ObjectPose, reason: RefusalReason, words: str, help_: str) -> PoseRefused:
    return PoseRefused(item.name, reason, f"the pose of `{item.name}` {words}", help_)
