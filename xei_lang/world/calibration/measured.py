"""A measured transform as lines of a calibration profile, and in the place of the present ones.

Only the values of that one transform are replaced, and keys that it lacks are added behind its last one, so
that comments, order and everything else of the file stay as they are, to the byte.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node
from xei_lang.world.perception.findings import rpy

_KEYS = ("parent", "position", "rpy", "status", "measured_on", "method", "tolerance")


@dataclass(frozen=True, slots=True)
class Measured:
    """A transform that was measured: `T_parent_frame`, when and how, and its standard deviations.

    The tolerance that is written is three of them, rounded up, because tolerances are used as bounds.
    """

    frame: str
    parent: str
    T_parent_frame: Pose
    measured_on: str
    method: str
    position_std_m: float
    rotation_std_rad: float

    def values(self) -> Mapping[str, str]:
        """The value of each key of the transform, as YAML on one line."""
        position = ", ".join(f"{value + 0.0:.6f} m" for value in self.T_parent_frame.position_m)
        turns = ", ".join(f"{math.degrees(value) + 0.0:.5f} deg" for value in rpy(self.T_parent_frame))
        millimetres = math.ceil(3e6 * self.position_std_m) / 1e3
        degrees = math.ceil(3e4 * math.degrees(self.rotation_std_rad)) / 1e4
        return {
            "parent": self.parent,
            "position": f"[{position}]",
            "rpy": f"[{turns}]",
            "status": "measured",
            "measured_on": f'"{self.measured_on}"',
            "method": json.dumps(self.method),
            "tolerance": f"{{position: {millimetres:.3f} mm, rotation: {degrees:.4f} deg}}",
        }

    def snippet(self) -> str:
        """The transform as it stands under `frames:` of a calibration profile."""
        lines = [f"    {key}: {value}" for key, value in self.values().items()]
        return "\n".join(["frames:", f"  {self.frame}:", *lines, ""])


def put_in(source: Source, measured: Measured) -> str | Diagnostic:
    """The text of a calibration profile with this transform in the place of the present one."""
    root, faults = read_yaml(source.file, source.text)
    node = root.find(("frames", measured.frame)) if root and not faults else None
    if root is None or node is None or node.kind != "map" or "parent" not in node.items:
        return _refused(source, f"`{source.file}` has no transform `{measured.frame}` that can be replaced")
    text = _edited(source.text, node, measured.values())
    again, faults = read_yaml(source.file, text)
    if again is None or faults or again.plain() != _expected(root, measured):
        message = f"the lines of `{measured.frame}` cannot be replaced for sure"
        return _refused(source, message)
    return text


def _refused(source: Source, message: str) -> Diagnostic:
    help_ = "leave `--write` out, and copy the lines that are printed"
    return Diagnostic("XEI0687", message, notes=(f"`{source.file}` was left as it is",), help=(help_,))


def _edited(text: str, node: Node, values: Mapping[str, str]) -> str:
    """Replace from the end of the text on, so that earlier offsets hold."""
    places = {key: _place(text, node, key) for key in node.items}
    missing = [key for key in _KEYS if key not in node.items]
    edits = [(start, end, values[key]) for key, (start, end) in places.items() if key in values]
    last = max(end for _, end in places.values())
    if text[node.span.start] == "{":
        added = "".join(f", {key}: {values[key]}" for key in missing)
    else:
        first = min(key.start for key in node.keys.values())
        indent = first - (text.rfind("\n", 0, first) + 1)
        newline = "\r\n" if "\r\n" in text else "\n"
        added = "".join(f"{newline}{' ' * indent}{key}: {values[key]}" for key in missing)
        # Behind a comment on the last value's line, and not between the two.
        line_end = text.find("\n", last)
        last = len(text) if line_end < 0 else line_end - (text[line_end - 1] == "\r")
    if added:
        edits.append((last, last, added))
    for start, end, value in sorted(edits, reverse=True):
        space = " " if text[start - 1] == ":" else ""
        text = text[:start] + space + value + text[end:]
    return text


def _place(text: str, node: Node, key: str) -> tuple[int, int]:
    """Where the value of a key stands, from behind the key's colon and space to its last character."""
    value = node.items[key]
    end = value.span.start + len(text[value.span.start : value.span.end].rstrip())
    if value.kind == "scalar" or text[value.span.start] in "[{":
        return value.span.start, end
    # A block begins on a line of its own, where its one-line form might stand too far left.
    return text.index(":", node.keys[key].end) + 1, end


def _expected(root: Node, measured: Measured) -> object:
    """The whole file's values with the transform's replaced: what the edited text must read back as."""
    written, _ = read_yaml("snippet", measured.snippet())
    value = _plain(written.find(("frames", measured.frame))) if written else {}
    before = _plain(root.find(("frames", measured.frame)))
    frames = {**_plain(root.find(("frames",))), measured.frame: {**before, **value}}
    return {**_plain(root), "frames": frames}


def _plain(node: Node) -> dict[str, object]:
    return {key: item.plain() for key, item in node.items.items()}
