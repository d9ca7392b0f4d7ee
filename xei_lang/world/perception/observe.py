"""The pose service as a source of the world: ask, hold against the picture, hand over what is believed."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from xei_lang.ir.forms.canonical import Json, line
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.perception.acceptance import Accepted, Criteria, Evidence, accept, stale
from xei_lang.world.perception.cameras import camera_at
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.optics import Optics, matrix_of
from xei_lang.world.perception.other_shape import other_shape
from xei_lang.world.perception.pictures import depth_image, mask_image
from xei_lang.world.perception.pose_request import (
    Matrix,
    ObjectPose,
    Picture,
    PoseQuery,
    PoseRequest,
    PoseResponse,
)
from xei_lang.world.perception.registry import Registry, registry_of
from xei_lang.world.perception.seen import Seen
from xei_lang.world.perception.service_fault import PoseRefused, ServiceFault
from xei_lang.world.sources import Observation, Observations
from xei_lang.world.transforms import lookup

BASE = "robot_base"


def ask_for(
    picture: Picture, registry: Registry, names: Sequence[str], *, request_id: str, session_id: str
) -> PoseRequest:
    """A request for objects of the registry, by name. Raises KeyError for a name that it does not have."""
    queries: list[PoseQuery] = []
    for name in names:
        known = registry.find(name)
        if known is None:
            raise KeyError(name)
        queries.append(PoseQuery(name, known.mesh.sha256))
    return PoseRequest(request_id, picture, tuple(queries), session_id)


def observe(
    client: PoseClient,
    profile: Profile,
    request: PoseRequest,
    *,
    now_ns: int,
    criteria: Criteria | None = None,
    world: World | None = None,
) -> Seen | ServiceFault:
    """Ask a service for the objects of a request, and keep what the picture bears out.

    `now_ns` is the time at which the answer is used, on the clock of the picture's stamp. `world` has the
    frames that the workspace is placed in; without one they are as at the start. Raises KeyError for an
    output frame that there is not.
    """
    registry = registry_of(profile)
    healthy = client.health(registry)
    if isinstance(healthy, ServiceFault):
        return healthy
    answer = client.poses(request)
    if isinstance(answer, ServiceFault):
        return answer
    return judge(client.url, profile, request, answer, now_ns=now_ns, criteria=criteria, world=world)


def judge(
    url: str,
    profile: Profile,
    request: PoseRequest,
    answer: PoseResponse,
    *,
    now_ns: int,
    criteria: Criteria | None = None,
    world: World | None = None,
) -> Seen | ServiceFault:
    """An answer held against its request's picture and the profile. Raises KeyError like `observe`."""
    criteria = criteria or Criteria()
    picture = request.picture
    optics = Optics.of_intrinsics(picture.intrinsics)
    depth = depth_image(picture.depth_png16, optics.size_px, picture.depth_scale_m)
    if isinstance(depth, str):
        return ServiceFault("no_picture", f"the depth image of the request is of no use: {depth}",
                            "record depth as grey PNG of 16 bits, at the size of the intrinsics")  # fmt: skip
    tree, camera = world or _at_start(profile), camera_at(profile, picture.camera_frame)
    T_base_output = lookup(tree, BASE, picture.output_frame).T_target_source
    refused: list[PoseRefused] = []
    kept: list[Observation] = []
    late = stale(answer.stamp_ns, now_ns, criteria)
    asked = {query.object_id: query for query in request.queries}
    registry = registry_of(profile)
    for item in answer.objects:
        query = asked.pop(item.name, None)
        lab_object = profile.object(item.name)
        doubt = None if query and lab_object else _unasked(item)
        if query and lab_object:
            doubt = other_shape(item, query, registry.find(item.name))
        if doubt is None and late is not None and item.status == "ok":
            doubt = PoseRefused(item.name, late[0], f"the pose of `{item.name}` {late[1]}",
                                "ask again with a new picture, and look at both clocks")  # fmt: skip
        if doubt is not None or query is None or lab_object is None:
            refused.append(doubt or _unasked(item))
            continue
        mask = None if query.mask_png is None else mask_image(query.mask_png, optics.size_px)
        evidence = Evidence(picture, optics, depth, None if isinstance(mask, str) else mask,
                            profile.calibration.workspace_bounds_m, T_base_output)  # fmt: skip
        found = accept(item, lab_object.geometry, evidence, criteria)
        if isinstance(found, PoseRefused):
            refused.append(found)
        else:
            kept.append(_observation(item, found, answer, camera))
    refused += [_missing(name) for name in asked]
    kept.sort(key=lambda item: item.name)
    source = f"pose_service {url}"
    looked_for = tuple(sorted(query.object_id for query in request.queries))
    said = Observations(source, tuple(kept), _digest(kept), answer.stamp_ns, looked_for)
    return Seen(said, tuple(refused), camera)


def _at_start(profile: Profile) -> World:
    state = start_state(profile)
    return World(frame_tree(profile, state), (), state)


def _observation(item: ObjectPose, found: Accepted, answer: PoseResponse, camera: str) -> Observation:
    proof = [("agreeing", f"{found.agreeing:.3f}"), ("residual_m", f"{found.residual_m:.5f}")]
    if found.overlap is not None:
        proof.append(("mask_overlap", f"{found.overlap:.3f}"))
    return Observation(
        name=item.name,
        T_frame_object=found.T_output_object,
        frame_id=item.frame_id,
        confidence=item.confidence,
        stamp_ns=answer.stamp_ns,
        covariance=roll_pitch_yaw(item.covariance, found.T_output_object),
        metadata=(
            ("pose_service.camera", camera),
            ("pose_service.model", answer.model_version),
            *((f"pose_service.{k}", v) for k, v in proof),
        ),
    )


def roll_pitch_yaw(covariance: Matrix | None, pose: Pose) -> tuple[float, ...]:
    """A covariance in the object's own axes as one of x, y, z and fixed-axis roll, pitch, yaw in its frame.

    36 numbers, row by row; none where there is no covariance, or where the pitch is 90 degrees and roll and
    yaw are one. The rates are those of Siciliano et al., Robotics (2009), 3.6, for Z Y X angles.
    """
    if covariance is None:
        return ()
    R = matrix_of(pose)[:3, :3]
    yaw, down = np.arctan2(R[1, 0], R[0, 0]), -R[2, 0]
    level = np.sqrt(max(0.0, 1.0 - down**2))
    if level < 1e-3:
        return ()
    by_rates = np.array([
        [np.cos(yaw) * level, -np.sin(yaw), 0.0],
        [np.sin(yaw) * level, np.cos(yaw), 0.0],
        [-down, 0.0, 1.0],
    ])  # fmt: skip
    J = np.zeros((6, 6))
    J[:3, :3] = R
    J[3:, 3:] = np.linalg.solve(by_rates, R)
    return tuple(float(value) for value in (J @ np.array(covariance) @ J.T).reshape(-1))


def _unasked(item: ObjectPose) -> PoseRefused:
    message = f"the service gives a pose of `{item.name}`, which it was not asked for"
    return PoseRefused(item.name, "not_asked", message, "mend the service: it answers once for each query")


def _missing(name: str) -> PoseRefused:
    message = f"the service says nothing of `{name}`, which it was asked for"
    return PoseRefused(name, "missing", message, "look at what the service says itself")


def _digest(items: Sequence[Observation]) -> str:
    """SHA-256 of the poses that are believed."""
    said: Json = [
        {"name": item.name, "frame": item.frame_id,
         "position_m": list(item.T_frame_object.position_m),
         "quaternion": list(item.T_frame_object.quaternion)}
        for item in items if item.T_frame_object is not None
    ]  # fmt: skip
    return hashlib.sha256(line(said).encode()).hexdigest()
