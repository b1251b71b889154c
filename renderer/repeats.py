"""Copies of a groove: where they are placed, and the placed paths.

A placement turns a path about (0, 0), scales it about (0, 0) as a whole, the cross-section with it, and moves it.
Lengths are in pattern units; angles are radians but for the arguments of `scatter`, which are degrees.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer.tables import Chain, Floats

PLACEMENT = np.dtype([("dp", "f8"), ("dq", "f8"), ("angle", "f8"), ("scale", "f8")])
"""(dp, dq) the movement, pattern units; the angle of the turn, radians, to the left; the scale, above 0."""

Placements = NDArray[np.void]  # (k,) PLACEMENT

# G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, with the
# constants of S. Vigna's public-domain splitmix64.c.
_GAMMA = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)


def linear(count: int, step: tuple[float, float]) -> Placements:
    """(count,) PLACEMENT in a row: copy i is moved by i * step. Raises ValueError where count is negative."""
    rows = _unmoved(count)
    index = np.arange(count)
    rows["dp"], rows["dq"] = index * step[0], index * step[1]
    return rows


def grid(counts: tuple[int, int], steps: tuple[tuple[float, float], tuple[float, float]]) -> Placements:
    """(counts[0] * counts[1],) PLACEMENT in a grid: copy (i, j), row i * counts[1] + j, is moved by
    i * steps[0] + j * steps[1]. Raises ValueError where a count is negative.
    """
    _unmoved(counts[0]), _unmoved(counts[1])
    rows = _unmoved(counts[0] * counts[1])
    i, j = np.repeat(np.arange(counts[0]), counts[1]), np.tile(np.arange(counts[1]), counts[0])
    rows["dp"], rows["dq"] = i * steps[0][0] + j * steps[1][0], i * steps[0][1] + j * steps[1][1]
    return rows


def scatter(
    count: int,
    seed: int,
    bounds: tuple[float, float, float, float],
    angle: tuple[float, float],
    scale: tuple[float, float],
) -> Placements:
    """(count,) PLACEMENT at random: uniform in `bounds` (p0, q0, p1, q1), `angle` (degrees) and `scale` (ranges).

    The same for one seed (modulo 2^64) on every machine, bit for bit: integers and one IEEE multiplication and
    addition a number, none of numpy's generators. Number n of seed s is output n + 1 of splitmix64 whose state is
    the mixed seed; placement i takes the numbers 4 i to 4 i + 3 for p, q, angle and scale. So a larger count leaves
    the first placements as they are.

    Raises ValueError where count is negative, a range runs backwards, or a scale is not positive.
    """
    p0, q0, p1, q1 = bounds
    for name, low, high in (("p bounds", p0, p1), ("q bounds", q0, q1), ("angles", *angle), ("scales", *scale)):
        if not low <= high:
            raise ValueError(f"expected {name} that run upwards, found {low:g} to {high:g}")
    if not scale[0] > 0:
        raise ValueError(f"expected scales above 0, found {scale[0]:g}")
    rows = _unmoved(count)
    state = _mixed(np.array([seed % 2**64], np.uint64))
    number = _uniform(splitmix64(state, 4 * count)).reshape(count, 4)
    for column, name, low, high in ((0, "dp", p0, p1), (1, "dq", q0, q1), (2, "angle", *angle), (3, "scale", *scale)):
        rows[name] = np.minimum(low + number[:, column] * (high - low), high)
    rows["angle"] *= np.pi / 180
    return rows


def concentric(count: int, step: float, radius: float) -> Floats:
    """The radii (count,) of circles about one centre: radius + i * step.

    Raises ValueError where count is negative or a radius is not positive.
    """
    _unmoved(count)
    radii: Floats = np.asarray(radius + np.arange(count) * step, np.float64)
    if not (radii > 0).all():
        raise ValueError(f"expected radii above 0, found {radii.min():g}")
    return radii


def place(chain: Chain, placement: np.void) -> Chain:
    """A chain at one placement, a row of PLACEMENT."""
    return Chain(place_all(chain.segments, np.array([placement], PLACEMENT)), chain.closed)


def place_all(segments: NDArray[np.void], placements: Placements) -> NDArray[np.void]:
    """The segments (n,) SEGMENT at each of the placements (k,) PLACEMENT: (k * n,) SEGMENT, placement by placement."""
    placed = np.empty((len(placements), len(segments)), segments.dtype)
    c, s = np.cos(placements["angle"])[:, None], np.sin(placements["angle"])[:, None]
    scale = placements["scale"][:, None]
    for x, y, factor, dx, dy in (
        ("x", "y", scale, placements["dp"][:, None], placements["dq"][:, None]),
        ("tx", "ty", 1.0, 0.0, 0.0),
    ):
        placed[x] = (c * segments[x] - s * segments[y]) * factor + dx
        placed[y] = (s * segments[x] + c * segments[y]) * factor + dy
    placed["length"] = segments["length"] * scale
    placed["curvature"] = segments["curvature"] / scale
    return placed.ravel()


def splitmix64(state: NDArray[np.uint64], count: int) -> NDArray[np.uint64]:
    """The first `count` outputs of splitmix64 from a state (1,). All arithmetic wraps around at 2^64."""
    return _mixed(state + np.arange(1, count + 1, dtype=np.uint64) * _GAMMA)


def _mixed(z: NDArray[np.uint64]) -> NDArray[np.uint64]:
    z = (z ^ (z >> np.uint64(30))) * _MIX_1
    z = (z ^ (z >> np.uint64(27))) * _MIX_2
    return z ^ (z >> np.uint64(31))


def _uniform(z: NDArray[np.uint64]) -> Floats:
    """Numbers in [0, 1) of the upper 53 bits."""
    return np.asarray((z >> np.uint64(11)).astype(np.float64) * 2.0**-53)


def _unmoved(count: int) -> Placements:
    if count < 0:
        raise ValueError(f"expected a count of 0 or more, found {count}")
    rows = np.zeros(count, PLACEMENT)
    rows["scale"] = 1.0
    return rows
