"""A map as a file: PNG for a texture, EXR for its exact values."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from renderer import film

TYPES = {".png": "image/png", ".exr": "image/x-exr"}


def encode(kind: str, values: NDArray[np.float32], suffix: str) -> bytes:
    """The file of a map as `renderer.maps.texture` gives it.

    PNG: heights in 16 bits, from the least (0) to the greatest (65535), which the text entries `low` and `high` tell
    in world units; normals n in 8 bits as (n + 1) / 2. EXR: float32 as they are; heights in the channel Y.
    """
    if suffix == ".exr":
        return film.exr({"Y" if values.ndim == 2 else "RGB": values})
    told = PngInfo()
    told.add_text("map", kind)
    if kind == "height":
        low, high = bounds(values)
        told.add_text("low", repr(low))
        told.add_text("high", repr(high))
        scaled = (values.astype(np.float64) - low) / ((high - low) or 1.0)
        image = Image.fromarray((scaled * 65535.0 + 0.5).astype(np.uint16))
    else:
        scaled = np.clip(0.5 + 0.5 * values if kind == "normal" else values, 0.0, 1.0)
        image = Image.fromarray((scaled * 255.0 + 0.5).astype(np.uint8), "RGB")
    out = io.BytesIO()
    image.save(out, "PNG", pnginfo=told, compress_level=6)
    return out.getvalue()


def bounds(heights: NDArray[np.float32]) -> tuple[float, float]:
    """What 0 and 65535 stand for, world units."""
    return float(heights.min()), float(heights.max())
