"""Triangles of pattern space cut along the cells of a curved surface, so that each part can be carried onto it.

Both sides of a cut compute the same points, along a grid bit for bit, and so the parts meet without gaps.
"""

from __future__ import annotations

import numpy as np

from renderer.kernel import kernel, leaf
from renderer.tables import Floats, Ints

CORNERS = 24  # room for those of a polygon: a triangle cut by at most four lines has seven


@leaf
def cut(polygon: Floats, count: int, a: float, b: float, c: float, out: Floats) -> int:
    """Write the part of a convex polygon (p, q, w) with a p + b q + c >= 0 into `out`: how many corners it has."""
    made = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here = a * polygon[i, 0] + b * polygon[i, 1] + c
        there = a * polygon[j, 0] + b * polygon[j, 1] + c
        if here >= 0.0:
            for k in range(3):
                out[made, k] = polygon[i, k]
            made += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            # From the same end in both triangles that share the edge.
            m, n, first, last = i, j, here, there
            for k in range(3):
                if polygon[i, k] != polygon[j, k]:
                    if polygon[i, k] > polygon[j, k]:
                        m, n, first, last = j, i, there, here
                    break
            t = first / (first - last)
            for k in range(3):
                out[made, k] = polygon[m, k] + t * (polygon[n, k] - polygon[m, k])
            made += 1
    return made


@leaf
def fan(
    polygon: Floats, count: int, source: int, cell: int, made: int, parts: Floats, sources: Ints, cells: Ints
) -> int:
    """Add a polygon's triangles while there is room: how many there are then, or would be."""
    for i in range(1, count - 1):
        if made < len(parts):
            for k in range(3):
                parts[made, 0, k], parts[made, 1, k] = polygon[0, k], polygon[i, k]
                parts[made, 2, k] = polygon[i + 1, k]
            sources[made], cells[made] = source, cell
        made += 1
    return made


@kernel
def cut_by_grid(corners: Floats, p: Floats, q: Floats, parts: Floats, sources: Ints, cells: Ints) -> int:
    """Cut triangles (n, 3, 3) by a grid with lines at ascending `p` and `q`; nothing outside it is left.

    Writes parts (k, 3, 3), the triangles they come from and their cells, as many as there is room for; returns how
    many there are.
    """
    above, row = np.empty((CORNERS, 3)), np.empty((CORNERS, 3))
    right, part, rest = np.empty((CORNERS, 3)), np.empty((CORNERS, 3)), np.empty((CORNERS, 3))
    made = 0
    for t in range(len(corners)):
        # What is left is cut line by line, so that an edge comes to the same parts in both triangles that share it.
        above[:3] = corners[t]
        j = min(max(np.searchsorted(q, above[:3, 1].min(), side="right") - 1, 0), len(q) - 2)
        count = cut(above, 3, 0.0, 1.0, -q[j], rest)
        above[:count] = rest[:count]
        while count >= 3 and j + 1 < len(q):
            across = cut(above, count, 0.0, -1.0, q[j + 1], row)
            count = cut(above, count, 0.0, 1.0, -q[j + 1], rest)
            above[:count] = rest[:count]
            if across >= 3:
                i = min(max(np.searchsorted(p, row[:across, 0].min(), side="right") - 1, 0), len(p) - 2)
                across = cut(row, across, 1.0, 0.0, -p[i], right)
                while across >= 3 and i + 1 < len(p):
                    kept = cut(right, across, -1.0, 0.0, p[i + 1], part)
                    across = cut(right, across, 1.0, 0.0, -p[i + 1], rest)
                    right[:across] = rest[:across]
                    made = fan(part, kept, t, j * (len(p) - 1) + i, made, parts, sources, cells)
                    i += 1
            j += 1
    return made


@kernel
def cut_by_triangles(
    corners: Floats, by: Floats, low: Floats, cell: Floats, shape: Ints, first: Ints, items: Ints, parts: Floats,
    sources: Ints, cells: Ints,
) -> int:  # fmt: skip
    """Cut triangles (n, 3, 3) by those of the plane, `by` (m, 3, 2), either way round; as `cut_by_grid` else.

    low, cell, shape, first, items: the bins of `bins`, which list the triangles (n, 3, 3).
    """
    one, two = np.empty((CORNERS, 3)), np.empty((CORNERS, 3))
    made = 0
    for b in range(len(by)):
        area = (by[b, 1, 0] - by[b, 0, 0]) * (by[b, 2, 1] - by[b, 0, 1])
        area -= (by[b, 2, 0] - by[b, 0, 0]) * (by[b, 1, 1] - by[b, 0, 1])
        if area == 0.0:
            continue
        sign = 1.0 if area > 0.0 else -1.0
        i0, j0, i1, j1 = box_of(by[b], low, cell, shape)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                for item in items[first[j * shape[0] + i] : first[j * shape[0] + i + 1]]:
                    ti, tj, _, _ = box_of(corners[item], low, cell, shape)
                    if max(ti, i0) != i or max(tj, j0) != j:
                        continue  # met in another bin
                    one[:3] = corners[item]
                    count = 3
                    for k in range(3):
                        # From the same end for both neighbours of the edge.
                        m, n = k, (k + 1) % 3
                        way = sign
                        if by[b, m, 0] > by[b, n, 0] or (by[b, m, 0] == by[b, n, 0] and by[b, m, 1] > by[b, n, 1]):
                            m, n, way = n, m, -sign
                        x, y = by[b, n, 0] - by[b, m, 0], by[b, n, 1] - by[b, m, 1]
                        count = cut(one, count, -way * y, way * x, way * (y * by[b, m, 0] - x * by[b, m, 1]), two)
                        if count < 3:
                            break
                        one[:count] = two[:count]
                    if count >= 3:
                        made = fan(one, count, item, b, made, parts, sources, cells)
    return made


@leaf
def box_of(corners: Floats, low: Floats, cell: Floats, shape: Ints) -> tuple[int, int, int, int]:
    """The bins that a triangle's box covers: first and last column and row."""
    i0 = min(max(int((corners[:, 0].min() - low[0]) / cell[0]), 0), shape[0] - 1)
    j0 = min(max(int((corners[:, 1].min() - low[1]) / cell[1]), 0), shape[1] - 1)
    i1 = min(max(int((corners[:, 0].max() - low[0]) / cell[0]), 0), shape[0] - 1)
    j1 = min(max(int((corners[:, 1].max() - low[1]) / cell[1]), 0), shape[1] - 1)
    return i0, j0, i1, j1


@kernel
def bins(corners: Floats, low: Floats, cell: Floats, shape: Ints) -> tuple[Ints, Ints]:
    """Triangles (n, 3, 3) listed by the bins that their boxes cover: where each bin's list begins, and the lists."""
    first = np.zeros(shape[0] * shape[1] + 1, np.int32)
    for t in range(len(corners)):
        i0, j0, i1, j1 = box_of(corners[t], low, cell, shape)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                first[j * shape[0] + i + 1] += 1
    for k in range(len(first) - 1):
        first[k + 1] += first[k]
    items = np.empty(first[-1], np.int32)
    fill = first[:-1].copy()
    for t in range(len(corners)):
        i0, j0, i1, j1 = box_of(corners[t], low, cell, shape)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                items[fill[j * shape[0] + i]] = t
                fill[j * shape[0] + i] += 1
    return first, items
