"""Profiles that overhang: polylines (b, w) whose b runs back somewhere. Which of them make sense, and what they make.

The polyline C_0 .. C_n goes from left to right on the whole and does not meet itself. Its facets are *external* from
each end towards the centre while it does not descend, and *internal* in between, as for any profile. Such a groove

- removes what lies between its internal facets and the two vertical lines that rise without end from the first and
  the last internal point: all above the internal facets, and the undercut to either side of it;
- adds what the polyline and the line w = 0 enclose above w = 0: the places with an odd number of facets above them.

Its band, which a priority rules, goes from the least to the greatest b of the profile; so do the half-widths by which
`profile` ends read it. For a profile that is a height field all of this says what the simpler rules say.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from .base import MIN_LENGTH, Fault

MAX_FACETS = 128
Points = Sequence[tuple[float, float]]

_NEAR = 1e-9  # facets this close, as a part of the profile's size, meet


def overhangs(points: Points) -> bool:
    """Whether the polyline is no height field: b runs back somewhere."""
    return any(here[0] < before[0] for before, here in pairwise(points))


def internal(points: Points) -> tuple[int, int]:
    """The internal facets first <= i < last: what is left of the polyline when, from each end towards the centre, the
    facets before the first descending one are taken off (DESIGN 1.2; 003, 5.3). Equal where nothing is left."""
    first, last = 0, len(points) - 1
    while first < len(points) - 1 and points[first + 1][1] >= points[first][1]:
        first += 1
    while last > 0 and points[last - 1][1] >= points[last][1]:
        last -= 1
    return (first, last) if first < last else (0, 0)


def faults(points: Points) -> Iterator[Fault]:
    """What is wrong with a profile that overhangs: the first thing alone, as one brings others with it."""
    last = len(points) - 1
    if last > MAX_FACETS:
        yield Fault(("points",), f"at most {MAX_FACETS + 1} points, as the profile overhangs", f"{last + 1}")
        return
    if points[last][0] - points[0][0] < MIN_LENGTH:
        expected = f"a b of at least {points[0][0] + MIN_LENGTH:.12g}, to the right of where the profile begins"
        yield Fault(("points", last, 0), expected, f"{points[last][0]:.12g}")
        return
    meeting = _meeting(points)
    if meeting is not None:
        i, j, found = meeting
        yield Fault(("points", j + 1), "a polyline that does not meet itself", f"facet {j} {found} facet {i}")
        return
    for i, (a, b) in enumerate(pairwise(points)):
        if a[1] * b[1] < 0:
            at = a[0] + a[1] / (a[1] - b[1]) * (b[0] - a[0])
            if not points[0][0] < at < points[last][0]:
                expected = (
                    f"no facet that crosses w = 0 beyond the profile's ends, {points[0][0]:g} and {points[last][0]:g}"
                )
                yield Fault(("points", i + 1), expected, f"facet {i} at b = {at:g}")
                return
    first, end = internal(points)
    if first == end:
        return
    if points[end][0] - points[first][0] < MIN_LENGTH:
        expected = f"a b above {points[first][0]:.12g}, as here the opening ends that begins with point {first}"
        yield Fault(("points", end, 0), expected, f"{points[end][0]:.12g}")
        return
    for corner in (first, end):
        for i in range(last):
            if _rises_through(points[i], points[i + 1], points[corner]):
                expected = (
                    f"no facet above point {corner}, from where the groove is open upwards (internal facets begin "
                    "where the profile first descends)"
                )
                yield Fault(("points", i + 1), expected, f"facet {i} at b = {points[corner][0]:.12g}")
                return
    for i in (*range(first), *range(end, last)):
        if _is_removed(points, first, end, _middle(points[i], points[i + 1])):
            found = f"facet {i}, which the internal facets {first} to {end - 1} remove again"
            yield Fault(("points", i + 1), "external facets outside of what the groove removes", found)
            return


def _middle(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])


def _side(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], near: float) -> int:
    """On which side of the line from a to b the point c is: 1 left, -1 right, 0 within `near` of it."""
    across = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    bound = near * math.dist(a, b)
    return 0 if abs(across) <= bound else 1 if across > 0 else -1


def _meeting(points: Points) -> tuple[int, int, str] | None:
    """Two facets i < j that meet other than neighbours in their common point, and how; None: there are none."""
    size = max(max(c) - min(c) for c in zip(*points, strict=True))
    near = _NEAR * size
    facets = range(len(points) - 1)
    for j in facets:
        a, b = points[j], points[j + 1]
        low_b, high_b, low_w, high_w = min(a[0], b[0]), max(a[0], b[0]), min(a[1], b[1]), max(a[1], b[1])
        for i in range(j):
            c, d = points[i], points[i + 1]
            if (
                max(c[0], d[0]) < low_b - near
                or min(c[0], d[0]) > high_b + near
                or max(c[1], d[1]) < low_w - near
                or min(c[1], d[1]) > high_w + near
            ):
                continue
            if i == j - 1:
                back = (d[0] - c[0]) * (b[0] - a[0]) + (d[1] - c[1]) * (b[1] - a[1]) < 0
                if back and (_side(c, d, b, near) == 0 or _side(a, b, c, near) == 0):
                    return i, j, "runs back along"
            elif _side(a, b, c, near) * _side(a, b, d, near) <= 0 and _side(c, d, a, near) * _side(c, d, b, near) <= 0:
                return i, j, "meets"
    return None


def _rises_through(a: tuple[float, float], b: tuple[float, float], corner: tuple[float, float]) -> bool:
    """Whether the facet from a to b meets the vertical line above the corner."""
    low, high = sorted((a, b))
    if not low[0] <= corner[0] <= high[0]:
        return False
    if low[0] == high[0]:
        return max(a[1], b[1]) > corner[1]
    if corner in (a, b):
        return False
    return low[1] + (corner[0] - low[0]) / (high[0] - low[0]) * (high[1] - low[1]) > corner[1]


def _is_removed(points: Points, first: int, end: int, at: tuple[float, float]) -> bool:
    """Whether a place lies between the internal facets and the lines that rise from their ends."""
    above = 0
    for i in range(first, end):
        low, high = sorted((points[i], points[i + 1]))
        if low[0] <= at[0] < high[0]:
            above += low[1] + (at[0] - low[0]) / (high[0] - low[0]) * (high[1] - low[1]) > at[1]
    return (points[first][0] <= at[0] < points[end][0]) != (above % 2 == 1)
