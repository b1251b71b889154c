"""Which pieces come near a rectangle of the pattern plane (000, 4.1)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import leaf
from renderer.tables import Grid, Pattern


class Nearby(NamedTuple):
    """What a query found; its own memory, used again by each query of one thread."""

    piece: NDArray[np.int32]  # (capacity,) rows of PIECE
    shift: NDArray[np.float64]  # (capacity, 2) the repetition of the tile that it stands in, pattern units
    seen: NDArray[np.int64]  # (pieces,) the last query that met a piece
    query: NDArray[np.int64]  # (1,) the number of queries so far


@leaf
def nearby(pattern: Pattern, capacity: int) -> Nearby:
    """Memory for queries of at most `capacity` pieces."""
    return Nearby(
        np.empty(capacity, np.int32),
        np.empty((capacity, 2)),
        np.full(len(pattern.pieces), -1, np.int64),
        np.zeros(1, np.int64),
    )


@leaf
def find(pattern: Pattern, found: Nearby, x0: float, y0: float, x1: float, y1: float, capacity: int) -> int:
    """Find every piece whose centre line may cross the rectangle, each once a repetition: how many, -1 if too many.

    The caller enlarges the rectangle by the reach of the cross-sections: the grid knows the paths alone, so that a
    new profile leaves it as it is.
    """
    return find_in(pattern.grid, found, x0, y0, x1, y1, capacity)


@leaf
def find_in(grid: Grid, found: Nearby, x0: float, y0: float, x1: float, y1: float, capacity: int) -> int:
    """`find` among the pieces of one grid, which may list a part of the pattern's."""
    right = grid.origin[0] + grid.cell[0] * grid.shape[0]
    top = grid.origin[1] + grid.cell[1] * grid.shape[1]
    first_x = last_x = first_y = last_y = 0
    if grid.tile[0] > 0.0:  # the repetitions whose paths' bounds meet the rectangle
        first_x = math.ceil((x0 - right) / grid.tile[0])
        last_x = math.floor((x1 - grid.origin[0]) / grid.tile[0])
        first_y = math.ceil((y0 - top) / grid.tile[1])
        last_y = math.floor((y1 - grid.origin[1]) / grid.tile[1])
        if (last_x - first_x + 1.0) * (last_y - first_y + 1.0) > capacity:
            return -1
    count = 0
    for row in range(first_y, last_y + 1):
        for column in range(first_x, last_x + 1):
            dx, dy = column * grid.tile[0], row * grid.tile[1]
            if x1 - dx < grid.origin[0] or y1 - dy < grid.origin[1] or x0 - dx > right or y0 - dy > top:
                continue
            found.query[0] += 1
            low_x = int(max((x0 - dx - grid.origin[0]) / grid.cell[0], 0.0))
            low_y = int(max((y0 - dy - grid.origin[1]) / grid.cell[1], 0.0))
            high_x = int(min((x1 - dx - grid.origin[0]) / grid.cell[0], grid.shape[0] - 1.0))
            high_y = int(min((y1 - dy - grid.origin[1]) / grid.cell[1], grid.shape[1] - 1.0))
            for iy in range(low_y, high_y + 1):
                for ix in range(low_x, high_x + 1):
                    cell = iy * grid.shape[0] + ix
                    for k in range(grid.first[cell], grid.first[cell + 1]):
                        item = grid.items[k]
                        if found.seen[item] == found.query[0]:
                            continue
                        found.seen[item] = found.query[0]
                        if count == capacity:
                            return -1
                        found.piece[count] = item
                        found.shift[count, 0] = dx
                        found.shift[count, 1] = dy
                        count += 1
    return count


@leaf
def over_crossing(pattern: Pattern, x0: float, y0: float, x1: float, y1: float) -> bool:
    """Whether paths of one repetition of the tile cross in the rectangle (001, 4.2)."""
    grid = pattern.grid
    if len(grid.crossings) == 0:
        return False
    if grid.tile[0] > 0.0:  # the rectangle's repetition; what lies across a border is left to the pieces found
        dx = math.floor((0.5 * (x0 + x1) - grid.origin[0]) / grid.tile[0]) * grid.tile[0]
        dy = math.floor((0.5 * (y0 + y1) - grid.origin[1]) / grid.tile[1]) * grid.tile[1]
        x0, x1, y0, y1 = x0 - dx, x1 - dx, y0 - dy, y1 - dy
    low_x = int(max((x0 - grid.origin[0]) / grid.cell[0], 0.0))
    low_y = int(max((y0 - grid.origin[1]) / grid.cell[1], 0.0))
    high_x = int(min((x1 - grid.origin[0]) / grid.cell[0], grid.shape[0] - 1.0))
    high_y = int(min((y1 - grid.origin[1]) / grid.cell[1], grid.shape[1] - 1.0))
    for iy in range(low_y, high_y + 1):
        for ix in range(low_x, high_x + 1):
            cell = iy * grid.shape[0] + ix
            for k in range(grid.crossing_first[cell], grid.crossing_first[cell + 1]):
                x, y = grid.crossings[k, 0], grid.crossings[k, 1]
                if x0 <= x <= x1 and y0 <= y <= y1:
                    return True
    return False
