"""Strokes: pieces of a pattern with their ends made explicit, and solids swept along them.

A *stroke* is a straight or circular path with a cross-section polyline. In its local frame (s along the path, b to
the left of it, w up) it covers `start(b) <= s <= finish(b)`, where each end is `at + slope * b + wedge * |b|`: square,
mitred or a wedge, which is all that the ends of DESIGN 1.2 need. Triangles carry the number of the facet they lie on
(see `Facets`); 0 stands for a wall that no facet makes.

Everything here is exact for straight strokes whose scale is constant or linear. Arcs, and scales that vary in another
way, are cut into rings that stay within a given tolerance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from manifold3d import Error, Manifold, Mesh64, OpType
from numpy.typing import NDArray

from renderer.outline import Outline, Shape, added, removed
from renderer.tables import (
    CORNER,
    FLAT,
    PROFILE,
    SCALE_CONSTANT,
    SCALE_LINEAR,
    SCALE_SINE,
    SCALE_TABLE,
    SMOOTH,
    Floats,
    Ints,
    Pattern,
)

HAIR = 1e-6
"""How far pieces that would only touch are made to overlap, as a share of the groove's half-width. Removed solids that
only touch leave a wall of no thickness between them, which still casts shadows."""

ARC = 2e-3  # how far chords may leave arcs, as a share of the groove's half-width; a quarter where the scale varies

_TURN = math.radians(3.0)  # the largest angle of an arc between two rings, whatever the tolerance
_THIN = 1e-6  # the smallest scale, as a share of the groove's largest: keeps a groove that fades out a valid solid


class End(NamedTuple):
    """Where a stroke ends: s = at + slope * b + wedge * |b|; for arcs the slope is that of a straight line drawn across
    the end point, in the frame of the tangent there."""

    at: float
    slope: float = 0.0
    wedge: float = 0.0


class Section(NamedTuple):
    """A cross-section: the polyline from left to right at scale 1."""

    b: Floats  # (n,)
    w: Floats  # (n,)
    facet: Ints  # (n - 1,) facet index within the profile


class Scale(NamedTuple):
    """f(t) * size along a stroke, t = t0 + (t1 - t0) * s / length; past the piece's ends it keeps the end's value."""

    kind: int
    a: float
    b: float
    c: float
    table: Floats  # (r, 2)
    t0: float
    t1: float
    length: float
    size: float
    most: float  # the largest value, size included

    def __call__(self, s: Floats) -> Floats:
        if self.kind == SCALE_CONSTANT:
            return np.full(np.shape(s), self.size)
        t = self.t0 + (self.t1 - self.t0) * np.clip(np.asarray(s, np.float64) / self.length, 0.0, 1.0)
        if self.kind == SCALE_LINEAR:
            f = self.a + (self.b - self.a) * t
        elif self.kind == SCALE_SINE:
            f = 1.0 + self.a * np.sin(2.0 * math.pi * self.b * t + self.c)
        else:
            f = np.interp(t, self.table[:, 0], self.table[:, 1])
        return np.maximum(f * self.size, _THIN * self.most)


class Stroke(NamedTuple):
    """A path with a cross-section, cut at its two ends."""

    x: float
    y: float
    tx: float
    ty: float
    curvature: float
    length: float  # where the finish's frame stands
    start: End
    finish: End
    closed: bool  # a whole circle without ends
    section: Section
    scale: Scale
    slot: int  # the groove's first row of Pattern.facet_slot
    inner: tuple[int, int]  # internal facets, first and beyond the last
    priority: int
    hair: float
    tolerance: float
    outline: Outline | None  # of a profile that overhangs; its section is then level, and has but the places b
    trims: tuple[End | None, End | None] = None, None  # planes that its swept solids are cut at


def scale_of(pattern: Pattern, piece: np.void) -> Scale:
    groove = pattern.grooves[piece["groove"]]
    first, size = int(groove["table_start"]), float(piece["size"])
    kind = int(groove["scale_kind"])
    table = pattern.scale_table[first : first + int(groove["table_count"])]
    a, b, c = (float(groove[name]) for name in ("scale_a", "scale_b", "scale_c"))
    most = {SCALE_CONSTANT: 1.0, SCALE_LINEAR: max(a, b), SCALE_SINE: 1.0 + abs(a)}.get(kind, 0.0)
    if kind == SCALE_TABLE:
        most = float(table[:, 1].max())
    t0, t1, length = float(piece["t0"]), float(piece["t1"]), float(piece["length"])
    return Scale(kind, a, b, c, table, t0, t1, length, size, max(most * size, 1e-300))


def section_of(pattern: Pattern, piece: np.void) -> Section:
    """The whole cross-section, with a point wherever the polyline crosses w = 0."""
    row = pattern.profiles[pattern.grooves[piece["groove"]]["profile"]]
    points = pattern.points[row["start"] : row["start"] + row["count"]]
    b, w = points[:, 0].astype(np.float64), points[:, 1].astype(np.float64)
    out_b, out_w, out_f = [b[0]], [w[0]], []
    for i in range(len(b) - 1):
        if w[i] * w[i + 1] < 0.0:
            share = w[i] / (w[i] - w[i + 1])
            out_b.append(b[i] + share * (b[i + 1] - b[i]))
            out_w.append(0.0)
            out_f.append(i)
        out_b.append(b[i + 1])
        out_w.append(w[i + 1])
        out_f.append(i)
    return Section(np.array(out_b), np.array(out_w), np.array(out_f, np.int32))


def outline_of(pattern: Pattern, piece: np.void) -> Outline | None:
    """The cross-section, where it overhangs."""
    index = int(pattern.grooves[piece["groove"]]["profile"])
    if not len(pattern.part_first) or pattern.part_first[index] == pattern.part_first[index + 1]:
        return None
    row = pattern.profiles[index]
    return Outline(
        pattern.points[row["start"] : row["start"] + row["count"]],
        pattern.parts[pattern.part_first[index] : pattern.part_first[index + 1]],
        (int(row["inner_first"]), int(row["inner_last"])),
    )


def insert(section: Section, at: Floats) -> Section:
    """The same polyline with points at these b, where it has none."""
    b, w, facet = section
    for value in at:
        i = int(np.searchsorted(b, value))
        near = 1e-12 * (b[-1] - b[0])
        if 0 < i < len(b) and b[i] - value > near and value - b[i - 1] > near:
            height = w[i - 1] + (value - b[i - 1]) / (b[i] - b[i - 1]) * (w[i] - w[i - 1])
            b, w, facet = np.insert(b, i, value), np.insert(w, i, height), np.insert(facet, i, facet[i - 1])
    return Section(b, w, facet)


def between(section: Section, low: float, high: float) -> Section | None:
    """The part of the polyline over low <= b <= high, None where it has no width."""
    section = insert(section, np.array([low, high]))
    near = 1e-12 * max(abs(section.b[0]), abs(section.b[-1]))
    keep = np.flatnonzero((section.b >= low - near) & (section.b <= high + near))
    if len(keep) < 2:
        return None
    first, last = int(keep[0]), int(keep[-1])
    if section.b[last] - section.b[first] <= near:
        return None
    return Section(section.b[first : last + 1], section.w[first : last + 1], section.facet[first:last])


def strokes_of(pattern: Pattern, index: int, tolerance: float | None) -> list[Stroke]:
    """The strokes of a piece: its body and what its ends add."""
    piece = pattern.pieces[index]
    groove = pattern.grooves[piece["groove"]]
    row = pattern.profiles[groove["profile"]]
    section, scale, outline = section_of(pattern, piece), scale_of(pattern, piece), outline_of(pattern, piece)
    if outline is not None:
        places = outline.places
        tallest = float(np.abs(section.w).max())
        section = Section(places, np.full(len(places), tallest), np.full(len(places) - 1, -1, np.int32))
    left, right = float(section.b[0]), float(section.b[-1])
    half = max(abs(left), abs(right)) * scale.most
    if not right > left or not half > 0.0:
        return []
    hair = HAIR * half
    length, curvature = float(piece["length"]), float(piece["curvature"])
    exact = scale.kind == SCALE_CONSTANT  # then normals are those of the arc, not of its chords
    tol = (ARC if exact else 0.25 * ARC) * half if tolerance is None else tolerance
    body = Stroke(
        x=float(piece["x"]),
        y=float(piece["y"]),
        tx=float(piece["tx"]),
        ty=float(piece["ty"]),
        curvature=curvature,
        length=length,
        start=End(0.0),
        finish=End(length),
        closed=False,
        section=section,
        scale=scale,
        slot=int(groove["slot"]),
        inner=(int(row["inner_first"]), int(row["inner_last"])),
        priority=int(groove["priority"]),
        hair=hair,
        tolerance=tol,
        outline=outline,
    )
    if piece["closed"]:
        seam = scale(np.array([0.0, length]))
        if abs(seam[0] - seam[1]) <= 1e-9 * scale.most:
            return [body._replace(closed=True)]
        return arcs(body._replace(start=End(-hair), finish=End(length + hair)))
    merge = curvature == 0.0 and scale.kind == SCALE_CONSTANT
    ratio = right / -left if left < 0.0 else math.inf  # of the half-widths, right to left
    strokes: list[Stroke] = []
    kinds, cuts = (int(piece["start_end"]), int(piece["finish_end"])), [End(0.0), End(length)]
    for which in (0, 1):
        outward = 2 * which - 1  # +1 at the finish
        at = length * which
        mitre = float(piece[("start_mitre", "finish_mitre")[which]])
        kind = FLAT if kinds[which] == PROFILE and right <= 0.0 else kinds[which]
        if kind == SMOOTH:
            cuts[which] = End(at + outward * hair)
        elif kind == CORNER:
            cuts[which] = End(at + outward * hair * (1.0 + 2.0 * abs(mitre)), -outward * mitre)
        elif kind == PROFILE:
            # Past the end the body reads the profile at b where |b| / side > x / right. With unequal halves the
            # wedge's slope differs on the two sides: a slope and a wedge together.
            if left < 0.0:
                wedge, slope = 0.5 * (1.0 + ratio), 0.5 * (1.0 - ratio)
            else:
                wedge, slope = 1.0, 0.0
            beyond = End(at + outward * hair, outward * slope, outward * wedge)
            x, y, tx, ty = place(body, np.array(at), np.array(0.0))
            size = float(scale(np.array(at)))
            still = Scale(SCALE_CONSTANT, 0.0, 0.0, 0.0, scale.table, 0.0, 0.0, 1.0, size, size)
            if merge:
                cuts[which] = beyond
            else:
                cuts[which] = End(at + outward * hair)
                ends = [End(-hair), End(hair)]
                ends[which] = beyond._replace(at=outward * hair)
                strokes.append(
                    body._replace(x=x, y=y, tx=tx, ty=ty, curvature=0.0, length=0.0, scale=still, start=ends[0],
                                  finish=ends[1])
                )  # fmt: skip
            # The cap: a path of no length across the end, whose left is outward, with the right half only.
            cap = between(section, max(0.0, left), right)
            if cap is not None:
                back = -1.0 / ratio if left < 0.0 else 0.0  # the reach to the groove's left, by b
                near, far = (End(-hair, -1.0), End(hair, -back)) if which else (End(-hair, back), End(hair, 1.0))
                strokes.append(
                    body._replace(x=x, y=y, tx=outward * ty, ty=-outward * tx, curvature=0.0, length=0.0, section=cap,
                                  scale=still, start=near, finish=far)
                )  # fmt: skip
    body = body._replace(start=cuts[0], finish=cuts[1])
    return [*arcs(body if curvature != 0.0 or exact else untrimmed(body)), *strokes]


def untrimmed(stroke: Stroke) -> Stroke:
    """A straight stroke whose mitres are cut when it has been swept: where the scale changes along a mitre it may meet
    the line of one b more than once."""
    reach = max(abs(float(stroke.section.b[0])), abs(float(stroke.section.b[-1]))) * stroke.scale.most + stroke.hair
    start, finish = stroke.start, stroke.finish
    return stroke._replace(
        start=End(start.at - abs(start.slope) * reach),
        finish=End(finish.at + abs(finish.slope) * reach),
        trims=(start if start.slope != 0.0 else None, finish if finish.slope != 0.0 else None),
    )


def arcs(stroke: Stroke) -> list[Stroke]:
    """The stroke in parts that turn by 120 degrees at the most."""
    parts = math.ceil(abs(stroke.curvature) * stroke.length / math.radians(121.0))
    if parts < 2:
        return [stroke]
    cuts = np.linspace(0.0, stroke.length, parts + 1)
    return [
        stroke._replace(
            start=stroke.start if i == 0 else End(cuts[i] - stroke.hair),
            finish=stroke.finish if i == parts - 1 else End(cuts[i + 1] + stroke.hair),
            closed=False,
        )
        for i in range(parts)
    ]


def place(stroke: Stroke, s: Floats, b: Floats) -> tuple[float, float, float, float]:
    """A point of the plane and the path's tangent there, for one (s, b)."""
    p, q = positions(stroke, s, b)
    turn = stroke.curvature * float(s)
    tx = stroke.tx * math.cos(turn) - stroke.ty * math.sin(turn)
    ty = stroke.ty * math.cos(turn) + stroke.tx * math.sin(turn)
    return float(p), float(q), tx, ty


def positions(stroke: Stroke, s: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Pattern coordinates of local ones; beyond an arc's centre everything is at the centre."""
    if stroke.curvature == 0.0:
        forward, left = s, b
    else:
        radius = 1.0 / stroke.curvature
        rest = np.maximum(radius - b, 0.0) if radius > 0.0 else np.minimum(radius - b, 0.0)
        angle = s * stroke.curvature
        # R - (R - b) cos a without the loss of digits where R is large
        forward = rest * np.sin(angle)
        near = np.minimum(b, radius) if radius > 0.0 else np.maximum(b, radius)
        left = near + rest * 2.0 * np.sin(0.5 * angle) ** 2
    p = stroke.x + forward * stroke.tx - left * stroke.ty
    q = stroke.y + forward * stroke.ty + left * stroke.tx
    return p, q


def _cut(stroke: Stroke, end: End, b: Floats) -> Floats:
    """s of an end, for distances b (scale included) from the path."""
    if stroke.curvature == 0.0 or end.slope == 0.0:
        return end.at + end.slope * b + end.wedge * np.abs(b)
    # The line x = slope * b in the tangent frame meets the circle of radius R - b where
    # (R - b) sin(a + phi) = R sin(phi), tan(phi) = slope.
    radius = 1.0 / stroke.curvature
    phi = math.atan(end.slope)
    rest = radius - b
    rest = np.where(np.abs(rest) < 1e-12 * abs(radius), math.copysign(1e-12, radius), rest)
    sine = np.clip(math.sin(phi) * radius / rest, -1.0, 1.0)
    angle = np.arcsin(sine) - phi
    return end.at + angle * radius


def extent(stroke: Stroke, which: int, b: Floats) -> Floats:
    """s where the stroke starts (0) or finishes (1), for b of the cross-section (scale 1)."""
    end = stroke.finish if which else stroke.start
    s = np.full(np.shape(b), end.at)
    if end.slope == 0.0 and end.wedge == 0.0:
        return s
    # The end depends on b, b on the scale, the scale on s.
    for _ in range(1 if stroke.scale.kind == SCALE_CONSTANT else 40):
        s = _cut(stroke, end, b * stroke.scale(s))
    return s


def _along_mitres(stroke: Stroke, section: Section) -> Section:
    """More points where an arc is mitred: there b is not linear along the line of the cut."""
    far = math.sqrt(8.0 * stroke.tolerance / abs(stroke.curvature))
    for _ in range(12):
        b = section.b
        steps = [np.diff(b) * stroke.scale.most, np.diff(extent(stroke, 0, b)), np.diff(extent(stroke, 1, b))]
        wide = np.flatnonzero((np.abs(np.stack(steps)).max(axis=0) > far) & (np.diff(b) > 0.0))
        if len(wide) == 0:
            break
        section = insert(section, 0.5 * (b[wide] + b[wide + 1]))
    return section


def _refined(stroke: Stroke) -> list[Section]:
    """The cross-section with the points that the ends need, without what they cut off altogether."""
    section = stroke.section
    constant = stroke.scale.kind == SCALE_CONSTANT
    if stroke.curvature != 0.0:
        centre = 1.0 / stroke.curvature / (stroke.scale.size if constant else stroke.scale.most)
        if constant:
            low, high = (section.b[0], min(section.b[-1], centre)) if centre > 0.0 else (
                max(section.b[0], centre), section.b[-1])  # fmt: skip
            cut = between(section, float(low), float(high))
            if cut is None:
                return []
            section = cut
        if not constant and section.b[0] < centre < section.b[-1]:
            section = insert(section, np.linspace(section.b[0], section.b[-1], 17)[1:-1])
        if stroke.start.slope != 0.0 or stroke.finish.slope != 0.0:
            section = _along_mitres(stroke, section)
    if stroke.start.wedge != 0.0 or stroke.finish.wedge != 0.0:
        section = insert(section, np.array([0.0]))
    if stroke.closed:
        return [section]
    gap = extent(stroke, 1, section.b) - extent(stroke, 0, section.b)
    if np.all(gap > 0.0):
        return [section]
    roots = []
    for i in range(len(gap) - 1):
        if gap[i] * gap[i + 1] < 0.0:
            low, high = float(section.b[i]), float(section.b[i + 1])
            rising = gap[i + 1] > 0.0
            for _ in range(60):
                probe = np.array([0.5 * (low + high)])
                positive = float((extent(stroke, 1, probe) - extent(stroke, 0, probe))[0]) > 0.0
                low, high = (low, float(probe[0])) if positive == rising else (float(probe[0]), high)
            roots.append(high if rising else low)  # the side where something is left
    section = insert(section, np.array(roots))
    gap = extent(stroke, 1, section.b) - extent(stroke, 0, section.b)
    middle = 0.5 * (section.b[1:] + section.b[:-1])
    alive = (extent(stroke, 1, middle) - extent(stroke, 0, middle)) > 0.0
    alive &= (gap[1:] > -stroke.hair) & (gap[:-1] > -stroke.hair)
    parts_of: list[Section] = []
    i = 0
    while i < len(alive):
        if not alive[i]:
            i += 1
            continue
        first = i
        while i < len(alive) and alive[i]:
            i += 1
        b = section.b[first : i + 1]
        if b[-1] > b[0]:
            parts_of.append(Section(b, section.w[first : i + 1], section.facet[first:i]))
    return parts_of


def _step(stroke: Stroke) -> float:
    """The distance between rings that keeps within the tolerance."""
    section, scale = stroke.section, stroke.scale
    half = max(abs(section.b[0]), abs(section.b[-1])) * scale.most
    step = math.inf
    if stroke.curvature != 0.0:
        radius = 1.0 / abs(stroke.curvature)
        share = min(1.0, stroke.tolerance / (radius + half))
        step = radius * min(_TURN, 2.0 * math.acos(1.0 - share))
    if scale.kind == SCALE_SINE and scale.a != 0.0 and scale.b != 0.0 and scale.t1 != scale.t0:
        size = max(half, float(np.abs(section.w).max()) * scale.most)
        rate = 2.0 * math.pi * abs(scale.b * (scale.t1 - scale.t0)) / scale.length
        step = min(step, math.sqrt(8.0 * stroke.tolerance / (size * abs(scale.a))) / rate, 0.25 / rate)
    return step


def ring_table(stroke: Stroke, section: Section) -> Floats:
    """s of each ring (rows) at each point of the section (columns)."""
    begin, end = extent(stroke, 0, section.b), extent(stroke, 1, section.b)
    step, scale = _step(stroke), stroke.scale
    knots = np.zeros(0)
    if scale.kind == SCALE_TABLE and scale.t1 != scale.t0:
        knots = (scale.table[:, 0] - scale.t0) / (scale.t1 - scale.t0) * scale.length
    if stroke.trims != (None, None):  # past the piece's ends the scale stays as it is
        knots = np.concatenate([knots, [0.0, stroke.length]])
    if stroke.closed:
        count = max(3, math.ceil(stroke.length / step))
        at = np.unique(np.concatenate([np.arange(count) * (stroke.length / count), knots]))
        at = at[(at >= 0.0) & (at < stroke.length)]
        return np.repeat(at[:, None], len(section.b), axis=1)
    straight = bool(np.all(begin == begin[0]) and np.all(end == end[0])) or scale.kind == SCALE_CONSTANT
    if not math.isfinite(step) and len(knots) == 0 and straight:
        return np.stack([begin, end])
    low, high = float(begin.max()), float(end.min())
    if high <= low:
        count = max(1 if scale.kind == SCALE_CONSTANT else 64, math.ceil(float(end.max() - begin.min()) / step))
        u = np.linspace(0.0, 1.0, count + 1)[:, None]
        return (1.0 - u) * begin + u * end
    bends = 1 if scale.kind == SCALE_CONSTANT else 32  # a mitre leads past the piece's end, where the scale bends
    inset = 1e-3 * min(step, high - low)
    rings = [begin[None, :]]
    sheared = (float(begin.max() - begin.min()) > 0.0, float(end.max() - end.min()) > 0.0)
    first, last = low + inset * sheared[0], high - inset * sheared[1]
    if sheared[0]:
        u = np.linspace(0.0, 1.0, max(bends, math.ceil(float(low - begin.min()) / step)) + 1)[1:, None]
        rings.append((1.0 - u) * begin + u * first)
    count = max(1, math.ceil((last - first) / step))
    at = np.linspace(first, last, count + 1)[1:-1]
    near = 1e-9 * (last - first)
    inside = knots[(knots > first + near) & (knots < last - near)]
    if len(inside):
        at = np.unique(np.concatenate([at, inside]))
        at = at[np.concatenate([[True], np.diff(at) > near])]
    rings.append(np.repeat(at[:, None], len(section.b), axis=1))
    if sheared[1]:
        u = np.linspace(0.0, 1.0, max(bends, math.ceil(float(end.max() - high) / step)) + 1)[:-1, None]
        rings.append((1.0 - u) * last + u * end)
    rings.append(end[None, :])
    return np.concatenate(rings)


def _trimmed(ribbon: Ribbon | Prism, made: Faces, shift: tuple[float, float]) -> Faces:
    """What the planes of its stroke's mitres leave of a ribbon's or prism's solid."""
    stroke = ribbon.stroke
    for which, end in enumerate(stroke.trims):
        if end is None or len(made.triangles) == 0:
            continue
        outward = 2.0 * which - 1.0
        longer = ribbon.rings[-1].max() - stroke.finish.at if which else stroke.start.at - ribbon.rings[0].min()
        s, b = _local(stroke, made.vertices[:, 0] - shift[0], made.vertices[:, 1] - shift[1])
        far = 1.0 + float(np.abs(b).max()), 1.0 + float(np.ptp(s)) + 2.0 * abs(end.slope) * (1.0 + np.abs(b).max())
        line = end.at + outward * longer + end.slope * np.array([-far[0], far[0]])
        corners_s = np.concatenate([line, line + outward * far[1]])
        p, q = positions(stroke, corners_s, np.tile([-far[0], far[0]], 2))
        low, high = float(made.vertices[:, 2].min()) - 1.0, float(made.vertices[:, 2].max()) + 1.0
        beyond = solid([block(p + shift[0], q + shift[1], low, high)])
        made = faces_of(Manifold.batch_boolean([solid([made]), beyond], OpType.Subtract))
    return made


def _local(stroke: Stroke, p: Floats, q: Floats) -> tuple[Floats, Floats]:
    """(s, b) of points of the plane, for a straight stroke."""
    x, y = p - stroke.x, q - stroke.y
    return x * stroke.tx + y * stroke.ty, y * stroke.tx - x * stroke.ty


def block(p: Floats, q: Floats, low: float, high: float) -> Faces:
    """A block over a quadrilateral, (4,) each: two sides' ends, one after the other. It has no facets of its own."""
    corners = np.stack([np.tile(p, 2), np.tile(q, 2), np.repeat([low, high], 4)], axis=1)
    triangles = np.array(
        [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6],
         [1, 3, 5], [3, 7, 5]], np.int64
    )  # fmt: skip
    if (p[1] - p[0]) * (q[2] - q[0]) - (q[1] - q[0]) * (p[2] - p[0]) < 0.0:
        triangles = triangles[:, ::-1]
    return Faces(corners, triangles, np.zeros(len(triangles), np.int64))


def _groups(b: Floats) -> list[tuple[int, int]]:
    """Runs of points at one b: first and last."""
    out: list[tuple[int, int]] = []
    first = 0
    for i in range(1, len(b) + 1):
        if i == len(b) or b[i] > b[first]:
            out.append((first, i - 1))
            first = i
    return out


def _loop(section: Section, up: bool) -> tuple[Ints, Ints, list[tuple[int, int]]]:
    """A cross-section between a polyline and a straight line above (`up`) or below it: the boundary's edges (p, q,
    facet or -1), the triangles that fill it, and the groups. Points of the straight line follow those of the polyline,
    one a group. Anticlockwise for `up`, clockwise otherwise."""
    m, groups = len(section.b), _groups(section.b)
    n = len(groups)
    edges = [(i, i + 1, int(section.facet[i])) for i in range(m - 1)]
    edges.append((m - 1, m + n - 1, -1))
    edges += [(m + g, m + g - 1, -1) for g in range(n - 1, 0, -1)]
    edges.append((m, 0, -1))
    sign = 1.0 if up else -1.0
    triangles: list[tuple[int, int, int]] = []
    for g in range(n - 1):
        a0, a1 = groups[g]
        c0, c1 = groups[g + 1]
        left = [a1, *range(a1 - 1, a0 - 1, -1)] if sign * (section.w[a0] - section.w[a1]) > 0.0 else [a1]
        right = [c0, *range(c0 + 1, c1 + 1)] if sign * (section.w[c1] - section.w[c0]) > 0.0 else [c0]
        left.append(m + g)
        right.append(m + g + 1)
        triangles += [(left[0], right[i], right[i + 1]) for i in range(len(right) - 1)]
        triangles += [(left[i], right[-1], left[i + 1]) for i in range(len(left) - 1)]
    return np.array(edges, np.int32), np.array(triangles, np.int32), groups


class Ribbon(NamedTuple):
    """What to sweep: the region between a polyline and the horizontal line w = flat."""

    stroke: Stroke
    whole: Section  # the refined section that rings are taken from, so that all ribbons of a stroke share them
    rings: Floats  # s of each ring (rows) at each point of `whole` (columns)
    section: Section
    flat: float
    up: bool  # the flat line is above the polyline
    widen: tuple[int, int]  # how many hairs the flat side stands out by, on the left and on the right

    def triangles(self) -> int:
        """How many triangles the solid has."""
        count = len(self.rings)
        m = len(self.section.b)
        around = m + len(_groups(self.section.b))
        return 2 * around * (count if self.stroke.closed else count - 1) + 2 * (around - 2)


class Prism(NamedTuple):
    """What to sweep of a cross-section that overhangs."""

    stroke: Stroke
    whole: Section  # as of a Ribbon, and `rings` as well
    rings: Floats
    shape: Shape  # over the places of `whole`
    bottom: float  # where it ends downwards and
    top: float  # upwards
    widen: tuple[int, int]  # how many hairs its uppermost side stands out by, on the left and on the right

    @property
    def section(self) -> Section:
        """What it lies over."""
        return self.whole

    def triangles(self) -> int:
        """How many triangles the solid has."""
        count = len(self.rings) if self.stroke.closed else len(self.rings) - 1
        return 2 * len(self.shape.edges) * count + 2 * len(self.shape.triangles)


def _raised(whole: Section, inner: NDArray[np.intp]) -> list[Section]:
    """The parts of a cross-section that stand above w = 0, to be added. Over the internal facets, above which the
    groove itself removes everything, the added solid is higher: so its faces never coincide with the removal's."""
    b, w, facet = whole
    if len(inner) and w.max() > 0.0:
        first, last = int(inner[0]), int(inner[-1]) + 1
        if w[first] > 0.0 or w[last] > 0.0 or w[first : last + 1].max() > 0.0:
            top = float(w[first : last + 1].max())
            flat = np.array([first + head for head, _ in _groups(b[first : last + 1])])
            # Where the bridge is higher than its end it leans inwards, away from the side of the removal.
            lead, tail = int(w[first] < top), int(w[last] < top)
            flat = flat[lead : len(flat) - tail]
            inside_b = np.concatenate([b[first : first + lead], b[flat], b[last : last + tail]])
            inside_w = np.concatenate([w[first : first + lead], np.full(len(flat), top), w[last : last + tail]])
            none = np.full(len(inside_b) - 1, -1, np.int32)
            b = np.concatenate([b[:first], inside_b, b[last + 1 :]])
            w = np.concatenate([w[:first], inside_w, w[last + 1 :]])
            facet = np.concatenate([facet[:first], none, facet[last:]])
    above = (w[1:] > 0.0) | (w[:-1] > 0.0)
    parts = []
    i = 0
    while i < len(above):
        first = i
        while i < len(above) and above[i]:
            i += 1
        if i > first and b[i] > b[first]:
            parts.append(Section(b[first : i + 1], w[first : i + 1], facet[first:i]))
        i += 1
    return parts


def ribbons(stroke: Stroke, *, top: float, bottom: float) -> dict[str, list[Ribbon | Prism]]:
    """The ribbons of a stroke: 'add', 'remove' and its band above ('clear') and below ('fill') the plate's surface."""
    out: dict[str, list[Ribbon | Prism]] = {"add": [], "remove": [], "clear": [], "fill": []}
    for whole in _refined(stroke):
        inner = np.flatnonzero((whole.facet >= stroke.inner[0]) & (whole.facet < stroke.inner[1]))
        if len(inner) and whole.w[inner[0] : inner[-1] + 2].max() > min(whole.w[inner[0]], whole.w[inner[-1] + 1]):
            wide = inner[np.diff(whole.b)[inner] > 0.0]
            if len(wide):
                b = whole.b
                lean = [0.75 * b[wide[0]] + 0.25 * b[wide[0] + 1], 0.25 * b[wide[-1]] + 0.75 * b[wide[-1] + 1]]
                whole = insert(whole, np.array(lean))
        inner = np.flatnonzero((whole.facet >= stroke.inner[0]) & (whole.facet < stroke.inner[1]))
        rings = ring_table(stroke, whole)
        longer = rings.copy()  # the removal reaches a hair beyond the addition
        if not stroke.closed:
            longer[0] -= stroke.hair
            longer[-1] += stroke.hair
        free = [True, True]  # an end at an arc's centre is not widened
        if stroke.curvature != 0.0:
            radius = 1.0 / stroke.curvature
            which = 1 if radius > 0.0 else 0
            if abs(float(whole.b[-which]) * stroke.scale.most) >= abs(radius) * (1.0 - 1e-9):
                free[which] = False
        widen = (int(free[0]), int(free[1]))
        if stroke.outline is not None:
            shape = removed(stroke.outline, whole.b)
            if shape is not None:
                out["remove"].append(Prism(stroke, whole, longer, shape, bottom, top, widen))
            shape = added(stroke.outline, whole.b)
            if shape is not None:
                out["add"].append(Prism(stroke, whole, rings, shape, bottom, top, (0, 0)))
        elif len(inner):
            first, last = int(inner[0]), int(inner[-1]) + 1
            part = Section(whole.b[first : last + 1], whole.w[first : last + 1], whole.facet[first:last])
            if part.b[-1] > part.b[0]:
                out["remove"].append(Ribbon(stroke, whole, longer, part, top, True, widen))
        if stroke.outline is None:
            out["add"] += [Ribbon(stroke, whole, rings, part, bottom, False, (0, 0)) for part in _raised(whole, inner)]
        ends = _groups(whole.b)
        single = np.array([first for first, _ in ends])
        level = Section(whole.b[single], np.zeros(len(single)), np.full(len(single) - 1, -1, np.int32))
        out["clear"].append(Ribbon(stroke, whole, rings, level, top, True, widen))
        # Narrower, so that the groove's own removal leaves no fin of it standing at a wall.
        out["fill"].append(Ribbon(stroke, whole, rings, level, bottom, False, (-widen[0], -widen[1])))
    return out


class Facets:
    """The facets that a solid's triangles lie on, numbered from 1 on."""

    def __init__(self) -> None:
        self.rows: list[tuple[int, float, float, float, float]] = [(-1, 0.0, 0.0, 0.0, 0.0)]
        """(slot, centre p, centre q, radial, up): the row of Pattern.facet_slot, and for facets swept along an arc its
        centre and the unit normal there, outward from the centre and upward; radial = up = 0 for all others."""
        self._numbers: dict[tuple[int, float, float, float, float], int] = {}

    def number(self, stroke: Stroke, facet: int, shift: tuple[float, float]) -> int:
        """Of a facet of a stroke moved by `shift`."""
        row = (stroke.slot + facet, 0.0, 0.0, 0.0, 0.0)
        if stroke.curvature != 0.0 and stroke.scale.kind == SCALE_CONSTANT:
            b, w, of = stroke.section
            if stroke.outline is not None:
                (b, w), of = stroke.outline.points.T, np.arange(len(stroke.outline.points) - 1, dtype=np.int32)
            edges = np.flatnonzero(of == facet)
            db, dw = np.diff(b)[edges], np.diff(w)[edges]
            i = int(np.argmax(np.hypot(db, dw)))
            length = math.hypot(db[i], dw[i])
            if length > 0.0:
                radius = 1.0 / stroke.curvature
                p, q = stroke.x - stroke.ty * radius + shift[0], stroke.y + stroke.tx * radius + shift[1]
                row = (row[0], p, q, math.copysign(1.0, radius) * dw[i] / length, db[i] / length)
        if row not in self._numbers:
            self._numbers[row] = len(self.rows)
            self.rows.append(row)
        return self._numbers[row]


class Faces(NamedTuple):
    """A closed mesh with tags."""

    vertices: Floats  # (n, 3)
    triangles: NDArray[np.int64]  # (m, 3)
    tags: NDArray[np.int64]  # (m,) numbers of `Facets`, 0: none


def sweep(ribbon: Ribbon | Prism, shift: tuple[float, float], known: Facets) -> Faces:
    """The solid of a ribbon or prism, moved by `shift`; what it is made of goes into `known`."""
    stroke = ribbon.stroke
    if isinstance(ribbon, Prism):
        shape = ribbon.shape
        s = ribbon.rings[:, shape.column]
        factor = stroke.scale(s)
        b = factor * ribbon.whole.b[shape.column]
        w = factor * np.where(np.isfinite(shape.w), shape.w, 0.0)
        w[:, shape.w == -math.inf], w[:, shape.w == math.inf] = ribbon.bottom, ribbon.top
        upper = np.flatnonzero(shape.w == math.inf)
        if len(upper):
            b[:, upper[0]] -= stroke.hair * ribbon.widen[0]
            b[:, upper[-1]] += stroke.hair * ribbon.widen[1]
        return _trimmed(ribbon, _along(stroke, s, b, w, shape.edges, shape.triangles, shift, known), shift)
    section = ribbon.section
    edges, caps, groups = _loop(section, ribbon.up)
    m, n = len(section.b), len(groups)
    # s of this ribbon's points: those of the whole section have the same b.
    column = np.searchsorted(ribbon.whole.b, section.b)
    heads = np.array([first for first, _ in groups])
    s = np.concatenate([ribbon.rings[:, column], ribbon.rings[:, column[heads]]], axis=1)
    factor = stroke.scale(s)
    b = factor * np.concatenate([section.b, section.b[heads]])
    b[:, m] -= stroke.hair * ribbon.widen[0]
    b[:, m + n - 1] += stroke.hair * ribbon.widen[1]
    w = np.empty(s.shape)
    w[:, :m] = factor[:, :m] * section.w
    w[:, m:] = ribbon.flat
    made = _along(stroke, s, b, w, edges, caps, shift, known)
    return _trimmed(ribbon, made if ribbon.up else made._replace(triangles=made.triangles[:, ::-1]), shift)


def _along(
    stroke: Stroke, s: Floats, b: Floats, w: Floats, edges: Ints, caps: Ints, shift: tuple[float, float], known: Facets
) -> Faces:
    """The closed mesh whose rings have their points at (s, b, w) (rings, points); edges (start, stop, facet or -1) and
    triangles `caps` as of a region of the cross-section, anticlockwise."""
    rings, size = s.shape
    p, q = positions(stroke, s, b)
    vertices = np.stack([p + shift[0], q + shift[1], w], axis=2).reshape(-1, 3)

    follow = np.arange(rings) if stroke.closed else np.arange(rings - 1)
    ahead = (follow + 1) % rings
    start, stop, facet = edges[:, 0], edges[:, 1], edges[:, 2]
    # Always the same diagonal of a quadrilateral, so that an addition and a removal share a common facet exactly.
    flip = (start > stop) & (facet < 0)
    lo, hi = follow[:, None] * size, ahead[:, None] * size
    one = np.where(flip, np.stack([lo + start, lo + stop, hi + start]), np.stack([lo + start, lo + stop, hi + stop]))
    two = np.where(flip, np.stack([lo + stop, hi + stop, hi + start]), np.stack([lo + start, hi + stop, hi + start]))
    numbers = {-1: 0} | {int(f): known.number(stroke, int(f), shift) for f in np.unique(facet[facet >= 0])}
    tag = np.array([numbers[int(f)] for f in facet], np.int64)
    faces = [one.reshape(3, -1).T, two.reshape(3, -1).T]
    tags = [np.tile(tag, len(follow)), np.tile(tag, len(follow))]
    if not stroke.closed:
        faces += [caps[:, ::-1], caps + (rings - 1) * size]
        tags.append(np.zeros(2 * len(caps), np.int64))
    triangles, ids = np.concatenate(faces), np.concatenate(tags)
    if stroke.curvature != 0.0 and stroke.scale.kind == SCALE_CONSTANT:
        # At an arc's centre all rings meet in one point.
        axis = np.abs(1.0 / stroke.curvature - b[0]) <= 1e-9 * abs(1.0 / stroke.curvature)
        if axis.any():
            index = np.arange(rings * size).reshape(rings, size)
            index[:, axis] = index[0, axis]
            triangles = index.reshape(-1)[triangles]
            alive = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2])
            alive &= triangles[:, 2] != triangles[:, 0]
            triangles, ids = triangles[alive], ids[alive]
            used, triangles_flat = np.unique(triangles, return_inverse=True)
            vertices, triangles = vertices[used], triangles_flat.reshape(-1, 3)
    return Faces(vertices, triangles, ids)


def solid(parts: list[Faces]) -> Manifold:
    """Closed meshes that do not touch as one manifold."""
    first = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    made = Manifold(
        Mesh64(
            np.concatenate([part.vertices for part in parts]),
            np.concatenate([part.triangles + n for part, n in zip(parts, first, strict=True)]).astype(np.uint64),
            face_id=np.concatenate([part.tags for part in parts]).astype(np.uint64),
        )
    )
    if made.status() != Error.NoError:
        raise ValueError(f"a swept piece is not a closed solid: {made.status()}")
    return made


def faces_of(made: Manifold) -> Faces:
    """The mesh of a solid."""
    mesh = made.to_mesh64()
    triangles = np.asarray(mesh.tri_verts).astype(np.int64)
    vertices = np.array(mesh.vert_properties[:, :3], np.float64)
    if len(mesh.merge_from_vert):
        index = np.arange(len(vertices))
        index[np.asarray(mesh.merge_from_vert, np.int64)] = np.asarray(mesh.merge_to_vert, np.int64)
        triangles = index[triangles]
    return Faces(vertices, triangles, np.asarray(mesh.face_id, np.int64))
