"""The backend `foundationpose`: a separate process that speaks this same contract, asked on our behalf.

FoundationPose has no HTTP layer of its own, runs on a GPU, and its licence is non-commercial; so it stays a
process of its own, with the few lines that speak the contract beside it. A mask goes with every query, as it
registers by one. Not tried on a GPU or with the real estimator: the tests ask a real second HTTP process.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.contract import HealthModel
from xei_lang.world.perception.other_shape import other_shape
from xei_lang.world.perception.pictures import encode_mask
from xei_lang.world.perception.pose_request import Mode, ObjectPose, PoseQuery
from xei_lang.world.perception.registry import RegisteredObject, Registry
from xei_lang.world.perception.service.backend import Estimate, Shot, Unable
from xei_lang.world.perception.service_fault import ServiceFault


@dataclass(frozen=True, slots=True)
class FoundationPoseBackend:
    """Another service behind this one, which has to speak for the same registry."""

    client: PoseClient
    name: str = "foundationpose"
    version: str = "foundationpose adapter 1"
    modes: tuple[Mode, ...] = ("register", "track")
    needs_masks: bool = True

    def ready(self, registry: Registry) -> str | None:
        """Whether the process answers, is ready and speaks for this lab."""
        said = self.client.health(registry)
        return None if isinstance(said, HealthModel) else said.message

    def put(self, item: RegisteredObject) -> Unable | None:
        """Tell the process of the object."""
        said = self.client.put_object(item)
        return _unable(said) if isinstance(said, ServiceFault) else None

    def estimate(self, shot: Shot) -> tuple[Estimate, ...] | Unable:
        """What the process says of each object that has a mask; what has none is not asked for."""
        request = shot.request
        queries = tuple(_with_mask(query, shot) for query in request.queries if query.object_id in shot.masks)
        if not queries:
            return tuple(Estimate(query.object_id, "no_object") for query in request.queries)
        answer = self.client.poses(replace(request, queries=queries))
        if isinstance(answer, ServiceFault):
            return _unable(answer)
        given = {item.name: item for item in answer.objects}
        known = {item.name: item for item in shot.known}
        found: list[Estimate] = []
        for query in request.queries:
            item = given.get(query.object_id)
            if item is None or query.object_id not in shot.masks:
                found.append(Estimate(query.object_id, "no_object"))
            elif (
                other_shape(item, query, known.get(item.name))
                or item.frame_id != request.picture.output_frame
            ):
                found.append(Estimate(query.object_id, "error"))
            else:
                found.append(_estimate(item))
        return tuple(found)


def _with_mask(query: PoseQuery, shot: Shot) -> PoseQuery:
    return replace(query, mask_png=query.mask_png or encode_mask(shot.masks[query.object_id]))


def _estimate(item: ObjectPose) -> Estimate:
    return Estimate(item.name, item.status, item.T_output_object, item.confidence, item.covariance)


def _unable(fault: ServiceFault) -> Unable:
    return Unable(504 if fault.reason == "slow" else 502, fault.message)
