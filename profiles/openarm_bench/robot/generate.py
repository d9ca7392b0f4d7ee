"""Write openarm_mobile.urdf and openarm_mobile.srdf beside figures.yaml, from its figures alone.

Run by hand after a change of figures.yaml; the same figures give the same bytes.
A capsule is written as a cylinder named in `<collision_checking>`, which pinocchio reads as a capsule whose
axis has the cylinder's length.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import yaml

Figures = dict[str, Any]
HERE = Path(__file__).parent
SIDES = ("left", "right")


def number(value: float) -> str:
    return f"{value + 0.0:.12g}"


def numbers(values: list[float]) -> str:
    return " ".join(number(value) for value in values)


def origin(xyz: list[float], rpy: list[float] | None = None) -> str:
    return f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy or [0.0, 0.0, 0.0])}"/>'


def mirrored(vector: list[float], mirror: bool) -> list[float]:
    return [vector[0], -vector[1], vector[2]] if mirror else vector


def box_lines(box: Figures, mirror: bool) -> tuple[str, str]:
    if "lower" in box:
        low, high = box["lower"], box["upper"]
        center = [round((a + b) / 2, 9) for a, b in zip(low, high, strict=True)]
        size = [round(b - a, 9) for a, b in zip(low, high, strict=True)]
    else:
        center, size = box["center"], box["size"]
    return origin(mirrored(center, mirror), box.get("rpy")), f'<box size="{numbers(size)}"/>'


def capsule_lines(capsule: Figures, mirror: bool) -> tuple[str, str]:
    p0, p1 = (mirrored(capsule[end], mirror) for end in ("p0", "p1"))
    d = [b - a for a, b in zip(p0, p1, strict=True)]
    length = math.sqrt(sum(x * x for x in d))
    rpy = [0.0, math.atan2(math.hypot(d[0], d[1]), d[2]), math.atan2(d[1], d[0])]
    center = [(a + b) / 2 for a, b in zip(p0, p1, strict=True)]
    cylinder = f'<cylinder radius="{number(capsule["radius"])}" length="{number(length)}"/>'
    return origin(center, rpy), cylinder


def shape_lines(name: str, shapes: list[Figures], mirror: bool) -> list[str]:
    lines: list[str] = []
    capsules: list[str] = []
    for index, shape in enumerate(shapes):
        kind, figures = next(iter(shape.items()))
        placed, geometry = (box_lines if kind == "box" else capsule_lines)(figures, mirror)
        shape_name = f"{name}_{index}"
        for tag in ("visual", "collision"):
            lines.append(f'    <{tag} name="{shape_name}">{placed}<geometry>{geometry}</geometry></{tag}>')
        if kind == "capsule":
            capsules.append(f'<capsule name="{shape_name}"/>')
    if capsules:
        lines.append(f"    <collision_checking>{''.join(capsules)}</collision_checking>")
    return lines


def box_inertia(mass: float, size: list[float]) -> list[float]:
    x, y, z = (side * side for side in size)
    return [mass / 12 * (y + z), 0.0, 0.0, mass / 12 * (x + z), 0.0, mass / 12 * (x + y)]


def link(name: str, figures: Figures, mirror: bool = False) -> list[str]:
    """A `<link>`; one without an inertia gets that of its first box, one without a mass is a bare frame."""
    if "mass" not in figures:
        return [f'  <link name="{name}"/>']
    first = figures["shapes"][0].get("box", {})
    com = mirrored(figures.get("com") or first["center"], mirror)
    inertia = figures.get("inertia") or box_inertia(figures["mass"], first["size"])
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    terms = " ".join(f'{name}="{number(value)}"' for name, value in zip(names, inertia, strict=True))
    inertial = f'{origin(com)}<mass value="{number(figures["mass"])}"/><inertia {terms}/>'
    shapes = shape_lines(name, figures["shapes"], mirror)
    return [f'  <link name="{name}">', f"    <inertial>{inertial}</inertial>", *shapes, "  </link>"]


def fixed(name: str, parent: str, child: str, xyz: list[float], rpy: list[float] | None = None) -> list[str]:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return [f'  <joint name="{name}" type="fixed">{ends}{origin(xyz, rpy)}</joint>']


def moving(kind: str, name: str, ends: tuple[str, str], figures: Figures, mimic: str = "") -> list[str]:
    keys = ("lower", "upper", "velocity", "effort")
    limit = " ".join(f'{key}="{number(figures[key])}"' for key in keys)
    placed = origin(figures["xyz"], figures.get("rpy"))
    return [
        f'  <joint name="{name}" type="{kind}">',
        f'    <parent link="{ends[0]}"/><child link="{ends[1]}"/>{placed}',
        f'    <axis xyz="{numbers(figures["axis"])}"/><limit {limit}/>{mimic}',
        "  </joint>",
    ]


def arm_links(side: str, figures: Figures) -> list[str]:
    mirrors = side == "left"
    lines: list[str] = []
    for name, item in figures["links"].items():
        if name != "source":
            lines += link(f"openarm_{side}_{name}", item, mirrors and item.get("mirror", False))
    for finger in SIDES:
        lines += link(f"openarm_{side}_{finger}_finger", figures["fingers"], finger == "right")
    return lines


def arm_joints(side: str, figures: Figures) -> list[str]:
    prefix = f"openarm_{side}_"
    mount, hand = figures["mounts"][side], figures["hand"]
    lines = fixed(f"{prefix}mount_joint", "openarm_body_link0", f"{prefix}link0", mount["xyz"], mount["rpy"])
    for index, right in enumerate(figures["joints"]["right"]):
        other = figures["joints"]["left"].get(right["name"], {}) if side == "left" else {}
        ends = (f"{prefix}link{index}", f"{prefix}link{index + 1}")
        lines += moving("revolute", prefix + right["name"], ends, {**right, **other})
    lines += fixed(f"{prefix}joint8", f"{prefix}link7", f"{prefix}link8", hand["link8_xyz"])
    lines += fixed(f"{prefix}hand_joint", f"{prefix}link8", f"{prefix}hand", hand["hand_xyz"])
    lines += fixed(f"{prefix}hand_tcp_joint", f"{prefix}hand", f"{prefix}hand_tcp", hand["hand_tcp_xyz"])
    lines += fixed(f"{prefix}grasp_joint", f"{prefix}hand_tcp", f"{prefix}grasp", hand["grasp_xyz"])
    return lines + finger_joints(prefix, figures)


def finger_joints(prefix: str, figures: Figures) -> list[str]:
    fingers, hand = figures["fingers"], figures["hand"]
    common = {**fingers["travel"], "velocity": fingers["velocity"], "effort": fingers["effort"]}
    first = {**common, "xyz": hand["right_finger_xyz"], "axis": [0, -1, 0]}
    second = {**common, "xyz": hand["left_finger_xyz"], "axis": [0, 1, 0]}
    mimic = f'<mimic joint="{prefix}finger_joint1" multiplier="1" offset="0"/>'
    ends = ((f"{prefix}hand", f"{prefix}right_finger"), (f"{prefix}hand", f"{prefix}left_finger"))
    return [
        *moving("prismatic", f"{prefix}finger_joint1", ends[0], first),
        *moving("prismatic", f"{prefix}finger_joint2", ends[1], second, mimic),
    ]


def urdf(figures: Figures) -> str:
    slide = figures["slide"]
    slide_joint = {**slide["joint"], "xyz": slide["origin"], "axis": [0, 0, 1]}
    lines = [
        '<?xml version="1.0"?>',
        "<!-- Written by generate.py from figures.yaml, which names each figure's source. Do not edit. -->",
        "<!-- limit: velocity is the rated speed and effort the rated torque of the motor;",
        "     what a plan may use stands in calibration_profile.yaml. -->",
        '<robot name="openarm_mobile">',
        *link("base_link", figures["base"]),
        *link("slide_column", slide["column"]),
        *link("slide_carriage", slide["carriage"]),
        *link("openarm_body_link0", figures["body"]),
        *fixed("slide_column_joint", "base_link", "slide_column", [0.0, 0.0, 0.0]),
        *moving("prismatic", "slide_joint", ("base_link", "slide_carriage"), slide_joint),
        *fixed("openarm_body_mount_joint", "slide_carriage", "openarm_body_link0", [0.0, 0.0, 0.0]),
    ]
    for side in SIDES:
        lines += arm_links(side, figures) + arm_joints(side, figures)
    return "\n".join([*lines, "</robot>", ""])


def group(name: str, joints: list[str]) -> list[str]:
    return [f'  <group name="{name}">', *(f'    <joint name="{joint}"/>' for joint in joints), "  </group>"]


def state(name: str, group_name: str, values: dict[str, float]) -> list[str]:
    joints = [f'    <joint name="{joint}" value="{number(value)}"/>' for joint, value in values.items()]
    return [f'  <group_state name="{name}" group="{group_name}">', *joints, "  </group_state>"]


def arm_states(side: str, figures: Figures) -> list[str]:
    states = figures["states"]
    lines: list[str] = []
    for name, values in states["arm"].items():
        signs = states["left_sign"] if side == "left" else [1] * 7
        named = {
            f"openarm_{side}_joint{i + 1}": s * v for i, (s, v) in enumerate(zip(signs, values, strict=True))
        }
        lines += state(name, f"{side}_arm", named)
    for name, value in states["gripper"].items():
        lines += state(name, f"{side}_gripper", {f"openarm_{side}_finger_joint1": value})
    return lines


def pairs(figures: Figures) -> list[str]:
    lines: list[str] = []
    for entry in figures["disabled_pairs"]:
        named = [tuple(pair) for pair in entry.get("fixed", [])]
        named += [
            (side_link(side, a), side_link(side, b)) for side in SIDES for a, b in entry.get("side", [])
        ]
        for a, b in named:
            lines.append(f'  <disable_collisions link1="{a}" link2="{b}" reason="{entry["reason"]}"/>')
    return lines


def side_link(side: str, name: str) -> str:
    if name == "body_link0":
        return "openarm_body_link0"
    return name if name in ("base_link", "slide_column", "slide_carriage") else f"openarm_{side}_{name}"


def srdf(figures: Figures) -> str:
    lines = [
        '<?xml version="1.0"?>',
        "<!-- Written by generate.py from figures.yaml. Do not edit. -->",
        '<robot name="openarm_mobile">',
        *group("slide", ["slide_joint"]),
    ]
    for side in SIDES:
        lines += group(f"{side}_arm", [f"openarm_{side}_joint{i}" for i in range(1, 8)])
        lines += group(f"{side}_gripper", [f"openarm_{side}_finger_joint1"])
        lines.append(
            f'  <end_effector name="{side}_ee" parent_link="openarm_{side}_hand" group="{side}_gripper"/>'
        )
        lines.append(f'  <passive_joint name="openarm_{side}_finger_joint2"/>')
    for name, value in figures["states"]["slide"].items():
        lines += state(name, "slide", {"slide_joint": value})
    for side in SIDES:
        lines += arm_states(side, figures)
    return "\n".join([*lines, *pairs(figures), "</robot>", ""])


def main() -> None:
    figures = yaml.safe_load((HERE / "figures.yaml").read_text(encoding="utf-8"))
    for suffix, text in (("urdf", urdf(figures)), ("srdf", srdf(figures))):
        (HERE / f"openarm_mobile.{suffix}").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
