"""Point clouds: PLY through the mesh library, PCD (ASCII and binary) and XYZ."""

from __future__ import annotations

from pathlib import PurePosixPath

import numpy as np

from xei_lang.profiles.assets.points import Array, Points, UnreadableError, require_body
from xei_lang.profiles.assets.structure import MAX_POINTS, is_count

CLOUDS = (".ply", ".pcd", ".xyz")
_PCD_TYPES = {
    ("F", "4"): "<f4", ("F", "8"): "<f8", ("I", "1"): "<i1", ("I", "2"): "<i2", ("I", "4"): "<i4",
    ("I", "8"): "<i8", ("U", "1"): "<u1", ("U", "2"): "<u2", ("U", "4"): "<u4", ("U", "8"): "<u8",
}  # fmt: skip
_COMPRESSED = "is compressed: write it as `DATA binary`, such as with `pcl_convert_pcd_ascii_binary`"
_LONGEST_HEADER = 20


def read_cloud(data: bytes, name: str) -> Points | str:
    """The points of a file (n x 3, in its own unit), or in words that follow its name why there are none.

    Points that are no numbers are left out: depth cameras mark so what they did not see.
    """
    try:
        found = _points(data, PurePosixPath(name).suffix.lower())
        seen = found[np.isfinite(found).all(axis=1)]
        require_body(seen)
    except UnreadableError as reason:
        return str(reason)
    return Points(seen)


def _points(data: bytes, suffix: str) -> Array:
    if suffix not in CLOUDS:
        raise UnreadableError("is no point cloud that xei reads: expected `.ply`, `.pcd` or `.xyz`")
    if not data.strip():
        raise UnreadableError("is empty")
    if suffix == ".ply":
        from xei_lang.profiles.assets.read_mesh import ply_points

        return ply_points(data)
    return _pcd(data) if suffix == ".pcd" else _xyz(data)


def _xyz(data: bytes) -> Array:
    """A point a line: three or more numbers between blanks or commas; `#` begins a comment."""
    if data.count(b"\n") > MAX_POINTS:
        raise UnreadableError(f"has more than {MAX_POINTS} points, which is the limit")
    try:
        lines = data.decode("utf-8").splitlines()
    except UnicodeDecodeError:
        raise UnreadableError("is no XYZ file: it is not text") from None
    rows: list[list[str]] = []
    columns = 0
    for number, line in enumerate(lines, 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if words and (len(words) < 3 or columns not in (0, len(words))):
            raise UnreadableError(f"has {len(words)} numbers in line {number}, expected {columns or 3}")
        if words:
            columns = len(words)
            rows.append(words[:3])
    return _numbers(rows, "is no XYZ file")


def _numbers(rows: list[list[str]], otherwise: str) -> Array:
    try:
        return np.array(rows, dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise UnreadableError(f"{otherwise}: {error}") from None


def _pcd(data: bytes) -> Array:
    """The fields x, y and z of a PCD file (Point Cloud Library, The PCD file format, v0.7)."""
    header, body = _pcd_header(data)
    fields, counts = header["FIELDS"], [int(count) for count in header["COUNT"]]
    total, kind = int(header["POINTS"][0]), header["DATA"][0]
    if kind == "ascii":
        return _pcd_text(body, fields, counts, total)
    layout: list[tuple[str, str, tuple[int]]] = []
    for index, (size, form) in enumerate(zip(header["SIZE"], header["TYPE"], strict=True)):
        if (form, size) not in _PCD_TYPES:
            raise UnreadableError(f"has a field of type {form} and size {size}, which PCD does not have")
        layout.append((str(index), _PCD_TYPES[form, size], (counts[index],)))
    row = np.dtype(layout)
    needed = row.itemsize * total
    if len(body) < needed:
        raise UnreadableError(f"is cut: {total} points take {needed} bytes, and it has {len(body)}")
    table = np.frombuffer(body, row, total)
    return np.column_stack([table[str(fields.index(axis))][:, 0].astype(np.float64) for axis in "xyz"])


def _pcd_header(data: bytes) -> tuple[dict[str, list[str]], bytes]:
    """The lines of a header that go together, and what follows them."""
    header: dict[str, list[str]] = {}
    rest = data
    while rest and "DATA" not in header and len(header) < _LONGEST_HEADER:
        line, _, rest = rest.partition(b"\n")
        words = line[:2000].decode("ascii", "replace").split()
        if words and not words[0].startswith("#"):
            header[words[0]] = words[1:]
    fields, total, kind = header.get("FIELDS", []), header.get("POINTS", []), header.get("DATA", [])
    if len(kind) != 1 or len(total) != 1 or not is_count(total[0]) or not {"x", "y", "z"} <= set(fields):
        raise UnreadableError("is no PCD file, or breaks off in its header")
    if int(total[0]) > MAX_POINTS:
        raise UnreadableError(f"has {total[0]} points, the limit is {MAX_POINTS}")
    if kind[0] not in ("ascii", "binary"):
        other = f"has data of the kind `{kind[0]}`"
        raise UnreadableError(_COMPRESSED if kind[0] == "binary_compressed" else other)
    header.setdefault("COUNT", ["1"] * len(fields))
    if any(len(header.get(key, [])) != len(fields) for key in ("SIZE", "TYPE", "COUNT")):
        raise UnreadableError("has a header whose fields, sizes and types do not go together")
    if not all(is_count(count) and 0 < int(count) < 10_000 for count in header["COUNT"]):
        raise UnreadableError("has a header with a `COUNT` that is none")
    return header, rest


def _pcd_text(body: bytes, fields: list[str], counts: list[int], total: int) -> Array:
    rows = [line.split() for line in body.decode("ascii", "replace").splitlines() if line.strip()]
    if len(rows) != total or any(len(row) != sum(counts) for row in rows):
        raise UnreadableError(f"is cut or damaged: it tells of {total} points of {sum(counts)} numbers")
    starts = [sum(counts[: fields.index(axis)]) for axis in "xyz"]
    return _numbers([[row[at] for at in starts] for row in rows], "is damaged")
