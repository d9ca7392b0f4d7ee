"""Between the contract's models and the values behind them, both ways."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.world.perception.contract import (
    MeshModel,
    ObjectPoseModel,
    PoseRequestModel,
    PoseResponseModel,
    PutObjectModel,
    RegisteredModel,
    decoded,
    encoded,
)
from xei_lang.world.perception.pose_request import (
    Intrinsics,
    Matrix,
    MeshInfo,
    ObjectPose,
    Picture,
    PoseQuery,
    PoseRequest,
    PoseResponse,
)
from xei_lang.world.perception.registry import RegisteredObject
from xei_lang.world.sources.rigid import pose_of_matrix

DISTORTIONS = (0, 4, 5, 8, 12, 14)


def request_of(model: PoseRequestModel) -> PoseRequest | str:
    """The request that was sent, or what is wrong with it beyond its form."""
    T_output_camera = pose_of_matrix(model.T_output_camera)
    if isinstance(T_output_camera, str):
        return f"T_output_camera: {T_output_camera}"
    rgb, depth = decoded(model.rgb_png), decoded(model.depth_png16)
    if rgb is None or depth is None:
        return f"{'rgb_png' if rgb is None else 'depth_png16'}: it is not base64"
    queries: list[PoseQuery] = []
    for query in model.queries:
        mask = None if query.mask_png is None else decoded(query.mask_png)
        if mask is None and query.mask_png is not None:
            return f"mask_png of `{query.object_id}`: it is not base64"
        if any(query.object_id == known.object_id for known in queries):
            return f"`{query.object_id}` is asked for twice"
        queries.append(PoseQuery(query.object_id, query.mesh_sha256, mask, query.mode))
    lens = model.intrinsics
    if len(lens.distortion) not in DISTORTIONS:
        return f"distortion: no model of OpenCV has {len(lens.distortion)} coefficients"
    picture = Picture(
        stamp_ns=model.stamp_ns,
        camera_frame=model.camera_frame,
        output_frame=model.output_frame,
        T_output_camera=T_output_camera,
        intrinsics=Intrinsics(
            lens.fx, lens.fy, lens.cx, lens.cy, lens.width, lens.height, tuple(lens.distortion)
        ),
        rgb_png=rgb,
        depth_png16=depth,
        depth_scale_m=model.depth_scale_m,
    )
    return PoseRequest(model.request_id, picture, tuple(queries), model.session_id)


def request_json(request: PoseRequest) -> Json:
    """The body of `POST /v1/poses`."""
    picture = request.picture
    lens = picture.intrinsics
    return {
        "request_id": request.request_id,
        "stamp_ns": picture.stamp_ns,
        "camera_frame": picture.camera_frame,
        "output_frame": picture.output_frame,
        "T_output_camera": matrix_json(picture.T_output_camera),
        "intrinsics": {
            "fx": float(lens.fx), "fy": float(lens.fy), "cx": float(lens.cx), "cy": float(lens.cy),
            "width": lens.width, "height": lens.height, "distortion": [float(k) for k in lens.distortion],
        },
        "rgb_png": encoded(picture.rgb_png),
        "depth_png16": encoded(picture.depth_png16),
        "depth_scale_m": picture.depth_scale_m,
        "queries": [_query_json(query) for query in request.queries],
        "session_id": request.session_id,
    }  # fmt: skip


def response_of(model: PoseResponseModel) -> PoseResponse:
    """The answer that was sent."""
    objects = tuple(_object_pose(item) for item in model.objects)
    return PoseResponse(model.request_id, model.stamp_ns, objects, model.model_version, model.processing_ms)


def response_model(response: PoseResponse) -> PoseResponseModel:
    """The answer as it is sent."""
    return PoseResponseModel(
        request_id=response.request_id,
        stamp_ns=response.stamp_ns,
        objects=[
            ObjectPoseModel(
                name=item.name,
                frame_id=item.frame_id,
                status=item.status,
                T_output_object=_rows(item.T_output_object),
                confidence=item.confidence,
                covariance=_rows(item.covariance),
                roles=list(item.roles),
                skills=list(item.skills),
                mesh=mesh_model(item.mesh),
            )
            for item in response.objects
        ],
        model_version=response.model_version,
        processing_ms=response.processing_ms,
    )


def registered_of(model: RegisteredModel) -> RegisteredObject:
    """An object of a listed registry."""
    return RegisteredObject(model.name, tuple(model.roles), tuple(model.skills), _mesh(model.mesh))


def registered_put(name: str, model: PutObjectModel) -> RegisteredObject:
    """An object that was put under a name."""
    return RegisteredObject(name, tuple(model.roles), tuple(model.skills), _mesh(model.mesh))


def registered_model(item: RegisteredObject) -> RegisteredModel:
    """An object as it is listed."""
    return RegisteredModel(
        name=item.name, roles=list(item.roles), skills=list(item.skills), mesh=mesh_model(item.mesh)
    )


def put_json(item: RegisteredObject) -> Json:
    """The body of `PUT /objects/{id}`."""
    size: Vec3 = item.mesh.size_m
    mesh = {"sha256": item.mesh.sha256, "units": item.mesh.units, "size_m": [float(side) for side in size]}
    return {"roles": list(item.roles), "skills": list(item.skills), "mesh": mesh}


def matrix_json(pose: Pose) -> list[list[float]]:
    """The 4x4 matrix of a pose by rows."""
    return [[float(value) for value in row] for row in pose.matrix()]


def mesh_model(mesh: MeshInfo) -> MeshModel:
    """A shape's description as it is sent."""
    return MeshModel(sha256=mesh.sha256, units=mesh.units, size_m=[float(side) for side in mesh.size_m])


def _mesh(model: MeshModel) -> MeshInfo:
    x, y, z = model.size_m
    return MeshInfo(model.sha256, model.units, (x, y, z))


def _object_pose(model: ObjectPoseModel) -> ObjectPose:
    return ObjectPose(
        name=model.name,
        frame_id=model.frame_id,
        status=model.status,
        T_output_object=_matrix(model.T_output_object),
        confidence=model.confidence,
        covariance=_matrix(model.covariance),
        roles=tuple(model.roles),
        skills=tuple(model.skills),
        mesh=_mesh(model.mesh),
    )


def _query_json(query: PoseQuery) -> Json:
    mask = None if query.mask_png is None else encoded(query.mask_png)
    return {
        "object_id": query.object_id,
        "mesh_sha256": query.mesh_sha256,
        "mask_png": mask,
        "mode": query.mode,
    }


def _matrix(rows: Sequence[Sequence[float]] | None) -> Matrix | None:
    return None if rows is None else tuple(tuple(row) for row in rows)


def _rows(matrix: Matrix | None) -> list[list[float]] | None:
    return None if matrix is None else [list(row) for row in matrix]
