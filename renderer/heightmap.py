"""A pattern's solid as maps over a window of the plane: height, normal and material, by rays straight down.

Each texel is the mean of k x k points in a regular grid, each of them exact: DESIGN 1.2 holds in full, as for `csg`.
Vertical walls have no extent in such a map: the height jumps, and no normal tells of them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.errors import Cancelled
from renderer.geometry.query import find, nearby
from renderer.geometry.solid import DOWN, meet, normal_of, polish, thin_of
from renderer.geometry.spans import events
from renderer.kernel import borrow, fixed, keep, kernel
from renderer.shading import unit
from renderer.tables import Ints, Pattern

SHARED = fixed(32)  # up to so many pieces are found once for all points of a texel
ROWS = 16  # a thread takes at a time

Window = tuple[float, float, float, float]
"""(p0, q0, p1, q1), pattern units."""


class HeightMap(NamedTuple):
    """Maps of H x W texels; row 0 lies at q0, column 0 at p0, texel (i, j) has its centre at (j + 1/2, i + 1/2)."""

    height: NDArray[np.float32]  # (H, W) the mean of w, pattern units
    normal: NDArray[np.float32]  # (H, W, 3) the mean of the unit normals of pattern space: the shorter, the rougher
    share: NDArray[np.float32]  # (H, W, S) how much of the texel is of each material of `slots`; their sum is 1
    slots: Ints  # (S,) the materials: 0 the object's own, else 1 + facet_slot, as in `csg`; ascending, 0 always there

    @property
    def slot(self) -> Ints:
        """The material (H, W) that fills most of each texel."""
        return self.slots[self.share.argmax(axis=2)]


def slots_of(pattern: Pattern) -> Ints:
    """HeightMap.slots of a pattern."""
    return np.unique(np.append(pattern.facet_slot + 1, 0)).astype(np.int32)


def height_map(
    pattern: Pattern,
    window: Window,
    size: tuple[int, int],
    k: int = 1,
    *,
    threads: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> HeightMap:
    """The maps of `window` in `size` (W, H) texels of k x k points each; threads: one a processor.

    For heights finer than the texels ask for k times as many texels of one point each.
    """
    width, height = size
    slots = slots_of(pattern)
    column = np.zeros(int(slots[-1]) + 1, np.int32)
    column[slots] = np.arange(len(slots))
    made = HeightMap(
        np.empty((height, width), np.float32),
        np.empty((height, width, 3), np.float32),
        np.empty((height, width, len(slots)), np.float32),
        slots,
    )
    box = np.array(window, np.float64)

    def rows(first: int) -> None:
        if cancelled is not None and cancelled():
            raise Cancelled
        sample(pattern, box, k, column, first, min(first + ROWS, height), made.height, made.normal, made.share)

    with ThreadPoolExecutor(threads or os.cpu_count() or 1, "texels") as pool:
        for _ in pool.map(rows, range(0, height, ROWS)):
            pass
    return made


@kernel
def sample(
    pattern: Pattern, window: NDArray[np.float64], k: int, column: Ints, first: int, end: int,
    heights: NDArray[np.float32], normals: NDArray[np.float32], shares: NDArray[np.float32],
) -> None:  # fmt: skip
    """Fill the rows `first` to `end`. column: where each slot stands in `shares`."""
    owned = nearby(pattern, max(pattern.near, SHARED)), events(pattern)
    found, spans = borrow(owned[0]), borrow(owned[1])
    pattern, window, column = borrow(pattern), borrow(window), borrow(column)
    heights, normals, shares = borrow(heights), borrow(normals), borrow(shares)
    rows, columns = heights.shape
    dp, dq = (window[2] - window[0]) / columns, (window[3] - window[1]) / rows
    high, low = pattern.height, -pattern.depth
    thin = thin_of(pattern)
    margin = pattern.reach
    part = 1.0 / (k * k)
    for i in range(first, end):
        q0 = window[1] + i * dq
        for j in range(columns):
            p0 = window[0] + j * dp
            shared = find(
                pattern, found, p0 - margin, q0 - margin, p0 + dp + margin, q0 + dq + margin, SHARED
            )  # fmt: skip
            height = np0 = nq0 = nw0 = 0.0
            for s in range(shares.shape[2]):
                shares[i, j, s] = 0.0
            for point in range(k * k):
                p, q = p0 + dp * (point % k + 0.5) / k, q0 + dq * (point // k + 0.5) / k
                m = meet(pattern, found, spans, shared, p, q, 0.0, 0.0, high + thin, low - thin, DOWN)
                height += max(polish(pattern, found, m, p, q, 0.0, 0.0), low)
                n = unit(normal_of(pattern, found, m, p, q, 0.0, 0.0))
                np0, nq0, nw0 = np0 + n[0], nq0 + n[1], nw0 + n[2]
                slot = 0
                if m.found >= 0 and m.facet >= 0:
                    piece = pattern.pieces[found.piece[m.found]]
                    slot = pattern.facet_slot[pattern.grooves[piece.groove].slot + m.facet] + 1
                shares[i, j, column[slot]] += part
            heights[i, j] = height * part
            normals[i, j, 0], normals[i, j, 1], normals[i, j, 2] = np0 * part, nq0 * part, nw0 * part
    keep(owned)
