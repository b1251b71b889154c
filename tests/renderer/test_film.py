"""Pictures as files: what goes in comes out."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from renderer import film
from renderer.tables import METHODS

RNG = np.random.default_rng(5)
PICTURE = (RNG.random((5, 7, 3)) * 1.5).astype(np.float32)
METHOD = RNG.integers(0, len(METHODS), (5, 7)).astype(np.uint8)


def exr(data: bytes, folder: Path) -> dict[str, np.ndarray]:
    path = folder / "picture.exr"
    path.write_bytes(data)
    return {name: channel.pixels for name, channel in OpenEXR.File(str(path)).channels().items()}


def test_srgb() -> None:
    """IEC 61966-2-1: 0.0031308 is where the line ends, 0.214041 is 50 %; what is beyond 0 to 1 is clipped."""
    linear = np.array([-1.0, 0.0, 0.0031308, 0.0031309, 0.21404114, 1.0, 7.0, np.inf], np.float32)
    expected = [0, 0, 10, 10, 128, 255, 255, 255]  # 12.92 x 0.0031308 x 255 = 10.3; 0.5 x 255 = 127.5
    assert film.srgb(linear).tolist() == expected
    steps = film.srgb(np.linspace(0, 1, 100_000, dtype=np.float32))
    assert (np.diff(steps.astype(int)) >= 0).all()
    assert len(np.unique(steps)) == 256


def test_png() -> None:
    """8 bits of exposure times radiance: decoded, within half a step of what went in."""
    image = Image.open(io.BytesIO(film.encode(PICTURE, ".png", 0.5)))
    assert (image.format, image.mode, image.size) == ("PNG", "RGB", (7, 5))
    encoded = np.asarray(image, float) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    slope = 2.4 / 1.055 / 255  # of the decoding curve at its steepest, a step
    assert np.abs(linear - np.clip(0.5 * PICTURE, 0, 1)).max() < 0.51 * slope


def test_exr(tmp_path: Path) -> None:
    """Linear and whole: exposure is for PNG alone."""
    assert (exr(film.encode(PICTURE, ".exr", 0.5), tmp_path)["RGB"] == PICTURE).all()


def test_npy() -> None:
    loaded = np.load(io.BytesIO(film.encode(PICTURE, ".npy", 0.5)))
    assert loaded.dtype == np.float32
    assert (loaded == PICTURE).all()


def test_aov(tmp_path: Path) -> None:
    assert (np.load(io.BytesIO(film.encode_aov("method", METHOD, ".npy"))) == METHOD).all()
    assert (exr(film.encode_aov("method", METHOD, ".exr"), tmp_path)["method"] == METHOD).all()
    colours = np.asarray(Image.open(io.BytesIO(film.encode_aov("method", METHOD, ".png"))))
    assert len(film.COLOURS) == len(METHODS) == len(np.unique(film.COLOURS, axis=0))
    assert (colours == film.COLOURS[METHOD]).all()


def test_other_suffixes_are_refused() -> None:
    with pytest.raises(ValueError, match="expected one of"):
        film.encode(PICTURE, ".jpg")
    with pytest.raises(ValueError, match="expected one of"):
        film.encode_aov("method", METHOD, ".jpg")


def test_shares() -> None:
    """Of the pixels that see an object: three of four here."""
    method = np.array([[0, 1], [3, 3]], np.uint8)
    assert film.shares(method) == {METHODS[1]: 1 / 3, METHODS[3]: 2 / 3}
    assert film.shares(np.zeros((2, 2), np.uint8)) == {}
