"""The closed solid of a sphere or a cylinder with a pattern.

The solid of the flat pattern over the object's window is built as for a plate. Of its surface only the top is kept,
cut along the cells of a grid, and carried as `body` carries it: (p, q, w) to S(p, q) + w sigma N. What encloses the
inside then is
- at a sphere's poles nothing more, as every height comes to the same point there;
- at a cylinder's ends a cone over the edge, flat, as that edge lies in the end's plane;
- at the seam, where the window's last p meets its first and the pattern need not fit itself, the wall between the two
  edges of the top. Both are height fields over q, so the wall falls into columns between consecutive q, each bounded
  by one line of either edge. Where they cross there is a column's border.

All of it is assembled in pattern space, where points that belong together are equal bit for bit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer import body, mesh
from renderer.tables import SPHERE, Floats, Ints, Pattern

CELL = 0.018  # of the grid, radians: chords leave the surface by 4e-5 of its radius, a cell's diagonal by twice that

_SNAP = 1e-9  # places this close, in windows, are one
_LEAN = 2e-6  # and along the seam, where the solid's vertical walls lean by a hair, either way
_CROSS = 1e-12  # and heights, in windows


def slab(pattern: Pattern, window: tuple[float, float, float, float], limit: int) -> mesh.SolidMesh:
    """The solid cut square at the window's edge, with vertices exactly on it."""
    p0, q0, p1, q1 = window
    # The solid that `build` makes ends at window + margin: so hand in a window that much too small.
    margin = 0.01 * min(p1 - p0, q1 - q0)
    inner = (p0 + margin, q0 + margin, p1 - margin, q1 - margin)
    solid = mesh.build(pattern, inner, margin=margin, limit=limit)
    for values, first, last in ((solid.vertices[:, 0], p0, p1), (solid.vertices[:, 1], q0, q1)):
        values[np.abs(values - first) < _SNAP * (last - first)] = first
        values[np.abs(values - last) < _SNAP * (last - first)] = last
    return solid


def wrapped(obj: np.void, pattern: Pattern, limit: int) -> tuple[Floats, Ints, Ints]:
    """The solid: vertices (n, 3) in the world, triangles (m, 3), material slots (m,).

    Raises ValueError where a groove reaches the middle of the object, or where there are too many triangles.
    """
    base = body.round_base(obj)
    su, sv, du, dv = (float(value) for value in obj["mapping"])
    window = (du, dv, du + su, dv + sv)
    p0, q0, p1, q1 = window
    sphere = base.shape == SPHERE
    radius, tall = float(base.size[0]), math.pi * float(base.size[0]) if sphere else float(base.size[1])
    deepest = pattern.depth * math.sqrt(2.0 * math.pi * radius * tall / (su * sv))
    if not deepest < 0.999 * radius:
        raise ValueError(f"a groove of depth {deepest:g} in a radius of {radius:g}")

    solid = slab(pattern, window, limit)
    flat = solid.vertices[solid.triangles]
    p, q, w = np.moveaxis(flat, 2, 0)
    out = [p == p0, p == p1, q == q0, q == q1, w == solid.vertices[:, 2].min()]
    top = np.flatnonzero(~np.any([side.all(axis=1) for side in out], axis=0))
    parts, source, _ = body.cut(base, flat[top], CELL, limit)
    slot = solid.slot[top[source]]

    parts, more = _seamed(parts, window)
    slot = np.concatenate([slot[more[more >= 0]], np.full(int((more < 0).sum()), -1, np.int32)])
    parts[..., 0][parts[..., 0] == p1] = p0
    if sphere:
        parts[parts[..., 1] == q0] = (p0, q0, 0.0)
        parts[parts[..., 1] == q1] = (p0, q1, 0.0)
    points, faces = _welded(parts)
    kept = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces, slot = faces[kept], slot[kept]
    places = body.carry(base, points, np.zeros(0, np.int32))
    if sphere:
        for end, z in ((q0, -radius), (q1, radius)):
            places[points[:, 1] == end] = (0.0, 0.0, z)
    else:
        for end, z in ((q0, -0.5 * tall), (q1, 0.5 * tall)):
            cap = _cap(points, faces, end, len(places), 1e-9 * su)
            places = np.concatenate([places, [[0.0, 0.0, z]]])
            faces = np.concatenate([faces, cap])
            slot = np.concatenate([slot, np.full(len(cap), -1, np.int32)])
    return np.asarray(obj["translation"] + places @ obj["rotation"].T), faces, slot


def _welded(parts: Floats) -> tuple[Floats, Ints]:
    """Triangles (n, 3, 3) as points, no two the same, and rows of them (n, 3)."""
    rows = parts.reshape(-1, 3) + 0.0
    order = np.lexsort(rows.T)
    ordered = rows[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)])
    index = np.empty(len(rows), np.int32)
    index[order] = np.cumsum(new) - 1
    return ordered[new], index.reshape(-1, 3)


def _open(faces: Ints) -> tuple[Ints, Ints]:
    """The directed edges (n, 2) that no triangle runs back along, and which they are (n,): 3 face + corner."""
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    n = int(edges.max(initial=0)) + 1
    alone = ~np.isin(edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0])
    alone &= edges[:, 0] != edges[:, 1]
    return edges[alone].astype(np.int32), np.flatnonzero(alone).astype(np.int32)


class _Edge:
    """One edge of the top along the seam, a height field over q with steps.

    lines: (n, 4) q, w, q, w of its lines by rising q; steps: (m, 3) q, w, w.
    """

    def __init__(self, ends: Floats) -> None:
        """ends: (n, 2, 2) (q, w) of its pieces, either way round."""
        level = ends[:, 0, 0] == ends[:, 1, 0]
        turned = ends[:, 0, 0] > ends[:, 1, 0]
        ends = np.where(turned[:, None, None], ends[:, ::-1], ends)
        self.steps = np.column_stack([ends[level, 0], ends[level, 1, 1]])
        lines = ends[~level].reshape(-1, 4)
        self.lines = lines[np.argsort(lines[:, 0])]
        if not len(lines) or (self.lines[1:, 0] != self.lines[:-1, 2]).any():
            raise ValueError("a surface that overhangs at the seam")

    def heights(self, q: Floats) -> Floats:
        """(n - 1, 2): w at both ends of the columns between consecutive q (n,), which hold all of the lines' ends."""
        line = self.lines[np.searchsorted(self.lines[:, 0], q[:-1], side="right") - 1]
        w = np.empty((len(q) - 1, 2))
        for k, at in enumerate((q[:-1], q[1:])):
            w[:, k] = line[:, 1] + (at - line[:, 0]) / (line[:, 2] - line[:, 0]) * (line[:, 3] - line[:, 1])
            w[:, k] = np.where(at == line[:, 0], line[:, 1], np.where(at == line[:, 2], line[:, 3], w[:, k]))
        return w


def _seamed(parts: Floats, window: tuple[float, float, float, float]) -> tuple[Floats, Ints]:
    """The top's triangles (n, 3, 3) with the seam's wall among them, and which each comes from: -1, the wall."""
    p0, q0, p1, q1 = window
    points, faces = _welded(parts)
    # Along a step, and where cells and facets meet, places differ by a little: make them one.
    on = np.flatnonzero((points[:, 0] == p0) | (points[:, 0] == p1))
    at, back = np.unique(points[on, 1], return_inverse=True)
    first = np.concatenate([[True], np.diff(at) > _LEAN * (q1 - q0)])
    at = at[first][np.cumsum(first) - 1]
    at[at > q1 - _LEAN * (q1 - q0)] = q1
    points[on, 1] = at[back.reshape(-1)]

    edges, which = _open(faces)
    ends = points[edges]
    sides, chosen = [], []
    for p in (p0, p1):
        here = (ends[:, :, 0] == p).all(axis=1)
        sides.append(_Edge(ends[here][:, :, 1:]))
        chosen.append(here)
    q = np.unique(np.concatenate([side.lines[:, [0, 2]].reshape(-1) for side in sides]))
    a, b = (side.heights(q) for side in sides)
    q = np.union1d(q, _crossings(q, a, b, _CROSS * (q1 - q0), _SNAP * (q1 - q0)))
    a, b = (side.heights(q) for side in sides)
    nodes = _nodes(q, sides, a, b)

    wall = []
    for k in range(len(q) - 1):
        left, right = (nodes[k + i][_between(nodes[k + i], a[k, i], b[k, i])] for i in (0, 1))
        if a[k, 0] > b[k, 0]:
            left = left[::-1]
        if a[k, 1] > b[k, 1]:
            right = right[::-1]
        wall += _zip(p0, q[k], left, q[k + 1], right)
    made, source = _split(points, faces, which[chosen[0] | chosen[1]], q, nodes, {p0: a, p1: b})
    if not wall:
        return made, source
    return np.concatenate([made, np.array(wall)]), np.concatenate([source, np.full(len(wall), -1, np.int32)])


def _crossings(q: Floats, a: Floats, b: Floats, flat: float, near: float) -> Floats:
    """Where lines with heights a and b (n - 1, 2) at the columns' ends cross within them."""
    gap = a - b
    row = np.flatnonzero((gap[:, 0] * gap[:, 1] < 0.0) & (np.abs(gap).max(axis=1) > flat))
    at = q[row] + gap[row, 0] / (gap[row, 0] - gap[row, 1]) * (q[row + 1] - q[row])
    return np.asarray(at[(at - q[row] > near) & (q[row + 1] - at > near)])


def _nodes(q: Floats, sides: list[_Edge], a: Floats, b: Floats) -> list[Floats]:
    """At each q all the heights of the seam's points, rising."""
    found: list[list[float]] = [[] for _ in q]
    for w in (a, b):
        for k, (low, high) in enumerate(w.tolist()):
            found[k].append(low)
            found[k + 1].append(high)
    for side in sides:
        for k, (_, low, high) in zip(np.searchsorted(q, side.steps[:, 0]).tolist(), side.steps.tolist(), strict=True):
            found[k] += [low, high]
    return [np.unique(heights) for heights in found]


def _between(heights: Floats, one: float, two: float) -> NDArray[np.bool_]:
    return (heights >= min(one, two)) & (heights <= max(one, two))


def _zip(p: float, q0: float, left: Floats, q1: float, right: Floats) -> list[list[tuple[float, float, float]]]:
    """Triangles between the points at q0 and at q1, heights in `left` and `right`, both from the first edge on."""
    i = j = 0
    made = []
    while i + 1 < len(left) or j + 1 < len(right):
        ahead = j + 1 == len(right) or (i + 1 < len(left) and (i + 1) * len(right) <= (j + 1) * len(left))
        tip = (p, q0, float(left[i + 1])) if ahead else (p, q1, float(right[j + 1]))
        made.append([(p, q0, float(left[i])), (p, q1, float(right[j])), tip])
        i, j = (i + 1, j) if ahead else (i, j + 1)
    return made


def _split(
    points: Floats, faces: Ints, which: Ints, q: Floats, nodes: list[Floats], heights: dict[float, Floats]
) -> tuple[Floats, Ints]:
    """The triangles as (n, 3, 3), those with an edge at the seam (`which`: 3 face + corner) split at the seam's
    points; and which they come from."""
    rows, corners = which // 3, which % 3
    u, v = points[faces[rows, corners]], points[faces[rows, (corners + 1) % 3]]
    tips = points[faces[rows, (corners + 2) % 3]]
    starts, ends = np.searchsorted(q, u[:, 1]), np.searchsorted(q, v[:, 1])
    made, source = [], []
    for row, one, two, tip, i, j in zip(rows.tolist(), u, v, tips, starts.tolist(), ends.tolist(), strict=True):
        p = float(one[0])
        if i == j:
            inner = nodes[i][(nodes[i] > min(one[2], two[2])) & (nodes[i] < max(one[2], two[2]))]
            line = np.column_stack([np.full(len(inner), p), np.full(len(inner), q[i]), inner])
            line = line if one[2] < two[2] else line[::-1]
        else:
            inside = np.arange(min(i, j) + 1, max(i, j))
            line = np.column_stack([np.full(len(inside), p), q[inside], heights[p][inside, 0]])
            line = line if i < j else line[::-1]
        line = np.concatenate([one[None], line, two[None]])
        made.append(np.stack([line[:-1], line[1:], np.broadcast_to(tip, (len(line) - 1, 3))], axis=1))
        source += [row] * (len(line) - 1)
    rest = np.ones(len(faces), np.bool_)
    rest[rows] = False
    kept = np.flatnonzero(rest)
    if len(np.unique(rows)) < len(rows):
        raise ValueError("a triangle with two edges at the seam")
    return np.concatenate([points[faces[kept]], *made]), np.concatenate([kept, source]).astype(np.int32)


def _cap(points: Floats, faces: Ints, end: float, middle: int, near: float) -> Ints:
    """A cylinder's end: triangles (n, 3) from the open edges at q = end to the point `middle`.

    A step of the edge points to the middle, so that its triangle has no area: it takes some of its neighbour's.
    """
    edges, _ = _open(faces)
    edges = edges[(points[edges, 1] == end).all(axis=1)]
    cone = {int(u): int(v) for v, u in edges}  # the triangle (u, v, middle)
    if len(cone) < len(edges):  # an edge that touches itself
        return np.column_stack([edges[:, ::-1], np.full(len(edges), middle, np.int32)])
    made = []
    p, w = points[:, 0], points[:, 2]
    before = {v: u for u, v in cone.items()}
    steps = [(u, v) for u, v in cone.items() if abs(p[u] - p[v]) < near]
    # The farthest out first: its neighbour beyond lies to one side, and so does, next, that of the one below.
    for u, v in sorted(steps, key=lambda step: -max(w[step[0]], w[step[1]])):
        if cone.get(u) != v:
            continue
        out = v if w[v] > w[u] else u
        other = cone[v] if out == v else before[u]
        if abs(p[other] - p[out]) < near:
            continue
        made.append((u, v, other) if out == v else (other, u, v))
        one, two = (u, other) if out == v else (other, v)
        del cone[out if out == v else u], before[out if out == u else v]
        cone[one], before[two] = two, one
    return np.array([*made, *((u, v, middle) for u, v in cone.items())], np.int32)
