"""The uniform grid over the paths (000, 4.1; 001, 4.1), built once a set of paths and kept for every profile.

Each cell lists the pieces whose centre line crosses it. Cells about as wide as the grooves (001, 4.1) serve scattered
paths best; a family of parallel lines is served as well by cells as long as the lines, at a fraction of the memory.
So the resolution is the one with the least estimated work a query, entries being charged for, among powers of two
with cells no finer than the grooves' width.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.crossings import find_crossings
from renderer.geometry.pieces import point_at
from renderer.kernel import kernel
from renderer.tables import Floats, Grid, Ints

FINEST = 1024  # cells along one side at most
CELLS = 1 << 18  # cells in all at most
ENTRY = 0.05  # what an entry a piece costs, in pieces looked at a query
ENTRIES = 40  # a piece at most, on average, as estimated: about half the memory of patterns that have more
CROSSINGS = 64  # a piece that are kept; where there are more, hardly a footprint is without
ARC_CHORD = 0.05  # an arc is listed by chords that leave it by this part of a cell, and by the cells so near to them


def build(pieces: NDArray[np.void], tile: tuple[float, float] | None, width: float) -> Grid:
    """The grid of pieces (n,) PIECE.

    tile: period of the pattern, None: it does not repeat. width: the mean width of the grooves. Lengths in pattern
    units.
    """
    low, high, run = extents(pieces)
    size = np.maximum(high - low, max(width, 1e-12 * float(np.abs(low).max() + np.abs(high).max() + 1.0)))
    middle = 0.5 * (low + high)
    low = middle - 0.5 * size * (1.0 + 1e-9)
    size = size * (1.0 + 2e-9)
    nx, ny = _resolution(run, size, width)
    cell = size / (nx, ny)
    shape = np.array([nx, ny], np.int32)
    counts = np.zeros(nx * ny, np.int32)
    rasterize(pieces, low, cell, shape, counts, np.zeros(0, np.int32), np.zeros(0, np.int32))
    first = np.zeros(nx * ny + 1, np.int32)
    np.cumsum(counts, out=first[1:])
    items = np.empty(int(first[-1]), np.int32)
    rasterize(pieces, low, cell, shape, counts, first, items)
    crossings = find_crossings(pieces, low, cell, shape, first, items, CROSSINGS * len(pieces))
    return Grid(
        low, cell, shape, np.array(tile or (0.0, 0.0)), first, items, crossings, _starts(crossings, low, cell, shape)
    )


def _starts(crossings: Floats, low: Floats, cell: Floats, shape: Ints) -> Ints:
    """Where each cell's crossings begin, for crossings in the order of their cells; (0,) where there are none."""
    if not len(crossings):
        return np.zeros(0, np.int32)
    at = np.floor((crossings - low) / cell).astype(np.int64)
    return np.searchsorted(at[:, 1] * shape[0] + at[:, 0], np.arange(shape[0] * shape[1] + 1)).astype(np.int32)


def _resolution(run: Floats, size: Floats, width: float) -> tuple[int, int]:
    """Cells along p and q. run: (n, 2) how far each piece goes to and fro along p and q."""
    n = len(run)
    total = run.sum(axis=0) / size  # crossings of the whole extent
    best, choice = math.inf, (1, 1)
    finest = [min(FINEST, max(1, math.ceil(extent / width))) for extent in size]
    for i in range(11):
        for j in range(11):
            nx, ny = 1 << i, 1 << j
            if nx > 2 * finest[0] - 1 or ny > 2 * finest[1] - 1 or nx * ny > CELLS:
                continue
            entries = n + total[0] * nx + total[1] * ny
            if entries > ENTRIES * n and nx * ny > 1:
                continue
            cells = (1.0 + nx * width / size[0]) * (1.0 + ny * width / size[1])  # that a query of a groove's width sees
            work = (entries / (nx * ny) + 0.2) * cells + ENTRY * (entries + 0.5 * nx * ny) / n
            if work < best:
                best, choice = work, (nx, ny)
    return choice


@kernel
def extents(pieces: NDArray[np.void]) -> tuple[Floats, Floats, Floats]:
    """Lower and upper bounds (2,) of all pieces, and how far each goes along p and q, to and fro (n, 2)."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    run = np.zeros((len(pieces), 2))
    for i in range(len(pieces)):
        piece = pieces[i]
        steps = 1
        if piece.curvature != 0.0:
            steps = int(math.ceil(abs(piece.curvature) * piece.length * 8.0)) + 1
        x, y = piece.x, piece.y
        slack = 0.0
        if piece.curvature != 0.0:
            slack = 0.5 * (piece.length / steps) ** 2 * abs(piece.curvature)
        for k in range(steps + 1):
            px, py = point_at(piece, piece.length * k / steps)
            run[i, 0] += abs(px - x)
            run[i, 1] += abs(py - y)
            x, y = px, py
            low[0], low[1] = min(low[0], x - slack), min(low[1], y - slack)
            high[0], high[1] = max(high[0], x + slack), max(high[1], y + slack)
    return low, high, run


@kernel
def rasterize(
    pieces: NDArray[np.void], low: Floats, cell: Floats, shape: Ints, counts: Ints, first: Ints, items: Ints
) -> None:
    """Count each cell's pieces into `counts` (nx * ny,); where `first` is given, list them in `items` as well."""
    nx, ny = shape[0], shape[1]
    counts[:] = 0
    seen = np.full(nx * ny, -1, np.int32)
    for i in range(len(pieces)):
        piece = pieces[i]
        steps, slack = 1, 1e-9
        if piece.curvature != 0.0:
            slack = ARC_CHORD
            step = math.sqrt(8.0 * ARC_CHORD * min(cell[0], cell[1]) / abs(piece.curvature))
            steps = int(min(max(math.ceil(piece.length / step), math.ceil(piece.length * abs(piece.curvature))), 1e6))
        ax, ay = point_at(piece, 0.0)
        for k in range(steps):
            bx, by = point_at(piece, piece.length * (k + 1) / steps)
            x0, y0 = (ax - low[0]) / cell[0], (ay - low[1]) / cell[1]
            x1, y1 = (bx - low[0]) / cell[0], (by - low[1]) / cell[1]
            ax, ay = bx, by
            # column by column, the rows that the line crosses there
            left, right = min(x0, x1) - slack, max(x0, x1) + slack
            for ix in range(max(int(left), 0), min(int(right), nx - 1) + 1):
                u0, u1 = 0.0, 1.0
                if x0 != x1:
                    ua, ub = (ix - slack - x0) / (x1 - x0), (ix + 1 + slack - x0) / (x1 - x0)
                    u0, u1 = max(min(ua, ub), 0.0), min(max(ua, ub), 1.0)
                ya, yb = y0 + u0 * (y1 - y0), y0 + u1 * (y1 - y0)
                bottom, top = min(ya, yb) - slack, max(ya, yb) + slack
                for iy in range(max(int(bottom), 0), min(int(top), ny - 1) + 1):
                    c = iy * nx + ix
                    if seen[c] == i:
                        continue
                    seen[c] = i
                    if len(first) > 0:
                        items[first[c] + counts[c]] = i
                    counts[c] += 1
