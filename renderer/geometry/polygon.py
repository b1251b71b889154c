"""Convex polygons of a plane, cut by half-planes: the one operation of exact area sampling (DESIGN 2.3).

A half-plane (a, b, c) is where a x + b y + c >= 0. Polygons run anticlockwise, in any unit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import leaf
from renderer.tables import Floats

CORNERS = 64
"""Room for a polygon's corners while it is cut."""
MOST = 24
"""Polygons with more corners are kept as two; so much room is left for half-planes, each of which adds one."""
FULL = -1
"""What a list of polygons says that has run out of room."""

Counts = NDArray[np.int64]


@leaf
def edges(polygon: Floats, count: int, least: float, planes: Floats) -> int:
    """The half-planes of a polygon's edges, to the left of each; those of no length have no direction."""
    n = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        dx, dy = polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1]
        long = math.hypot(dx, dy)
        if long <= least:
            continue
        planes[n, 0], planes[n, 1] = -dy / long, dx / long
        planes[n, 2] = (polygon[i, 0] * dy - polygon[i, 1] * dx) / long
        n += 1
    return n


@leaf
def enclose(polygon: Floats, count: int, box: Floats) -> None:
    """Write its least and greatest coordinates to box: x0, y0, x1, y1."""
    box[0] = box[1] = math.inf
    box[2] = box[3] = -math.inf
    for k in range(count):
        box[0], box[1] = min(box[0], polygon[k, 0]), min(box[1], polygon[k, 1])
        box[2], box[3] = max(box[2], polygon[k, 0]), max(box[3], polygon[k, 1])


@leaf
def overlap(one: Floats, two: Floats) -> bool:
    """Whether two boxes have a part in common."""
    return bool(one[0] < two[2] and one[2] > two[0] and one[1] < two[3] and one[3] > two[1])


@leaf
def divide(
    polygon: Floats, count: int, a: float, b: float, c: float, inside: Floats, outside: Floats
) -> tuple[int, int]:
    """Write the parts of a polygon within a half-plane and beyond it: how many corners each has."""
    n = m = 0
    x0, y0 = polygon[count - 1, 0], polygon[count - 1, 1]
    d0 = a * x0 + b * y0 + c
    for i in range(count):
        x1, y1 = polygon[i, 0], polygon[i, 1]
        d1 = a * x1 + b * y1 + c
        if (d0 > 0.0 and d1 < 0.0) or (d0 < 0.0 and d1 > 0.0):
            t = d0 / (d0 - d1)
            x, y = x0 + t * (x1 - x0), y0 + t * (y1 - y0)
            inside[n, 0], inside[n, 1] = x, y
            outside[m, 0], outside[m, 1] = x, y
            n += 1
            m += 1
        if d1 >= 0.0:
            inside[n, 0], inside[n, 1] = x1, y1
            n += 1
        if d1 <= 0.0:
            outside[m, 0], outside[m, 1] = x1, y1
            m += 1
        x0, y0, d0 = x1, y1, d1
    return n if n >= 3 else 0, m if m >= 3 else 0


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


@leaf
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


@leaf
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
            before = n
            for j in range(count):
                one[j, 0], one[j, 1] = polygon[j, 0], polygon[j, 1]
            for k in range(last):
                a, b, c = planes[k, 0], planes[k, 1], planes[k, 2]
                least_of = a * one[0, 0] + b * one[0, 1] + c
                for j in range(1, count):
                    least_of = min(least_of, a * one[j, 0] + b * one[j, 1] + c)
                if least_of >= 0.0:
                    continue
                if n == len(polygons):
                    return FULL
                count, outside = divide(one, count, a, b, c, two, polygons[n])
                one, two = two, one
                if outside and area(polygons[n], outside) > least:
                    begin = 0
                    if outside > MOST:  # in two or more, along diagonals
                        for j in range(outside):
                            two[j, 0], two[j, 1] = polygons[n, j, 0], polygons[n, j, 1]
                        while outside - begin > MOST:
                            for j in range(1, MOST):
                                polygons[n, j, 0], polygons[n, j, 1] = two[begin + j, 0], two[begin + j, 1]
                            counts[n] = MOST
                            n += 1
                            begin += MOST - 2
                            if n == len(polygons):
                                return FULL
                            polygons[n, 0, 0], polygons[n, 0, 1] = two[0, 0], two[0, 1]
                        for j in range(1, outside - begin):
                            polygons[n, j, 0], polygons[n, j, 1] = two[begin + j, 0], two[begin + j, 1]
                    counts[n] = outside - begin
                    n += 1
                if count == 0:
                    break
            if count == 0 or area(one, count) <= least:
                n = before
                continue
        n -= 1  # polygon i is replaced by the last
        for j in range(counts[n]):
            polygons[i, j, 0], polygons[i, j, 1] = polygons[n, j, 0], polygons[n, j, 1]
        counts[i] = counts[n]
    return n
