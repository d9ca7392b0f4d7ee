"""The line of a profile's file that the answer to a blocker goes to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath

from xei_lang.diagnostics import Source
from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node

Place = tuple[str, int]
"""A file as it is shown, and a line that counts from 1."""
_AXES = "xyz"


def places_of(
    blockers: Sequence[Blocker], folder: str, sources: Mapping[str, Source]
) -> Mapping[Blocker, Place]:
    """Where each blocker's answer goes: the line of the item, or of the deepest part of it that the file has.

    `folder` is the profile's, as it is shown; `sources` are its texts by their shown names. Blockers of what
    is in no file have no place.
    """
    trees: dict[str, Node | None] = {}
    found: dict[Blocker, Place] = {}
    for blocker in blockers:
        name, _, item = blocker.write_to.partition(":")
        span = blocker.span
        file = span.file if span and PurePosixPath(span.file).name == name else f"{folder}/{name}"
        source = sources.get(file)
        if source is None or not name.endswith(".yaml"):
            continue
        if file not in trees:
            trees[file] = read_yaml(file, source.text)[0]
        start = _offset(trees[file], item)
        if start is None and span is not None and span.file == file:
            start = span.start
        if start is not None:
            found[blocker] = (source.file, source.line_number(start))
    return found


def _offset(root: Node | None, item: str) -> int | None:
    """Where the deepest part of `frames.camera.tolerance` begins: at its key, or in a list at its element."""
    if root is None or not item:
        return None
    node, start = root, None
    for word in item.split("."):
        step = int(word) if word.isdigit() else word
        if node.kind == "list" and word in _AXES:
            step = _AXES.index(word)
        below = node.child(step)
        if below is None:
            break
        start = node.keys[step].start if isinstance(step, str) else below.span.start
        node = below
    return start
