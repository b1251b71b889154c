"""The grooves that run parallel around a footprint, found and laid out as one cross-section (000, 4.1 and 4.2).

On a curved base it is what the plane of rays cuts out of the solid (`curve`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import Bow, applied, reach_over
from renderer.geometry.folds import SUMS, any_within, bends_by, crowded, extent_along, family_at, fold, is_alone
from renderer.geometry.pieces import is_beyond, locate, scale_at, tangent_at
from renderer.geometry.query import Nearby, find, nearby, over_crossing
from renderer.geometry.reach import CROOKED, NEAR, SPUN, Reach, aside_by
from renderer.geometry.reflection import Mirrors, Section, mirrors
from renderer.geometry.section import ACROSS, shifts
from renderer.geometry.slices import SLICES
from renderer.geometry.strings import BENT, Strings, strings
from renderer.geometry.view import View, on_plane
from renderer.kernel import callee, fixed, leaf
from renderer.shading import light_to_pattern
from renderer.tables import SCALE_CONSTANT, SCALE_SINE, SCALE_TABLE, SMOOTH, Floats, Pattern

CAPACITY = fixed(2048)  # pieces near a footprint; more are left to sampling
POINTS = fixed(16384)  # points of one cross-section
KNOWN = fixed(8)  # shares of a folded footprint that are kept

NARROWEST = 1e-6  # of a radius: paths are not known to bend by more
BOWED = 0.5  # of its width: paths that bow by more within a footprint have left their tangents
PARALLEL = 1e-6  # sine of the angle between grooves that count as parallel
NEARLY_PARALLEL = 0.05  # ... where it need not be right
ROUND = fixed(16)  # chords of the base between two grooves, at most
SAG = 0.005  # of the highest ridge, by which they leave it
LEVEL = 1.001  # an eye or a light must stand this much higher than the highest ridge


class Work(NamedTuple):
    """Memory of one thread, used again for each footprint."""

    found: Nearby
    near: NDArray[np.void]  # (CAPACITY,) NEAR, from left to right
    b: Floats  # (POINTS,) the cross-section's points along B, from the centre
    w: Floats  # (POINTS,) their heights
    owner: NDArray[np.int64]  # (POINTS,) the groove of the facet after each point: its row in `near`, -1 the plane
    facet: NDArray[np.int64]  # (POINTS,) which of the groove's facets that is
    x: Floats  # (POINTS,) projections
    low: Floats  # (POINTS,) the visible interval of each facet, on the base line
    high: Floats
    lit_low: Floats  # (lights, POINTS) the lit interval, on the light's base line
    lit_high: Floats
    light: Floats  # (lights, 6) D_b, D_w, h (ACROSS: a direction over a curved base); 1 where it lights anything here;
    # then how far a ray through the centre's line goes along T, by b and by height
    towards: Floats  # (lights, 2) shift along p and q for a unit of height to each light
    sums: Floats  # (SUMS, 2) what the grooves laid out stand for, where repeats are folded: shift along B, copies
    known: Floats  # (KNOWN + 1, 2) shares known of such sums: places along B, shares; then the row to write next
    bent: Floats  # (POINTS,) on a curved base: the points along B, where their heights lean out, and their heights
    sunk: Floats  # (lights + 1, POINTS) over the tangent plane, where each light meets them, and then the eye
    slices: Floats  # (SLICES, 6) of the footprint (`slice_up`)
    rims: Floats  # (6, 2) first and last of the periods of a fold that are summed one by one
    tint: Floats  # (2 facets + 1, lights + 1, 3) radiance of a facet under each light, then under the sky
    tinted: NDArray[np.int64]  # (2 facets + 1,) the footprint for which `tint` holds
    section: Section  # the cross-section as mirrors see it
    mirrors: Mirrors
    strings: Strings


@leaf
def work_for(pattern: Pattern, lights: int) -> Work:
    facets = len(pattern.facet_slot)
    b, w = np.empty(POINTS), np.empty(POINTS)
    return Work(
        nearby(pattern, CAPACITY), np.empty(CAPACITY, NEAR), b, w,
        np.empty(POINTS, np.int64), np.empty(POINTS, np.int64), np.empty(POINTS), np.empty(POINTS), np.empty(POINTS),
        np.empty((lights, POINTS)), np.empty((lights, POINTS)), np.empty((lights, 6)), np.empty((lights, 2)),
        np.empty((SUMS, 2)), np.zeros((KNOWN + 1, 2)), np.empty(POINTS), np.empty((lights + 1, POINTS)),
        np.empty((SLICES, 6)), np.empty((6, 2)),
        np.empty((2 * facets + 1, lights + 1, 3)), np.full(2 * facets + 1, -1, np.int64),
        Section(b, w, np.empty(POINTS, np.int64), np.empty((lights, POINTS, 2))), mirrors(), strings(lights),
    )  # fmt: skip


@leaf
def rise(pattern: Pattern, frame: np.void, view: View, d: tuple[float, float, float, float]) -> float:
    """How far a distant light's rays go sideways, in lengths of its direction d, for a unit of height they rise over a
    curved base, at most; 0 where the light is too low for any to reach the footprint."""
    u, v = applied(frame, d[0], d[1])
    bend = u * d[0] + v * d[1]
    least, most = d[2], d[2]
    for k in range(4):
        p, q = on_plane(view, float(k & 1), float(k >> 1))
        slope = d[2] + u * (p - view.p) + v * (q - view.q)
        least, most = min(least, slope), max(most, slope)
    beside = 2.0 * pattern.width * math.hypot(u, v)  # in the grooves that reach into the footprint
    least, most = least - beside, most + beside
    if bend <= 0.0 and least <= 0.0:
        return 0.0 if d[2] <= 0.0 else 1.0 / d[2]
    if most <= -math.sqrt(2.0 * max(bend, 0.0) * pattern.height):
        return 0.0
    return reach_over(least, bend, pattern.height + pattern.depth)


@leaf
def meet_lights(
    curved: bool, pattern: Pattern, frame: np.void, view: View, blocked: np.uint64, lights: NDArray[np.void], work: Work
) -> bool:
    """Fill `work.light` (D_b is left to `turn_lights`) and `work.towards`; False: a light stands among the ridges."""
    clear = True
    for l in range(len(lights)):
        d = light_to_pattern(frame, lights[l])
        work.light[l, 1], work.light[l, 2] = d[2], d[3]
        work.towards[l, 0] = work.towards[l, 1] = 0.0
        above = d[2] > LEVEL * pattern.height * d[3] and d[2] > 0.0
        work.light[l, 3] = 1.0 if above and (blocked >> np.uint64(l)) & np.uint64(1) == 0 else 0.0
        if curved and d[3] == 0.0:
            far = rise(pattern, frame, view, d)
            work.light[l, 3] = 1.0 if far > 0.0 and (blocked >> np.uint64(l)) & np.uint64(1) == 0 else 0.0
            work.towards[l, 0], work.towards[l, 1] = far * d[0], far * d[1]
        elif above:
            work.towards[l, 0] = (d[0] - d[3] * view.p) / d[2]
            work.towards[l, 1] = (d[1] - d[3] * view.q) / d[2]
        elif d[2] > 0.0:
            clear = False
    return clear


@leaf
def turn_lights(
    curved: bool, frame: np.void, view: View, bx: float, by: float, lights: NDArray[np.void], paper: bool, work: Work
) -> None:
    """Complete `work.light`: each light in the plane of the cross-section."""
    for l in range(len(lights)):
        d = light_to_pattern(frame, lights[l])
        work.light[l, 0] = (d[0] - d[3] * view.p) * bx + (d[1] - d[3] * view.q) * by
        if paper:  # one direction a pixel
            work.light[l, 2] = 0.0
        elif curved:
            x, y = work.light[l, 0], work.light[l, 1]
            t = (d[0] - d[3] * view.p) * by - (d[1] - d[3] * view.q) * bx
            square = x * x + y * y
            work.light[l, 4] = t * x / square if square > 0.0 else 0.0
            work.light[l, 5] = t * y / square if square > 0.0 else 0.0
            if d[3] == 0.0:
                work.light[l, 2] = ACROSS


@leaf
def find_around(strict: bool, pattern: Pattern, view: View, eye_p: float, eye_q: float, work: Work) -> int:
    """Find the pieces whose cross-sections may be seen through the footprint, or stand in its light: how many.

    -1 where they are too many; strict: and where paths cross in the footprint's bounds.
    """
    lp, hp, lq, hq = 0.0, 0.0, 0.0, 0.0
    for k in range(4):
        p, q = on_plane(view, float(k & 1), float(k >> 1))
        lp, hp, lq, hq = min(lp, p - view.p), max(hp, p - view.p), min(lq, q - view.q), max(hq, q - view.q)
    if strict and over_crossing(pattern, view.p + lp, view.q + lq, view.p + hp, view.q + hq):
        return -1
    if pattern.height > 0.0:
        left, right = shifts(pattern.height, 0.0, eye_p, 0.0, 0.0, 0.0)
        down, up = shifts(pattern.height, 0.0, eye_q, 0.0, 0.0, 0.0)
        for l in range(len(work.light)):
            left, right = shifts(pattern.height, 0.0, eye_p, work.towards[l, 0], left, right)
            down, up = shifts(pattern.height, 0.0, eye_q, work.towards[l, 1], down, up)
        lp, hp, lq, hq = lp + left, hp + right, lq + down, hq + up
    m = pattern.reach
    return find(pattern, work.found, view.p + lp - m, view.q + lq - m, view.p + hp + m, view.q + hq + m, CAPACITY)


@leaf
def near_groove(pattern: Pattern, count: int, view: View, eye_p: float, eye_q: float, work: Work) -> bool:
    """Whether any of the cross-sections found may lie under the footprint, hide a part of it or shade it."""
    found = work.found
    radius = 0.0
    for l in range(len(work.towards)):
        radius = max(radius, pattern.height * math.hypot(work.towards[l, 0], work.towards[l, 1]))
    radius = max(radius, pattern.height * math.hypot(eye_p, eye_q))
    above = radius
    for k in range(4):
        p, q = on_plane(view, float(k & 1), float(k >> 1))
        radius = max(radius, above + math.hypot(p - view.p, q - view.q))
    return any_within(pattern, found, count, view, radius)


@leaf
def direction(pattern: Pattern, found: Nearby, count: int, view: View) -> tuple[float, float]:
    """The tangent of the path that runs nearest to the footprint's centre."""
    nearest = math.inf
    tx, ty = 1.0, 0.0
    for k in range(count):
        piece = pattern.pieces[found.piece[k]]
        s, b = locate(piece, view.p - found.shift[k, 0], view.q - found.shift[k, 1])
        past = 0.0 if piece.closed == 1 else max(0.0, -s, s - piece.length)
        if abs(b) + past < nearest:
            nearest = abs(b) + past
            tx, ty = tangent_at(piece, s if piece.closed == 1 else min(max(s, 0.0), piece.length))
    return tx, ty


@leaf
def wider_of(pattern: Pattern, frame: np.void, eye_p: float, eye_q: float) -> float:
    """How much farther sight goes over a curved base than over its tangent plane, at most."""
    u, v = applied(frame, eye_p, eye_q)
    bend = u * eye_p + v * eye_q
    return max(reach_over(1.0, -bend, pattern.depth), reach_over(1.0, bend, pattern.height), 1.0)


@leaf
def reach_along(
    paper: bool, wider: float, pattern: Pattern, view: View, eye_p: float, eye_q: float, tx: float, ty: float,
    work: Work,
) -> Reach:  # fmt: skip
    """How far what matters to the footprint lies, along T and B.

    Inside a groove a ray gets no deeper than the groove's width lets it, which bounds how far it goes on below.
    wider: so much farther goes sight over a curved base.
    """
    bx, by = -ty, tx
    low, high = extent_along(view, bx, by)
    long_low, long_high = extent_along(view, tx, ty)
    seen_t = eye_p * tx + eye_q * ty
    eye_b, eye_t = wider * (eye_p * bx + eye_q * by), wider * seen_t
    length = max(-long_low, long_high)
    p, q = on_plane(view, 1.0, 0.5)
    p1, q1 = on_plane(view, 0.5, 1.0)
    right, down = (p - view.p) * tx + (q - view.q) * ty, (p1 - view.p) * tx + (q1 - view.q) * ty
    spread = 0.0 if paper else math.sqrt((right * right + down * down) / 3.0)
    room = 2.0 * pattern.width
    deep = pattern.depth if abs(eye_b) * pattern.depth <= room else room / abs(eye_b)
    wide_low, wide_high = shifts(pattern.height, deep, eye_b, 0.0, 0.0, 0.0)
    back, forth = shifts(pattern.height, deep, eye_t, 0.0, 0.0, 0.0)
    for l in range(len(work.light)):
        if work.light[l, 3] != 0.0:
            light_b = work.towards[l, 0] * bx + work.towards[l, 1] * by
            light_t = work.towards[l, 0] * tx + work.towards[l, 1] * ty
            below = deep if abs(light_b) * deep <= room else room / abs(light_b)
            wide_low, wide_high = shifts(pattern.height, below, eye_b, light_b, wide_low, wide_high)
            back, forth = shifts(pattern.height, below, eye_t, light_t, back, forth)
    wide_low, wide_high, long_low, long_high = low + wide_low, high + wide_high, long_low + back, long_high + forth
    return Reach(tx, ty, seen_t, low, high, length, spread, wide_low, wide_high, long_low, long_high)


@leaf
def longer(r: Reach, beyond: float) -> Reach:
    """The same where so much more on either side along T matters."""
    return Reach(
        r.tx, r.ty, r.eye_t, r.low, r.high, r.length, r.spread, r.wide_low, r.wide_high, r.long_low - beyond,
        r.long_high + beyond,
    )  # fmt: skip


@leaf
def find_within(pattern: Pattern, view: View, r: Reach, work: Work) -> int:
    """Find the pieces whose cross-sections may reach anything that matters to the footprint."""
    bx, by = -r.ty, r.tx
    p0 = view.p + min(r.long_low * r.tx, r.long_high * r.tx) + min(r.wide_low * bx, r.wide_high * bx) - pattern.reach
    p1 = view.p + max(r.long_low * r.tx, r.long_high * r.tx) + max(r.wide_low * bx, r.wide_high * bx) + pattern.reach
    q0 = view.q + min(r.long_low * r.ty, r.long_high * r.ty) + min(r.wide_low * by, r.wide_high * by) - pattern.reach
    q1 = view.q + max(r.long_low * r.ty, r.long_high * r.ty) + max(r.wide_low * by, r.wide_high * by) + pattern.reach
    return find(pattern, work.found, p0, q0, p1, q1, CAPACITY)


@leaf
def steepest(pattern: Pattern, groove: np.void, piece: np.void, s: float, slope: float, length: float) -> float:
    """At most so much does the scale change by arc length within `length` of s, where it changes by `slope`."""
    if groove.scale_kind == SCALE_SINE:
        turns = 2.0 * math.pi * abs(groove.scale_b) * (piece.t1 - piece.t0) / piece.length
        most = abs(groove.scale_a) * turns * piece.size
        return min(most, abs(slope) + most * turns * length)
    if groove.scale_kind == SCALE_TABLE:
        before = scale_at(pattern.scale_table, groove, piece, s - length)[1]
        after = scale_at(pattern.scale_table, groove, piece, s + length)[1]
        return max(abs(slope), abs(before), abs(after))
    return abs(slope)


@leaf
def pick(
    strict: bool, beyond: float, pattern: Pattern, view: View, r: Reach, count: int, work: Work
) -> tuple[int, float]:  # fmt: skip
    """Fill `work.near` with the grooves that run along T, from left to right: how many; and what is left to error where
    they bend past the footprint and change their scales, in parts of what facets differ by.

    -1 where ridges overlap; strict: and where anything in reach is not parallel, ends, bends or changes its scale far
    too much, or overlaps. beyond: so much of the reach along T is there for light from facet to facet, which hardly
    asks for how grooves bend and scale.
    """
    crooked = 0.0
    found = work.found
    n = 0
    spread = max(-r.long_low, r.long_high) + max(-r.wide_low, r.wide_high)
    length = max(-r.long_low, r.long_high) - beyond
    # Whose cross-sections must be known: where nothing stands above the plane, those inside the footprint alone, if
    # nothing overlaps them.
    low, high = (r.low, r.high) if pattern.height == 0.0 and not strict else (r.wide_low, r.wide_high)
    for k in range(count):
        piece = pattern.pieces[found.piece[k]]
        groove = pattern.grooves[piece.groove]
        profile = pattern.profiles[groove.profile]
        x, y = view.p - found.shift[k, 0], view.q - found.shift[k, 1]
        s, b = locate(piece, x, y)
        if is_beyond(piece, x, y, s, b, spread):
            continue
        ux, uy = tangent_at(piece, s if piece.closed == 1 else min(max(s, 0.0), piece.length))
        sine, cosine = r.tx * uy - r.ty * ux, r.tx * ux + r.ty * uy
        # what matters, a rectangle along T and B, in the piece's own coordinates
        bend = 0.5 * spread * spread * abs(piece.curvature)
        b0 = b + min(-sine * r.long_low, -sine * r.long_high) + min(cosine * r.wide_low, cosine * r.wide_high)
        b1 = b + max(-sine * r.long_low, -sine * r.long_high) + max(cosine * r.wide_low, cosine * r.wide_high)
        if (b0 - bend > piece.half or b1 + bend < -piece.half) and (piece.closed == 1 or piece.curvature == 0.0):
            continue
        s0 = s + min(cosine * r.long_low, cosine * r.long_high) + min(sine * r.wide_low, sine * r.wide_high)
        s1 = s + max(cosine * r.long_low, cosine * r.long_high) + max(sine * r.wide_low, sine * r.wide_high)
        if piece.curvature == 0.0 and (s1 < -pattern.reach or s0 > piece.length + pattern.reach):
            continue
        overhangs = len(pattern.part_first) > 0 and (
            pattern.part_first[groove.profile + 1] > pattern.part_first[groove.profile]
        )
        if overhangs or abs(sine) > (PARALLEL if strict else NEARLY_PARALLEL):
            if strict:
                return -1, 0.0
            continue
        sign = 1.0 if cosine >= 0.0 else -1.0
        if piece.closed == 0:
            if strict and (
                (s0 < 0.0 and piece.start_end != SMOOTH) or (s1 > piece.length and piece.finish_end != SMOOTH)
            ):
                return -1, 0.0
            if s < 0.0 or s > piece.length:
                continue  # the next piece takes it on
        f, slope = scale_at(pattern.scale_table, groove, piece, s)
        # Bending moves whole strips aside: it tells at the footprint's rim, and between a facet and its shadow. Most
        # where it is nearest to the centre of curvature.
        bent = 0.0
        if piece.curvature != 0.0:
            left, right = min(max(b0, -piece.half), piece.half), min(max(b1, -piece.half), piece.half)
            closest = 1.0 - max(piece.curvature * left, piece.curvature * right)  # to the centre, in radii
            if strict and closest <= 0.0:
                return -1, 0.0
            turn = abs(piece.curvature) / max(closest, NARROWEST)
            if strict and beyond > 0.0 and turn * piece.half > BENT:
                return -1, 0.0
            around = bend / max(closest, NARROWEST)
            only = one_facet(pattern, profile, f, b0 - around, b1 + around)
            if only == 0:
                bent = aside_by(turn, length - r.length, piece.half)
                if strict and 0.5 * turn * r.length**2 > BOWED * (r.high - r.low):
                    return -1, 0.0
            if only < 2:
                bent += SPUN * (turn * r.length) ** 2
        if groove.scale_kind != SCALE_CONSTANT:  # facets are tilted: what they reflect is off by about as much
            bent += steepest(pattern, groove, piece, s, slope, length) * max(length, pattern.depth, piece.half) / f
        if strict and bent > CROOKED:
            return -1, 0.0
        crooked = max(crooked, bent)
        # A curved path runs beside its tangent: in the mean over the footprint so far.
        axis = sign * (0.5 * piece.curvature * r.spread * r.spread - b)
        start = axis + f * (profile.left if sign > 0.0 else -profile.right)
        finish = axis + f * (profile.right if sign > 0.0 else -profile.left)
        if finish <= low or start >= high or finish <= start:
            continue
        at = n
        while at > 0 and (
            work.near[at - 1].start > start
            or (work.near[at - 1].start == start and work.near[at - 1].piece > found.piece[k])
        ):
            work.near[at] = work.near[at - 1]
            at -= 1
        g = work.near[at]
        g.piece, g.start, g.finish = found.piece[k], start, finish
        g.axis, g.turned, g.scale, g.copies = axis, sign, f, 1.0
        n += 1
    if n > 1:
        last = 0  # grooves that coincide are one
        for k in range(1, n):
            g, h = work.near[k], work.near[last]
            hair = 1e-9 * (g.finish - g.start)
            same = g.scale == h.scale and g.turned == h.turned and abs(g.axis - h.axis) <= 1e-3 * hair
            groove = pattern.grooves[pattern.pieces[g.piece].groove]
            other = pattern.grooves[pattern.pieces[h.piece].groove]
            if same and groove.profile == other.profile and groove.priority == other.priority:
                for i in range(pattern.profiles[groove.profile].count - 1):
                    same = same and pattern.facet_slot[groove.slot + i] == pattern.facet_slot[other.slot + i]
                if same:
                    continue
            if g.start < h.finish + hair and is_upright(pattern, h, True) and is_upright(pattern, g, False):
                return -1, 0.0  # no wall stands where upright ones touch
            if (strict or pattern.height > 0.0) and g.start < h.finish - hair:
                return -1, 0.0  # ridges that overlap are not laid out one beside the other
            last += 1
            work.near[last] = g
        n = last + 1
    return n, crooked


@leaf
def one_facet(pattern: Pattern, profile: np.void, scale: float, low: float, high: float) -> int:
    """Whether one facet fills a cross-section from `low` to `high`: 2 where it is level, 1 where it is not; 0: no."""
    i = profile.start
    end = i + profile.count
    while i < end and scale * pattern.points[i, 0] <= low:
        i += 1
    if i < end and scale * pattern.points[i, 0] < high:
        return 0
    beyond = i == profile.start or i == end
    return 2 if beyond or pattern.points[i - 1, 1] == pattern.points[i, 1] else 1


@leaf
def is_upright(pattern: Pattern, near: np.void, right: bool) -> bool:
    """Whether the cross-section ends in a vertical facet on this side."""
    profile = pattern.profiles[pattern.grooves[pattern.pieces[near.piece].groove].profile]
    i = profile.start + (profile.count - 2 if right == (near.turned > 0.0) else 0)
    return bool(pattern.points[i, 0] == pattern.points[i + 1, 0])


@leaf
def lay(pattern: Pattern, r: Reach, chord: float, first: int, last: int, work: Work) -> int:
    """Lay out the cross-section of the grooves first <= g < last: the number of its points.

    With ridges the plane between and around the grooves is part of it, in chords of a curved base.
    """
    b, w = work.b, work.w
    n = 0
    ridged = pattern.height > 0.0
    beyond = 1.0 + (r.wide_high - r.wide_low) if chord == math.inf else pattern.width
    if ridged:
        b[0], w[0] = min(r.wide_low, work.near[first].start) - beyond, 0.0
        work.owner[0] = work.facet[0] = -1
        n = 1
    for g in range(first, last):
        near = work.near[g]
        profile = pattern.profiles[pattern.grooves[pattern.pieces[near.piece].groove].profile]
        if n + profile.count + 1 >= POINTS:
            break
        if ridged and chord < math.inf:
            n = go_on(near.start, chord, n, work)
        for i in range(profile.count):
            j = i if near.turned > 0.0 else profile.count - 1 - i
            place = near.axis + near.turned * near.scale * pattern.points[profile.start + j, 0]
            if n > 0 and place <= b[n - 1]:
                place = b[n - 1]
                if i == 0 and w[n - 1] == 0.0:
                    n -= 1  # grooves that touch share a point
            b[n], w[n] = place, near.scale * pattern.points[profile.start + j, 1]
            work.owner[n] = g
            work.facet[n] = j if near.turned > 0.0 else j - 1
            n += 1
        work.owner[n - 1] = work.facet[n - 1] = -1
    if ridged:
        end = max(r.wide_high, b[n - 1]) + beyond
        if chord < math.inf:
            n = go_on(end, chord, n, work)
        b[n], w[n] = end, 0.0
        n += 1
    return n


@leaf
def go_on(b: float, chord: float, n: int, work: Work) -> int:
    """Append places of the base between the last point and b to the cross-section, so that its chords are so short."""
    from_b = work.b[n - 1]
    parts = math.ceil(min(max((b - from_b) / chord, 1.0), ROUND + 0.0))
    for i in range(1, int(parts)):
        work.b[n], work.w[n] = from_b + (b - from_b) * i / parts, 0.0
        work.owner[n - 1] = work.facet[n - 1] = work.owner[n] = work.facet[n] = -1
        n += 1
    return n


@leaf
def chord_of(pattern: Pattern, bow: Bow, lights: int, work: Work) -> float:
    """How long chords of the base may be."""
    most = abs(bow.bb)
    for l in range(lights):
        a = work.light[l, 4]
        most = max(most, abs(bow.bb + (2.0 * bow.bt + bow.tt * a) * a))
    return math.sqrt(8.0 * SAG * pattern.height / most) if most > 0.0 else 1e3 * pattern.width


@callee
def fold_within(
    curved: bool, beyond: float, pattern: Pattern, frame: np.void, view: View, lights: NDArray[np.void], work: Work
) -> tuple[int, int, float, Reach]:
    """Fill `work.near` with what stands for all grooves within reach, where they are many periods of one family.

    How many rows, how many entries of `work.sums`, what bent paths leave, as `pick`, and the frame; no rows where all
    is left as it is. beyond: so much farther along T must the family go on, for light from facet to facet.
    """
    none = Reach(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    which = crowded(pattern, view)
    if which < 0:
        return 0, 0, 0.0, none
    family = pattern.families[which]
    tx, ty, _ = family_at(family, view.p, view.q)
    eye_w = frame.eye[2]
    eye_p, eye_q = frame.eye[0] - view.p, frame.eye[1] - view.q
    wider = wider_of(pattern, frame, eye_p / eye_w, eye_q / eye_w) if curved else 1.0
    r = reach_along(False, wider, pattern, view, eye_p / eye_w, eye_q / eye_w, tx, ty, work)
    wide = longer(r, beyond)
    crooked = bends_by(family, view, r if family.radius > 0.0 else wide)
    if crooked > CROOKED or not is_alone(pattern, which, view, wide, work.found):
        return 0, 0, 0.0, none
    turn_lights(curved, frame, view, -ty, tx, lights, False, work)
    eye_d = eye_q * tx - eye_p * ty
    rows, entries = fold(pattern, family, view, r, eye_d, eye_w, work.light, work.near, work.sums, work.rims)
    return rows, entries, crooked, r
