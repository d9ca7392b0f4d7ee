"""Pictures of a bench, rendered by MuJoCo from a World: its primitives, and its profile's tags as texture.

What renders shares no code with what is tested: intrinsics become a frustum, depth comes from the z-buffer.
"""

from __future__ import annotations

import os

import mujoco
import numpy as np

from tests.world.perception.render import MODULES, bitmap
from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive
from xei_lang.ir.world import World
from xei_lang.profiles.model import Camera, Profile, Tag
from xei_lang.world.frames import frame_tree
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL
from xei_lang.world.perception.pictures import encode_depth, encode_png
from xei_lang.world.perception.pose_request import Intrinsics, Picture
from xei_lang.world.transforms import lookup

DEPTH_SCALE_M = 1e-4
_FLIP = Pose.from_rpy((0.0, 0.0, 0.0), (np.pi, 0.0, 0.0))
"""MuJoCo's cameras look along -z with y up, the optical frame along z with y down."""
_PAPER_M = 1e-4
"""How far a tag lies above what it is stuck on, so that the z-buffer tells them apart."""
_PER_MODULE = 12


def egl_missing() -> str | None:
    """Why no off-screen context can be made here, or None where one can."""
    try:
        with mujoco.Renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8):
            return None
    except Exception as error:
        return f"MuJoCo cannot render off screen with {os.environ['MUJOCO_GL']}: {error}"


def take_picture(
    profile: Profile,
    world: World,
    camera: Camera,
    output_frame: str = "world",
    *,
    stamp_ns: int,
    seed: int = 0,
    noise: float = 2.0,
    depth_noise_m: float = 0.0005,
) -> Picture:
    """Colour and depth of a world from a camera of its profile, with noise of a sensor (grey values, m)."""
    T_world_camera = world.T_world_frame(camera.frame)
    spec = _spec(world, camera, T_world_camera)
    for tag in profile.calibration.apriltags.tags:
        _add_tag(spec, tag, profile.calibration.apriltags.family, _T_world_tag(world, tag))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, camera.height, camera.width) as renderer:
        renderer.update_scene(data, camera="eye")
        colour = renderer.render().astype(np.float64)
        renderer.enable_depth_rendering()
        renderer.update_scene(data, camera="eye")
        depth = renderer.render().astype(np.float64)
    random = np.random.default_rng(seed)
    colour = np.clip(np.rint(colour + random.normal(0.0, noise, colour.shape)), 0, 255).astype(np.uint8)
    depth = np.where(depth > 5.0, np.nan, depth + random.normal(0.0, depth_noise_m, depth.shape))
    return Picture(
        stamp_ns=stamp_ns,
        camera_frame=camera.frame,
        output_frame=output_frame,
        T_output_camera=lookup(world, output_frame, camera.frame).T_target_source,
        intrinsics=Intrinsics(
            camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height, camera.distortion
        ),
        rgb_png=encode_png(colour[:, :, ::-1]),
        depth_png16=encode_depth(depth, DEPTH_SCALE_M),
        depth_scale_m=DEPTH_SCALE_M,
    )


def with_robot_at(profile: Profile, world: World) -> World:
    """The world with its frames where its robot state has them."""
    return World(frame_tree(profile, world.robot), world.objects, world.robot, world.sources)


def _T_world_tag(world: World, tag: Tag) -> Pose:
    """A tag on an object moves with it; others stand in their frame."""
    is_frame = tag.frame == "world" or world.frame(tag.frame) is not None
    T = world.T_world_frame(tag.frame) if is_frame else world.T_world_object(tag.frame)
    return T @ tag.T_frame_tag


def _spec(world: World, camera: Camera, T_world_camera: Pose) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    spec.stat.extent = 1.0
    spec.visual.map.znear, spec.visual.map.zfar = 0.05, 20.0
    spec.visual.global_.offwidth, spec.visual.global_.offheight = camera.width, camera.height
    spec.visual.quality.shadowsize, spec.visual.quality.offsamples = 0, 8
    spec.visual.headlight.ambient = [0.6, 0.6, 0.6]
    spec.visual.headlight.diffuse = [0.35, 0.35, 0.35]
    spec.visual.headlight.specular = [0.0, 0.0, 0.0]
    T_world_eye = T_world_camera @ T_CAMERA_OPTICAL @ _FLIP
    eye = spec.worldbody.add_camera(name="eye", pos=T_world_eye.position_m, quat=_wxyz(T_world_eye))
    eye.resolution = [camera.width, camera.height]
    eye.sensor_size = [camera.width * 1e-6, camera.height * 1e-6]
    eye.focal_pixel = [camera.fx, camera.fy]
    # MuJoCo's principal point is counted from the middle of the image, the other way round.
    eye.principal_pixel = [(camera.width - 1) / 2 - camera.cx, (camera.height - 1) / 2 - camera.cy]
    for item in world.objects:
        grey = 0.35 + 0.4 * ((sum(item.name.encode()) % 17) / 17)
        for part in item.geometry:
            _add_part(spec, part, world.T_world_object(item.name), grey)
    return spec


def _add_part(spec: mujoco.MjSpec, part: Primitive, T_world_object: Pose, grey: float) -> None:
    T, shape = T_world_object @ part.T_object_shape, part.shape
    if isinstance(shape, Box):
        kind, size = mujoco.mjtGeom.mjGEOM_BOX, [0.5 * side for side in shape.size_m]
    elif isinstance(shape, Cylinder):
        kind, size = mujoco.mjtGeom.mjGEOM_CYLINDER, [shape.radius_m, 0.5 * shape.height_m, 0.0]
    elif isinstance(shape, Capsule):
        kind, size = mujoco.mjtGeom.mjGEOM_CAPSULE, [shape.radius_m, 0.5 * shape.height_m, 0.0]
    else:
        kind, size = mujoco.mjtGeom.mjGEOM_SPHERE, [shape.radius_m, 0.0, 0.0]
    spec.worldbody.add_geom(
        type=kind, size=size, pos=T.position_m, quat=_wxyz(T), rgba=[grey, grey, grey, 1.0]
    )


def _add_tag(spec: mujoco.MjSpec, tag: Tag, family: str, T_world_tag: Pose) -> None:
    """The tag with its white margin: a flat mesh with a texture."""
    modules = MODULES[family]
    half = 0.5 * tag.size_m * (modules + 2) / modules
    levels = np.kron(bitmap(family, tag.id), np.ones((_PER_MODULE, _PER_MODULE)))
    pixels = np.where(levels > 0, 230, 20).astype(np.uint8)
    name = f"tag_{tag.id}"
    spec.add_texture(
        name=name, type=mujoco.mjtTexture.mjTEXTURE_2D, width=pixels.shape[1], height=pixels.shape[0],
        nchannel=3, data=np.repeat(pixels.reshape(-1), 3).tolist(),
    )  # fmt: skip
    material = spec.add_material(name=name)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
    spec.add_mesh(
        name=name,
        uservert=[-half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0],
        usertexcoord=[0, 1, 1, 1, 1, 0, 0, 0],
        userface=[0, 1, 2, 0, 2, 3],
        userfacetexcoord=[0, 1, 2, 0, 2, 3],
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    T = T_world_tag @ Pose((0.0, 0.0, _PAPER_M))
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        material=name,
        pos=T.position_m,
        quat=_wxyz(T),
        contype=0,
        conaffinity=0,
    )


def _wxyz(pose: Pose) -> list[float]:
    x, y, z, w = pose.quaternion
    return [w, x, y, z]
