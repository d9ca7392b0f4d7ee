"""An image before anything is looked for in it: what it must be like, and what speaks against it."""

from __future__ import annotations

from typing import Any, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from xei_lang.world.perception.refusal import Refused

Gray = NDArray[np.uint8]

MIN_SIDE_PX = 32
MIN_CONTRAST = 12.0
"""Between the 1st and the 99th percentile of grey values: below it a frame is a wall, a cap or darkness."""

_CHANNELS = {3: cv2.COLOR_BGR2GRAY, 4: cv2.COLOR_BGRA2GRAY}


def gray_image(image: NDArray[Any], size_px: tuple[int, int]) -> Gray | Refused:
    """The grey values (height, width) of an image, or why it is of no use.

    `image` is grey (h, w), BGR (h, w, 3) or BGRA (h, w, 4), of 8 or 16 bits, or of floats from 0 to 1.
    `size_px` is the (width, height) that the camera's intrinsics are for.
    """
    channels = image.shape[2] if image.ndim == 3 else 0
    if image.ndim not in (2, 3) or (channels and channels not in (1, *_CHANNELS)) or min(image.shape) == 0:
        shape = " x ".join(str(side) for side in image.shape)
        return Refused("no_image", f"an array of {shape} is no image", "give a grey or a colour image")
    height, width = int(image.shape[0]), int(image.shape[1])
    if (width, height) != size_px:
        return Refused(
            "wrong_size",
            f"the image has {width} x {height} pixels, and the camera's intrinsics are for {size_px[0]} x "
            f"{size_px[1]}",
            "record at the size that was calibrated, or calibrate the camera at this one",
        )
    if min(width, height) < MIN_SIDE_PX:
        return Refused(
            "no_image", f"an image of {width} x {height} pixels is too small", "record a larger one"
        )
    levels = _eight_bits(image)
    if levels is None:
        return Refused(
            "no_image", f"an image of {image.dtype} with such values cannot be read",
            "give 8 or 16 bits, or floats from 0 to 1 without NaN",
        )  # fmt: skip
    gray = levels.reshape(height, width) if channels in (0, 1) else cv2.cvtColor(levels, _CHANNELS[channels])
    low, high = np.percentile(gray[::4, ::4], (1, 99))
    if high - low < MIN_CONTRAST:
        return Refused(
            "no_contrast", f"the image is blank: its grey values span {high - low:.0f} of 255",
            "look for a covered lens, a dark room or an overexposed image",
        )  # fmt: skip
    return cast(Gray, np.ascontiguousarray(gray))


def decode_image(data: bytes) -> NDArray[Any] | None:
    """The pixels of a PNG, JPEG or other image file, grey, BGR or BGRA; None where these bytes are none."""
    if not data:
        return None
    try:
        return cast("NDArray[Any] | None", cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED))
    except cv2.error:
        return None


def _eight_bits(image: NDArray[Any]) -> Gray | None:
    if image.dtype == np.uint8:
        return image
    if image.dtype == np.uint16:
        return (image >> 8).astype(np.uint8)
    if image.dtype.kind == "f":
        fine = bool(np.isfinite(image).all()) and float(image.min()) >= 0.0 and float(image.max()) <= 1.0
        return np.rint(image * 255.0).astype(np.uint8) if fine else None
    return None
