"""The closed solid of a triangle mesh with a pattern.

The top of the pattern's flat solid is cut along the mesh's triangles and carried as `body` carries it, to F + w G with
a foot F on the triangle and the rise G = sigma N there. Within a triangle that leaves no gaps. Along an edge of the
mesh the tops of its two triangles meet where both have the same heights and the same normals. Where they have not, as
at a seam of the uv, at a crease, or where a vertical wall runs along the edge, a wall joins them. A mesh with a
boundary is a sheet: it gets a floor, each of its triangles moved inward, and the boundary's walls go down to it.

All of this happens on vertical lines: one with a foot on an edge for each rise that it has there. A wall falls into
columns between neighbouring feet, each bounded by one line of either top; where these cross there is a foot more.
Stretches of one vertical line are cut at all the points on it, so that they meet their equals. Where several vertical
lines share a foot, as at a corner of a box, the points on them are left with a hole, which is filled.

Points that belong together are found by their edge, their place along it and their height, not by where they are.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections import defaultdict
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer import body
from renderer.tables import Floats, Ints, Pattern

_SNAP = 1e-9  # weights of corners, and heights in windows, that close are the same
_LEAN = 2e-6  # and places along an edge, in windows, as the solid's vertical walls lean by a hair
_NORMAL = 1e-6  # and parts of normals
_SLIT = 1e-6  # of the solid's size: how wide what is left open by rounding may be
_FOLD = 0.2  # the least cosine between a corner's normal and the floor's direction below it

_NEXT = [1, 2, 0]
_CORNER = np.array([[True, False, True], [True, True, False], [False, True, True]])  # which edges a corner is on


class Shape(NamedTuple):
    """A mesh's triangles, anticlockwise seen from where their normals point, and how they hang together."""

    base: body.Base
    place: Ints  # (n, 3) of corners: the same number where they meet
    edge: Ints  # (n, 3) from corner k to the next
    boundary: NDArray[np.bool_]  # (n, 3) of edges without a second triangle
    rise: Ints  # (n, 3) of corners: a place's different G
    ribbon: Ints  # (n, 3) of edges: the same number where both ends' rises are


def shape_of(base: body.Base) -> Shape:
    """Raises ValueError where the triangles are no surface with an inside."""
    faces = np.cross(base.corners[:, 1] - base.corners[:, 0], base.corners[:, 2] - base.corners[:, 0])
    turned = np.einsum("nx,nkx->n", faces, base.normals) < 0.0
    order = np.where(turned[:, None], [0, 2, 1], [0, 1, 2])
    corners, normals, pq, rise = (
        np.take_along_axis(values.reshape(*order.shape, -1), order[:, :, None], axis=1)
        for values in (base.corners, base.normals, base.pq, base.rise)
    )
    base = base._replace(corners=corners, normals=normals, pq=np.ascontiguousarray(pq), rise=rise[..., 0])
    place = body.places(corners)
    if (place == place[:, _NEXT]).any():
        where = corners[(place == place[:, _NEXT]).any(axis=1)][0, 0]
        raise ValueError(f"a triangle with two corners at {_text(where)}")
    edge = _numbers(_upward(place, place).reshape(-1, 2)).reshape(-1, 3)
    back = place > place[:, _NEXT]
    ahead, behind = (np.bincount(edge[way], minlength=edge.max() + 1)[edge] for way in (~back, back))
    if (ahead > 1).any() or (behind > 1).any():
        row, k = np.argwhere((ahead > 1) | (behind > 1))[0]
        raise ValueError(f"two triangles on one side of an edge, at {_text(corners[row, k])}")
    boundary = ahead + behind == 1
    if not boundary.any() and np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) <= 0.0:
        raise ValueError("a closed mesh whose normals point into it")
    # What is rendered goes by the normals as they are; that they are equal is said by their first digits.
    rows = np.concatenate([place[..., None], np.round(normals / _NORMAL)], axis=2)
    number = _numbers(rows.reshape(-1, 4)).reshape(-1, 3)
    ribbon = _numbers(_upward(place, number).reshape(-1, 2)).reshape(-1, 3)
    return Shape(base, place, edge, boundary, number, ribbon)


def _upward(place: Ints, values: NDArray[Any]) -> NDArray[Any]:
    """Corners' values (n, 3, ...) at both ends of the edges (n, 3, 2, ...), that of the lower place first."""
    ends = np.stack([values, values[:, _NEXT]], axis=2)
    back = (place > place[:, _NEXT]).reshape(*place.shape, *(1,) * (ends.ndim - 2))
    return np.where(back, ends[:, :, ::-1], ends)


def _numbers(rows: NDArray[Any]) -> Ints:
    """Numbers (n,) of rows (n, k), the same for equal ones."""
    return np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1).astype(np.int32)


def _text(point: Floats) -> str:
    return "(" + ", ".join(f"{x:g}" for x in point) + ")"


def draped(shape: Shape, pattern: Pattern, thickness: float, limit: int) -> tuple[Floats, Ints, Ints]:
    """The solid: vertices (n, 3) in the world, triangles (m, 3), material slots (m,).

    `thickness`, world units, is that of a mesh with a boundary. Raises ValueError where there is no such solid, or
    where it has too many triangles.
    """
    weights, w, cell, slot = _top(shape, pattern, limit)
    flat = _SNAP * float(np.ptp(shape.base.pq, axis=(0, 1)).max())
    lines = _Lines(shape, -2.0 * pattern.depth - 1.0, thickness, flat)
    foot, way, w, on = _rim(shape, lines, weights, w, cell)
    inner = foot < 0
    rows = np.concatenate([cell[np.nonzero(inner)[0]][:, None], weights[inner][:, 1:], w[inner][:, None]], axis=1)
    rows, index = np.unique(rows + 0.0, axis=0, return_inverse=True)
    places = body.carry(shape.base, np.ascontiguousarray(rows[:, None, 1:]), rows[:, 0].astype(np.int32))[:, 0]

    if shape.boundary.any():  # the floor
        back, count = [0, 2, 1], len(shape.place)
        foot, way = np.concatenate([foot, shape.place[:, back]]), np.concatenate([way, shape.rise[:, back]])
        w, slot = np.concatenate([w, np.full((count, 3), lines.floor)]), np.concatenate([slot, np.full(count, -1)])
        cell = np.concatenate([cell, np.arange(count, dtype=np.int32)])
        on = np.concatenate([on, np.tile(_CORNER[back], (count, 1, 1))])
    points = np.empty(foot.shape, np.int32)
    points[foot < 0] = index.reshape(-1)
    points[foot >= 0] = lines.known(len(places), foot[foot >= 0], way[foot >= 0], w[foot >= 0])
    kept = (points != points[:, _NEXT]).all(axis=1) & ~np.any(on.all(axis=1), axis=1)
    lids = _Lids(points[kept], foot[kept], way[kept], w[kept], on[kept], cell[kept])
    faces, slot = _joined(shape, lines, lids, slot[kept])
    if len(faces) > limit:
        raise ValueError(f"a solid of {len(faces)} triangles, more than {limit}")
    places = np.concatenate([places, lines.places()])
    filled = _filled(faces, places, lines.feet(len(places)))
    return places, np.concatenate([faces, filled]), np.concatenate([slot, np.full(len(filled), -1)]).astype(np.int32)


def _top(shape: Shape, pattern: Pattern, limit: int) -> tuple[Floats, Floats, Ints, Ints]:
    """The top as triangles: weights (m, 3, 3) of their corners in the mesh's triangles, heights (m, 3), these triangles
    (m,), slots (m,)."""
    base, count = shape.base, len(shape.place)
    if not len(pattern.pieces):
        own = np.arange(count, dtype=np.int32)
        return np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3)), own, np.full(count, -1, np.int32)
    one, two = base.pq[:, 1] - base.pq[:, 0], base.pq[:, 2] - base.pq[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    if (area == 0.0).any():
        raise ValueError(f"a triangle without an area in uv, at {_text(base.corners[area == 0.0][0, 0])}")
    window = np.concatenate([base.pq.min(axis=(0, 1)), base.pq.max(axis=(0, 1))])
    flat, slot, _ = body.sheet(pattern, window, limit)  # with sides, but along edges alone
    parts, source, cell = body.cut(base, flat, body.CELL, limit)
    parts[area[cell] < 0.0] = parts[area[cell] < 0.0, ::-1]
    weights = body.barycentric(base.pq[cell], parts[..., :2])
    weights[weights < _SNAP] = 0.0
    return weights, parts[..., 2].copy(), cell, slot[source]


class _Lids(NamedTuple):
    """Triangles of the top and of the floor, which are open to one another where walls are to come."""

    points: Ints  # (m, 3)
    foot: Ints  # (m, 3) of the corners' vertical lines, -1 inside the mesh's triangles
    way: Ints  # (m, 3) of these lines
    w: Floats  # (m, 3)
    on: NDArray[np.bool_]  # (m, 3, 3) on which edges of the mesh's triangle a corner is
    cell: Ints  # (m,) the mesh's triangle


class _Lines:
    """Vertical lines with a foot on the mesh's edges and the points on them.

    The first feet are the mesh's places, the others belong to an edge. A line is a foot and a way: a place's rise, an
    edge's ribbon. All lines of a foot share their points at w = 0 and at the floor.
    """

    def __init__(self, shape: Shape, floor: float, thickness: float, flat: float) -> None:
        self.floor, self.flat = floor, flat
        self.corners = _first(shape.place, shape.base.corners)
        self.count = len(self.corners)
        self.sunk = self.corners
        if shape.boundary.any():
            self.sunk = self.corners - thickness * _inward(shape, self.count)
        self.rises = _first(shape.rise, shape.base.rise[..., None] * shape.base.normals)
        self.ends = _first(shape.edge, _upward(shape.place, shape.place))
        self.ways = _first(shape.ribbon, _upward(shape.place, shape.rise))
        self.edge: list[int] = []  # of the feet after the places
        self.t: list[float] = []
        self.heights: dict[tuple[int, int], list[float]] = defaultdict(list)  # rising, where tops are open
        self.rows: dict[tuple[int, int, float], int] = {}

    def known(self, first: int, foot: Ints, way: Ints, w: Floats) -> Ints:
        """The numbers of the points (n,) that there are from the beginning; they go up from `first`."""
        self.first = first
        way = np.where((w == 0.0) | (w == self.floor), -1, way)
        rows, index = np.unique(np.stack([foot, way, w], axis=1), axis=0, return_inverse=True)
        keys = zip(rows[:, 0].astype(int).tolist(), rows[:, 1].astype(int).tolist(), rows[:, 2].tolist(), strict=True)
        self.rows = {key: number for number, key in enumerate(keys)}
        return (first + index.reshape(-1)).astype(np.int32)

    def point(self, line: tuple[int, int], w: float) -> int:
        foot, way = line
        key = (foot, -1 if w in (0.0, self.floor) else way, w)
        return self.first + self.rows.setdefault(key, len(self.rows))

    def height(self, line: tuple[int, int], w: float) -> float:
        """The height of a point of the line: that of one which is there already, if it is so close."""
        heights = self.heights[line]
        k = bisect_left(heights, w)
        for near in heights[max(k - 1, 0) : k + 1]:
            if abs(near - w) <= self.flat:
                return near
        heights.insert(k, w)
        return w

    def between(self, line: tuple[int, int], first: float, last: float) -> list[int]:
        """The line's points from one to the other."""
        heights = self.heights[line]
        low, high = sorted((first, last))
        found = heights[bisect_left(heights, low) : bisect_right(heights, high)]
        return [self.point(line, w) for w in (found if first <= last else found[::-1])]

    def place(self, edge: int, foot: int) -> float:
        """Where on an edge a foot is, 0 to 1."""
        return self.t[foot - self.count] if foot >= self.count else float(foot == self.ends[edge, 1])

    def line(self, edge: int, foot: int, ribbon: int) -> tuple[int, int]:
        """The line on a ribbon of an edge."""
        if foot >= self.count:
            return foot, ribbon
        return foot, int(self.ways[ribbon, int(foot == self.ends[edge, 1])])

    def add(self, edge: int, t: float) -> int:
        self.edge.append(edge)
        self.t.append(t)
        return self.count + len(self.t) - 1

    def feet(self, count: int) -> Ints:
        """The feet of `count` points, those before the first here with one each of their own."""
        feet = np.array([foot for foot, _, _ in self.rows], np.int32)
        return np.concatenate([-1 - np.arange(count - len(feet), dtype=np.int32), feet])

    def places(self) -> Floats:
        """Where the points are (n, 3), world."""
        foot, way, w = (np.array(column) for column in zip(*self.rows, strict=True))
        on = foot >= self.count
        ends = np.stack([foot, foot], axis=1)
        ways = np.stack([way, way], axis=1)
        edge = np.array(self.edge, np.int32)[foot[on] - self.count]
        ends[on], ways[on] = self.ends[edge], np.where(way[on, None] < 0, -1, self.ways[way[on]])
        t = np.zeros((len(foot), 1))
        t[on, 0] = np.array(self.t)[foot[on] - self.count]
        sunk = w == self.floor
        rise = (1.0 - t) * self.rises[ways[:, 0]] + t * self.rises[ways[:, 1]]
        top = (1.0 - t) * self.corners[ends[:, 0]] + t * self.corners[ends[:, 1]] + w[:, None] * rise
        floor = (1.0 - t) * self.sunk[ends[:, 0]] + t * self.sunk[ends[:, 1]]
        return np.asarray(np.where(sunk[:, None], floor, top))


def _first(numbers: Ints, values: NDArray[Any]) -> NDArray[Any]:
    """The values (k, ...) of the first of each number, of numbers (n, 3) and values (n, 3, ...)."""
    return values.reshape(-1, *values.shape[2:])[np.unique(numbers, return_index=True)[1]]


def _inward(shape: Shape, count: int) -> Floats:
    """Where the floor's corners (count, 3) are below those of the mesh, so that it is 1 away from all of a corner's
    triangles, as far as one point can be."""
    normals, place = shape.base.normals.reshape(-1, 3), shape.place.reshape(-1)
    mean = np.stack([np.bincount(place, normals[:, k], count) for k in range(3)], axis=1)
    mean = mean / np.linalg.norm(mean, axis=1, keepdims=True).clip(1e-300)
    least = np.ones(count)
    np.minimum.at(least, place, np.einsum("ij,ij->i", normals, mean[place]))
    if least.min() < _FOLD:
        where = shape.base.corners.reshape(-1, 3)[place == least.argmin()][0]
        raise ValueError(f"a sheet folded too far for a floor below it, at {_text(where)}")
    return np.asarray(mean / least[:, None])


def _rim(
    shape: Shape, lines: _Lines, weights: Floats, w: Floats, cell: Ints
) -> tuple[Ints, Ints, Floats, NDArray[np.bool_]]:
    """Of the top's corners (m, 3) the lines they are on, foot -1 inside the mesh's triangles, and the way; the heights,
    equal ones made so; the edges they are on (m, 3, 3)."""
    on = weights[..., [2, 0, 1]] == 0.0  # edge k is from corner k to the next: the other one weighs nothing
    row, corner = np.nonzero(on.sum(axis=2) == 1)
    k = on[row, corner].argmax(axis=1)
    edge, back = shape.edge[cell[row], k], shape.place[cell[row], k] > shape.place[cell[row], (k + 1) % 3]
    first, last = weights[row, corner, k], weights[row, corner, (k + 1) % 3]
    t = np.where(back, first, last) / (first + last)

    pq = shape.base.pq
    long = np.linalg.norm(pq[:, _NEXT] - pq, axis=2).clip(1e-300)
    near = (_LEAN * np.ptp(pq, axis=(0, 1)).max() / long).clip(_SNAP, 0.05)
    close = np.zeros(len(lines.ends))
    np.maximum.at(close, shape.edge.reshape(-1), near.reshape(-1))
    end = (t <= close[edge]) | (t >= 1.0 - close[edge])
    on[row[end], corner[end]] = _CORNER[np.where((t[end] > 0.5) ^ back[end], (k[end] + 1) % 3, k[end])]
    row, corner, k, edge, t = row[~end], corner[~end], k[~end], edge[~end], t[~end]

    foot, way = np.full(w.shape, -1, np.int32), np.full(w.shape, -1, np.int32)
    order = np.lexsort((t, edge))
    fresh = np.concatenate([[True], (np.diff(edge[order]) != 0) | (np.diff(t[order]) > close[edge[order][1:]])])
    fresh = fresh[: len(order)]
    foot[row[order], corner[order]] = lines.count + np.cumsum(fresh) - 1
    way[row, corner] = shape.ribbon[cell[row], k]
    lines.edge, lines.t = edge[order][fresh].tolist(), t[order][fresh].tolist()
    row, corner = np.nonzero(on.sum(axis=2) >= 2)
    k = (on[row, corner][:, None] == _CORNER).all(axis=2).argmax(axis=1)
    foot[row, corner], way[row, corner] = shape.place[cell[row], k], shape.rise[cell[row], k]

    rim = foot >= 0
    at, heights = foot[rim], np.where(np.abs(w[rim]) <= lines.flat, 0.0, w[rim])
    order = np.lexsort((heights, at))
    fresh = np.concatenate([[True], (np.diff(at[order]) != 0) | (np.diff(heights[order]) > lines.flat)])
    heights[order] = heights[order][fresh][np.cumsum(fresh) - 1]
    w = w.copy()
    w[rim] = heights
    return foot, way, w, on


class _Span(NamedTuple):
    """A line of a lid's open edge, from foot to foot up its edge; its points, which way round it is the lid's; and its
    ribbon, -1 for the floor."""

    t0: float
    t1: float
    foot0: int
    foot1: int
    w0: float
    w1: float
    points: tuple[int, int]
    ribbon: int

    def height(self, foot: int, t: float) -> float:
        if foot in (self.foot0, self.foot1):
            return self.w0 if foot == self.foot0 else self.w1
        return self.w0 + (t - self.t0) / (self.t1 - self.t0) * (self.w1 - self.w0)


_Line = tuple[int, int]
_End = tuple[_Line, float, _Line, float]  # of a column, left or right: where it meets the one top and the other
_Cuts = dict[tuple[int, int], list[tuple[float, int]]]  # by a lid's edge: points to cut it at and where they are


def _joined(shape: Shape, lines: _Lines, lids: _Lids, slot: Ints) -> tuple[Ints, Ints]:
    """The lids with the walls between them: triangles (m, 3) and slots (m,)."""
    _, more, which = _edges(lids.points)
    each, first = np.unique(which, return_index=True)  # a sliver may run along an edge once more
    face, corner = np.divmod(first[more[each] > 0], 3)
    ahead = (corner + 1) % 3
    both = lids.on[face, corner] & lids.on[face, ahead]
    rim = both.any(axis=1)
    face, corner, ahead, k = face[rim], corner[rim], ahead[rim], both[rim].argmax(axis=1)
    ends = [
        tuple(zip(*(values[face, at].tolist() for values in (lids.foot, lids.way, lids.w, lids.points)), strict=True))
        for at in (corner, ahead)
    ]
    for foot, way, w, _ in (*ends[0], *ends[1]):
        if w not in lines.heights[foot, way]:
            insort(lines.heights[foot, way], w)

    uprights, tops = [], defaultdict(lambda: ([], []))  # type: ignore[var-annotated]
    edges, ribbons = shape.edge[lids.cell[face], k].tolist(), shape.ribbon[lids.cell[face], k].tolist()
    for edge, ribbon, one, two in zip(edges, ribbons, *ends, strict=True):
        (foot0, way, w0, point0), (foot1, _, w1, point1) = one, two
        if foot0 == foot1:
            uprights.append(((point0, point1), (foot0, way), w0, w1))
            continue
        ribbon = -1 if w0 == lines.floor else ribbon
        t0, t1 = lines.place(edge, foot0), lines.place(edge, foot1)
        if t0 < t1:
            tops[edge][0].append(_Span(t0, t1, foot0, foot1, w0, w1, (point0, point1), ribbon))
        else:
            tops[edge][1].append(_Span(t1, t0, foot1, foot0, w1, w0, (point0, point1), ribbon))
    cuts: _Cuts = defaultdict(list)
    columns = [column for edge, (one, two) in tops.items() for column in _columns(lines, edge, one, two, cuts)]

    # Only now are all points on all lines known.
    chains = {}
    for points, line, first, last in uprights:
        chains[points] = lines.between(line, first, last)[1:-1]
    for points, found in cuts.items():
        chains[points] = [point for _, point in sorted(found)]
    return _assembled(lids.points, slot, chains, [triangle for column in columns for triangle in _wall(lines, *column)])


def _columns(lines: _Lines, edge: int, one: list[_Span], two: list[_Span], cuts: _Cuts) -> list[tuple[_End, _End]]:
    """The columns of the wall on an edge of the mesh between the open spans of the top that runs up the edge and of
    that which runs down it; left and right ends of each. Says where the spans have to be cut."""
    for spans in (one, two):
        spans.sort()
        if any(after.t0 < before.t1 for before, after in pairwise(spans)):
            raise ValueError(f"a surface that overhangs at {_text(lines.corners[lines.ends[edge]].mean(axis=0))}")
    feet = sorted({end for span in (*one, *two) for end in ((span.t0, span.foot0), (span.t1, span.foot1))})
    columns = []
    for (s, left), (t, right) in pairwise(feet):
        a, b = _over(one, s, t), _over(two, s, t)
        if a is None or b is None:
            if a is not b:
                raise ValueError(f"a surface that is open at {_text(lines.corners[lines.ends[edge]].mean(axis=0))}")
            continue
        ribbons = [span.ribbon if span.ribbon >= 0 else a.ribbon + b.ribbon + 1 for span in (a, b)]
        gaps = [a.height(foot, at) - b.height(foot, at) for at, foot in ((s, left), (t, right))]
        stops = [(s, left), (t, right)]
        if ribbons[0] == ribbons[1] and gaps[0] * gaps[1] < 0.0 and min(abs(gap) for gap in gaps) > lines.flat:
            at = s + gaps[0] / (gaps[0] - gaps[1]) * (t - s)
            stops.insert(1, (at, lines.add(edge, at)))
        ends = []
        for at, foot in stops:
            end: list[tuple[_Line, float]] = []
            for span, ribbon in zip((a, b), ribbons, strict=True):
                line = lines.line(edge, foot, ribbon)
                end.append((line, lines.height(line, span.height(foot, at))))
                if foot not in (span.foot0, span.foot1):
                    way = at if span is a else -at
                    cut = (way, lines.point(*end[-1]))
                    if cut not in cuts[span.points]:
                        cuts[span.points].append(cut)
            ends.append((*end[0], *end[1]))
        columns += list(pairwise(ends))
    return columns


def _over(spans: list[_Span], s: float, t: float) -> _Span | None:
    """The span over the places from s to t."""
    k = bisect_right(spans, s, key=lambda span: span.t0) - 1
    return spans[k] if k >= 0 and spans[k].t1 >= t else None


def _wall(lines: _Lines, left: _End, right: _End) -> list[tuple[int, int, int]]:
    """A column's triangles between the points on its lines."""
    sides = []
    for one, first, two, last in (left, right):
        side = lines.between(one, first, last) if one == two else [lines.point(one, first), lines.point(two, last)]
        sides.append(side if side[0] != side[-1] else side[:1])
    ups, downs = sides
    i = j = 0
    made = []
    while i + 1 < len(ups) or j + 1 < len(downs):
        ahead = j + 1 == len(downs) or (i + 1 < len(ups) and (i + 1) * len(downs) <= (j + 1) * len(ups))
        made.append((downs[j], ups[i], ups[i + 1] if ahead else downs[j + 1]))
        i, j = (i + 1, j) if ahead else (i, j + 1)
    return [triangle for triangle in made if len(set(triangle)) == 3]


def _assembled(
    faces: Ints, slot: Ints, chains: dict[tuple[int, int], list[int]], wall: list[tuple[int, int, int]]
) -> tuple[Ints, Ints]:
    """The lids' triangles, cut at the chains of points on their edges, and the walls'; and slots."""
    made = list(wall)
    slots = [-1] * len(wall)
    count = int(faces.max()) + 1
    edges = np.stack([faces, faces[:, _NEXT]], axis=2).astype(np.int64) @ [count, 1]
    touched = np.isin(edges, [u * count + v for (u, v), chain in chains.items() if chain]).any(axis=1)
    for triangle, own in zip(faces[touched].tolist(), slot[touched].tolist(), strict=True):
        stack = [tuple(triangle)]
        while stack:
            a, b, c = stack.pop()
            for u, v, tip in ((a, b, c), (b, c, a), (c, a, b)):
                if chains.get((u, v)):
                    stack += [(p, q, tip) for p, q in pairwise((u, *chains[u, v], v))]
                    break
            else:
                made.append((a, b, c))
                slots.append(own)
    return (
        np.concatenate([faces[~touched], np.array(made, np.int32).reshape(-1, 3)]),
        np.concatenate([slot[~touched], np.array(slots, np.int32)]),
    )


def _edges(faces: Ints) -> tuple[NDArray[np.int64], Ints, Ints]:
    """Directed edges: the different ones and their backs (n, 2), how many more there are of each than of its back (n,),
    and which those of the faces (m, 3) are (3 m,)."""
    edges = np.stack([faces, faces[:, _NEXT]], axis=2).reshape(-1, 2).astype(np.int64)
    count = int(faces.max()) + 1
    codes, which = np.unique(np.concatenate([edges @ [count, 1], edges @ [1, count]]), return_inverse=True)
    more = np.bincount(which, np.repeat([1, -1], len(edges))).astype(np.int32)
    return np.stack([codes // count, codes % count], axis=1), more, which[: len(edges)].astype(np.int32)


def _filled(faces: Ints, places: Floats, feet: Ints) -> Ints:
    """Triangles (n, 3) that close what is still open: holes around one foot, and slits. `feet` are the points'."""
    edges, more, _ = _edges(faces)
    ahead: dict[int, list[int]] = defaultdict(list)
    for u, v in np.repeat(edges, more.clip(0), axis=0).tolist():
        ahead[u].append(v)
    loops: list[list[int]] = []
    for start in list(ahead):
        path = [start]
        while ahead[path[-1]]:  # what is open has as many edges to a point as from it
            point = ahead[path[-1]].pop()
            if point in path:
                loops.append(path[path.index(point) :])
                del path[path.index(point) + 1 :]
            else:
                path.append(point)
    made = [(loop[0], two, one) for loop in loops for one, two in pairwise(loop[1:])]
    filled = np.array(made, np.int32).reshape(-1, 3)
    corners = places[filled]
    around = feet[filled]
    sides = corners - corners[:, _NEXT]
    wide = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    wide = wide / np.linalg.norm(sides, axis=2).max(axis=1, initial=0.0).clip(1e-300)
    wrong = (around != around[:, _NEXT]).any(axis=1) & (wide > _SLIT * np.ptp(places, axis=0).max())
    if wrong.any():
        raise ValueError(f"a surface that is open at {_text(corners[wrong][0, 0])}")
    return filled
