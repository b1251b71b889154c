"""The spans in which the grooves add or remove material along a ray (003, 5.3).

A ray is a place on the base plane and a slope: X(w) = (p + w g_p, q + w g_q, w). Its parameter is the height w, so
that it always runs downwards and spans are intervals of w. Each piece of a path gives, for its body and for the caps
of `profile` ends, the spans of the ray inside its band, under its added part, above its internal facets.

Profiles that are height fields are walked along, facet by facet. Those that overhang come as trapezoids (PART), each
of which holds the ray in one interval.

Straight grooves of a constant or linear scale are exact. On arcs, and under other scales, the ray is followed in
(s, b) by chords that leave it by at most CHORD of the groove's width, and next to an arc's centre by a part TURN^2 / 8
of the distance to it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.pieces import locate, point_at, row_before, scale_at, tangent_at
from renderer.kernel import callee, fixed, leaf
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
    Pattern,
)

CHORD = 1e-4
CHORDS = 64  # at most this many chords for one crossing of a piece
TURN = 0.2  # the most that a chord turns about an arc's centre, radians
CLOSEST = 1e-6  # rays that pass the centre closer than this part of the groove's width pass through it
WIDER = 1e-3  # how much more than its width is followed of a groove by chords
SINE_CHORDS = 96  # a period of a scale
HAIR = 1e-6  # of a groove's half-width
SMOOTH_HAIR = 2e-4  # where pieces go on smoothly, which may mean a turn of up to paths.SNAP
EVENTS = 8192

BAND, ADD, REMOVE = fixed(0), fixed(1), fixed(2)

# What a ray met (Meeting.facet), where it is not the number of a facet.
PLANE = fixed(-1)  # the base plane
SIDE = fixed(-2)  # a wall along the groove that no facet makes
END = fixed(-3)  # a wall across the groove: a flat end

BODY, CAP_START, CAP_FINISH, TAIL_START, TAIL_FINISH = fixed(0), fixed(1), fixed(2), fixed(3), fixed(4)
PARTS = 5

YES, NO = fixed(True), fixed(False)
NONE = fixed(0)


class Events(NamedTuple):
    """Ends of spans along one ray; memory of one thread, used again by each ray."""

    w: NDArray[np.float64]  # (EVENTS,)
    change: NDArray[np.int32]  # (EVENTS, 5): +1 or -1, BAND, ADD or REMOVE, rank, facet, PARTS * place found + part
    order: NDArray[np.int32]  # (EVENTS,) from high to low
    open: NDArray[np.int32]  # (ranks, 3) spans open at the ray's present height


@leaf
def events(pattern: Pattern) -> Events:
    ranks = 1
    for groove in pattern.grooves:
        ranks = max(ranks, groove.priority + 1)
    return Events(
        np.empty(EVENTS), np.empty((EVENTS, 5), np.int32), np.empty(EVENTS, np.int32), np.zeros((ranks, 3), np.int32)
    )


@leaf
def put(e: Events, n: int, w: float, sign: int, kind: int, rank: int, facet: int, owner: int) -> int:
    """Note the end of a span: the number of events now. Beyond EVENTS they are dropped."""
    if n >= EVENTS:
        return n
    e.w[n] = w
    e.change[n, 0], e.change[n, 1], e.change[n, 2], e.change[n, 3], e.change[n, 4] = sign, kind, rank, facet, owner
    return n + 1


@leaf
def sort(e: Events, n: int) -> None:
    """Fill `e.order` with the n events from high to low, equal ones as they were noted (Shell 1959; Ciura's gaps).

    Most rays have a few events, for which it is an insertion sort.
    """
    for i in range(n):
        e.order[i] = i
    for gap in (701, 301, 132, 57, 23, 10, 4, 1):
        for i in range(gap, n):
            item = e.order[i]
            w = e.w[item]
            at = i
            while at >= gap:
                other = e.order[at - gap]
                if e.w[other] > w or (e.w[other] == w and other < item):
                    break
                e.order[at] = other
                at -= gap
            e.order[at] = item


@leaf
def wall(points: Floats, profile: np.void, side: int, level: float) -> int:
    """What the wall along the left (0) or right (1) of a cross-section is at a height (scale 1): a vertical facet of
    the profile, or none of its facets."""
    i = profile.start if side == 0 else profile.start + profile.count - 2
    found = SIDE
    while profile.start <= i < profile.start + profile.count - 1 and points[i, 0] == points[i + 1, 0]:
        found = i - profile.start
        if min(points[i, 1], points[i + 1, 1]) <= level <= max(points[i, 1], points[i + 1, 1]):
            break
        i += 1 if side == 0 else -1
    return found


@leaf
def upright(points: Floats, first: int, last: int, b: float, level: float) -> int:
    """The vertical facet of the points first .. last that is at b at a height (scale 1), or none of the facets."""
    for i in range(first, last):
        low, high = min(points[i, 1], points[i + 1, 1]), max(points[i, 1], points[i + 1, 1])
        if points[i, 0] == b == points[i + 1, 0] and low <= level <= high:
            return i - first
    return SIDE


@callee
def part_events(
    points: Floats, parts: NDArray[np.void], first: int, last: int, left: float, right: float, rank: int, e: Events,
    n: int, owner: int, edge: int, w0: float, b0: float, f0: float, w1: float, b1: float, f1: float,
) -> int:  # fmt: skip
    """`walk` for a profile that overhangs, which has the points first .. last and reaches from `left` to `right`."""
    enter, leave = 0.0, 1.0
    enter_facet = leave_facet = edge
    for side in range(2):
        limit = left if side == 0 else right
        sign = 1.0 if side == 0 else -1.0
        d0, d1 = sign * (b0 - f0 * limit), sign * (b1 - f1 * limit)
        if d0 < 0.0 and d1 < 0.0:
            return n
        t = d0 / (d0 - d1) if (d0 < 0.0) != (d1 < 0.0) else 0.0
        level = (w0 + t * (w1 - w0)) / (f0 + t * (f1 - f0))
        if d0 < 0.0:
            if t > enter:
                enter, enter_facet = t, upright(points, first, last, limit, level)
        elif d1 < 0.0 and t < leave:
            leave, leave_facet = t, upright(points, first, last, limit, level)
    if enter >= leave:
        return n
    n = put(e, n, w0 + enter * (w1 - w0), 1, BAND, rank, enter_facet, owner)
    n = put(e, n, w0 + leave * (w1 - w0), -1, BAND, rank, leave_facet, owner)
    for k in range(len(parts)):
        part = parts[k]
        removes = part.removes == 1
        t0, t1 = enter, leave
        facet0, facet1 = enter_facet, leave_facet
        for bound in range(4):
            facet = SIDE
            if bound < 2:
                limit = part.b0 if bound == 0 else part.b1
                sign = 1.0 if bound == 0 else -1.0
                d0, d1 = sign * (b0 - f0 * limit), sign * (b1 - f1 * limit)
            else:
                facet = part.lower if bound == 2 else part.upper
                if facet < 0:  # below the plane all is solid anyway
                    continue
                limit = points[first + facet, 0]
                run, rise = (
                    points[first + facet + 1, 0] - limit,
                    points[first + facet + 1, 1] - points[first + facet, 1],
                )
                sign = 1.0 if (run > 0.0) == (bound == 2) else -1.0
                d0 = sign * (run * (w0 - f0 * points[first + facet, 1]) - rise * (b0 - f0 * limit))
                d1 = sign * (run * (w1 - f1 * points[first + facet, 1]) - rise * (b1 - f1 * limit))
            if d0 < 0.0 and d1 < 0.0:
                t1 = t0
                break
            if d0 < 0.0 or d1 < 0.0:
                t = d0 / (d0 - d1)
                starts = d0 < 0.0
                if (starts and t > t0) or (not starts and t < t1):
                    if bound < 2 and starts != removes:  # the others are no way into the solid
                        level = (w0 + t * (w1 - w0)) / (f0 + t * (f1 - f0))
                        facet = upright(points, first, last, limit, level)
                    if starts:
                        t0, facet0 = t, facet
                    else:
                        t1, facet1 = t, facet
        if t0 < t1:
            kind = REMOVE if removes else ADD
            n = put(e, n, w0 + t0 * (w1 - w0), 1, kind, rank, facet0, owner)
            n = put(e, n, w0 + t1 * (w1 - w0), -1, kind, rank, facet1 if removes else SIDE, owner)
    return n


@leaf
def walk(
    points: Floats, parts: NDArray[np.void], profile: np.void, rank: int, e: Events, n: int, owner: int, edge: int,
    w0: float, b0: float, f0: float, w1: float, b1: float, f1: float,
) -> int:  # fmt: skip
    """The events of a ray that falls from height w0 to w1 while its (b, scale) go linearly from (b0, f0) to (b1, f1).

    `edge` says what the wall is where the ray enters or leaves other than along the groove. parts: those of a profile
    that overhangs.
    """
    if len(parts) > 0:
        return part_events(
            points, parts, profile.start, profile.start + profile.count - 1, profile.left, profile.right, rank, e, n,
            owner, edge, w0, b0, f0, w1, b1, f1,
        )  # fmt: skip
    first, last = profile.start, profile.start + profile.count - 1
    # where the ray is inside the band, the sides being linear in w
    enter, leave = 0.0, 1.0
    enter_facet = leave_facet = edge
    for side in range(2):
        limit = profile.left if side == 0 else profile.right
        sign = 1.0 if side == 0 else -1.0
        d0, d1 = sign * (b0 - f0 * limit), sign * (b1 - f1 * limit)
        if d0 < 0.0 and d1 < 0.0:
            return n
        if d0 < 0.0:
            t = d0 / (d0 - d1)
            if t > enter:
                enter, enter_facet = t, wall(points, profile, side, (w0 + t * (w1 - w0)) / (f0 + t * (f1 - f0)))
        elif d1 < 0.0:
            t = d0 / (d0 - d1)
            if t < leave:
                leave, leave_facet = t, wall(points, profile, side, (w0 + t * (w1 - w0)) / (f0 + t * (f1 - f0)))
    if enter >= leave:
        return n
    n = put(e, n, w0 + enter * (w1 - w0), 1, BAND, rank, enter_facet, owner)
    n = put(e, n, w0 + leave * (w1 - w0), -1, BAND, rank, leave_facet, owner)
    beta = (b0 + enter * (b1 - b0)) / (f0 + enter * (f1 - f0))
    beta_end = (b0 + leave * (b1 - b0)) / (f0 + leave * (f1 - f0))
    step = 1 if beta_end >= beta else -1
    i = first
    while i < last - 1 and (points[i + 1, 0] < beta or (points[i + 1, 0] == beta and step > 0)):
        i += 1
    if step < 0:
        while i > first and points[i, 0] >= beta:
            i -= 1
        while i < last - 1 and points[i + 1, 0] < beta:
            i += 1
    t = enter
    adding = removing = False
    came_by = enter_facet
    while True:
        # facet i from t to `until`
        run = points[i + 1, 0] - points[i, 0]
        edge_b = points[i + 1, 0] if step > 0 else points[i, 0]
        d0, d1 = b0 - f0 * edge_b, b1 - f1 * edge_b
        until = leave
        if d0 != d1:
            crossing = d0 / (d0 - d1)
            if t <= crossing < leave:
                until = crossing
            elif crossing < t and step * (beta_end - edge_b) > 0.0:
                until = t
        over_last = (i == last - 1) if step > 0 else (i == first)
        if over_last:
            until = leave
        if run > 0.0:
            slope = (points[i + 1, 1] - points[i, 1]) / run
            base = points[i, 1] - slope * points[i, 0]
            # height above the facet is linear along the chord
            up0 = w0 - f0 * base - slope * b0
            up1 = w1 - f1 * base - slope * b1
            ua, ub = up0 + t * (up1 - up0), up0 + until * (up1 - up0)
            wa = w0 + t * (w1 - w0)
            inner = profile.inner_first <= i - first < profile.inner_last
            now_removing = inner and ua > 0.0
            now_adding = ua < 0.0 and (points[i, 1] > 0.0 or points[i + 1, 1] > 0.0)
            if now_removing != removing:
                n = put(e, n, wa, 1 if now_removing else -1, REMOVE, rank, came_by, owner)
            if now_adding != adding:
                n = put(e, n, wa, 1 if now_adding else -1, ADD, rank, came_by, owner)
            removing, adding = now_removing, now_adding
            if (ua > 0.0) != (ub > 0.0) and ua != ub:
                cross = w0 + (t + (until - t) * ua / (ua - ub)) * (w1 - w0)
                if inner:
                    n = put(e, n, cross, -1 if removing else 1, REMOVE, rank, i - first, owner)
                    removing = not removing
                if points[i, 1] > 0.0 or points[i + 1, 1] > 0.0:
                    n = put(e, n, cross, -1 if adding else 1, ADD, rank, i - first, owner)
                    adding = not adding
            came_by = SIDE
        else:
            level = (w0 + t * (w1 - w0)) / (f0 + t * (f1 - f0))
            if came_by < 0 or min(points[i, 1], points[i + 1, 1]) <= level <= max(points[i, 1], points[i + 1, 1]):
                came_by = i - first  # a vertical wall
        t = max(t, until)
        if t >= leave or over_last:
            break
        i += step
    if removing:
        n = put(e, n, w0 + leave * (w1 - w0), -1, REMOVE, rank, leave_facet, owner)
    if adding:
        n = put(e, n, w0 + leave * (w1 - w0), -1, ADD, rank, leave_facet, owner)
    return n


@leaf
def cut(
    points: Floats, parts: NDArray[np.void], profile: np.void, rank: int, e: Events, n: int, owner: int,
    w0: float, s0: float, b0: float, f0: float, w1: float, s1: float, b1: float, f1: float,
    begin_left: float, begin_right: float, length: float, end_left: float, end_right: float, caps: bool,
) -> int:  # fmt: skip
    """`walk`, for the part of the ray's chord between the ends s = begin * b and s = length + end * b.

    The ends' slopes differ to the left (b > 0) and to the right; a cap has the left side alone.
    """
    middle = -1.0
    if (b0 > 0.0) != (b1 > 0.0) and b0 != b1 and (caps or begin_left != begin_right or end_left != end_right):
        middle = b0 / (b0 - b1)
    for half in range(2):
        low, high = 0.0, 1.0
        if middle >= 0.0:
            low, high = (0.0, middle) if half == 0 else (middle, 1.0)
        elif half == 1:
            break
        side = b0 + 0.5 * (low + high) * (b1 - b0)
        if caps and side <= 0.0:
            continue
        begin, end = (begin_left, end_left) if side > 0.0 else (begin_right, end_right)
        for which in range(2):
            if which == 0:
                d0, d1 = s0 - begin * b0, s1 - begin * b1
            else:
                d0, d1 = length + end * b0 - s0, length + end * b1 - s1
            at_low, at_high = d0 + low * (d1 - d0), d0 + high * (d1 - d0)
            if at_low < 0.0 and at_high < 0.0:
                high = low
            elif at_low < 0.0:
                low = min(low + (high - low) * at_low / (at_low - at_high), high)
            elif at_high < 0.0:
                high = max(low + (high - low) * at_low / (at_low - at_high), low)
        if low < high:
            n = walk(
                points, parts, profile, rank, e, n, owner, END,
                w0 + low * (w1 - w0), b0 + low * (b1 - b0), f0 + low * (f1 - f0),
                w0 + high * (w1 - w0), b0 + high * (b1 - b0), f0 + high * (f1 - f0),
            )  # fmt: skip
    return n


@leaf
def chords(profile: np.void, groove: np.void, piece: np.void, closest: float, turn: float) -> int:
    """How many chords follow a ray around an arc while asinh(u / closest) changes by `turn`.

    u is the place on the ray from its point nearest to the arc's centre, and `closest` that point's distance, pattern
    units. A chord with such a step leaves the ray by step^2 / 8 of `closest` at the most, and turns about the centre by
    no more than the step.
    """
    width = (profile.right - profile.left) * groove.scale_max * piece.size
    count = turn / min(TURN, math.sqrt(8.0 * CHORD * width / closest))
    if groove.scale_kind != SCALE_CONSTANT:
        part = (piece.t1 - piece.t0) * min(turn / (piece.length * abs(piece.curvature)), 1.0)
        if groove.scale_kind == SCALE_LINEAR:
            count = max(count, 64.0 * part)
        elif groove.scale_kind == SCALE_SINE:
            count = max(count, SINE_CHORDS * groove.scale_b * part)
        else:
            count = max(count, 4.0 * groove.table_count * part)
    return int(math.ceil(min(max(count, 1.0), CHORDS + 0.0)))


@leaf
def meet_piece(
    pattern: Pattern, e: Events, n: int, found: int, item: int, dx: float, dy: float,
    p: float, q: float, gp: float, gq: float, high: float, low: float,
) -> int:  # fmt: skip
    """The events of one piece, shifted by (dx, dy), for the ray between the heights `high` and `low`."""
    piece = pattern.pieces[item]
    groove = pattern.grooves[piece.groove]
    profile = pattern.profiles[groove.profile]
    points, rank = pattern.points, groove.priority
    parts = pattern.parts[0:0]
    if len(pattern.part_first) > 0:
        parts = pattern.parts[pattern.part_first[groove.profile] : pattern.part_first[groove.profile + 1]]
    most = groove.scale_max * piece.size
    left, right = profile.left * most, profile.right * most
    x0, y0 = p - dx + high * gp, q - dy + high * gq
    x1, y1 = p - dx + low * gp, q - dy + low * gq
    capped = profile.right > 0.0
    ratio = profile.right / -profile.left if profile.left < 0.0 else 0.0  # right half-width by left
    # Pieces that go on in one another overlap by a hair, as no two of them end at quite the same line.
    hair = HAIR * piece.half
    start_hair = finish_hair = 0.0
    if piece.start_end != FLAT:
        start_hair = SMOOTH_HAIR * piece.half if piece.start_end == SMOOTH else hair * (1.0 + abs(piece.start_mitre))
    if piece.finish_end != FLAT:
        finish_hair = SMOOTH_HAIR * piece.half if piece.finish_end == SMOOTH else hair * (1.0 + abs(piece.finish_mitre))

    if piece.curvature == 0.0:
        begin_left = begin_right = end_left = end_right = 0.0
        if piece.start_end == CORNER:
            begin_left = begin_right = piece.start_mitre
        elif piece.start_end == PROFILE and capped:
            begin_left, begin_right = -1.0, ratio
        if piece.finish_end == CORNER:
            end_left = end_right = -piece.finish_mitre
        elif piece.finish_end == PROFILE and capped:
            end_left, end_right = 1.0, -ratio
        s0, b0 = locate(piece, x0, y0)
        s1, b1 = locate(piece, x1, y1)
        varies = s0 != s1 and groove.scale_kind != SCALE_CONSTANT
        if not (min(b0, b1) > right or max(b0, b1) < left):
            t0, t1 = 0.0, 1.0
            if varies and b0 != b1:  # a little more than the band, whose sides `walk` finds
                more = WIDER * (right - left)
                ta, tb = (left - more - b0) / (b1 - b0), (right + more - b0) / (b1 - b0)
                t0, t1 = max(t0, min(ta, tb)), min(t1, max(ta, tb))
            least = (t1 - t0) / (4 * CHORDS)
            a = t0
            while a < t1:
                sa = s0 + a * (s1 - s0)
                c = t1
                if varies:
                    stop = (next_stop(pattern.scale_table, groove, piece, sa, s1 > s0) - s0) / (s1 - s0)
                    c = min(t1, max(stop, a + least))
                sc = s0 + c * (s1 - s0)
                fa, _ = scale_at(pattern.scale_table, groove, piece, sa)
                fc, _ = scale_at(pattern.scale_table, groove, piece, sc)
                n = cut(
                    points, parts, profile, rank, e, n, PARTS * found + BODY,
                    high + a * (low - high), sa + start_hair, b0 + a * (b1 - b0), fa,
                    high + c * (low - high), sc + start_hair, b0 + c * (b1 - b0), fc,
                    begin_left, begin_right, piece.length + start_hair + finish_hair, end_left, end_right, NO,
                )  # fmt: skip
                a = c
        if piece.closed == 0 and capped:
            if piece.start_end == PROFILE and min(s0, s1) < 0.0:
                f, _ = scale_at(pattern.scale_table, groove, piece, 0.0)
                n = meet_cap(
                    points, parts, profile, rank, e, n, PARTS * found + CAP_START, CAP_START, f,
                    -s0, b0, -s1, b1, high, low,
                )  # fmt: skip
            if piece.finish_end == PROFILE and max(s0, s1) > piece.length:
                f, _ = scale_at(pattern.scale_table, groove, piece, piece.length)
                n = meet_cap(
                    points, parts, profile, rank, e, n, PARTS * found + CAP_FINISH, CAP_FINISH, f,
                    s0 - piece.length, -b0, s1 - piece.length, -b1, high, low,
                )  # fmt: skip
        return n

    # An arc: the ray inside the ring, which it may cross twice.
    radius = 1.0 / piece.curvature
    cx, cy = piece.x - piece.ty * radius, piece.y + piece.tx * radius
    size = abs(radius)
    more = WIDER * (right - left)
    outer = size + (-left if radius > 0.0 else right) + more
    inner = max(size - (right if radius > 0.0 else -left) - more, 0.0)
    ax, ay, rx, ry = x0 - cx, y0 - cy, x1 - x0, y1 - y0
    a, h, c = rx * rx + ry * ry, ax * rx + ay * ry, ax * ax + ay * ay
    speed = math.sqrt(a)
    foot = -h / a if a > 0.0 else 0.0  # where the ray is closest to the centre
    closest = max(math.hypot(ax + foot * rx, ay + foot * ry), CLOSEST * (right - left))
    o0, o1, i0, i1 = 0.0, 1.0, 2.0, 2.0
    if a <= 1e-30 * c:
        if not inner * inner <= c <= outer * outer:
            o1 = -1.0
    else:
        root = h * h - a * (c - outer * outer)
        if root <= 0.0:
            o1 = -1.0
        else:
            root = math.sqrt(root)
            o0, o1 = max((-h - root) / a, 0.0), min((-h + root) / a, 1.0)
            root = h * h - a * (c - inner * inner)
            if root > 0.0:
                root = math.sqrt(root)
                i0, i1 = (-h - root) / a, (-h + root) / a
    # Its ends are straight lines across it: how far inside of them the ray is at its two ends.
    ds0, ds1 = inside(piece, 0.0, x0, y0) + start_hair, inside(piece, 0.0, x1, y1) + start_hair
    df0, df1 = inside(piece, piece.length, x0, y0) + finish_hair, inside(piece, piece.length, x1, y1) + finish_hair
    if i0 > 1.0:
        i0 = i1 = foot  # there chords end, as they leave the ray most
    for crossing in range(2):
        t0, t1 = (o0, min(o1, i0)) if crossing == 0 else (max(o0, i1), o1)
        if t0 >= t1:
            continue
        begin, end = math.asinh((t0 - foot) * speed / closest), math.asinh((t1 - foot) * speed / closest)
        count = chords(profile, groove, piece, closest, end - begin)
        s0, b0 = locate(piece, x0 + t0 * rx, y0 + t0 * ry)
        f0, _ = scale_at(pattern.scale_table, groove, piece, s0)
        ta = t0
        for k in range(count):
            tc = t1
            if k < count - 1:
                tc = foot + math.sinh(begin + (end - begin) * (k + 1) / count) * closest / speed
            s1, b1 = locate(piece, x0 + tc * rx, y0 + tc * ry)
            f1, _ = scale_at(pattern.scale_table, groove, piece, s1)
            if piece.closed == 1 or abs(s1 - s0) <= math.pi * size:  # not across the far side, where s starts again
                u0, u1 = 0.0, 1.0
                for which in range(2 if piece.closed == 0 else 0):
                    # the line across an end meets the ring once more: there it does not count
                    at = 0.0 if which == 0 else piece.length
                    lean = math.atan(piece.start_mitre) if which == 0 else -math.atan(piece.finish_mitre)
                    angle = (0.5 * (s0 + s1) - at) / size + math.copysign(lean, lean * radius)
                    d0, d1 = (ds0, ds1) if which == 0 else (df0, df1)
                    if abs(angle) > 0.5 * math.pi:
                        if (angle < 0.0) == (which == 0):
                            u1 = -1.0
                        continue
                    d0, d1 = d0 + ta * (d1 - d0), d0 + tc * (d1 - d0)
                    if d0 < 0.0 and d1 < 0.0:
                        u1 = -1.0
                    elif d0 < 0.0:
                        u0 = max(u0, d0 / (d0 - d1))
                    elif d1 < 0.0:
                        u1 = min(u1, d0 / (d0 - d1))
                if u0 < u1:
                    n = walk(
                        points, parts, profile, rank, e, n, PARTS * found + BODY, END,
                        high + (ta + u0 * (tc - ta)) * (low - high), b0 + u0 * (b1 - b0), f0 + u0 * (f1 - f0),
                        high + (ta + u1 * (tc - ta)) * (low - high), b0 + u1 * (b1 - b0), f0 + u1 * (f1 - f0),
                    )  # fmt: skip
            s0, b0, f0, ta = s1, b1, f1, tc
    if piece.closed == 0 and capped:
        for end in range(2):
            if (piece.start_end if end == 0 else piece.finish_end) != PROFILE:
                continue
            s = 0.0 if end == 0 else piece.length
            tx, ty = tangent_at(piece, s)
            ex, ey = point_at(piece, s)
            out = -1.0 if end == 0 else 1.0
            f, _ = scale_at(pattern.scale_table, groove, piece, s)
            s0, s1 = out * ((x0 - ex) * tx + (y0 - ey) * ty), out * ((x1 - ex) * tx + (y1 - ey) * ty)
            b0, b1 = (y0 - ey) * tx - (x0 - ex) * ty, (y1 - ey) * tx - (x1 - ex) * ty
            if max(s0, s1) <= 0.0:
                continue
            # past its end the groove goes on straight, as far as it is read along b
            n = cut(
                points, parts, profile, rank, e, n, PARTS * found + (TAIL_START if end == 0 else TAIL_FINISH),
                high, s0 + hair, b0, f, low, s1 + hair, b1, f, 0.0, 0.0, 2.0 * hair, 1.0, -ratio, NO,
            )  # fmt: skip
            part = CAP_START if end == 0 else CAP_FINISH
            n = meet_cap(
                points, parts, profile, rank, e, n, PARTS * found + part, part, f,
                s0, -out * b0, s1, -out * b1, high, low,
            )  # fmt: skip
    return n


@leaf
def inside(piece: np.void, s: float, x: float, y: float) -> float:
    """How far a point is inside the line that ends an arc at s: 0 or its length."""
    tx, ty = tangent_at(piece, s)
    ex, ey = point_at(piece, s)
    on, across = (x - ex) * tx + (y - ey) * ty, (y - ey) * tx - (x - ex) * ty
    return on - piece.start_mitre * across if s == 0.0 else -on - piece.finish_mitre * across


@leaf
def next_stop(scale_table: Floats, groove: np.void, piece: np.void, s: float, forwards: bool) -> float:
    """Where along a straight piece, beyond s, its scale bends: between these places it counts as linear."""
    sign = 1.0 if forwards else -1.0
    s += sign * 1e-9 * piece.length
    if s <= 0.0:
        return 0.0 if forwards else -math.inf
    if s >= piece.length:
        return math.inf if forwards else piece.length
    if groove.scale_kind == SCALE_SINE:
        step = piece.length / math.ceil(max(SINE_CHORDS * groove.scale_b * (piece.t1 - piece.t0), 1.0))
        stop = step * (math.floor(s / step) + 1.0) if forwards else step * (math.ceil(s / step) - 1.0)
        return min(max(stop, 0.0), piece.length)
    if groove.scale_kind == SCALE_TABLE:
        t = piece.t0 + (piece.t1 - piece.t0) * s / piece.length
        row = row_before(scale_table, groove.table_start, groove.table_count, t)
        knot = (scale_table[row + 1 if forwards else row, 0] - piece.t0) / (piece.t1 - piece.t0) * piece.length
        return min(max(knot, 0.0), piece.length)
    return piece.length if forwards else 0.0


@leaf
def meet_cap(
    points: Floats, parts: NDArray[np.void], profile: np.void, rank: int, e: Events, n: int, owner: int, part: int,
    f: float, b0: float, s0: float, b1: float, s1: float, high: float, low: float,
) -> int:  # fmt: skip
    """The events of the cap of a `profile` end: the profile's right half along a line square to the path.

    b is the distance past the end, s runs to the right of someone who leaves the path there.
    """
    left = -profile.left / profile.right if profile.left < 0.0 else 0.0
    if max(b0, b1) < 0.0 or min(b0, b1) > f * profile.right:
        return n
    # leaving by the finish, s > 0 is the path's right side; by the start, its left side
    begin, end = (-1.0, left) if part == CAP_FINISH else (-left, 1.0)
    return cut(
        points, parts, profile, rank, e, n, owner, high, s0, b0, f, low, s1, b1, f, begin, begin, 0.0, end, end, YES
    )
