"""Cross-sections that overhang, as what is swept: polygons of (b, w) over given places b, with their triangles.

Between two neighbouring places the region is a few trapezoids, each between two facets. Their corners are the
polygons' points; what bounds the region on one side alone are their edges.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.tables import Floats, Ints

DOWN, UP, LID = -1, -2, -3
"""Sides that are no facets: as far down and as far up as the solid goes, and a lid over the opening."""

_RAISED = 1.25  # the lid's height, in those of the profile's highest point

Side = tuple[int, int]  # lower and upper side of a trapezoid: facets, or DOWN, UP, LID


class Outline(NamedTuple):
    """A profile that overhangs."""

    points: Floats  # (n, 2) its polyline (b, w)
    parts: NDArray[np.void]  # PART
    inner: tuple[int, int]  # internal facets, first and beyond the last

    @property
    def places(self) -> Floats:
        """All b where the profile has a corner, or what it adds and removes has one; and two in the opening."""
        (b0, _), (b1, _) = self.points[list(self.inner)]
        lean = [0.75 * b0 + 0.25 * b1, 0.25 * b0 + 0.75 * b1]
        return np.unique(np.concatenate([self.points[:, 0], self.parts["b0"], self.parts["b1"], lean]))


class Shape(NamedTuple):
    """A region of the plane (b, w)."""

    column: Ints  # (n,) at which of the places its points are
    w: Floats  # (n,) their heights; -inf and inf: as far down and up as the solid goes
    edges: Ints  # (m, 3) from a point to a point, with the region to the left, and on which facet; -1: none
    triangles: Ints  # (k, 3) anticlockwise, that fill it


def height(points: Floats | tuple[tuple[float, float], ...], facet: int, b: float) -> float:
    """w of a facet at b; exactly that of its points at theirs."""
    (b0, w0), (b1, w1) = points[facet], points[facet + 1]
    return float(w0 if b == b0 else w1 if b == b1 else w0 + (b - b0) / (b1 - b0) * (w1 - w0))


def removed(outline: Outline, places: Floats) -> Shape | None:
    """What the profile removes between the first and the last of the places."""
    parts = outline.parts[outline.parts["removes"] == 1]
    return _shape(outline, places, [_sides(parts, a, b, UP) for a, b in pairwise(places.tolist())])


def added(outline: Outline, places: Floats) -> Shape | None:
    """What it adds, and below w = 0 what is under that; where it also removes next to it, that as well, up to a lid:
    so its faces never coincide with the removal's."""
    removes = outline.parts["removes"] == 1
    if removes.all():
        return None
    columns = []
    for a, b in pairwise(places.tolist()):
        middle = 0.5 * (a + b)
        sides = _sides(outline.parts[~removes], a, b, UP)
        for lower, upper in _sides(outline.parts[removes], a, b, LID):
            if upper == LID or height(outline.points, upper, middle) > 0.0:
                sides.append((lower if height(outline.points, lower, middle) > 0.0 else DOWN, upper))
        sides.sort(key=lambda side: -math.inf if side[0] == DOWN else height(outline.points, side[0], middle))
        merged: list[Side] = []
        for side in sides:
            if merged and merged[-1][1] == side[0]:
                side = (merged.pop()[0], side[1])
            merged.append(side)
        columns.append(merged)
    return _shape(outline, places, columns)


def _sides(parts: NDArray[np.void], a: float, b: float, top: int) -> list[Side]:
    """The trapezoids from a to b."""
    here = parts[(parts["b0"] <= a) & (parts["b1"] >= b)]
    return [
        (DOWN if lower < 0 else lower, top if upper < 0 else upper)
        for lower, upper in zip(here["lower"].tolist(), here["upper"].tolist(), strict=True)
    ]


def _at(outline: Outline, side: int, b: float) -> float:
    """The height of a side at b. The lid begins at the ends of the opening, so that it leans inwards."""
    if side in (DOWN, UP):
        return -math.inf if side == DOWN else math.inf
    if side == LID:
        for corner in outline.inner:
            if b == outline.points[corner, 0]:
                return float(outline.points[corner, 1])
        return _RAISED * float(outline.points[:, 1].max())
    return height(outline.points, side, b)


def _shape(outline: Outline, places: Floats, columns: list[list[Side]]) -> Shape | None:
    """The region of the trapezoids `columns` between each two places."""
    if not any(columns):
        return None
    at = places.tolist()
    corners = [  # of each trapezoid: low and high at its left, low and high at its right
        [(*(_at(outline, side, a) for side in sides), *(_at(outline, side, b) for side in sides)) for sides in column]
        for (a, b), column in zip(pairwise(at), columns, strict=True)
    ]
    nodes: list[list[float]] = []
    first = [0]
    for i in range(len(at)):
        before = [w for corner in corners[i - 1] for w in corner[2:]] if i else []
        behind = [w for corner in corners[i] for w in corner[:2]] if i < len(corners) else []
        # and where a vertical facet ends at a side
        ends = outline.points[outline.points[:, 0] == at[i], 1].tolist()
        beside = [*zip(before[::2], before[1::2], strict=True), *zip(behind[::2], behind[1::2], strict=True)]
        ends = [w for w in ends if any(low < w < high for low, high in beside)]
        nodes.append(sorted({*before, *behind, *ends}))
        first.append(first[-1] + len(nodes[-1]))
    index = [{w: first[i] + k for k, w in enumerate(heights)} for i, heights in enumerate(nodes)]

    edges: list[tuple[int, int, int]] = []
    triangles: list[tuple[int, int, int]] = []
    covered = [[[0] * max(len(heights) - 1, 0) for heights in nodes] for _ in range(2)]  # to the left, to the right
    for i, column in enumerate(columns):
        for (lower, upper), (low0, high0, low1, high1) in zip(column, corners[i], strict=True):
            edges.append((index[i][low0], index[i + 1][low1], max(lower, -1)))
            edges.append((index[i + 1][high1], index[i][high0], max(upper, -1)))
            left = range(index[i][low0], index[i][high0] + 1)
            right = range(index[i + 1][low1], index[i + 1][high1] + 1)
            for k in left[:-1]:
                covered[1][i][k - first[i]] += 1
            for k in right[:-1]:
                covered[0][i + 1][k - first[i + 1]] += 1
            triangles += [(left[0], k, k + 1) for k in right[:-1]]
            triangles += [(k, right[-1], k + 1) for k in left[:-1]]
    for i, heights in enumerate(nodes):
        for k, (low, high) in enumerate(pairwise(heights)):
            if covered[0][i][k] != covered[1][i][k]:
                ends = (first[i] + k, first[i] + k + 1)
                facet = _upright(outline.points, at[i], low, high)
                edges.append((*ends, facet) if covered[0][i][k] else (*ends[::-1], facet))
    return Shape(
        np.repeat(np.arange(len(at)), [len(heights) for heights in nodes]).astype(np.int32),
        np.array([w for heights in nodes for w in heights]),
        np.array(edges, np.int32),
        np.array(triangles, np.int32),
    )


def _upright(points: Floats, b: float, low: float, high: float) -> int:
    """The vertical facet that reaches from one height to another at b, or -1."""
    here = (points[:-1, 0] == b) & (points[1:, 0] == b)
    here &= (np.minimum(points[:-1, 1], points[1:, 1]) <= low) & (np.maximum(points[:-1, 1], points[1:, 1]) >= high)
    found = np.flatnonzero(here)
    return int(found[0]) if len(found) else -1
