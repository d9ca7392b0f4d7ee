"""A map with its stations and drives, as text and as a picture."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.quantity.lengths import exact_mm
from xei_lang.world.map.deployed import MapFindings, station_pose
from xei_lang.world.map.drive import Floor
from xei_lang.world.map.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from xei_lang.world.map.sweep import Station, standing_cells

_SHADES = {FREE: (250, 250, 250), OCCUPIED: (20, 20, 20), UNKNOWN: (190, 190, 190)}
_OUTLINE, _TAKEN, _WAY = (30, 90, 200), (210, 30, 30), (20, 140, 60)
_PIXELS, _LARGEST = 4, 4000


def size_text(grid: OccupancyGrid) -> str:
    """How large a grid is, and how much of it is what, in a line."""
    height, width = grid.shape
    area_m2 = grid.resolution_m**2
    parts = ((FREE, "free"), (OCCUPIED, "occupied"), (UNKNOWN, "unknown"))
    told = ", ".join(f"{grid.count(value) * area_m2:.1f} m2 {word}" for value, word in parts)
    size = f"{width} x {height} cells of {exact_mm(grid.resolution_m)}"
    return f"{size}, {width * grid.resolution_m:.1f} m x {height * grid.resolution_m:.1f} m: {told}"


def summary(profile: Profile, world: World, seen: MapFindings, floor: Floor) -> str:
    """The map, the base's outline, and each station and drive with what is wrong with it, a line each."""
    named, outline = profile.calibration.map, floor.footprint
    assert named is not None
    lines = [
        f"{named.yaml} in the frame `{profile.calibration.map_frame}`: {named.status}, sha256 {named.sha256}",
        f"  {size_text(floor.grid)}",
        f"base: {len(outline.corners)} corners, turns within a circle of {outline.circumscribed_m:.2f} m",
        *_stations(profile, world, seen, floor),
    ]
    for drive in seen.drives:
        turn = f"{math.degrees(drive.turn_rad):.0f}"
        drive_s = drive.length_m / floor.speed_m_s + drive.turn_rad / floor.turn_rad_s
        way = f"{drive.length_m:.2f} m, turns of {turn} deg, {drive_s:.1f} s"
        lines.append(f"drive {drive.start} -> {drive.goal}: {way}")
    lines += [f"{fault.item}: {fault.status}" for fault in seen.faults if fault.item.startswith("drives.")]
    return "\n".join(lines) + "\n"


def _stations(profile: Profile, world: World, seen: MapFindings, floor: Floor) -> Iterator[str]:
    faults = {fault.item: fault.status for fault in seen.faults}
    for name, (x, y, yaw) in _poses(profile, world).items():
        status = faults.get(f"stations.{name}", "free")
        yield f"station {name}: at {x:.2f}, {y:.2f} m, {math.degrees(yaw):.0f} deg; below the base {status}"


def _poses(profile: Profile, world: World) -> dict[str, Station]:
    T_map_world = world.T_world_frame(profile.calibration.map_frame).inverse()
    return {one.name: station_pose(one, T_map_world) for one in profile.calibration.stations}


def picture_png(profile: Profile, world: World, seen: MapFindings, floor: Floor) -> bytes:
    """The map as PNG, up along the grid's rows, with the base's outline at each station (red where it does
    not stand on free floor) and the drives.
    """
    from PIL import Image, ImageDraw

    grid = floor.grid
    scale = max(1, min(_PIXELS, _LARGEST // max(grid.shape)))
    image = Image.fromarray(_shaded(grid)[::-1]).resize(
        (grid.shape[1] * scale, grid.shape[0] * scale), Image.Resampling.NEAREST
    )
    draw = ImageDraw.Draw(image)

    def pixels(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
        inside = grid.to_grid(np.array(points)) / grid.resolution_m * scale
        return [(float(x), grid.shape[0] * scale - float(y)) for x, y in inside]

    T_map_world = world.T_world_frame(profile.calibration.map_frame).inverse()
    for drive in seen.drives:
        way = [T_map_world.apply((x, y, 0.0))[:2] for x, y, _ in drive.poses]
        draw.line(pixels(way), fill=_WAY, width=2)
    for pose in _poses(profile, world).values():
        free = bool(np.all(grid.values_at(standing_cells(grid, floor.footprint, pose)) == FREE))
        corners = list(floor.footprint.at(*pose))
        color = _OUTLINE if free else _TAKEN
        draw.polygon(pixels(corners), outline=color)
        ahead = (pose[0] + 0.3 * math.cos(pose[2]), pose[1] + 0.3 * math.sin(pose[2]))
        draw.line(pixels([(pose[0], pose[1]), ahead]), fill=color, width=2)
    written = io.BytesIO()
    image.save(written, "PNG")
    return written.getvalue()


def _shaded(grid: OccupancyGrid) -> NDArray[np.uint8]:
    """Colours (height, width, 3); chances in between are greys of their own."""
    shades = 250.0 - 2.3 * np.clip(grid.cells.astype(np.float64), 0.0, 100.0)
    colors = np.repeat(shades[..., None], 3, axis=2).astype(np.uint8)
    for value, color in _SHADES.items():
        colors[grid.cells == value] = color
    return colors
