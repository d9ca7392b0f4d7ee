"""The robot's own description, as far as the compiler's early stages need it: joints, ranges, named states.

Only the standard library's XML reader is used, so that `check` needs no robotics library. Formats: URDF
(https://wiki.ros.org/urdf/XML) and SRDF (https://wiki.ros.org/srdf).
"""

from __future__ import annotations

import math
from xml.etree import ElementTree

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.profiles.model import NamedState, RobotDescription, RobotJoint

_KINDS = ("fixed", "revolute", "continuous", "prismatic")


class _UnreadableError(Exception):
    """A fault of the description; never leaves this module."""


def read_robot(urdf: Source, srdf: Source) -> tuple[RobotDescription | None, Diagnostics]:
    """The description of the two texts, or what is wrong with them."""
    found: list[Diagnostic] = []
    trees: list[ElementTree.Element | None] = [_tree(urdf, found), _tree(srdf, found)]
    if trees[0] is None or trees[1] is None:
        return None, tuple(found)
    try:
        links = tuple(_attribute(link, "name") for link in trees[0].findall("link"))
        joints = tuple(_joint(joint) for joint in trees[0].findall("joint"))
    except (_UnreadableError, ValueError) as fault:
        return None, (_unreadable(urdf, str(fault)),)
    children = {joint.child for joint in joints}
    roots = [link for link in links if link not in children]
    if len(roots) != 1:
        return None, (_unreadable(urdf, f"it has {len(roots)} links that no joint carries, expected one"),)
    try:
        states = tuple(_state(state) for state in trees[1].findall("group_state"))
    except (_UnreadableError, ValueError) as fault:
        return None, (_unreadable(srdf, str(fault)),)
    return RobotDescription(roots[0], links, joints, states), ()


def _tree(source: Source, found: list[Diagnostic]) -> ElementTree.Element | None:
    if "<!DOCTYPE" in source.text:
        found.append(
            _unreadable(source, "it declares a document type, which a robot description does not need")
        )
        return None
    try:
        return ElementTree.fromstring(source.text)
    except ElementTree.ParseError as error:
        line, column = error.position
        offset = sum(len(text) for text in source.text.splitlines(keepends=True)[: line - 1]) + column
        found.append(_unreadable(source, f"it is not well-formed XML: {error}", offset))
        return None


def _unreadable(source: Source, reason: str, offset: int = 0) -> Diagnostic:
    name = source.file.rsplit("/", 1)[-1]
    return Diagnostic(
        "XEI0650",
        f"`{name}` cannot be read as a robot description",
        Span(source.file, offset, offset + 1),
        label=reason,
        notes=("`robot:` in development_profile.yaml names the URDF and SRDF",),
        help=("write the description anew from its figures, or name another file",),
    )


def _joint(element: ElementTree.Element) -> RobotJoint:
    name, kind = _attribute(element, "name"), _attribute(element, "type")
    if kind not in _KINDS:
        raise _UnreadableError(f"joint `{name}` has the type `{kind}`; known are {', '.join(_KINDS)}")
    limit, mimic = element.find("limit"), element.find("mimic")
    lower, upper = _number(limit, "lower", 0.0), _number(limit, "upper", 0.0)
    if kind == "continuous":
        lower, upper = -math.inf, math.inf
    origin, axis = element.find("origin"), element.find("axis")
    return RobotJoint(
        name=name,
        kind=kind,
        parent=_attribute(_child(element, "parent"), "link"),
        child=_attribute(_child(element, "child"), "link"),
        T_parent_joint=Pose.from_rpy(_vector(origin, "xyz", "0 0 0"), _vector(origin, "rpy", "0 0 0")),
        axis=_vector(axis, "xyz", "1 0 0"),
        lower=lower,
        upper=upper,
        velocity=_number(limit, "velocity", 0.0),
        effort=_number(limit, "effort", 0.0),
        mimic=_attribute(mimic, "joint") if mimic is not None else "",
    )


def _state(element: ElementTree.Element) -> NamedState:
    joints = tuple(
        (_attribute(joint, "name"), float(_attribute(joint, "value"))) for joint in element.findall("joint")
    )
    return NamedState(_attribute(element, "name"), _attribute(element, "group"), joints)


def _child(element: ElementTree.Element, tag: str) -> ElementTree.Element:
    found = element.find(tag)
    if found is None:
        raise _UnreadableError(f"joint `{element.get('name')}` has no <{tag}>")
    return found


def _attribute(element: ElementTree.Element, name: str) -> str:
    value = element.get(name)
    if value is None:
        raise _UnreadableError(f"a <{element.tag}> has no `{name}`")
    return value


def _number(element: ElementTree.Element | None, name: str, otherwise: float) -> float:
    return float(element.get(name, otherwise)) if element is not None else otherwise


def _vector(element: ElementTree.Element | None, name: str, otherwise: str) -> Vec3:
    words = (element.get(name, otherwise) if element is not None else otherwise).split()
    if len(words) != 3:
        raise _UnreadableError(f"`{' '.join(words)}` are not three numbers")
    x, y, z = (float(word) for word in words)
    return (x, y, z)
