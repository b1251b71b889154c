"""A picture of the sky becomes tables of the light it gives where nothing stands before it.

What a lobe about a direction sees of the picture is a convolution on the sphere, for a lobe that is round: along the
rows of an equirectangular table it is one of functions of the azimuth, done by Fourier transforms. The picture comes to
the table's grid with its power and its centroids kept, so that a small sun lights surfaces from where it stands.

Rays that are drawn by the BRDF alone seldom meet a small sun, and leave bright specks. What of a texel is brighter than
SUN times a white surface under the whole picture is therefore taken out of it, and shines as directional lights, the
same power from the same places: the noise of 256 rays is then at most half as bright as that surface. A picture from
which nothing is taken has no spot that is smaller than about 14 degrees across and gives most of its light. Mirrors and
the background show what is left of a sun.
"""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from renderer import skyfile
from renderer.kernel import borrow, kernel, leaf
from renderer.shading import looked_up
from renderer.tables import GLOSS_LEVELS, Floats, Surroundings

ROWS = (256, 128, 64)  # of the tables of the first levels of gloss; the last serves all others
FINE = 2 * ROWS[0]  # rows that the picture has at least, when its power is summed
SUN = 64.0
SUNS = 8  # at most
SUN_RADIUS = math.radians(2.0)  # texels so near are one sun


class _File:
    """A file's bytes, the same as others of their hash."""

    def __init__(self, name: str, data: bytes) -> None:
        self.name, self.data = name, data
        self.key = hashlib.sha256(name.encode() + b"\0" + data).digest()

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _File) and self.key == other.key


def surroundings(name: str, data: bytes, scale: float, rotate: float) -> tuple[Surroundings, Floats]:
    """The tables of a picture file, and its suns (n, 6): unit vector to each, irradiance on a plane facing it.

    rotate: degrees. Raises skyfile.SkyFileError.
    """
    made, suns = _made(_File(name, data))
    c, s = math.cos(math.radians(rotate)), math.sin(math.radians(rotate))
    x, y = suns[:, 0], suns[:, 1]
    turned = np.column_stack([c * x - s * y, s * x + c * y, suns[:, 2], scale * suns[:, 3:]])
    return made._replace(scale=scale, turn=rotate / 360.0, white=made.white * scale), turned


@functools.lru_cache(maxsize=1)  # a picture may be large; editors send the same one again and again
def _made(file: _File) -> tuple[Surroundings, Floats]:
    return prepared(skyfile.read(file.name, file.data))


def prepared(picture: NDArray[np.float32]) -> tuple[Surroundings, Floats]:
    """The tables of a picture (h, w, 3), and its suns, as `surroundings`."""
    power = power_of(picture)
    rest, suns = without_suns(picture, SUN * brightest(convolved(power[1], cosine)))
    if len(suns):
        power = power_of(rest)
    height, width, _ = rest.shape
    tables: list[NDArray[Any]] = [rest.reshape(-1, 3)]
    sizes, first = [(0, height, width)], height * width
    for level in range(1, GLOSS_LEVELS + 1):
        made = convolved(power[min(level, len(power)) - 1], lobe((level / GLOSS_LEVELS) ** 2))
        tables.append(made.reshape(-1, 3))
        sizes.append((first, len(made), 2 * len(made)))
        first += len(tables[-1])
    made = convolved(power[1], cosine)
    tables.append(made.reshape(-1, 3))
    sizes.append((first, len(made), 2 * len(made)))
    texels = np.concatenate([table.astype(np.float32, copy=False) for table in tables])
    return Surroundings(texels, np.array(sizes, np.int32), 1.0, 0.0, brightest(made)), suns


def brightest(radiance: Floats) -> float:
    """The largest mean of the channels."""
    return float(radiance.mean(axis=2).max())


def power_of(picture: NDArray[np.float32]) -> list[Floats]:
    """Radiance times solid angle, and solid angle, on the grid of each of ROWS: (rows, columns, 4)."""
    height, width, _ = picture.shape
    texels = np.ascontiguousarray(picture, np.float32).reshape(-1, 3)
    power = np.zeros((ROWS[0], 2 * ROWS[0], 4))
    only = Surroundings(texels, np.array([[0, height, width]], np.int32), 1.0, 0.0, 0.0)
    spread(only, max(height, FINE), max(width, 2 * FINE), power)
    made = [power]
    while len(made) < len(ROWS):
        made.append(halved(made[-1]))
    return made


def without_suns(picture: NDArray[np.float32], most: float) -> tuple[NDArray[np.float32], Floats]:
    """The picture with what is brighter than `most`, mean of the channels, taken out; and that as suns (n, 6)."""
    bright = picture.mean(axis=2, dtype=np.float64)
    row, column = np.nonzero(bright > most)
    if not len(row):
        return picture, np.zeros((0, 6))
    height, width, _ = picture.shape
    tilt, turn = math.pi * (row + 0.5) / height, 2.0 * math.pi * (column + 0.5) / width
    towards = np.column_stack([np.sin(tilt) * np.sin(turn), np.sin(tilt) * np.cos(turn), np.cos(tilt)])
    solid = 2.0 * math.pi / width * (np.cos(math.pi * row / height) - np.cos(math.pi * (row + 1) / height))
    level = bright[row, column]
    excess = picture[row, column] * (1.0 - most / level)[:, None]
    power = excess * solid[:, None]
    left, rest = np.ones(len(row), np.bool_), picture.copy()
    suns: list[list[float]] = []
    while left.any() and len(suns) < SUNS:
        top = np.argmax(np.where(left, level, 0.0))
        near = left & (towards @ towards[top] > math.cos(SUN_RADIUS))
        middle = (towards[near] * power[near].sum(axis=1)[:, None]).sum(axis=0)
        suns.append([*(middle / np.linalg.norm(middle)), *power[near].sum(axis=0)])
        rest[row[near], column[near]] -= excess[near].astype(np.float32)
        left &= ~near
    return np.maximum(rest, np.float32(0.0)), np.array(suns)


@kernel
def spread(picture: Surroundings, height: int, width: int, power: Floats) -> None:
    """Add the picture's radiance times solid angle, looked up at the middles of so many texels, and the solid angle to
    `power` (rows, columns, 4): to the four nearest places each, as they weigh it linearly."""
    picture = borrow(picture)
    exact = picture.tables[0, 1] == height and picture.tables[0, 2] == width
    for j in range(height):
        tilt = math.pi * (j + 0.5) / height
        solid = 2.0 * math.pi / width * (math.cos(math.pi * j / height) - math.cos(math.pi * (j + 1) / height))
        for i in range(width):
            turn = 2.0 * math.pi * (i + 0.5) / width
            if exact:
                texel = picture.texels[j * width + i]
                red, green, blue = float(texel[0]), float(texel[1]), float(texel[2])
            else:
                across = math.sin(tilt)
                red, green, blue = looked_up(
                    picture, 0, (across * math.sin(turn), across * math.cos(turn), math.cos(tilt))
                )
            share(power, (i + 0.5) / width, (j + 0.5) / height, solid * red, solid * green, solid * blue, solid)


@leaf
def share(power: Floats, u: float, v: float, red: float, green: float, blue: float, solid: float) -> None:
    """Add to the four places about (u, v), 0 to 1, as they weigh it linearly."""
    rows, columns = power.shape[0], power.shape[1]
    x, y = u * columns - 0.5, v * rows - 0.5
    i, j = math.floor(x), math.floor(y)
    x, y = x - i, y - j
    for k in range(4):
        column, row = i + (k & 1), j + (k >> 1)
        if row < 0 or row >= rows:  # beyond the pole
            column += columns // 2
            row = min(max(row, 0), rows - 1)
        weight = (x if k & 1 else 1.0 - x) * (y if k & 2 else 1.0 - y)
        place = power[row, column % columns]
        place[0] += weight * red
        place[1] += weight * green
        place[2] += weight * blue
        place[3] += weight * solid


@kernel
def halved(power: Floats) -> Floats:
    """The same power in half as many rows and columns."""
    rows, columns = power.shape[0], power.shape[1]
    made = np.zeros((rows // 2, columns // 2, 4))
    for j in range(rows):
        for i in range(columns):
            p = power[j, i]
            share(made, (i + 0.5) / columns, (j + 0.5) / rows, p[0], p[1], p[2], p[3])
    return made


def cosine(towards: Floats) -> Floats:
    """What a matt surface weighs directions by, of the cosine to its normal."""
    return np.maximum(towards, 0.0)


def lobe(alpha: float) -> Callable[[Floats], Floats]:
    """What GGX weighs directions by, of the cosine to the normal, seen head on: D G2 / 4, Fresnel's term aside."""
    square = alpha * alpha

    def weight(towards: Floats) -> Floats:
        light = np.maximum(towards, 0.0)
        half = 0.5 * (1.0 + towards)  # the half vector's cosine, squared
        spike = half * (square - 1.0) + 1.0
        return np.asarray(light / (spike * spike * (light + np.sqrt(light * light * (1.0 - square) + square))))

    return weight


def convolved(power: Floats, weight: Callable[[Floats], Floats]) -> Floats:
    """The mean radiance (rows, columns, 3) about the middle of each texel, directions weighed by their cosine to it.

    power: (rows, columns, 4) radiance times solid angle, and solid angle. A constant picture stays what it is.
    """
    rows, columns, _ = power.shape
    tilt = math.pi * (np.arange(rows) + 0.5) / rows
    turn = 2.0 * math.pi * np.arange(columns // 2 + 1) / columns
    down, across, around = np.cos(tilt), np.sin(tilt), np.cos(turn)
    waves = np.fft.rfft(power, axis=1)
    made = np.empty((rows, columns, 3))
    for i in range(rows // 2):  # the southern rows see the north as the northern ones the south
        cosines = np.clip(down[i] * down[:, None] + across[i] * across[:, None] * around, -1.0, 1.0)
        kernel_waves = np.fft.hfft(weight(cosines), n=columns, axis=1)[:, : columns // 2 + 1]
        for row, seen in ((i, waves), (rows - 1 - i, waves[::-1])):
            mean = np.fft.irfft(np.einsum("jm,jmc->mc", kernel_waves, seen), n=columns, axis=0)
            made[row] = np.maximum(mean[:, :3] / mean[:, 3:], 0.0)
    return made
