"""Profiles that overhang, cut into trapezoids between consecutive b (vertical decomposition).

What such a profile removes and adds (schema.overhang) is no height field over b, but each trapezoid is convex: along
a ray it is one interval.
"""

from __future__ import annotations

import math
from itertools import pairwise

from renderer.outline import height

Row = tuple[float, float, float, float, float, float, int, int, int]
"""One PART."""

Points = tuple[tuple[float, float], ...]
_Key = tuple[int, int, int]  # lower and upper facet, removes

_NEAR = 1e-12  # places this close, as a part of the profile's width, are one


def decompose(points: Points, first: int, last: int) -> list[Row]:
    """The trapezoids (PART) of a profile with the internal facets first <= i < last: those that it removes, then those
    that it adds; each from left to right by b0, and from low to high."""
    near = _NEAR * (max(b for b, _ in points) - min(b for b, _ in points))
    done: list[tuple[float, float, _Key]] = []
    open_: dict[_Key, float] = {}  # where those that reach up to here begin
    places = _places(points, near)
    for left, right in pairwise(places):
        now = _between(points, first, last, left, right)
        done += [(begin, left, key) for key, begin in open_.items() if key not in now]
        open_ = {key: open_.get(key, left) for key in now}
    done += [(begin, places[-1], key) for key, begin in open_.items()]
    rows = [_row(points, *one) for one in done]
    return sorted(rows, key=lambda row: (-row[8], row[0], row[2] + row[3], row[1]))


def _places(points: Points, near: float) -> list[float]:
    """All b where the profile has a point or crosses w = 0, rising."""
    places = sorted({b for b, _ in points})
    for (b0, w0), (b1, w1) in pairwise(points):
        if w0 * w1 < 0.0 and b0 != b1:
            b = b0 + w0 / (w0 - w1) * (b1 - b0)
            if all(abs(b - other) > near for other in places):
                places.append(b)
    return sorted(places)


def _between(points: Points, first: int, last: int, left: float, right: float) -> set[_Key]:
    """What there is between two consecutive places."""
    middle = 0.5 * (left + right)
    across = [
        i for i, (a, b) in enumerate(pairwise(points)) if min(a[0], b[0]) <= left and max(a[0], b[0]) >= right
    ]  # fmt: skip
    across.sort(key=lambda i: -height(points, i, middle))
    keys: set[_Key] = set()
    for k in range(0, len(across), 2):
        upper, lower = across[k], across[k + 1] if k + 1 < len(across) else -1
        if height(points, upper, middle) <= 0.0:
            break
        keys.add((lower if lower >= 0 and height(points, lower, middle) > 0.0 else -1, upper, 0))
    inner = [i for i in across if first <= i < last]
    if points[first][0] <= middle <= points[last][0] and first < last:
        inner.insert(0, -1)
    keys |= {(lower, upper, 1) for upper, lower in zip(inner[::2], inner[1::2], strict=False)}
    return keys


def _row(points: Points, b0: float, b1: float, key: _Key) -> Row:
    lower, upper, removes = key
    low = [0.0 if lower < 0 else height(points, lower, b) for b in (b0, b1)]
    high = [math.inf if upper < 0 else height(points, upper, b) for b in (b0, b1)]
    if not removes:
        low, high = [max(w, 0.0) for w in low], [max(w, 0.0) for w in high]
    return b0, b1, low[0], low[1], high[0], high[1], lower, upper, removes
