"""The film: radiance of footprints summed to pixels, and pictures as files."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from renderer.geometry.view import sky_behind
from renderer.kernel import borrow, kernel
from renderer.tables import METHODS, Camera, Floats, Lighting

Aov = NDArray[np.uint8] | NDArray[np.float32]
SUFFIXES = (".png", ".exr", ".npy")

COLOURS = np.array(
    [
        [0, 0, 0], [90, 90, 90], [60, 120, 200], [70, 170, 110], [220, 120, 50], [190, 60, 120], [230, 200, 70],
        [140, 100, 200], [90, 200, 210],
    ],
    np.uint8,
)  # fmt: skip
"""How the AOV `method` looks as PNG, by METHODS."""


@kernel
def develop(
    footprints: NDArray[np.void], radiance: Floats, method: NDArray[np.uint8], x: int, y: int, width: int,
    camera: Camera, lighting: Lighting, image: Floats, methods: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Sum footprints (n,) with their radiance, error and cost (n, 5) into the pixels (m, 5) of a tile, so wide and with
    its upper left at (x, y); what none covers shows the sky, its mean over the whole pixel.

    A pixel's method is the last of METHODS that any part of it took. Parts come in a fixed order, so that sums round
    alike.
    """
    covered = np.zeros(len(image))
    image[:] = 0.0
    methods[:] = 0
    for i in range(len(footprints)):
        pixel, weight = footprints[i].pixel, footprints[i].weight
        covered[pixel] += weight
        methods[pixel] = max(methods[pixel], method[i])
        for c in range(4):
            image[pixel, c] += weight * radiance[i, c]
        image[pixel, 4] += radiance[i, 4]
    lighting = borrow(lighting)
    for pixel in range(len(image)):
        open_part = 1.0 - covered[pixel]
        if open_part > 0.0:
            sky = sky_behind(lighting, camera, float(x + pixel % width), float(y + pixel // width), 1.0)
            for c in range(3):
                image[pixel, c] += open_part * sky[c]


def encode(radiance: NDArray[np.float32], suffix: str, exposure: float = 1.0) -> bytes:
    """A picture (H, W, 3) of linear radiance as a file: .png (sRGB of exposure * radiance), .exr or .npy (linear)."""
    if suffix == ".png":
        return _png(srgb(radiance * np.float32(exposure)))
    if suffix == ".npy":
        return _npy(radiance.astype(np.float32, copy=False))
    if suffix == ".exr":
        return exr({"RGB": radiance.astype(np.float32, copy=False)})
    raise ValueError(f"expected one of {', '.join(SUFFIXES)}, found {suffix!r}")


def encode_aov(name: str, values: Aov, suffix: str) -> bytes:
    """An AOV (H, W): .exr (a channel of its name, float) or .npy as it is; .png: `method` in colours, others from black
    for 0 to white for the largest value, by their roots."""
    if suffix == ".npy":
        return _npy(values)
    if suffix == ".exr":
        return exr({name: values.astype(np.float32)})
    if suffix != ".png":
        raise ValueError(f"expected one of {', '.join(SUFFIXES)}, found {suffix!r}")
    if name == "method":
        return _png(COLOURS[values.astype(np.int64)])
    grey = np.sqrt(values / max(float(values.max()), 1e-30))
    return _png(np.repeat(np.asarray(grey * 255.0 + 0.5, np.uint8)[..., None], 3, axis=2))


def srgb(linear: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Linear RGB as 8-bit sRGB (IEC 61966-2-1), clipped."""
    clipped = np.clip(linear, 0.0, 1.0)
    encoded = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    return np.asarray(encoded * 255.0 + 0.5, np.uint8)


def shares(method: NDArray[np.uint8]) -> dict[str, float]:
    """The share of the pixels that see an object which each method took."""
    counts = np.bincount(method.ravel(), minlength=len(METHODS))[1:]
    total = max(int(counts.sum()), 1)
    return {name: int(count) / total for name, count in zip(METHODS[1:], counts, strict=True) if count}


def _png(pixels: NDArray[np.uint8]) -> bytes:
    out = io.BytesIO()
    Image.fromarray(pixels, "RGB").save(out, "PNG", compress_level=3)
    return out.getvalue()


def _npy(values: Aov) -> bytes:
    out = io.BytesIO()
    np.save(out, values)
    return out.getvalue()


def exr(channels: dict[str, NDArray[np.float32]]) -> bytes:
    """A file of float32 channels (H, W); (H, W, 3) for "RGB"."""
    import OpenEXR  # slow to load, and few pictures need it

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        OpenEXR.File(header, {name: np.ascontiguousarray(values) for name, values in channels.items()}).write(str(path))
        return path.read_bytes()
