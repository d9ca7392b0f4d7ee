"""What the service does with each kind of request, without HTTP: models in, models or a refusal out."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from xei_lang.profiles.model import Profile
from xei_lang.world.perception.contract import (
    MAX_OBJECTS,
    HealthModel,
    ModelEntry,
    ModelsModel,
    ObjectsModel,
    PoseRequestModel,
    PoseResponseModel,
    PutObjectModel,
)
from xei_lang.world.perception.optics import Optics
from xei_lang.world.perception.pictures import colour_image, depth_image, mask_image
from xei_lang.world.perception.pose_request import ObjectPose, PoseRequest, PoseResponse
from xei_lang.world.perception.registry import RegisteredObject, Registry, registry_of
from xei_lang.world.perception.service.backend import Backend, Estimate, Shot, Unable
from xei_lang.world.perception.service.masks import proposed_masks
from xei_lang.world.perception.wire import (
    registered_model,
    registered_put,
    request_of,
    response_model,
)


@dataclass(slots=True)
class Desk:
    """A lab, its registry as it is now, and the backend that is asked; one estimation at a time."""

    profile: Profile
    backend: Backend
    registry: Registry = field(init=False)
    _busy: threading.Lock = field(default_factory=threading.Lock)

    def __post_init__(self) -> None:
        self.registry = registry_of(self.profile)

    def health(self) -> HealthModel:
        """Whether poses can be asked for."""
        missing = self.backend.ready(self.registry)
        return HealthModel(
            status="ready" if missing is None else "not_ready",
            backend=self.backend.name,
            registry_sha256=self.registry.sha256,
            detail=(missing or "")[:500],
        )

    def models(self) -> ModelsModel:
        """What answers."""
        entry = ModelEntry(
            name=self.backend.name, version=self.backend.version, modes=list(self.backend.modes)
        )
        return ModelsModel(models=[entry])

    def objects(self) -> ObjectsModel:
        """The registry as it is now."""
        registry = self.registry
        listed = [registered_model(item) for item in registry.objects]
        return ObjectsModel(registry_sha256=registry.sha256, objects=listed)

    def put(self, name: str, model: PutObjectModel) -> ObjectsModel | Unable:
        """Know an object otherwise, or a new one."""
        with self._busy:
            changed = self.registry.put(registered_put(name, model))
            if len(changed.objects) > MAX_OBJECTS:
                return Unable(409, f"a registry has {MAX_OBJECTS} objects at most")
            said = self.backend.put(registered_put(name, model))
            if said is not None:
                return said
            self.registry = changed
            return self.objects()

    def poses(self, model: PoseRequestModel) -> PoseResponseModel | Unable:
        """Estimate the poses of all objects that are asked for."""
        began = time.monotonic()
        request = request_of(model)
        if isinstance(request, str):
            return Unable(422, request)
        with self._busy:
            known = _known(request, self.registry)
            if isinstance(known, Unable):
                return known
            shot = _shot(request, known)
            if isinstance(shot, Unable):
                return shot
            if self.backend.needs_masks:
                shot = proposed_masks(shot, known, self.profile)
            found = self.backend.estimate(shot)
        if isinstance(found, Unable):
            return found
        objects = tuple(_object(estimate, item, request) for estimate, item in zip(found, known, strict=True))
        took_ms = 1e3 * (time.monotonic() - began)
        return response_model(
            PoseResponse(request.request_id, request.picture.stamp_ns, objects, self.backend.version, took_ms)
        )


def _known(request: PoseRequest, registry: Registry) -> tuple[RegisteredObject, ...] | Unable:
    found: list[RegisteredObject] = []
    for query in request.queries:
        item = registry.find(query.object_id)
        if item is None:
            return Unable(404, f"there is no object `{query.object_id}` in this registry")
        if item.mesh.sha256 != query.mesh_sha256:
            return Unable(409, f"`{query.object_id}` has another shape in this registry: {item.mesh.sha256}")
        found.append(item)
    return tuple(found)


def _shot(request: PoseRequest, known: tuple[RegisteredObject, ...]) -> Shot | Unable:
    optics = Optics.of_intrinsics(request.picture.intrinsics)
    image = colour_image(request.picture.rgb_png, optics.size_px)
    if isinstance(image, str):
        return Unable(422, f"rgb_png: {image}")
    depth = depth_image(request.picture.depth_png16, optics.size_px, request.picture.depth_scale_m)
    if isinstance(depth, str):
        return Unable(422, f"depth_png16: {depth}")
    masks: dict[str, NDArray[np.bool_]] = {}
    for query in request.queries:
        if query.mask_png is not None:
            mask = mask_image(query.mask_png, optics.size_px)
            if isinstance(mask, str):
                return Unable(422, f"mask_png of `{query.object_id}`: {mask}")
            masks[query.object_id] = mask
    return Shot(request, optics, image, depth, masks, known)


def _object(estimate: Estimate, item: RegisteredObject, request: PoseRequest) -> ObjectPose:
    return ObjectPose(
        name=item.name,
        frame_id=request.picture.output_frame,
        status=estimate.status,
        T_output_object=estimate.T_output_object if estimate.status == "ok" else None,
        confidence=estimate.confidence,
        covariance=estimate.covariance if estimate.status == "ok" else None,
        roles=item.roles,
        skills=item.skills,
        mesh=item.mesh,
    )
