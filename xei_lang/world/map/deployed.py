"""The map of a deployment, held against its calibration: the files, the stations, the drives between them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import PurePosixPath

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import Drive, World
from xei_lang.profiles.files import CALIBRATION, DEVELOPMENT
from xei_lang.profiles.map_files import MapBytes, read_map_files
from xei_lang.profiles.model import MapFiles, Profile, SceneOrigin
from xei_lang.profiles.open import robot_texts
from xei_lang.world.map.drive import Floor, measures, plan_drive
from xei_lang.world.map.footprint import base_footprint
from xei_lang.world.map.grid import FREE, OCCUPIED, OccupancyGrid, yaw_of
from xei_lang.world.map.read_map import read_grid, read_meta
from xei_lang.world.map.sweep import Station, standing_cells


@dataclass(frozen=True, slots=True)
class MapFault:
    """Something that the map speaks against, or that is wrong with it.

    `item` is its place in the calibration profile, `status` a word for it, `measure` what to do and
    `write_to` where; `diagnostics` say the same in a compilation, which goes on without.
    """

    item: str
    status: str
    measure: str
    write_to: str
    diagnostics: Diagnostics


@dataclass(frozen=True, slots=True, eq=False)
class MapFindings:
    """The floor that drives are planned on, None where there is no map; the ways that it leaves; faults."""

    floor: Floor | None
    drives: tuple[Drive, ...]
    faults: tuple[MapFault, ...]

    @property
    def diagnostics(self) -> Diagnostics:
        """What a compilation says of all faults."""
        return tuple(said for fault in self.faults for said in fault.diagnostics)


def look_at_map(profile: Profile, world: World, stations: tuple[str, ...] | None = None) -> MapFindings:
    """The drives between stations (by default all) by the profile's map, both ways, and what is wrong.

    A profile that names no map has neither: that it is a placeholder is said elsewhere. The files are read
    from the profile's folder.
    """
    named = profile.calibration.map
    if named is None or not named.is_named:
        return MapFindings(None, (), ())
    floor = open_floor(profile, named)
    if isinstance(floor, MapFault):
        return MapFindings(None, (), (floor,))
    T_map_world = world.T_world_frame(profile.calibration.map_frame).inverse()
    standing: list[SceneOrigin] = []
    faults: list[MapFault] = []
    for station in profile.calibration.stations:
        if stations is None or station.name in stations:
            fault = _station_fault(station, floor, T_map_world)
            faults += [fault] if fault else []
            standing += [] if fault else [station]
    drives: list[Drive] = []
    for a, b in combinations(standing, 2):
        way = plan_drive(floor, station_pose(a, T_map_world), station_pose(b, T_map_world))
        if way is None:
            faults.append(_no_way(a, b, named))
        else:
            drives += _both_ways(a, b, way, T_map_world.inverse())
    return MapFindings(floor, tuple(drives), tuple(faults))


def open_floor(profile: Profile, named: MapFiles) -> Floor | MapFault:
    """The profile's map with the base's outline, or what is wrong with one of the two."""
    opened = read_map_files(profile, named)
    if isinstance(opened, Diagnostic):
        return _unreadable(named, (opened,), "missing")
    if opened.sha256 != named.sha256.lower():
        return _another(named, opened)
    grid = grid_of(opened, PurePosixPath(named.image).name)
    if not isinstance(grid, OccupancyGrid):
        return _unreadable(named, grid, "unreadable")
    footprint = base_footprint(profile, robot_texts(profile)[0])
    if isinstance(footprint, str):
        said = Diagnostic("XEI0679", f"the outline of the base is not known: {footprint}", named.span)
        measure = f"give the base collision shapes that can be laid on the floor: {footprint}"
        write_to = f"{DEVELOPMENT}:robot.urdf"
        return MapFault("base", "unknown outline", measure, write_to, (said,))
    base = profile.calibration
    return Floor(grid, footprint, base.base_speed_m_s, base.base_turn_rad_s)


def grid_of(opened: MapBytes, image_name: str) -> OccupancyGrid | Diagnostics:
    """The grid of a map's two files; `image_name` is what the YAML file must call the image."""
    meta, faults = read_meta(opened.yaml)
    if meta is None:
        return faults
    if PurePosixPath(meta.image).name != image_name:
        message = f"`{opened.yaml.file}` is the map of the image `{meta.image}`, not of `{image_name}`"
        return (Diagnostic("XEI0665", message, help=("name the two files that belong together",)),)
    grid = read_grid(meta, opened.yaml, opened.image_name, opened.image)
    return grid if isinstance(grid, OccupancyGrid) else (grid,)


def station_pose(station: SceneOrigin, T_map_world: Pose) -> Station:
    """Where the base stands at a station, in the map's frame."""
    T_map_base = T_map_world @ station.T_world_base
    return (T_map_base.position_m[0], T_map_base.position_m[1], yaw_of(T_map_base))


def _station_fault(station: SceneOrigin, floor: Floor, T_map_world: Pose) -> MapFault | None:
    values = floor.grid.values_at(
        standing_cells(floor.grid, floor.footprint, station_pose(station, T_map_world))
    )
    taken, unfree = int((values == OCCUPIED).sum()), int((values != FREE).sum())
    if not unfree:
        return None
    status = "occupied" if taken else "unknown"
    count = taken or unfree
    what = f"{count} cell{'' if count == 1 else 's'} of the map below the base"
    label = f"{what} {'is' if count == 1 else 'are'} {status}"
    item = f"stations.{station.name}"
    measure = f"drive there and record the base's pose, or map the place again: {label}"
    help_ = "record the pose again, or the map; a simulation goes on"
    message = f"the station `{station.name}` does not stand on free floor"
    said = Diagnostic("XEI0677", message, station.span, label, help=(help_,))
    return MapFault(item, status, measure, f"{CALIBRATION}:{item}.base", (said,))


def _no_way(a: SceneOrigin, b: SceneOrigin, named: MapFiles) -> MapFault:
    message = f"the map leaves the base no way between `{a.name}` and `{b.name}`"
    labels = (Label(b.span, "to here"),)
    help_ = "clear the way and map it again; a simulation drives straight"
    said = Diagnostic("XEI0678", message, a.span, "from here", labels, help=(help_,))
    measure = f"clear a way between `{a.name}` and `{b.name}` that the base fits through, and map it again"
    return MapFault(f"drives.{a.name}.{b.name}", "no way", measure, f"{CALIBRATION}:map", (said,))


def _both_ways(
    a: SceneOrigin, b: SceneOrigin, way: tuple[Station, ...], T_world_map: Pose
) -> Iterator[Drive]:
    poses = tuple(_in_world(pose, T_world_map) for pose in way)
    length_m, turn_rad = measures(poses)
    yield Drive(a.name, b.name, poses, length_m, turn_rad)
    yield Drive(b.name, a.name, poses[::-1], length_m, turn_rad)


def _in_world(pose: Station, T_world_map: Pose) -> Station:
    x, y, _ = T_world_map.apply((pose[0], pose[1], 0.0))
    return (x, y, math.remainder(pose[2] + yaw_of(T_world_map), math.tau))


def _unreadable(named: MapFiles, found: Diagnostics, status: str) -> MapFault:
    said = tuple(one if one.span else replace(one, span=named.span) for one in found)
    measure = "; ".join(dict.fromkeys(one.message for one in said)) + ": build the map again, or copy it here"
    return MapFault("map", status, measure, f"{CALIBRATION}:map", said)


def _another(named: MapFiles, opened: MapBytes) -> MapFault:
    message = f"`{named.yaml}` and `{named.image}` are not the map that was recorded"
    label = f"the files have {opened.sha256[:12]}..."
    help_ = f'copy that map back, or, if this is the right one, write `sha256: "{opened.sha256}"`'
    note = "everything that was measured in the map's frame holds for the map that it was measured with"
    said = Diagnostic("XEI0666", message, named.sha256_span, label, notes=(note,), help=(help_,))
    measure = f"copy the recorded map back; the files that are there have {opened.sha256}"
    return MapFault("map.sha256", "another map", measure, f"{CALIBRATION}:map.sha256", (said,))
