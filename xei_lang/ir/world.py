"""World: where everything is, who said so, and how sure they were."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.geometry import Pose, Primitive, Vec3
from xei_lang.ir.tolerance import ToleranceKind


@dataclass(frozen=True, slots=True)
class Opening:
    """A round hole straight into an object from a mouth in its outer surface: at the origin of
    `T_object_mouth`, z out of it; `radius_m` is the inner radius, `depth_m` from the mouth to the bottom.

    Of a grid this is the first hole; there are `counts` of them, `pitch_m` apart along x and y.
    """

    T_object_mouth: Pose
    radius_m: float
    depth_m: float
    counts: tuple[int, int] = (1, 1)
    pitch_m: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class WorldObject:
    """An object that was grounded.

    `T_frame_object` places the object's frame (bottom centre, z up) in `frame_id`; `place` is the slot or
    spot that it stands in (`rack_1.slot("A1")`) or empty. `provenance` says, field by field, which source
    won. `fastened_to` names the object that it rides on (a cap on its bottle): wherever that goes, it goes
    too. Empty for what stands free. `openings` are the holes that other things go into: all else of its
    geometry is solid.
    """

    name: str
    T_frame_object: Pose
    frame_id: str
    confidence: float
    roles: tuple[str, ...]
    skills: tuple[str, ...]
    size_m: Vec3
    geometry: tuple[Primitive, ...]
    mass_kg: float
    place: str = ""
    movable: bool = False
    states: tuple[tuple[str, str], ...] = ()
    metadata: tuple[tuple[str, str], ...] = ()
    provenance: tuple[tuple[str, str], ...] = ()
    fastened_to: str = ""
    openings: tuple[Opening, ...] = ()


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame of the tree: its parent, its pose there, and how it is known.

    Its tolerances are bounds or standard deviations, as `tolerance_as` says.
    """

    name: str
    parent: str
    T_parent_frame: Pose
    status: str
    position_tolerance_m: float
    rotation_tolerance_rad: float
    tolerance_as: ToleranceKind = "bound"


@dataclass(frozen=True, slots=True)
class RobotState:
    """Where the robot is before anything moves: its joints by name (rad, m) and the station it stands at."""

    joints: tuple[tuple[str, float], ...]
    station: str
    T_world_base: Pose


@dataclass(frozen=True, slots=True)
class Drive:
    """The way of the base from a station to another by the map: straight legs and turns in place.

    `poses` are (x, y, yaw) of the base in `world` (m, rad), one after each leg or turn; `length_m` is the
    length of all legs, `turn_rad` the sum of all turns.
    """

    start: str
    goal: str
    poses: tuple[Vec3, ...]
    length_m: float
    turn_rad: float


@dataclass(frozen=True, slots=True)
class World:
    """World grounding: frames, objects (sorted by name) and the robot's state. `world` is the root frame.

    `drives` are the ways between stations that the map is known to leave; empty where there is no map.
    """

    frames: tuple[Frame, ...]
    objects: tuple[WorldObject, ...]
    robot: RobotState
    sources: tuple[str, ...] = ()
    drives: tuple[Drive, ...] = ()

    def find(self, name: str) -> WorldObject | None:
        """The object of this name, or None."""
        return next((item for item in self.objects if item.name == name), None)

    def frame(self, name: str) -> Frame | None:
        """The frame of this name, or None; the root `world` is not listed."""
        return next((item for item in self.frames if item.name == name), None)

    def T_world_frame(self, name: str) -> Pose:
        """Pose of a frame in the root frame `world`.

        Raises KeyError for a frame that is not in the tree (loading a profile refuses those).
        """
        pose = Pose()
        while name != "world":
            frame = self.frame(name)
            if frame is None:
                raise KeyError(name)
            pose = frame.T_parent_frame @ pose
            name = frame.parent
        return pose

    def T_world_object(self, name: str) -> Pose:
        """Pose of an object in the root frame. Raises KeyError for an unknown object."""
        found = self.find(name)
        if found is None:
            raise KeyError(name)
        return self.T_world_frame(found.frame_id) @ found.T_frame_object
