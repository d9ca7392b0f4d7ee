"""PNG files that came over a network: how large they say they are is read before anything is unpacked."""

from __future__ import annotations

import struct
from typing import Any, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from xei_lang.world.perception.image import decode_image
from xei_lang.world.perception.optics import Array

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_HEADER = struct.Struct(">I4sIIBB")
"""Length, name, width, height, bits a sample and colour type (PNG, ISO/IEC 15948, 11.2.2)."""
_GREY = 0
_SAMPLES = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
MAX_PIXELS = 16_000_000


def colour_image(data: bytes, size_px: tuple[int, int]) -> NDArray[np.uint8] | str:
    """An 8-bit image (h, w) or (h, w, 3), BGR, of exactly this (width, height), or why it is none."""
    said = _unfit(data, size_px, bits=8)
    if said is not None:
        return said
    image = decode_image(data)
    if image is None or image.dtype != np.uint8:
        return "the PNG is damaged"
    if image.ndim == 3 and image.shape[2] == 4:
        image = image[:, :, :3]
    return cast("NDArray[np.uint8]", np.ascontiguousarray(image))


def depth_image(data: bytes, size_px: tuple[int, int], scale_m: float) -> Array | str:
    """Depths in m (h, w), NaN where nothing is known, of a grey PNG of 16 bits, or why it is none."""
    said = _unfit(data, size_px, bits=16)
    if said is not None:
        return said
    image = decode_image(data)
    if image is None or image.dtype != np.uint16 or image.ndim != 2:
        return "the PNG is damaged"
    return np.where(image == 0, np.nan, image * scale_m)


def mask_image(data: bytes, size_px: tuple[int, int]) -> NDArray[np.bool_] | str:
    """Where a mask (h, w) is white, or why it is none."""
    said = _unfit(data, size_px, bits=8)
    if said is not None:
        return said
    image = decode_image(data)
    if image is None or image.ndim != 2:
        return "the mask is damaged, or is not grey"
    return image > 127


def encode_png(image: NDArray[Any]) -> bytes:
    """A PNG of an image of 8 or 16 bits; the fastest compression, because it is sent once."""
    done, data = cv2.imencode(".png", image, [int(cv2.IMWRITE_PNG_COMPRESSION), 1])
    if not done:
        raise ValueError(f"{image.dtype} {image.shape} is no image")
    return data.tobytes()


def encode_mask(mask: NDArray[np.bool_]) -> bytes:
    """A mask as PNG, white where it holds."""
    return encode_png(mask.astype(np.uint8) * 255)


def encode_depth(depth_m: Array, scale_m: float) -> bytes:
    """Depths (h, w) in m as PNG of 16 bits; what is unknown, behind or too far is 0."""
    units = np.rint(np.nan_to_num(depth_m, nan=0.0, posinf=0.0, neginf=0.0) / scale_m)
    return encode_png(np.where((units < 1) | (units > 65535), 0, units).astype(np.uint16))


def _unfit(data: bytes, size_px: tuple[int, int], *, bits: int) -> str | None:
    if len(data) < len(_SIGNATURE) + _HEADER.size or not data.startswith(_SIGNATURE):
        return "it is no PNG"
    length, name, width, height, depth, colour = _HEADER.unpack_from(data, len(_SIGNATURE))
    if name != b"IHDR" or length != 13 or colour not in _SAMPLES:
        return "it is no PNG"
    if (width, height) != size_px:
        return f"it has {width} x {height} pixels, and the intrinsics are for {size_px[0]} x {size_px[1]}"
    if width * height > MAX_PIXELS:
        return f"it has more than {MAX_PIXELS // 1_000_000} million pixels"
    if depth != bits or (bits == 16 and colour != _GREY):
        return f"it has {depth} bits in {_SAMPLES[colour]} channels, and {bits} are needed"
    return None
