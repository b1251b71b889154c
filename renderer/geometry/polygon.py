"""Convex polygons of a plane, cut by half-planes: the one operation of exact area sampling (DESIGN 2.3).

A half-plane (a, b, c) is where a x + b y + c >= 0. Polygons run anticlockwise, in any unit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import callee, leaf
from renderer.tables import Floats

CORNERS = 64
"""Room for a polygon's corners while it is cut."""
MOST = 24
"""Polygons with more corners are kept as two; so much room is left for half-planes, each of which adds one."""
FULL = -1
"""What a list of polygons says that has run out of room."""

Counts = NDArray[np.int64]


@leaf
def clip(polygon: Floats, count: int, a: float, b: float, c: float, out: Floats) -> int:
    """Write the part of a polygon that lies in a half-plane to `out`: how many corners it has."""
    made = 0
    x0, y0 = polygon[count - 1, 0], polygon[count - 1, 1]
    d0 = a * x0 + b * y0 + c
    for i in range(count):
        x1, y1 = polygon[i, 0], polygon[i, 1]
        d1 = a * x1 + b * y1 + c
        if (d0 > 0.0 and d1 < 0.0) or (d0 < 0.0 and d1 > 0.0):
            t = d0 / (d0 - d1)
            out[made, 0], out[made, 1] = x0 + t * (x1 - x0), y0 + t * (y1 - y0)
            made += 1
        if d1 >= 0.0:
            out[made, 0], out[made, 1] = x1, y1
            made += 1
        x0, y0, d0 = x1, y1, d1
    return made if made >= 3 else 0


@callee
def clipped(polygon: Floats, count: int, planes: Floats, first: int, last: int, spare: Floats) -> int:
    """Cut a polygon in place by the half-planes first <= k < last, no more than CORNERS - MOST: how many corners."""
    for k in range(first, last):
        a, b, c = planes[k, 0], planes[k, 1], planes[k, 2]
        least = a * polygon[0, 0] + b * polygon[0, 1] + c
        for i in range(1, count):
            least = min(least, a * polygon[i, 0] + b * polygon[i, 1] + c)
        if least >= 0.0:
            continue
        count = clip(polygon, count, a, b, c, spare)
        if count == 0:
            return 0
        for i in range(count):
            polygon[i, 0], polygon[i, 1] = spare[i, 0], spare[i, 1]
    return count


@leaf
def area(polygon: Floats, count: int) -> float:
    """Its area."""
    total = 0.0
    x0, y0 = polygon[0, 0], polygon[0, 1]
    for i in range(1, count - 1):
        total += (polygon[i, 0] - x0) * (polygon[i + 1, 1] - y0) - (polygon[i + 1, 0] - x0) * (polygon[i, 1] - y0)
    return 0.5 * total


@callee
def subtract(
    polygons: Floats, counts: Counts, n: int, planes: Floats, last: int, least: float, one: Floats, two: Floats
) -> int:  # fmt: skip
    """Take the convex region of the half-planes planes[:last] out of polygons[:n], in place: how many are left.

    polygons: (capacity, CORNERS, 2). Parts of no more than `least` area are dropped, and so is what would be taken
    away where it is as small. FULL where they do not fit.
    """
    for i in range(n - 1, -1, -1):
        polygon, count = polygons[i], counts[i]
        apart, cut = False, False
        for k in range(last):
            a, b, c = planes[k, 0], planes[k, 1], planes[k, 2]
            most = least_of = a * polygon[0, 0] + b * polygon[0, 1] + c
            for j in range(1, count):
                d = a * polygon[j, 0] + b * polygon[j, 1] + c
                most, least_of = max(most, d), min(least_of, d)
            if most <= 0.0:
                apart = True
                break
            cut = cut or least_of < 0.0
        if apart:
            continue
        if cut:
            for j in range(count):
                one[j, 0], one[j, 1] = polygon[j, 0], polygon[j, 1]
            inside = clipped(one, count, planes, 0, last, two)
            if inside == 0 or area(one, inside) <= least:
                continue
            for j in range(count):
                one[j, 0], one[j, 1] = polygon[j, 0], polygon[j, 1]
            for k in range(last):
                a, b, c = planes[k, 0], planes[k, 1], planes[k, 2]
                outside = clip(one, count, -a, -b, -c, two)
                if outside and area(two, outside) > least:
                    begin = 0
                    while begin < outside - 2:  # those with many corners in two, along a diagonal
                        end = min(begin + MOST - 2, outside - 1)
                        if n == len(polygons):
                            return FULL
                        polygons[n, 0, 0], polygons[n, 0, 1] = two[0, 0], two[0, 1]
                        for j in range(begin + 1, end + 1):
                            polygons[n, j - begin, 0], polygons[n, j - begin, 1] = two[j, 0], two[j, 1]
                        counts[n] = end - begin + 1
                        n += 1
                        begin = end - 1
                count = clip(one, count, a, b, c, two)
                for j in range(count):
                    one[j, 0], one[j, 1] = two[j, 0], two[j, 1]
                if count == 0:
                    break
        n -= 1  # polygon i is replaced by the last
        for j in range(counts[n]):
            polygons[i, j, 0], polygons[i, j, 1] = polygons[n, j, 0], polygons[n, j, 1]
        counts[i] = counts[n]
    return n
