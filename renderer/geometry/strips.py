"""Grooves seen from above: convex strips of the plane, one a facet, each with a height linear in (p, q).

Of a profile that overhangs there is one for each of its trapezoids, with two heights: what lies between them is removed
or added.

A straight groove of a constant or linear scale is made of such strips exactly, its mitres and the caps of its
`profile` ends included. Arcs are followed by chords, and other scales by steps, that leave them by no more than a
given distance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.domain import Domain
from renderer.geometry.pieces import point_at, scale_at, tangent_at
from renderer.geometry.polygon import CORNERS, Counts, clipped, enclose
from renderer.geometry.spans import BODY, CAP_FINISH, CAP_START, END, SIDE, TAIL_FINISH, TAIL_START, next_stop
from renderer.kernel import leaf
from renderer.tables import CORNER, FLAT, PROFILE, SCALE_CONSTANT, SCALE_SINE, Floats, Pattern

STRIPS, WALLS, CHUNKS = 4096, 4096, 512  # room for those of one surface
BEND = 0.1  # a chord turns by no more, radians

CHUNK = np.dtype(
    [
        ("x", "f8"), ("y", "f8"), ("tx", "f8"), ("ty", "f8"),  # origin and tangent: (s, b) are local coordinates
        ("f", "f8"), ("g", "f8"),  # the scale is f + g s
        ("planes", "f8", (6, 3)), ("count", "i8"),  # its half-planes
        ("radius", "f8"), ("wedge", "f8"),  # arcs of changing scale: the centre's b, tan of half the angle
        ("half", "i8"),  # 1: where b >= 0 alone, -1: b <= 0, 0: both
        ("part", "i8"),
        ("start", "i8"), ("finish", "i8"),  # 1: it may end in a wall there
        ("ends", "f8", (2, 5)),  # where: a point of the axis, the way of a unit of b, the scale
    ]
)  # fmt: skip
"""A stretch of a groove, or a cap, that is straight and has a linear scale."""


class Strips(NamedTuple):
    """The strips within one domain of the plane, and where walls may stand between them; memory of one thread."""

    made: Counts  # (3,) how many strips, bands and walls there are; -1: too many
    chunks: NDArray[np.void]  # (CHUNKS,) CHUNK
    polygon: Floats  # (STRIPS, CORNERS, 2)
    corners: Counts  # (STRIPS,) of each
    box: Floats  # (STRIPS, 4) p0, q0, p1, q1
    height: Floats  # (STRIPS, 3) w = h0 p + h1 q + h2; of a trapezoid: its lower side
    roof: Floats  # (STRIPS, 3) the upper side of a trapezoid
    tag: Counts  # (STRIPS, 7) place of the piece in `Nearby`, facet, part, rank, whether the facet is internal; of a
    # trapezoid, whether it removes, and its row of `Pattern.parts` + 1, else 0; its band
    edge: Floats  # (STRIPS, CORNERS, 3) the half-planes of its edges
    edges: Counts  # (STRIPS,) how many
    band: Floats  # (STRIPS, CORNERS, 2) what the strips cover together
    band_count: Counts  # (STRIPS,)
    band_rank: Counts  # (STRIPS,)
    wall: Floats  # (WALLS, 4) p0, q0, p1, q1
    wall_tag: Counts  # (WALLS, 4) as `tag`: piece, facet or SIDE or END, part; of what overhangs the profile's point;
    # its band
    one: Floats  # (CORNERS, 2) for clipping
    two: Floats
    sides: Floats  # (CORNERS, 3) half-planes
    rims: Floats  # (2, 2, 3) lines of a facet


@leaf
def strips_of() -> Strips:
    return Strips(
        np.zeros(3, np.int64), np.zeros(CHUNKS, CHUNK), np.empty((STRIPS, CORNERS, 2)), np.empty(STRIPS, np.int64),
        np.empty((STRIPS, 4)), np.empty((STRIPS, 3)), np.empty((STRIPS, 3)), np.empty((STRIPS, 7), np.int64),
        np.empty((STRIPS, CORNERS, 3)), np.empty(STRIPS, np.int64),
        np.empty((STRIPS, CORNERS, 2)), np.empty(STRIPS, np.int64), np.empty(STRIPS, np.int64), np.empty((WALLS, 4)),
        np.empty((WALLS, 4), np.int64), np.empty((CORNERS, 2)), np.empty((CORNERS, 2)), np.empty((CORNERS, 3)),
        np.empty((2, 2, 3)),
    )  # fmt: skip


@leaf
def bound(chunk: np.void, a: float, b: float, c: float) -> None:
    chunk.planes[chunk.count, 0], chunk.planes[chunk.count, 1], chunk.planes[chunk.count, 2] = a, b, c
    chunk.count += 1


@leaf
def bound_local(chunk: np.void, x: float, y: float, s: float, b: float, c: float) -> None:
    """The half-plane s S + b B + c >= 0 in local coordinates about (x, y) with the chunk's tangent."""
    px, py = s * chunk.tx - b * chunk.ty, s * chunk.ty + b * chunk.tx
    bound(chunk, px, py, c - px * x - py * y)


@leaf
def begin(chunk: np.void, x: float, y: float, tx: float, ty: float, f: float, g: float, part: int) -> None:
    chunk.x, chunk.y, chunk.tx, chunk.ty, chunk.f, chunk.g, chunk.part = x, y, tx, ty, f, g, part
    chunk.count = chunk.half = chunk.start = chunk.finish = 0
    chunk.radius = chunk.wedge = 0.0


@leaf
def end_at(chunk: np.void, end: int, x: float, y: float, tx: float, ty: float, f: float) -> None:
    """Let a chunk end, at its start (0) or finish (1), in a wall across (tx, ty)."""
    if end == 0:
        chunk.start = 1
    else:
        chunk.finish = 1
    chunk.ends[end, 0], chunk.ends[end, 1], chunk.ends[end, 2], chunk.ends[end, 3] = x, y, -ty, tx
    chunk.ends[end, 4] = f


@leaf
def bends(pattern: Pattern, groove: np.void, piece: np.void, s: float, high: float, tolerance: float) -> float:
    """Up to where, above s and at most `high`, the scale counts as linear."""
    if groove.scale_kind == SCALE_CONSTANT:
        return high
    if s < 0.0:
        return min(0.0, high)
    if s >= piece.length:
        return high
    if groove.scale_kind == SCALE_SINE:
        rate = 2.0 * math.pi * abs(groove.scale_b) * (piece.t1 - piece.t0) / piece.length
        bend = abs(groove.scale_a) * rate * rate * (piece.half + pattern.depth + pattern.height)
        step = min(math.sqrt(8.0 * tolerance / bend), 0.5 / rate) if bend > 0.0 else piece.length
        step = piece.length / math.ceil(min(piece.length / step, 1e7))
        stop = step * (math.floor(s / step + 1e-9) + 1.0)
        return min(stop, high, piece.length)
    return min(max(next_stop(pattern.scale_table, groove, piece, s, True), s + 1e-9 * piece.length), high, piece.length)


@leaf
def divide(
    pattern: Pattern, item: int, dx: float, dy: float, slab: Floats, tolerance: float, chunks: NDArray[np.void]
) -> int:
    """Write the chunks of a piece that may reach the domain with these slabs: how many; -1: too many."""
    piece = pattern.pieces[item]
    groove = pattern.grooves[piece.groove]
    profile = pattern.profiles[groove.profile]
    right = profile.right
    capped = right > 0.0 and piece.closed == 0
    ratio = profile.right / -profile.left if profile.left < 0.0 else 0.0
    left = -profile.left / profile.right if profile.left < 0.0 and capped else 0.0
    wide = 1.01 * piece.half / max(profile.right, -profile.left, 1e-300)
    n = 0
    if piece.curvature == 0.0:
        x, y, tx, ty = piece.x + dx, piece.y + dy, piece.tx, piece.ty
        low, high = math.inf, -math.inf
        for k in range(4):
            cx, cy = slab[0, k & 1], slab[1, k >> 1]
            s = (cx - x) * tx + (cy - y) * ty
            low, high = min(low, s), max(high, s)
        s = max(low, -4.0 * pattern.reach)
        high = min(high, piece.length + 4.0 * pattern.reach)
        halved = capped and (piece.start_end == PROFILE or piece.finish_end == PROFILE)
        while s < high:
            until = bends(pattern, groove, piece, s, high, tolerance)
            f0, _ = scale_at(pattern.scale_table, groove, piece, s)
            f1, _ = scale_at(pattern.scale_table, groove, piece, until)
            g = (f1 - f0) / (until - s)
            if groove.scale_kind == SCALE_CONSTANT:
                g = 0.0
            for side in range(2 if halved else 1):
                if n == len(chunks):
                    return -1
                chunk = chunks[n]
                begin(chunk, x, y, tx, ty, f0 - g * s, g, BODY)
                if halved:
                    chunk.half = 1 - 2 * side
                if groove.scale_kind != SCALE_CONSTANT:
                    bound_local(chunk, x, y, 1.0, 0.0, -s)
                    bound_local(chunk, x, y, -1.0, 0.0, until)
                a = b = 0.0
                if piece.start_end == CORNER:
                    a = piece.start_mitre
                    if piece.start_step:
                        end_at(chunk, 0, x, y, tx + a * ty, ty - a * tx, wide)
                elif piece.start_end == PROFILE and capped:
                    a = -1.0 if side == 0 else ratio
                elif piece.start_end == FLAT or piece.start_end == PROFILE:
                    end_at(chunk, 0, x, y, tx, ty, f0 - g * s)
                if piece.finish_end == CORNER:
                    b = -piece.finish_mitre
                    if piece.finish_step:
                        along = piece.length
                        end_at(chunk, 1, x + along * tx, y + along * ty, tx + b * ty, ty - b * tx, wide)
                elif piece.finish_end == PROFILE and capped:
                    b = 1.0 if side == 0 else -ratio
                elif piece.finish_end == FLAT or piece.finish_end == PROFILE:
                    along = piece.length
                    end_at(chunk, 1, x + along * tx, y + along * ty, tx, ty, f0 + g * (along - s))
                bound_local(chunk, x, y, 1.0, -a, 0.0)
                bound_local(chunk, x, y, -1.0, b, piece.length)
                n += 1
            s = until
    else:
        radius = 1.0 / piece.curvature
        size = abs(radius)
        cx, cy = piece.x + dx - piece.ty * radius, piece.y + dy + piece.tx * radius
        most = 0.5 * math.pi * size  # that an arc goes on to its mitre; past other ends there would be slivers
        low = -min(2.0 * abs(piece.start_mitre) * piece.half, most)
        high = piece.length + min(2.0 * abs(piece.finish_mitre) * piece.half, most)
        # Chords whose mean leaves the arc by nothing, and their ends and middles by about half of this each. Powers of
        # two of them, so that those of rings side by side lie side by side: else gaps open between rings that touch.
        turn = min(math.sqrt(12.0 * tolerance / (size + piece.half)), BEND)
        step = piece.length * 2.0 ** -max(math.ceil(math.log2(piece.length / (turn * size))), 0.0)
        if groove.scale_kind == SCALE_SINE:  # chunks as long as one another
            step = min(step, bends(pattern, groove, piece, 0.0, piece.length, tolerance))
            step = piece.length / math.ceil(piece.length / step - 1e-9)
        # The arc within the domain, by the angles of its corners about the centre as seen from its middle.
        mx, my = 0.5 * (slab[0, 0] + slab[0, 1]) - cx, 0.5 * (slab[1, 0] + slab[1, 1]) - cy
        far = 0.5 * math.hypot(slab[0, 1] - slab[0, 0], slab[1, 1] - slab[1, 0])
        at, around = 0.0, math.pi
        if math.hypot(mx, my) > far:
            tx, ty = tangent_at(piece, 0.5 * piece.length)
            sign = math.copysign(1.0, radius)
            ux, uy = sign * ty, -sign * tx  # from the centre to the middle of the arc
            at = math.atan2(ux * my - uy * mx, ux * mx + uy * my) * sign
            around = math.asin(far / math.hypot(mx, my))
        for turned in range(-1, 2):  # once round, where the arc is more than half a circle
            middle = 0.5 * piece.length + (at + 2.0 * math.pi * turned) * size
            a, b = max(low, middle - around * size), min(high, middle + around * size)
            if around == math.pi:
                if turned != 0:
                    continue
                a, b = low, high
            if a >= b:
                continue
            for k in range(math.floor(a / step + 1e-9), math.ceil(b / step - 1e-9)):
                s0, s1 = k * step, (k + 1) * step
                s = s0
                while s < s1 - 1e-9 * step:
                    until = s1
                    if groove.scale_kind != SCALE_SINE:
                        until = bends(pattern, groove, piece, s, s1, tolerance)
                    if n == len(chunks):
                        return -1
                    chunk = chunks[n]
                    n += 1
                    tx, ty = tangent_at(piece, 0.5 * (s + until))
                    px, py = point_at(piece, 0.5 * (s + until))
                    theta = (until - s) / size
                    # out from the centre, so that the mean distance is kept
                    out = radius * ((1.0 + theta * theta / 12.0) * math.cos(0.5 * theta) - 1.0)
                    px, py = px + dx + ty * out, py + dy - tx * out
                    f0, _ = scale_at(pattern.scale_table, groove, piece, s)
                    f1, _ = scale_at(pattern.scale_table, groove, piece, until)
                    long = 2.0 * size * math.tan(0.5 * theta)
                    begin(chunk, px, py, tx, ty, 0.5 * (f0 + f1), (f1 - f0) / long, BODY)
                    if f0 != f1:
                        chunk.radius, chunk.wedge = radius + out, math.tan(0.5 * theta)
                    ux, uy = tangent_at(piece, s)
                    bound(chunk, ux, uy, -ux * cx - uy * cy)
                    ux, uy = tangent_at(piece, until)
                    bound(chunk, -ux, -uy, ux * cx + uy * cy)
                    beyond = False
                    if piece.closed == 0:
                        for end in range(2):
                            e = 0.0 if end == 0 else piece.length
                            # the line across an end meets the ring once more: there it does not count
                            lean = math.atan(piece.start_mitre) if end == 0 else -math.atan(piece.finish_mitre)
                            angle = (0.5 * (s + until) - e) / size + math.copysign(lean, lean * radius)
                            if abs(angle) > 0.5 * math.pi:
                                beyond = beyond or (angle < 0.0) == (end == 0)
                                continue
                            ux, uy = tangent_at(piece, e)
                            ex, ey = point_at(piece, e)
                            ex, ey = ex + dx, ey + dy
                            if end == 0:
                                vx, vy = ux + piece.start_mitre * uy, uy - piece.start_mitre * ux
                            else:
                                vx, vy = -ux + piece.finish_mitre * uy, -uy - piece.finish_mitre * ux
                            bound(chunk, vx, vy, -vx * ex - vy * ey)
                            ends = piece.start_end if end == 0 else piece.finish_end
                            near = min(abs(s0 - e), abs(s1 - e)) < 0.5 * step
                            if piece.start_step if end == 0 else piece.finish_step:
                                end_at(chunk, end, ex, ey, vx if end == 0 else -vx, vy if end == 0 else -vy, wide)
                            elif near and (ends == FLAT or (ends == PROFILE and not capped)):
                                end_at(chunk, end, ex, ey, ux, uy, f0 if end == 0 else f1)
                    if beyond:
                        n -= 1
                    s = until
    if not capped:
        return n
    for end in range(2):
        if (piece.start_end if end == 0 else piece.finish_end) != PROFILE:
            continue
        s = 0.0 if end == 0 else piece.length
        f, _ = scale_at(pattern.scale_table, groove, piece, s)
        ux, uy = tangent_at(piece, s)
        ex, ey = point_at(piece, s)
        ex, ey = ex + dx, ey + dy
        if n + 3 > len(chunks):
            return -1
        if end == 0:
            ux, uy = -ux, -uy  # outwards
        if piece.curvature != 0.0:  # past its end the groove goes on straight
            for side in range(2):
                chunk = chunks[n]
                n += 1
                if end == 0:
                    begin(chunk, ex, ey, -ux, -uy, f, 0.0, TAIL_START)
                    bound_local(chunk, ex, ey, -1.0, 0.0, 0.0)
                    bound_local(chunk, ex, ey, 1.0, 1.0 if side == 0 else -ratio, 0.0)
                else:
                    begin(chunk, ex, ey, ux, uy, f, 0.0, TAIL_FINISH)
                    bound_local(chunk, ex, ey, 1.0, 0.0, 0.0)
                    bound_local(chunk, ex, ey, -1.0, 1.0 if side == 0 else -ratio, 0.0)
                chunk.half = 1 - 2 * side
        # the cap: B outwards, T to the right of someone who leaves the path there
        chunk = chunks[n]
        n += 1
        begin(chunk, ex, ey, uy, -ux, f, 0.0, CAP_START if end == 0 else CAP_FINISH)
        low, high = (-left, 1.0) if end == 0 else (-1.0, left)
        bound_local(chunk, ex, ey, 1.0, -low, 0.0)
        bound_local(chunk, ex, ey, -1.0, high, 0.0)
        chunk.half = 1
    return n


@leaf
def keep_wall(
    walls: Floats, tags: Counts, n: int, planes: Floats, count: int, half: int, bx: float, by: float, bc: float,
    domain: Domain, x0: float, y0: float, x1: float, y1: float, near: float, found: int, facet: int, part: int,
    band: int,
) -> int:  # fmt: skip
    """Add the part of a line from (x0, y0) to (x1, y1) that is within the half-planes and the domain: how many."""
    low, high = 0.0, 1.0
    for k in range(count + 1 + 2 * domain.made[0]):
        if k < count:
            a, b, c = planes[k, 0], planes[k, 1], planes[k, 2]
        elif k == count:
            if half == 0:
                continue
            a, b, c = half * bx, half * by, half * bc
        else:
            i = k - count - 1
            a, b, c = domain.planes[i, 0], domain.planes[i, 1], domain.planes[i, 2]
        long = math.hypot(a, b)
        d0, d1 = (a * x0 + b * y0 + c) / long, (a * x1 + b * y1 + c) / long
        if abs(d0) <= near and abs(d1) <= near:
            continue
        at_low, at_high = d0 + low * (d1 - d0), d0 + high * (d1 - d0)
        if at_low <= 0.0 and at_high <= 0.0:
            return n
        if at_low < 0.0:
            low += (high - low) * at_low / (at_low - at_high)
        elif at_high < 0.0:
            high = low + (high - low) * at_low / (at_low - at_high)
    if (high - low) * math.hypot(x1 - x0, y1 - y0) <= near:
        return n
    if n < 0 or n == len(walls):
        return -1
    walls[n, 0], walls[n, 1] = x0 + low * (x1 - x0), y0 + low * (y1 - y0)
    walls[n, 2], walls[n, 3] = x0 + high * (x1 - x0), y0 + high * (y1 - y0)
    tags[n, 0], tags[n, 1], tags[n, 2], tags[n, 3] = found, facet, part, band
    return n + 1


@leaf
def rim(chunk: np.void, beta: float, w: float, slope: float, ends: Floats) -> None:
    """Write the ends (p, q, w) of the line b = scale * beta, at the height w of the profile, of a chunk with a wedge.

    It is straight from end to end, and facets are two triangles each: so neighbours meet. Lines end at the centre,
    where the profile is read on along its slope.
    """
    reach = abs(chunk.radius) * chunk.wedge
    for end in range(2):
        sign = 2.0 * end - 1.0
        f = chunk.f + sign * chunk.g * reach
        b = min(f * beta, chunk.radius) if chunk.radius > 0.0 else max(f * beta, chunk.radius)
        s = sign * abs(chunk.radius - b) * chunk.wedge
        ends[end, 0], ends[end, 1] = chunk.x + s * chunk.tx - b * chunk.ty, chunk.y + s * chunk.ty + b * chunk.tx
        ends[end, 2] = f * w + slope * (b - f * beta)


@leaf
def tag_strip(strips: Strips, at: int, corners: int, found: int, facet: int, part: int, rank: int, inner: bool) -> None:
    polygon, box, tag = strips.polygon[at], strips.box[at], strips.tag[at]
    strips.corners[at] = corners
    enclose(polygon, corners, box)
    tag[0], tag[1], tag[2], tag[3], tag[4], tag[5] = found, facet, part, rank, 1 if inner else 0, 0
    tag[6] = strips.made[1] - 1


@leaf
def within(polygon: Floats, count: int, domain: Domain, strips: Strips) -> int:
    """Cut a polygon by the domain: how many corners it has."""
    return clipped(polygon, count, domain.planes, 0, 2 * domain.made[0], strips.two)


@leaf
def triangle(chunk: np.void, a: Floats, b: Floats, c: Floats, domain: Domain, strips: Strips, at: int) -> int:
    """Write strip `at` for a triangle within the chunk and the domain: how many corners it has."""
    ux, uy, uw = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vw = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    twice = ux * vy - uy * vx
    if twice <= 1e-12 * (abs(ux) + abs(uy)) * (abs(vx) + abs(vy)):
        return 0
    polygon, height = strips.polygon[at], strips.height[at]
    height[0], height[1] = (uw * vy - uy * vw) / twice, (ux * vw - uw * vx) / twice
    height[2] = a[2] - height[0] * a[0] - height[1] * a[1]
    for k in range(2):
        polygon[0, k], polygon[1, k], polygon[2, k] = a[k], b[k], c[k]
    count = within(polygon, 3, domain, strips)
    return clipped(polygon, count, chunk.planes, 0, chunk.count, strips.two) if count else 0


@leaf
def overhangs(pattern: Pattern, profile: int) -> bool:
    """Whether a profile is no height field."""
    return len(pattern.part_first) > 0 and pattern.part_first[profile] < pattern.part_first[profile + 1]


@leaf
def lay_parts(
    pattern: Pattern, item: int, found: int, chunk: np.void, count: int, domain: Domain, strips: Strips
) -> bool:  # fmt: skip
    """Add the strips of a chunk of a groove that overhangs. False where there is no room.

    count: the corners of its band, the last of `strips.band`.
    """
    groove = pattern.grooves[pattern.pieces[item].groove]
    bx, by = -chunk.ty, chunk.tx
    bc, sc = -(bx * chunk.x + by * chunk.y), -(chunk.tx * chunk.x + chunk.ty * chunk.y)
    f, g = chunk.f, chunk.g
    base, sides = strips.band[strips.made[1] - 1], strips.sides
    lower, upper = strips.rims[0], strips.rims[1]
    for row in range(pattern.part_first[groove.profile], pattern.part_first[groove.profile + 1]):
        part = pattern.parts[row]
        b0, b1 = part.b0, part.b1
        if (chunk.half > 0 and b1 <= 0.0) or (chunk.half < 0 and b0 >= 0.0):
            continue
        made = strips.made[0]
        if made + 2 > STRIPS:
            return False
        polygon = strips.polygon[made]
        for k in range(count):
            polygon[k, 0], polygon[k, 1] = base[k, 0], base[k, 1]
        for k in range(2):
            beta, sign = (b0, 1.0) if k == 0 else (b1, -1.0)
            sides[k, 0], sides[k, 1] = sign * (bx - g * beta * chunk.tx), sign * (by - g * beta * chunk.ty)
            sides[k, 2] = sign * (bc - g * beta * sc - f * beta)
        corners = 0 if chunk.wedge > 0.0 else clipped(polygon, count, sides, 0, 2, strips.two)
        for k in range(2 if chunk.wedge > 0.0 else 1):
            for side in range(1, -1, -1):
                w0, w1 = (part.low0, part.low1) if side == 0 else (part.high0, part.high1)
                if not (w0 < math.inf and w1 < math.inf):
                    continue
                slope = (w1 - w0) / (b1 - b0)
                height = strips.height[made]
                if chunk.wedge > 0.0:
                    rim(chunk, b0, w0, slope, lower)
                    rim(chunk, b1, w1, slope, upper)
                    last = lower[1] if k == 0 else upper[1]
                    corners = triangle(chunk, lower[0], last, upper[1 - k], domain, strips, made)
                else:
                    level = w0 - slope * b0
                    height[0], height[1] = slope * bx + g * level * chunk.tx, slope * by + g * level * chunk.ty
                    height[2] = slope * bc + g * level * sc + f * level
                if side == 1:
                    for m in range(3):
                        strips.roof[made, m] = height[m]
            if corners:
                tag_strip(strips, made, corners, found, -1, chunk.part, groove.priority, part.removes == 1)
                strips.tag[made, 5] = row + 1
                made += 1
        strips.made[0] = made
    return True


@leaf
def lay(pattern: Pattern, item: int, found: int, chunk: np.void, domain: Domain, stepped: bool, strips: Strips) -> bool:
    """Add the strips of a chunk, its band and its walls. False where there is no room.

    stepped: heights of others may end at this groove's facets and band.
    """
    groove = pattern.grooves[pattern.pieces[item].groove]
    profile = pattern.profiles[groove.profile]
    points, first = pattern.points, profile.start
    bx, by = -chunk.ty, chunk.tx
    bc, sc = -(bx * chunk.x + by * chunk.y), -(chunk.tx * chunk.x + chunk.ty * chunk.y)
    f, g = chunk.f, chunk.g
    cap = chunk.part == CAP_START or chunk.part == CAP_FINISH
    made, bands = strips.made[0], strips.made[1]
    if made + profile.count > STRIPS or bands == STRIPS:
        return False

    # its part of the domain, and of that the band
    base, spare = strips.band[bands], strips.two
    count = domain.made[1]
    for k in range(count):
        base[k, 0], base[k, 1] = domain.outline[k, 0], domain.outline[k, 1]
    count = clipped(base, count, chunk.planes, 0, chunk.count, spare)
    sides = strips.sides
    if count and chunk.half != 0:
        sides[0, 0], sides[0, 1], sides[0, 2] = chunk.half * bx, chunk.half * by, chunk.half * bc
        count = clipped(base, count, sides, 0, 1, spare)
    for k in range(2):
        beta, sign = (profile.left, 1.0) if k == 0 else (profile.right, -1.0)
        # sign (b - (f + g s) beta) >= 0
        sides[k, 0], sides[k, 1] = sign * (bx - g * beta * chunk.tx), sign * (by - g * beta * chunk.ty)
        sides[k, 2] = sign * (bc - g * beta * sc - f * beta)
    lower, upper = strips.rims[0], strips.rims[1]
    if chunk.wedge > 0.0:
        rim(chunk, profile.left, 0.0, 0.0, lower)
        rim(chunk, profile.right, 0.0, 0.0, upper)
        for k in range(2):
            base[0, k], base[1, k], base[2, k], base[3, k] = lower[0, k], lower[1, k], upper[1, k], upper[0, k]
        count = within(base, 4, domain, strips)
        if count:
            count = clipped(base, count, chunk.planes, 0, chunk.count, spare)
    elif count:
        count = clipped(base, count, sides, 0, 2, spare)
    if count == 0:
        return True
    strips.band_count[bands], strips.band_rank[bands] = count, groove.priority
    strips.made[1] = bands + 1

    undercut = overhangs(pattern, groove.profile)
    if undercut:
        if not lay_parts(pattern, item, found, chunk, count, domain, strips):
            return False
        made = strips.made[0]
    for i in range(0 if undercut else profile.count - 1):
        b0, w0, b1, w1 = points[first + i, 0], points[first + i, 1], points[first + i + 1, 0], points[first + i + 1, 1]
        if b1 <= b0 or (chunk.half > 0 and b1 <= 0.0) or (chunk.half < 0 and b0 >= 0.0):
            continue
        slope = (w1 - w0) / (b1 - b0)
        inner = profile.inner_first <= i < profile.inner_last
        facet = i if inner or w0 != 0.0 or w1 != 0.0 else -1  # -1: the plane
        if chunk.wedge > 0.0:
            if made + profile.count + 2 > STRIPS:
                return False
            rim(chunk, b0, w0, slope, lower)
            rim(chunk, b1, w1, slope, upper)
            for k in range(2):
                last = lower[1] if k == 0 else upper[1]
                corners = triangle(chunk, lower[0], last, upper[1 - k], domain, strips, made)
                if corners:
                    tag_strip(strips, made, corners, found, facet, chunk.part, groove.priority, inner)
                    made += 1
            continue
        polygon = strips.polygon[made]
        for k in range(count):
            polygon[k, 0], polygon[k, 1] = base[k, 0], base[k, 1]
        for k in range(2):
            beta, sign = (b0, 1.0) if k == 0 else (b1, -1.0)
            sides[k, 0], sides[k, 1] = sign * (bx - g * beta * chunk.tx), sign * (by - g * beta * chunk.ty)
            sides[k, 2] = sign * (bc - g * beta * sc - f * beta)
        corners = clipped(polygon, count, sides, 0, 2, spare)
        if corners == 0:
            continue
        level = w0 - slope * b0
        height = strips.height[made]
        height[0], height[1] = slope * bx + g * level * chunk.tx, slope * by + g * level * chunk.ty
        height[2] = slope * bc + g * level * sc + f * level
        tag_strip(strips, made, corners, found, facet, chunk.part, groove.priority, inner)
        made += 1
    strips.made[0] = made

    walls = strips.made[2]
    p0, p1, q0, q1 = domain.slab[0, 0], domain.slab[0, 1], domain.slab[1, 0], domain.slab[1, 1]
    near = 1e-9 * (p1 - p0 + q1 - q0)
    far = math.hypot(p1 - p0, q1 - q0)
    middle = chunk.tx * (0.5 * (p0 + p1) - chunk.x) + chunk.ty * (0.5 * (q0 + q1) - chunk.y)
    sa, sb = middle - far, middle + far
    for j in range(profile.count):
        b = points[first + j, 0]
        if (chunk.half > 0 and (b < 0.0 or (cap and b == 0.0))) or (chunk.half < 0 and b >= 0.0):
            continue
        upright = j + 1 < profile.count and points[first + j + 1, 0] == b
        if j > 0 and points[first + j - 1, 0] == b:
            continue  # seen to already
        before = profile.inner_first <= j - 1 < profile.inner_last
        last = j
        while last + 1 < profile.count and points[first + last + 1, 0] == b:
            last += 1
        after = profile.inner_first <= last < profile.inner_last
        edge = j == 0 or last == profile.count - 1
        if not upright and not (stepped and (edge or before != after or undercut)):
            continue
        if chunk.wedge > 0.0:
            rim(chunk, b, 0.0, 0.0, lower)
        else:
            for k in range(2):
                along = sa if k == 0 else sb
                off = (f + g * along) * b
                lower[k, 0], lower[k, 1] = chunk.x + along * chunk.tx + off * bx, chunk.y + along * chunk.ty + off * by
        walls = keep_wall(
            strips.wall, strips.wall_tag, walls, chunk.planes, chunk.count, chunk.half, bx, by, bc, domain,
            lower[0, 0], lower[0, 1], lower[1, 0], lower[1, 1], near, found,
            j if upright or undercut else SIDE, chunk.part, bands,
        )  # fmt: skip
    for end in range(2):
        if (chunk.start if end == 0 else chunk.finish) == 0:
            continue
        x, y, nx, ny = chunk.ends[end, 0], chunk.ends[end, 1], chunk.ends[end, 2], chunk.ends[end, 3]
        b0, b1 = chunk.ends[end, 4] * profile.left, chunk.ends[end, 4] * profile.right
        walls = keep_wall(
            strips.wall, strips.wall_tag, walls, chunk.planes, chunk.count, chunk.half, bx, by, bc, domain,
            x + b0 * nx, y + b0 * ny, x + b1 * nx, y + b1 * ny, near, found, END, chunk.part, bands,
        )  # fmt: skip
    symmetric = True
    for j in range(profile.count):
        k = profile.count - 1 - j
        even = abs(points[first + j, 0] + points[first + k, 0]) + abs(points[first + j, 1] - points[first + k, 1])
        symmetric = symmetric and even <= 1e-12 * (profile.right - profile.left)
    if cap and not symmetric:  # along its mitres
        for k in range(2):
            a, b = chunk.planes[k, 0], chunk.planes[k, 1]
            dx, dy = (-b, a) if k == 1 else (b, -a)  # outwards: the strip is on the inner side
            if dx * bx + dy * by < 0.0:
                dx, dy = -dx, -dy
            reach = f * profile.right / (dx * bx + dy * by) if dx * bx + dy * by > 0.0 else 0.0
            walls = keep_wall(
                strips.wall, strips.wall_tag, walls, chunk.planes, chunk.count, 0, bx, by, bc, domain,
                chunk.x, chunk.y, chunk.x + reach * dx, chunk.y + reach * dy, near, found, END, chunk.part,
                bands,
            )  # fmt: skip
    strips.made[2] = walls
    return walls >= 0
