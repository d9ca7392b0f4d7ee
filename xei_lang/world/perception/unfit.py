"""Whether a request that was recorded is one about this lab, before anybody is asked."""

from __future__ import annotations

from xei_lang.diagnostics.suggest import did_you_mean
from xei_lang.profiles.model import Profile
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.perception.optics import Optics
from xei_lang.world.perception.pictures import colour_image, mask_image
from xei_lang.world.perception.pose_request import PoseQuery, PoseRequest
from xei_lang.world.perception.registry import Registry, registry_of


def unfit(profile: Profile, request: PoseRequest) -> str | None:
    """Why a request cannot be about this lab, or None: its frame, images, objects and their shapes."""
    picture = request.picture
    known = ["world", *(frame.name for frame in frame_tree(profile, start_state(profile)))]
    if picture.output_frame not in known:
        named = f"it wants poses in `{picture.output_frame}`, which is no frame of `{profile.name}`"
        near = did_you_mean(picture.output_frame, known)
        return f"{named}; did you mean `{near[0]}`?" if near else named
    size_px = Optics.of_intrinsics(picture.intrinsics).size_px
    image = colour_image(picture.rgb_png, size_px)
    if isinstance(image, str):
        return f"its `rgb_png` is of no use: {image}"
    registry = registry_of(profile)
    found = (_unfit(query, registry, profile.name, size_px) for query in request.queries)
    return next((said for said in found if said is not None), None)


def _unfit(query: PoseQuery, registry: Registry, lab: str, size_px: tuple[int, int]) -> str | None:
    known = registry.find(query.object_id)
    if known is None:
        return f"it asks for `{query.object_id}`, which is no object of `{lab}`"
    if known.mesh.sha256 != query.mesh_sha256:
        theirs, ours = query.mesh_sha256[:12], known.mesh.sha256[:12]
        return f"it asks for `{query.object_id}` of the shape {theirs}, and `{lab}` has it as {ours}"
    mask = None if query.mask_png is None else mask_image(query.mask_png, size_px)
    return f"the mask of `{query.object_id}` is of no use: {mask}" if isinstance(mask, str) else None
