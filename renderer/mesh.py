"""The solid of a pattern (DESIGN 1.2) as a closed triangle mesh, by booleans of swept pieces.

This is the ground truth that every other method is held against, so it shares nothing with them but the tables. One
priority at a time, lowest first, with all the pieces of that priority:

    solid = ((solid - bands above w = 0) + bands below w = 0 + additions) - removals

The bands are those of DESIGN 1.2: inside them a higher priority starts again from a flat plate. The lowest priority
starts from a plate anyway. Written so, no two solids that meet in a vertical wall are ever joined, which booleans
are bad at.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from manifold3d import Error, Manifold, OpType
from numpy.typing import NDArray

from renderer.sweep import (
    End,
    Faces,
    Facets,
    Prism,
    Ribbon,
    Stroke,
    block,
    extent,
    faces_of,
    positions,
    ribbons,
    solid,
    strokes_of,
    sweep,
)
from renderer.tables import Floats, Ints, Pattern

LIMIT = 4_000_000
"""The most triangles that `build` makes."""

_CELLS = 512  # of the grid that tells which pieces are apart, along either side


class SolidMesh(NamedTuple):
    """A closed mesh, outward triangles anticlockwise."""

    vertices: Floats  # (n, 3) pattern units (p, q, w)
    triangles: Ints  # (m, 3)
    slot: Ints  # (m,) material slot: -1 the object's own, else as Pattern.facet_slot
    bend: Floats  # (m, 4) of facets swept along an arc: its centre (p, q) and the normal's part away from it and up,
    # so that normals are not those of the chords; 0 for all others


class _Box(NamedTuple):
    p0: float
    q0: float
    p1: float
    q1: float


class _Copy(NamedTuple):
    ribbon: Ribbon | Prism
    shift: tuple[float, float]


def build(
    pattern: Pattern,
    window: tuple[float, float, float, float],
    *,
    arc_tolerance: float | None = None,
    margin: float | None = None,
    limit: int = LIMIT,
) -> SolidMesh:
    """The solid over `window` (p0, q0, p1, q1), and a margin around it whose grooves cast their shadows into it.

    `arc_tolerance` is how far chords may leave arcs and curved scales (default: ARC of the groove's half-width).
    Raises ValueError where the mesh would have more than `limit` triangles.
    """
    p0, q0, p1, q1 = window
    if not (p1 > p0 and q1 > q0 and all(math.isfinite(v) for v in window)):
        raise ValueError(f"window: expected p0 < p1 and q0 < q1, found {window}")
    tall = pattern.height + pattern.depth
    if margin is None:
        margin = max(4.0 * pattern.reach, 4.0 * tall) or 0.05 * max(p1 - p0, q1 - q0)
    box = _Box(p0 - margin, q0 - margin, p1 + margin, q1 + margin)
    above = 2.0 * pattern.height + max(tall, 1e-3 * margin)
    below = -(2.0 * pattern.depth + max(tall, 1e-3 * margin))

    levels = _levels(pattern, box, arc_tolerance, above, 0.5 * (below - pattern.depth))
    _check(levels, limit)

    tower = max(above - below, 1e-3 * margin)
    plate = _Box(box.p0 - 0.01 * margin, box.q0 - 0.01 * margin, box.p1 + 0.01 * margin, box.q1 + 0.01 * margin)
    whole = _block(plate if levels else box, below, 0.0)
    known = Facets()
    raised = lowered = False
    for level in levels:
        if raised and level["clear"]:
            whole = _join([whole, *_solids(level["clear"], box, known)], OpType.Subtract)
        fill = level["fill"] if lowered else []
        if fill or level["add"]:
            whole = _join([whole, *_solids(fill, box, known), *_solids(level["add"], box, known)], OpType.Add)
        if level["remove"]:
            whole = _join([whole, *_solids(level["remove"], box, known)], OpType.Subtract)
        raised, lowered = raised or bool(level["add"]), lowered or bool(level["remove"])
    if levels:
        whole = _join([whole, _block(box, below - tower, above + tower)], OpType.Intersect)
    return _mesh(pattern, whole, known)


def _levels(
    pattern: Pattern, box: _Box, arc_tolerance: float | None, above: float, below: float
) -> list[dict[str, list[_Copy]]]:
    """For each priority, lowest first, the ribbons that reach the box."""
    tile = (float(pattern.grid.tile[0]), float(pattern.grid.tile[1]))
    found: dict[int, dict[str, list[_Copy]]] = {}
    for index in range(len(pattern.pieces)):
        for stroke in strokes_of(pattern, index, arc_tolerance):
            for shift in _shifts(stroke, tile, box):
                here = _Box(box.p0 - shift[0], box.q0 - shift[1], box.p1 - shift[0], box.q1 - shift[1])
                for part in _crop(stroke, here):
                    level = found.setdefault(stroke.priority, {"add": [], "remove": [], "clear": [], "fill": []})
                    for kind, made in ribbons(part, top=above, bottom=below).items():
                        level[kind] += [_Copy(ribbon, shift) for ribbon in made]
    return [found[priority] for priority in sorted(found)]


def _width(stroke: Stroke) -> float:
    """How far the stroke gets from its line sideways."""
    return max(abs(float(stroke.section.b[0])), abs(float(stroke.section.b[-1]))) * stroke.scale.most + stroke.hair


def _span(stroke: Stroke) -> tuple[float, float, float, float]:
    """The least and the greatest s, and s beyond which it has started and before which it has not finished."""
    section = stroke.section
    at = np.concatenate([section.b, [0.0]]) if section.b[0] < 0.0 < section.b[-1] else section.b
    start, finish = extent(stroke, 0, at), extent(stroke, 1, at)
    return float(start.min()), float(finish.max()), float(start.max()), float(finish.min())


def _samples(stroke: Stroke) -> tuple[Floats, Floats, Floats, float]:
    """Points of the centre line (s, p, q), and the distance that the line may stray from their chords."""
    low, high, _, _ = _span(stroke)
    count = 2 if stroke.curvature == 0.0 else 65
    s = np.linspace(low, high, count)
    p, q = positions(stroke, s, np.zeros(count))
    step = 0.0 if stroke.curvature == 0.0 else (high - low) / (count - 1)
    return s, p, q, step


def _shifts(stroke: Stroke, tile: tuple[float, float], box: _Box) -> list[tuple[float, float]]:
    """The tiles whose copy of the stroke may reach the box."""
    _, p, q, stray = _samples(stroke)
    far = _width(stroke) + stray
    ranges: list[list[float]] = []
    for low, high, size, first, last in (
        (float(p.min()) - far, float(p.max()) + far, tile[0], box.p0, box.p1),
        (float(q.min()) - far, float(q.max()) + far, tile[1], box.q0, box.q1),
    ):
        if size > 0.0:
            ranges.append(
                [k * size for k in range(math.ceil((first - high) / size), math.floor((last - low) / size) + 1)]
            )
        else:
            ranges.append([0.0] if high >= first and low <= last else [])
    return [(dp, dq) for dp in ranges[0] for dq in ranges[1]]


def _crop(stroke: Stroke, box: _Box) -> list[Stroke]:
    """The stroke without what cannot reach the box, so that long paths cost nothing outside it."""
    far = _width(stroke)
    if stroke.closed:
        _, p, q, stray = _samples(stroke)
        far += stray
        if p.min() - far >= box.p0 and p.max() + far <= box.p1 and q.min() - far >= box.q0 and q.max() + far <= box.q1:
            return [stroke]
        parts, turn = 6, stroke.length / 6
        cut = [
            stroke._replace(closed=False, start=End(i * turn - stroke.hair), finish=End((i + 1) * turn + stroke.hair))
            for i in range(parts)
        ]
        return [one for part in cut for one in _crop(part, box)]
    low, high, started, unfinished = _span(stroke)
    s, p, q, stray = _samples(stroke)
    far += stray
    if stroke.curvature == 0.0:
        enter, leave = 0.0, 1.0
        for a, d, first, last in (
            (p[0], p[1] - p[0], box.p0 - far, box.p1 + far),
            (q[0], q[1] - q[0], box.q0 - far, box.q1 + far),
        ):
            if d == 0.0:
                if not first <= a <= last:
                    return []
                continue
            near, beyond = sorted(((first - a) / d, (last - a) / d))
            enter, leave = max(enter, float(near)), min(leave, float(beyond))
        if enter > leave:
            return []
        first_s, last_s = low + enter * (high - low), low + leave * (high - low)
    else:
        inside = (p >= box.p0 - far) & (p <= box.p1 + far) & (q >= box.q0 - far) & (q <= box.q1 + far)
        hit = np.flatnonzero(inside)
        if len(hit) == 0:
            return []
        first_s, last_s = float(s[max(hit[0] - 1, 0)]), float(s[min(hit[-1] + 1, len(s) - 1)])
    if first_s > started and first_s > low:
        stroke = stroke._replace(start=End(first_s))
    if last_s < unfinished and last_s < high:
        stroke = stroke._replace(finish=End(last_s))
    return [stroke]


def _check(levels: list[dict[str, list[_Copy]]], limit: int) -> None:
    """Refuse what would become too large, before anything is built."""
    total = 0.0
    chords: list[Floats] = []
    facets: list[float] = []
    for number, level in enumerate(levels):
        for kind, copies in level.items():
            if kind in ("add", "remove") or number:
                total += sum(copy.ribbon.triangles() for copy in copies)
        for copy in level["clear"]:
            _, p, q, _ = _samples(copy.ribbon.stroke)
            every = slice(None, None, 8) if len(p) > 2 else slice(None)
            p, q = p[every] + copy.shift[0], q[every] + copy.shift[1]
            chords.append(np.stack([p[:-1], q[:-1], p[1:], q[1:]], axis=1))
            facets += [float(len(copy.ribbon.section.b) - 1)] * (len(p) - 1)
    if chords:
        total += _crossings(np.concatenate(chords), np.array(facets))
    if total > limit:
        raise ValueError(f"the solid would need {int(total)} triangles, more than {limit}")


def _crossings(chords: Floats, facets: Floats) -> float:
    """About how many triangles the crossings of the paths add, from some of the chords against all."""
    n = len(chords)
    some = np.random.default_rng(0).permutation(n)[:400]

    def side(a: Floats, c: Floats) -> Floats:
        """On which sides of the chords `a` the ends of the chords `c` are: their product."""
        dx, dy = (a[..., 2] - a[..., 0]), (a[..., 3] - a[..., 1])
        first = dx * (c[..., 1] - a[..., 1]) - dy * (c[..., 0] - a[..., 0])
        last = dx * (c[..., 3] - a[..., 1]) - dy * (c[..., 2] - a[..., 0])
        return np.asarray(first * last, np.float64)

    total = 0.0
    for i in some:
        crossed = (side(chords[i], chords) < 0.0) & (side(chords, chords[i]) < 0.0)
        total += 4.0 * float(facets[i]) * float(facets[crossed].sum())
    return 0.5 * total * n / len(some)


def _solids(copies: list[_Copy], box: _Box, known: Facets) -> list[Manifold]:
    """The swept solids, those that are well apart put together in one: booleans take time for every solid."""
    if len(copies) < 3:
        return [solid([sweep(copy.ribbon, copy.shift, known)]) for copy in copies]
    taken: list[NDArray[np.bool_]] = []
    groups: list[list[Faces]] = []
    for copy in copies:
        cells = _cells(copy, box)
        for i in range(len(groups) + 1):
            if i == len(groups):
                taken.append(np.zeros((_CELLS, _CELLS), np.bool_))
                groups.append([])
            if not (taken[i] & cells).any():
                break
        taken[i] |= cells
        groups[i].append(sweep(copy.ribbon, copy.shift, known))
    return [solid(group) for group in groups]


def _cells(copy: _Copy, box: _Box) -> NDArray[np.bool_]:
    """The cells of a fine grid over the box that a ribbon may touch (and maybe some beside them)."""
    ribbon, stroke = copy.ribbon, copy.ribbon.stroke
    cell = max(box.p1 - box.p0, box.q1 - box.q0) / _CELLS
    b0, b1 = float(ribbon.section.b[0]), float(ribbon.section.b[-1])
    half = _width(stroke)
    across = 2 + math.ceil((b1 - b0) * stroke.scale.most / (0.7 * cell))
    b = np.linspace(b0, b1, across)
    start, finish = extent(stroke, 0, b), extent(stroke, 1, b)
    if stroke.closed:
        start, finish = np.zeros(across), np.full(across, stroke.length)
    span = float(np.abs(finish - start).max()) * (1.0 + abs(stroke.curvature) * half)
    along = 2 + math.ceil(span / (0.7 * cell))
    u = np.linspace(0.0, 1.0, along)[:, None]
    s = (1.0 - u) * start + u * finish
    p, q = positions(stroke, s, stroke.scale(s) * b)
    x, y = (p + copy.shift[0] - box.p0) / cell, (q + copy.shift[1] - box.q0) / cell
    marked = np.zeros((_CELLS, _CELLS), np.bool_)
    columns = [np.clip(x + d, 0, _CELLS - 1).astype(np.int32) for d in (-0.6, 0.6)]
    rows = [np.clip(y + d, 0, _CELLS - 1).astype(np.int32) for d in (-0.6, 0.6)]
    for row in rows:
        for column in columns:
            marked[row, column] = True
    return marked


def _join(parts: list[Manifold], how: OpType) -> Manifold:
    made = Manifold.batch_boolean(parts, how)
    if made.status() != Error.NoError:
        raise ValueError(f"the boolean of the solid failed: {made.status()}")
    return made


def _block(box: _Box, low: float, high: float) -> Manifold:
    """A block with no facets of its own."""
    p, q = np.array([box.p0, box.p1, box.p0, box.p1]), np.array([box.q0, box.q0, box.q1, box.q1])
    return solid([block(p, q, low, high)])


def _mesh(pattern: Pattern, whole: Manifold, known: Facets) -> SolidMesh:
    made = faces_of(whole)
    rows = np.array(known.rows)[made.tags]
    names = np.concatenate([np.asarray(pattern.facet_slot, np.int32), [-1]]).astype(np.int32)
    return SolidMesh(
        made.vertices,
        np.ascontiguousarray(made.triangles, np.int32),
        names[rows[:, 0].astype(np.int64)],
        np.ascontiguousarray(rows[:, 1:]),
    )
