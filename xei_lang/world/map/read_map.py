"""A map of ROS map_server, from the text of its YAML file and the bytes of its image."""

from __future__ import annotations

import io
import math
import warnings
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span
from xei_lang.profiles.faults import explain
from xei_lang.profiles.schema.map_server import MapServerModel
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node
from xei_lang.world.map.grid import OCCUPIED, UNKNOWN, Cells, OccupancyGrid

if TYPE_CHECKING:
    from PIL import Image

CODE = "XEI0665"
MAX_CELLS = 40_000_000
MAX_SIDE_M = 2_000.0
MAX_ORIGIN_M = 100_000.0

_GRAY = {"1": 1.0, "L": 255.0, "I": 65535.0, "I;16": 65535.0, "I;16B": 65535.0}
_CONVERTED = {"P": "RGBA", "LA": "RGBA", "PA": "RGBA", "RGB": "RGB", "RGBA": "RGBA"}


def read_meta(source: Source) -> tuple[MapServerModel | None, Diagnostics]:
    """What the YAML file of a map says; None, with all that is wrong with it."""
    root, faults = read_yaml(source.file, source.text)
    if root is None or faults:
        return None, tuple(_recoded(fault) for fault in faults)
    try:
        meta = MapServerModel.model_validate(root.plain())
    except ValidationError as error:
        return None, tuple(_recoded(fault) for fault in explain(error, root, MapServerModel))
    found = tuple(_contradictions(meta, root))
    return (None if found else meta), found


def read_grid(meta: MapServerModel, source: Source, name: str, image: bytes) -> OccupancyGrid | Diagnostic:
    """The grid of an image whose file is called `name`, or why it is none. `source` is the YAML file."""
    shade = _shades(name, image)
    if isinstance(shade, Diagnostic):
        return shade
    values, opaque = shade
    height, width = values.shape
    if max(height, width) * meta.resolution > MAX_SIDE_M:
        message = f"`{name}` is {width} x {height} pixels of {meta.resolution:g} m, which is no room"
        help_ = "`resolution` is in metres a pixel, such as 0.05"
        return Diagnostic(CODE, message, _place(source, "resolution"), help=(help_,))
    cells = _cells(meta, values)
    cells[~opaque] = UNKNOWN
    x, y, yaw = meta.origin
    # The image's first row is the map's farthest one.
    return OccupancyGrid(np.ascontiguousarray(cells[::-1]), meta.resolution, (x, y, yaw))


def _cells(meta: MapServerModel, shade: NDArray[np.float64]) -> Cells:
    """Values by the mode, as Nav2's map_server makes them; `shade` is 0 for black and 1 for white."""
    if meta.mode == "raw":
        raw = np.rint(shade * 255.0)
        return np.where(raw <= OCCUPIED, raw, UNKNOWN).astype(np.int8)
    chance = shade if meta.negate else 1.0 - shade
    between = np.full(shade.shape, float(UNKNOWN))
    if meta.mode == "scale":
        span = meta.occupied_thresh - meta.free_thresh
        between = np.rint(np.clip((chance - meta.free_thresh) / span, 0.0, 1.0) * 100.0)
    cells = np.where(chance > meta.occupied_thresh, 100.0, np.where(chance < meta.free_thresh, 0.0, between))
    return cells.astype(np.int8)


def _shades(name: str, data: bytes) -> tuple[NDArray[np.float64], NDArray[np.bool_]] | Diagnostic:
    """Grey values 0 .. 1 (height, width) and which pixels are not transparent."""
    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            opened = Image.open(io.BytesIO(data), formats=("PPM", "PNG"))
            width, height = opened.size
            if width * height > MAX_CELLS:
                return _huge(name, f"{width} x {height}")
            return _pixels(opened)
    except UnidentifiedImageError:
        return _no_image(name, "it is neither PGM nor PNG")
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        return _huge(name, "more than a hundred million")
    except (OSError, ValueError, SyntaxError) as error:
        return _no_image(name, str(error) or type(error).__name__)


def _pixels(opened: Image.Image) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """As `_shades`; ValueError for pixels of another kind."""
    if opened.mode in _GRAY:
        values = np.asarray(opened, dtype=np.float64) / _GRAY[opened.mode]
        return np.clip(values, 0.0, 1.0), np.ones(values.shape, dtype=np.bool_)
    if opened.mode not in _CONVERTED:
        raise ValueError(f"pixels of the kind {opened.mode} are none of a map")
    colors = np.asarray(opened.convert(_CONVERTED[opened.mode]), dtype=np.float64) / 255.0
    opaque = colors[..., 3] > 0.0 if colors.shape[2] == 4 else np.ones(colors.shape[:2], dtype=np.bool_)
    return cast("NDArray[np.float64]", colors[..., :3].mean(axis=2)), opaque


def _contradictions(meta: MapServerModel, root: Node) -> list[Diagnostic]:
    found: list[Diagnostic] = []
    if not meta.free_thresh < meta.occupied_thresh:
        message = f"`free_thresh` of {meta.free_thresh:g} is not below `occupied_thresh`"
        label = f"expected less than {meta.occupied_thresh:g}"
        found.append(Diagnostic(CODE, message, root.span_of("free_thresh"), label))
    x, y, yaw = meta.origin
    if abs(yaw) > 2.0 * math.pi:
        message = f"`origin` has a yaw of {yaw:g}, which is more than a turn"
        help_ = f"write {math.radians(yaw):.6g}, if {yaw:g} deg was meant"
        found.append(Diagnostic(CODE, message, root.span_of("origin", 2), "expected radians", help=(help_,)))
    if max(abs(x), abs(y)) > MAX_ORIGIN_M:
        message = "`origin` is more than 100 km away from the map's frame"
        found.append(Diagnostic(CODE, message, root.span_of("origin"), "expected metres"))
    return found


def _recoded(fault: Diagnostic) -> Diagnostic:
    """What the reader of profiles says, under the code of maps."""
    return Diagnostic(
        CODE, fault.message, fault.span, fault.label, fault.labels, fault.notes, fault.help, fault.fix
    )


def _place(source: Source, key: str) -> Span | None:
    root, _ = read_yaml(source.file, source.text)
    return root.span_of(key) if root else None


def _huge(name: str, pixels: str) -> Diagnostic:
    message = f"`{name}` has {pixels} pixels, more than {MAX_CELLS // 1_000_000} million"
    return Diagnostic(CODE, message, help=("cut it to the room, or make its pixels larger",))


def _no_image(name: str, reason: str) -> Diagnostic:
    message = f"`{name}` is no image of a map: {reason}"
    return Diagnostic(CODE, message, help=("save it as PGM or PNG",))
