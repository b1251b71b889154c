"""Where a ray meets the local solid (DESIGN 1.2): the ends of its spans, sorted, and a count of those that are open.

The rules of 1.2 are the rules of the count: inside the bands of the highest priority that holds the ray, material is
what lies below the plane or in an added span, and in no removed one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.pieces import locate, point_at, scale_at, tangent_at
from renderer.geometry.query import Nearby, find
from renderer.geometry.spans import (
    ADD,
    BAND,
    BODY,
    CAP_FINISH,
    CAP_START,
    CHORD,
    END,
    NONE,
    PARTS,
    PLANE,
    REMOVE,
    SIDE,
    TAIL_FINISH,
    TAIL_START,
    Events,
    meet_piece,
    sort,
)
from renderer.kernel import fixed, leaf
from renderer.tables import PROFILE, SCALE_CONSTANT, Pattern

SEARCH = 1024
"""Stretches of a ray on its way up that are looked at: all that a pattern has, and of one that tiles for ever so many
tiles that a ray which has met nothing there runs along free lanes."""

LEVEL = 1e-6  # a ray's slope to the plane is taken for at least this
THIN = 1e-8  # solid thinner than this part of the pattern's height range, or width, is rounding, not matter


DOWN, UP, SHADOW = fixed(0), fixed(1), fixed(2)  # where a ray goes,
SINK, RISE = fixed(3), fixed(4)  # and where one goes that is inside the solid


class Meeting(NamedTuple):
    """Where a ray meets the solid."""

    w: float
    facet: int
    found: int  # place of the piece in `Nearby`; -1: the plane
    part: int  # BODY, CAP_..., or TAIL_...: past an arc's end, where the groove goes on straight


OPEN = Meeting(-math.inf, -1, -1, 0)
"""Nothing was met."""


@leaf
def is_solid(e: Events, below: bool) -> bool:
    """Whether the ray is inside the solid, from what is open: the highest priority whose band holds it decides."""
    for rank in range(len(e.open) - 1, -1, -1):
        if e.open[rank, BAND] > 0:
            return (below or e.open[rank, ADD] > 0) and e.open[rank, REMOVE] == 0
    return below


@leaf
def begin(e: Events, n: int) -> None:
    """Nothing is open, and the events are in order."""
    for rank in range(len(e.open)):
        e.open[rank, 0] = e.open[rank, 1] = e.open[rank, 2] = 0
    sort(e, n)


@leaf
def first(e: Events, n: int, high: float, low: float, thin: float) -> tuple[float, int, int]:
    """The height at which the ray enters the solid on its way down, the facet and its owner; -inf: nowhere."""
    begin(e, n)
    below = high <= 0.0
    k = 0
    if below and (n == 0 or e.w[e.order[0]] < high - thin):
        return high, PLANE, -1
    while k < n or not below:
        at = e.w[e.order[k]] if k < n else -math.inf
        facet, owner = PLANE, -1
        if not below and at <= 0.0:
            at = 0.0
        if at <= low + thin:
            break  # here spans end because the ray does
        on_plane = not below and at <= thin
        below = below or on_plane
        until = at - thin
        while k < n and e.w[e.order[k]] >= until:
            sign, kind, rank = e.change[e.order[k], 0], e.change[e.order[k], 1], e.change[e.order[k], 2]
            e.open[rank, kind] += sign
            # What is no facet does not take the plane's place: chords may end there.
            if not (kind == REMOVE and sign > 0) and (e.change[e.order[k], 3] >= 0 or (facet < 0 and not on_plane)):
                facet, owner = e.change[e.order[k], 3], e.change[e.order[k], 4]
            k += 1
        if is_solid(e, below) and (k >= n or e.w[e.order[k]] < until):
            return at, facet, owner
    return -math.inf, PLANE, -1


@leaf
def last(e: Events, n: int, high: float, low: float, thin: float, way: int) -> tuple[float, int, int]:
    """The same for a ray on its way UP: where the solid that it meets first begins; and for one inside the solid, where
    that ends."""
    begin(e, n)
    below = high <= 0.0
    found, owner, what = -math.inf, -1, PLANE
    solid = below or way == SINK  # where a stretch of a ray ends that goes up, it may be inside
    k = 0
    while k < n or not below:
        at = e.w[e.order[k]] if k < n else -math.inf
        if not below and at <= 0.0:
            at = 0.0
        if at <= low + thin:
            break
        below = below or at <= thin
        until = at - thin
        facet, by = PLANE, -1
        while k < n and e.w[e.order[k]] >= until:
            sign, kind, rank = e.change[e.order[k], 0], e.change[e.order[k], 1], e.change[e.order[k], 2]
            e.open[rank, kind] += sign
            if e.change[e.order[k], 3] >= 0 or facet < 0:
                facet, by = e.change[e.order[k], 3], e.change[e.order[k], 4]
            k += 1
        now = is_solid(e, below)
        if way != SINK and at >= high - thin:  # the state it ends in
            solid = now
        if solid != now and now == (way == RISE):
            found, what, owner = at, facet, by
            if way == SINK:
                break
        solid = now
    return found, what, owner


@leaf
def meet(
    pattern: Pattern, found: Nearby, e: Events, count: int, p: float, q: float, gp: float, gq: float,
    high: float, low: float, way: int,
) -> Meeting:  # fmt: skip
    """Where the ray through (p, q) with slope (gp, gq) first enters the solid between the heights `high` and `low`.

    way: it goes DOWN or UP, or it is a SHADOW's, which goes up and asks only whether there is anything; or it is inside
    the solid and leaves it first on its way down, SINK, or up, RISE. `count` pieces have been found for the whole
    footprint; where -1, the ray looks for them itself, stretch by stretch. w = -inf: nothing.
    """
    thin = THIN * (pattern.height + pattern.depth)
    slope = math.sqrt(gp * gp + gq * gq)
    if slope * thin > THIN * pattern.width:  # a low ray, or a deep groove: as thin sideways
        thin = THIN * pattern.width / slope
    stretches = 1
    if count < 0:
        travel = slope * (high - low)
        stride = 2.0 * max(pattern.grid.cell[0], pattern.grid.cell[1]) + pattern.reach
        stretches = int(min(max(math.ceil(travel / stride), 1.0), 1e6))
    descends = way in (DOWN, SINK)
    for k in range(stretches if descends else min(stretches, SEARCH)):
        j = k if descends else stretches - 1 - k
        a = high + (low - high) * j / stretches
        c = high + (low - high) * (j + 1) / stretches
        pieces = count
        if count < 0:
            margin = pattern.reach
            pa, pc, qa, qc = p + a * gp, p + c * gp, q + a * gq, q + c * gq
            pieces = find(
                pattern, found, min(pa, pc) - margin, min(qa, qc) - margin,
                max(pa, pc) + margin, max(qa, qc) + margin, len(found.piece),
            )  # fmt: skip
            if pieces < 0:
                pieces = len(found.piece)  # the first Pattern.near, without a tile; with one there are no more
        n = NONE
        for i in range(pieces):
            item = found.piece[i]
            piece = pattern.pieces[item]
            dx, dy = found.shift[i, 0], found.shift[i, 1]
            if piece.curvature == 0.0:  # most are passed by: seen here, before the tables are handed on
                x, y = p - dx - piece.x, q - dy - piece.y
                b = y * piece.tx - x * piece.ty
                turn = gq * piece.tx - gp * piece.ty
                ba, bc = b + a * turn, b + c * turn
                if (ba > piece.half and bc > piece.half) or (ba < -piece.half and bc < -piece.half):
                    if piece.ended == 0:
                        continue
                    s, rise = x * piece.tx + y * piece.ty, gp * piece.tx + gq * piece.ty
                    if max(s + a * rise, s + c * rise) < piece.length and min(s + a * rise, s + c * rise) > 0.0:
                        continue
            elif piece.ended == 0:
                radius = 1.0 / piece.curvature
                x = p - dx - piece.x + piece.ty * radius + a * gp  # from the centre of curvature
                y = q - dy - piece.y - piece.tx * radius + a * gq
                mx, my = (c - a) * gp, (c - a) * gq
                along = mx * mx + my * my
                t = min(max(-(x * mx + y * my) / along, 0.0), 1.0) if along > 0.0 else 0.0
                outer, inner = abs(radius) + piece.half, max(abs(radius) - piece.half, 0.0)
                if (x + t * mx) ** 2 + (y + t * my) ** 2 > outer * outer:
                    continue
                if max(x * x + y * y, (x + mx) ** 2 + (y + my) ** 2) < inner * inner:
                    continue
                if piece.length < outer:  # all of it is near its middle
                    ux, uy = point_at(piece, 0.5 * piece.length)
                    x, y = x - ux + piece.x - piece.ty * radius, y - uy + piece.y + piece.tx * radius
                    t = min(max(-(x * mx + y * my) / along, 0.0), 1.0) if along > 0.0 else 0.0
                    mitre = max(abs(piece.start_mitre), abs(piece.finish_mitre))
                    far = 0.5 * piece.length + 1.01 * piece.half * math.sqrt(1.0 + mitre * mitre)
                    if (x + t * mx) ** 2 + (y + t * my) ** 2 > far * far:
                        continue
            n = meet_piece(pattern, e, n, i, item, dx, dy, p, q, gp, gq, a, c)
        if way in (DOWN, SHADOW):
            w, facet, owner = first(e, n, a, c, thin)
        else:
            w, facet, owner = last(e, n, a, c, thin, way)
        if w > -math.inf:
            return Meeting(w, facet, owner // PARTS if owner >= 0 else -1, owner % PARTS if owner >= 0 else 0)
    return OPEN


@leaf
def polish(pattern: Pattern, found: Nearby, m: Meeting, p: float, q: float, gp: float, gq: float) -> float:
    """The height at which the ray meets the facet of `m` itself, where `m` was found by chords."""
    if m.found < 0 or m.facet < 0 or m.part != BODY:
        return m.w
    piece = pattern.pieces[found.piece[m.found]]
    groove = pattern.grooves[piece.groove]
    if piece.curvature == 0.0 and groove.scale_kind == SCALE_CONSTANT:
        return m.w
    i = pattern.profiles[groove.profile].start + m.facet
    b0, w0 = pattern.points[i, 0], pattern.points[i, 1]
    run, rise = pattern.points[i + 1, 0] - b0, pattern.points[i + 1, 1] - w0
    x, y = p - found.shift[m.found, 0], q - found.shift[m.found, 1]
    far = 1e-2 * (pattern.height + pattern.depth)
    step = 1e-4 * far
    w = m.w
    for _ in range(3):
        a = above(pattern, groove, piece, x + w * gp, y + w * gq, w, b0, w0, run, rise)
        w += step
        c = above(pattern, groove, piece, x + w * gp, y + w * gq, w, b0, w0, run, rise)
        w -= step
        if a == c:
            break
        w -= a * step / (c - a)
        if not abs(w - m.w) < far:
            return m.w
    return w


@leaf
def above(
    pattern: Pattern, groove: np.void, piece: np.void, x: float, y: float, w: float,
    b0: float, w0: float, run: float, rise: float,
) -> float:  # fmt: skip
    """Of a point, how far it is on one side of the facet from (b0, w0) to (b0 + run, w0 + rise), in any unit."""
    s, b = locate(piece, x, y)
    f, _ = scale_at(pattern.scale_table, groove, piece, s)
    return run * (w - f * w0) - rise * (b - f * b0)


@leaf
def lift(pattern: Pattern, found: Nearby, m: Meeting) -> float:
    """How far from the surface a shadow ray must begin so as not to meet it again, pattern units."""
    if m.found < 0:
        return THIN * pattern.width
    piece = pattern.pieces[found.piece[m.found]]
    exact = piece.curvature == 0.0 and pattern.grooves[piece.groove].scale_kind == SCALE_CONSTANT
    return (THIN if exact or m.part != BODY else CHORD) * pattern.width


@leaf
def normal_of(
    pattern: Pattern, found: Nearby, m: Meeting, x: float, y: float, gp: float, gq: float
) -> tuple[float, float, float]:
    """The pattern-space normal (any length) of what the ray met at (x, y), on the side that the ray came from."""
    if m.found < 0:
        return 0.0, 0.0, 1.0
    piece = pattern.pieces[found.piece[m.found]]
    groove = pattern.grooves[piece.groove]
    profile = pattern.profiles[groove.profile]
    px, py = x - found.shift[m.found, 0], y - found.shift[m.found, 1]
    s, b = locate(piece, px, py)
    bend = 1.0
    if m.part == BODY:
        tx, ty = tangent_at(piece, s)
        _, slope = scale_at(pattern.scale_table, groove, piece, s)
        bend = 1.0 - piece.curvature * b
    elif m.part == TAIL_START or m.part == TAIL_FINISH:
        s = 0.0 if m.part == TAIL_START else piece.length
        tx, ty = tangent_at(piece, s)
        slope = 0.0
    else:
        s = 0.0 if m.part == CAP_START else piece.length
        ux, uy = tangent_at(piece, s)
        if m.part == CAP_START:
            ux, uy = -ux, -uy
        tx, ty = uy, -ux
        slope = 0.0
    bx, by = -ty, tx
    along = across = up = 0.0
    if m.facet >= 0:
        i = profile.start + m.facet
        run = pattern.points[i + 1, 0] - pattern.points[i, 0]
        rise = pattern.points[i + 1, 1] - pattern.points[i, 1]
        if run != 0.0:
            across, up = -rise / run, 1.0
            along = -slope * (pattern.points[i, 1] + across * pattern.points[i, 0])
        else:
            across, along = 1.0, -slope * pattern.points[i, 0]
    elif m.facet == SIDE:
        across = 1.0
    elif m.facet == END:
        along, across = 1.0, -lean(piece, profile, m.part, s, b)
    else:
        up = 1.0
    if abs(bend) > 1e-9:
        along /= bend
    n0, n1 = along * tx + across * bx, along * ty + across * by
    if n0 * gp + n1 * gq + up < 0.0:
        return -n0, -n1, -up
    return n0, n1, up


@leaf
def lean(piece: np.void, profile: np.void, part: int, s: float, b: float) -> float:
    """The slope ds / db of the wall that ends a part of the groove at (s, b): where a `profile` end of unequal halves
    goes over from being read across to being read along."""
    finish = part in (CAP_FINISH, TAIL_FINISH) or (part == BODY and 2.0 * s > piece.length)
    if profile.right <= 0.0 or (piece.finish_end if finish else piece.start_end) != PROFILE:
        return 0.0
    outward = 1.0 if finish else -1.0
    left = -profile.left / profile.right if profile.left < 0.0 else 0.0
    if part in (CAP_START, CAP_FINISH):
        return outward * (-1.0 if b > 0.0 else left)
    if part == BODY and piece.curvature != 0.0:
        return 0.0
    if b > 0.0:
        return outward
    return -outward / left if left > 0.0 else 0.0


@leaf
def shadow_ray(
    pattern: Pattern, light: tuple[float, float, float, float], x: float, y: float, w: float
) -> tuple[float, float, float, float, int]:
    """The ray from a point off the surface to a light (D_p, D_q, D_w, h), for `meet`: its slope, highest and lowest
    point, and its way. Where it has no height, nothing stands in it."""
    high = pattern.height + thin_of(pattern)
    gp, gq, rise = light[0] - light[3] * x, light[1] - light[3] * y, light[2] - light[3] * w
    rise = leveled(gp, gq, rise, LEVEL)
    gp, gq = gp / rise, gq / rise
    if rise < 0.0:
        return gp, gq, w, w + rise, DOWN
    if w >= pattern.height:
        return gp, gq, w, w, SHADOW
    return gp, gq, high if light[3] == 0.0 else min(high, w + rise), w, SHADOW


@leaf
def thin_of(pattern: Pattern) -> float:
    """How far beyond the highest and the lowest point rays begin and end."""
    return 1e-6 * (pattern.height + pattern.depth) + 1e-300


@leaf
def leveled(gp: float, gq: float, rise: float, least: float) -> float:
    """The height that a ray gains along (gp, gq), a little where it is level: rays are followed by height."""
    level = least * math.sqrt(gp * gp + gq * gq)
    return math.copysign(level, rise) if abs(rise) < level else rise
