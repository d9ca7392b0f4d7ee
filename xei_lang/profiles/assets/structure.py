"""Whether the bytes of a mesh are whole: libraries that read meshes take a cut one for a smaller one."""

from __future__ import annotations

import re
from dataclasses import dataclass

from xei_lang.profiles.assets.points import UnreadableError

MAX_TRIANGLES = 500_000
MAX_POINTS = 1_000_000
MAX_SOLIDS = 1_000

_VERTEX = re.compile(rb"^[ \t]*vertex[ \t]", re.M)
_LOOP = re.compile(rb"^[ \t]*(outer[ \t]+loop|endloop)\b", re.M)
_OBJ_VERTEX = re.compile(rb"^[ \t]*v[ \t]", re.M)
_OBJ_FACE = re.compile(rb"^[ \t]*f[ \t]", re.M)
_PLY_FORMATS = ("ascii", "binary_little_endian", "binary_big_endian")


@dataclass(frozen=True, slots=True)
class Claim:
    """How many points and faces a file says that it holds."""

    points: int
    faces: int


def claim(data: bytes, suffix: str) -> Claim:
    """What a file with this suffix (`.stl`, `.obj`, `.ply`) holds.

    Raises UnreadableError where it is cut, too large or something else.
    """
    if not data.strip():
        raise UnreadableError("is empty")
    found = {".stl": _stl, ".obj": _obj, ".ply": _ply}[suffix](data)
    if found.faces > MAX_TRIANGLES:
        raise UnreadableError(f"has {found.faces} triangles, the limit is {MAX_TRIANGLES}")
    if found.points > 3 * MAX_TRIANGLES:
        raise UnreadableError(f"has {found.points} points, the limit is {3 * MAX_TRIANGLES}")
    return found


def _stl(data: bytes) -> Claim:
    """Binary: 80 bytes, a count, 50 bytes a triangle (3D Systems, StereoLithography Interface, 1989)."""
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and len(data) == 84 + 50 * count:
        return Claim(3 * count, count)
    text = data.lower()
    if text.lstrip().startswith(b"solid") and (b"facet" in text or b"endsolid" in text):
        return _stl_text(text)
    if len(data) < 84 or _is_text(data):
        raise UnreadableError("is no STL file")
    needed = 84 + 50 * count
    found = f"{count} triangles take {needed} bytes, and it has {len(data)}"
    raise UnreadableError(f"is cut or no STL file: {found}")


def _stl_text(text: bytes) -> Claim:
    if text.count(b"endsolid") > MAX_SOLIDS:
        raise UnreadableError(f"has more than {MAX_SOLIDS} solids, which is the limit")
    vertices, loops = len(_VERTEX.findall(text)), _LOOP.findall(text)
    closed = loops.count(b"endloop")
    if b"endsolid" not in text[text.rfind(b"endloop") + 1 :]:
        raise UnreadableError("breaks off: it has no `endsolid`")
    if vertices != 3 * closed or len(loops) != 2 * closed:
        raise UnreadableError(f"is damaged: {vertices} vertices in {len(loops) - closed} triangles")
    return Claim(vertices, closed)


def _obj(data: bytes) -> Claim:
    if not _is_text(data):
        raise UnreadableError("is no OBJ file: it is not text")
    vertices, faces = len(_OBJ_VERTEX.findall(data)), len(_OBJ_FACE.findall(data))
    if not vertices:
        raise UnreadableError("is no OBJ file: no line begins with `v`")
    return Claim(vertices, faces)


def _ply(data: bytes) -> Claim:
    """The counts of a PLY header (Turk, The PLY Polygon File Format, 1994)."""
    if not data.startswith((b"ply\n", b"ply\r")):
        raise UnreadableError("is no PLY file")
    end = data.find(b"end_header")
    if end < 0:
        raise UnreadableError("breaks off in its header")
    counts = {"vertex": 0, "face": 0}
    for line in data[:end].decode("ascii", "replace").splitlines():
        words = line.split()
        if words[:1] == ["format"] and (len(words) < 2 or words[1] not in _PLY_FORMATS):
            raise UnreadableError(f"is of a kind of PLY that nothing reads: `{line[:40]}`")
        if words[:1] == ["element"]:
            if len(words) != 3 or not is_count(words[2]):
                raise UnreadableError(f"has a header that cannot be read: `{line[:40]}`")
            if words[1] not in counts and int(words[2]) > 3 * MAX_TRIANGLES:
                raise UnreadableError(
                    f"has {words[2]} of `{words[1][:40]}`, the limit is {3 * MAX_TRIANGLES}"
                )
            counts[words[1]] = int(words[2])
    if not counts["vertex"]:
        raise UnreadableError("holds no points")
    return Claim(counts["vertex"], counts["face"])


def is_count(word: str) -> bool:
    """Whether a word of a header is a number of things."""
    return word.isascii() and word.isdecimal() and len(word) <= 12


def _is_text(data: bytes) -> bool:
    return b"\0" not in data[:10_000]
