"""World as text for people: the robot, the frames, then a block an object: where it is and who said so."""

from __future__ import annotations

import math

from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.world import Drive, Frame, Opening, RobotState, World, WorldObject
from xei_lang.quantity.lengths import millimetres


def to_text(world: World) -> str:
    """The world; lengths in mm, angles in degrees, masses in g, joints in rad (m where they slide)."""
    blocks = [
        _robot(world.robot),
        "\n".join(_frame(frame) for frame in world.frames),
        *(_object(item) for item in world.objects),
        "\n".join(_drive(one) for one in world.drives),
        f"asked, in this order: {', '.join(world.sources) or 'nothing'}",
    ]
    return "\n\n".join(block for block in blocks if block) + "\n"


def _robot(state: RobotState) -> str:
    lines = [f"robot at {state.station}: base {pose_text(state.T_world_base)}"]
    lines.extend(f"  {name} = {value + 0.0:g}" for name, value in state.joints)
    return "\n".join(lines)


def _frame(frame: Frame) -> str:
    turn = f"{math.degrees(frame.rotation_tolerance_rad):.3g}"
    known = "standard deviation" if frame.tolerance_as == "std" else "good to"
    good = f"{known} {millimetres(frame.position_tolerance_m)} mm and {turn} deg"
    return f"frame {frame.name} in {frame.parent}: {pose_text(frame.T_parent_frame)}, {frame.status}, {good}"


def _drive(drive: Drive) -> str:
    turn = f"{math.degrees(drive.turn_rad):.0f}"
    return f"drive {drive.start} -> {drive.goal}: {drive.length_m:.2f} m and turns of {turn} deg, by the map"


def _object(item: WorldObject) -> str:
    place = f", in {item.place}" if item.place else ""
    place += f", fastened to {item.fastened_to}" if item.fastened_to else ""
    lines = [f"{item.name}: {pose_text(item.T_frame_object)} in {item.frame_id}{place}"]
    size = " x ".join(millimetres(value) for value in item.size_m)
    shapes = f"{len(item.geometry)} shape{'s' if len(item.geometry) != 1 else ''}"
    lines.append(f"  {size} mm, {shapes}{_mass(item.mass_kg)}; confidence {item.confidence:g}")
    lines.append(f"  {'movable' if item.movable else 'fixed'}: {', '.join(item.roles) or 'no role'}")
    lines.extend(f"  {_opening(one)}" for one in item.openings)
    if item.skills:
        lines.append(f"  skills: {', '.join(item.skills)}")
    lines.extend(f"  {name} = {value}" for name, value in (*item.states, *item.metadata))
    lines.extend(f"  {fields} from {source}" for source, fields in _by_source(item))
    return "\n".join(lines)


def _opening(one: Opening) -> str:
    count = one.counts[0] * one.counts[1]
    size = f"{millimetres(2 * one.radius_m)} mm wide, {millimetres(one.depth_m)} mm deep"
    return f"open: {count} holes {size}" if count > 1 else f"open: {size}"


def _mass(mass_kg: float) -> str:
    return f", {round(mass_kg * 1000, 3):g} g" if mass_kg else ""


def _by_source(item: WorldObject) -> list[tuple[str, str]]:
    """Fields grouped by what gave them, in the order in which the sources first appear."""
    grouped: dict[str, list[str]] = {}
    for name, source in item.provenance:
        grouped.setdefault(source, []).append(name)
    return [(source, ", ".join(names)) for source, names in grouped.items()]
