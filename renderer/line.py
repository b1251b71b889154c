"""Methods `line` and `segment`: grooves that run parallel within a footprint (000, section 4; 001, section 5).

The cross-section is projected along B onto the base line, masked from the eye and shadowed from each light by the
order of the projected points (000, eq. 4), and each visible, lit interval weighs as much of the footprint as it fills.
Two changes to the papers, which `segment` leaves out and `line` makes (DESIGN 2.1, 2.2):

- the eye and point lights project as points, not along one direction a pixel: exact under perspective;
- an interval's weight is the exact area of the pixel's square between its two lines, not its length on a segment that
  stands for the footprint (000, eq. 3).

An eye above the middle of the cross-section looks left and right at once: points are masked by those between them and
the foot of the eye.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.pieces import locate, scale_at, tangent_at
from renderer.geometry.query import find, nearby
from renderer.geometry.share import share
from renderer.geometry.view import View, on_plane, view_of
from renderer.kernel import kernel, leaf
from renderer.shading import ambient, light_to_pattern, lit_by, normal_to_world, to_world
from renderer.tables import BASE, DIRECTIONAL, LINE, SEGMENT_METHOD, SMOOTH, Camera, Lighting
from renderer.tables import Pattern as PatternTables

CAPACITY = np.int64(2048)  # pieces near a footprint; more are left to sampling
POINTS = 16384  # points of one merged cross-section

# How the kernel treats what is not parallel, isolated and straight.
STRICT = 0  # `auto`: mark it as not its own
LOOSE = 1  # `line` for the whole image: the grooves parallel to the nearest one, nothing else
PAPER = 2  # `segment` for the whole image

NOT_MINE = 255  # in `method`: left to another method

STRAIGHT = 0.02
"""How far, as a part of the footprint's width across the groove, a path may bend away from its tangent, and how much
its scale may change, before it no longer counts as straight."""
PARALLEL = 1e-6  # sine of the angle between grooves that count as parallel, for footprints of any length
LEVEL = 1.001  # an eye or a light must stand this much higher than the highest ridge


@leaf
def onto_base(b: float, w: float, db: float, dw: float, h: float) -> float:
    """The point (b, w) of the cross-section projected from D = (db, dw, h) onto w = 0 (DESIGN 2.1)."""
    if h == 0.0:
        return b - w * db / dw
    return db + (b - db) * dw / (dw - w)


@leaf
def foot_of(db: float, h: float) -> float:
    """Where the eye or light stands on the base line: at an end of it for a direction."""
    if h == 0.0:
        return math.inf if db > 0.0 else -math.inf
    return db


@leaf
def spans(
    b: NDArray[np.float64], x: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64],
    count: int, foot: float,
) -> None:  # fmt: skip
    """The visible interval (low, high) of each facet between projected points x; low >= high: hidden (000, eq. 4).

    b, x: (count,) points from left to right; low, high: (count - 1,).
    """
    farthest = -math.inf
    for i in range(count - 1):  # to the right of the foot the points on the left mask
        low[i], high[i] = x[i], x[i + 1]
        if b[i] >= foot:
            farthest = max(farthest, x[i])
            low[i] = farthest
    farthest = math.inf
    for i in range(count - 2, -1, -1):
        if b[i + 1] <= foot:
            farthest = min(farthest, x[i + 1])
            high[i] = farthest


@leaf
def fraction_at(x: float, b0: float, w0: float, b1: float, w1: float, db: float, dw: float, h: float) -> float:
    """Where on the facet from (b0, w0) to (b1, w1) the point lies that D projects to x: 0 at its start, 1 at its end."""
    if h == 0.0:
        x0, x1 = onto_base(b0, w0, db, dw, h), onto_base(b1, w1, db, dw, h)
        return (x - x0) / (x1 - x0)
    c = (x - db) / dw
    return (c * (dw - w0) - (b0 - db)) / (b1 - b0 + c * (w1 - w0))


@leaf
def shifts(height: float, depth: float, eye: float, light: float, lowest: float, highest: float) -> tuple[float, float]:
    """[lowest, highest] widened to the shifts along one axis from a footprint to what is seen through it at heights
    -depth .. height, and on to what may shade that.

    `eye` and `light`: the shift for a unit of height towards each, pattern units.
    """
    deep, high = -depth * eye, height * eye
    lit = deep + (height + depth) * light
    return min(lowest, deep, high, lit), max(highest, deep, high, lit)


@leaf
def along(view: View, bx: float, by: float, y: float) -> float:
    """The share of the footprint where B . x <= y."""
    return share(
        bx * view.pu + by * view.qu - y * view.wu,
        bx * view.pv + by * view.qv - y * view.wv,
        bx * view.p1 + by * view.q1 - y * view.w1,
    )


@kernel
def line(
    mode: int, pattern: PatternTables, footprints: NDArray[np.void], chosen: NDArray[np.int64],
    frames: NDArray[np.void], camera: Camera, lighting: Lighting, materials: NDArray[np.void],
    slots: NDArray[np.int32], albedo: NDArray[np.float64], radiance: NDArray[np.float64], method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance (n, 3) and the method each took.

    mode: STRICT, LOOSE or PAPER. slots: rows of `materials` for the pattern's facets, the object's own first.
    """
    lights = lighting.lights
    found = nearby(pattern, CAPACITY)
    near = np.empty(CAPACITY, np.int64)  # the found pieces that count, from left to right
    start = np.empty(CAPACITY)  # where their cross-sections begin along B, from the footprint's centre
    finish = np.empty(CAPACITY)
    axis = np.empty(CAPACITY)  # where their paths lie
    turned = np.empty(CAPACITY)  # -1: the path runs against T
    scale = np.empty(CAPACITY)
    b, w = np.empty(POINTS), np.empty(POINTS)
    owner, facet = np.empty(POINTS, np.int64), np.empty(POINTS, np.int64)
    x, low, high = np.empty(POINTS), np.empty(POINTS), np.empty(POINTS)
    lit_low, lit_high = np.empty((len(lights), POINTS)), np.empty((len(lights), POINTS))
    shadow = np.empty((len(lights), 4))  # each light in the cross-section: D_b, D_w, h, usable
    towards = np.empty((len(lights), 2))  # shift along p and q for a unit of height to each light
    facets = len(pattern.facet_slot)
    tint = np.empty((2 * facets + 1, len(lights) + 1, 3))  # radiance of a facet under each light, then the sky
    tinted = np.full(2 * facets + 1, -1, np.int64)
    distant = True
    for l in range(len(lights)):
        distant = distant and lights[l].kind == DIRECTIONAL
    flat = pattern.height == 0.0

    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        e = (view.ex, view.ey, view.ez)
        dw = frame.eye[2]
        eye_p, eye_q = (frame.eye[0] - view.p) / dw, (frame.eye[1] - view.q) / dw
        radiance[index, 0] = radiance[index, 1] = radiance[index, 2] = 0.0
        method[index] = NOT_MINE
        if dw <= LEVEL * pattern.height:
            if mode == STRICT:
                continue
        # The footprint's bounds, and those of what may be seen through it or shade it.
        p0 = p1 = view.p
        q0 = q1 = view.q
        for k in range(4):
            cp, cq = on_plane(view, float(k & 1), float(k >> 1))
            p0, p1, q0, q1 = min(p0, cp), max(p1, cp), min(q0, cq), max(q1, cq)
        mine = True
        lp, lq = p0 - view.p, q0 - view.q
        hp, hq = p1 - view.p, q1 - view.q
        for l in range(len(lights)):
            d = light_to_pattern(frame, lights[l])
            rise = d[2] if d[3] == 0.0 else d[2] - pattern.height
            shadow[l, 1], shadow[l, 2], shadow[l, 3] = d[2], d[3], 1.0
            if d[2] <= LEVEL * pattern.height * d[3] or d[2] <= 0.0:
                # below the plane: nothing is lit; between the ridges: left to sampling
                shadow[l, 3] = 0.0
                mine = mine and d[2] <= 0.0
                towards[l, 0] = towards[l, 1] = 0.0
                continue
            towards[l, 0], towards[l, 1] = (d[0] - d[3] * view.p) / d[2], (d[1] - d[3] * view.q) / d[2]
            if rise > 0.0 and not flat:
                lp, hp = shifts(pattern.height, 0.0, eye_p, towards[l, 0], lp, hp)
                lq, hq = shifts(pattern.height, 0.0, eye_q, towards[l, 1], lq, hq)
        if not mine and mode == STRICT:
            continue
        if not flat:
            lp, hp = shifts(pattern.height, 0.0, eye_p, 0.0, lp, hp)
            lq, hq = shifts(pattern.height, 0.0, eye_q, 0.0, lq, hq)
        margin = pattern.reach
        count = find(
            pattern, found, view.p + lp - margin, view.q + lq - margin, view.p + hp + margin, view.q + hq + margin, CAPACITY
        )
        if count < 0 and mode == STRICT:
            continue
        count = max(count, 0)

        # The common direction: the path's nearest to the centre.
        nearest = math.inf
        tx, ty = 1.0, 0.0
        for k in range(count):
            piece = pattern.pieces[found.piece[k]]
            s, distance = locate(piece, view.p - found.shift[k, 0], view.q - found.shift[k, 1])
            past = max(0.0, -s, s - piece.length) if piece.closed == 0 else 0.0
            if abs(distance) + past < nearest:
                nearest = abs(distance) + past
                tx, ty = tangent_at(piece, s if piece.curvature == 0.0 else min(max(s, 0.0), piece.length))
        bx, by = -ty, tx
        width_low = width_high = length_low = length_high = 0.0
        for k in range(4):
            cp, cq = on_plane(view, float(k & 1), float(k >> 1))
            across, on = (cp - view.p) * bx + (cq - view.q) * by, (cp - view.p) * tx + (cq - view.q) * ty
            width_low, width_high = min(width_low, across), max(width_high, across)
            length_low, length_high = min(length_low, on), max(length_high, on)
        eye_b, eye_t = eye_p * bx + eye_q * by, eye_p * tx + eye_q * ty
        near_low, near_high = length_low, length_high  # along T: what the footprint may see or be shaded by
        wide_low, wide_high = width_low, width_high
        if mode == STRICT and count > 0:
            room = 2.0 * pattern.width  # a ray inside a groove gets no deeper than the groove's width lets it
            deep = min(pattern.depth, room / abs(eye_b)) if eye_b != 0.0 else pattern.depth
            near_low, near_high = shifts(pattern.height, deep, eye_t, 0.0, near_low, near_high)
            wide_low, wide_high = shifts(pattern.height, deep, eye_b, 0.0, wide_low, wide_high)
            for l in range(len(lights)):
                if shadow[l, 3] != 0.0:
                    light_b = towards[l, 0] * bx + towards[l, 1] * by
                    light_t = towards[l, 0] * tx + towards[l, 1] * ty
                    below = min(deep, room / abs(light_b)) if light_b != 0.0 else deep
                    near_low, near_high = shifts(pattern.height, below, eye_t, light_t, near_low, near_high)
                    wide_low, wide_high = shifts(pattern.height, below, eye_b, light_b, wide_low, wide_high)
            if not pattern.parallel:
                cp0 = view.p + min(near_low * tx, near_high * tx) + min(wide_low * bx, wide_high * bx) - margin
                cp1 = view.p + max(near_low * tx, near_high * tx) + max(wide_low * bx, wide_high * bx) + margin
                cq0 = view.q + min(near_low * ty, near_high * ty) + min(wide_low * by, wide_high * by) - margin
                cq1 = view.q + max(near_low * ty, near_high * ty) + max(wide_low * by, wide_high * by) + margin
                count = find(pattern, found, cp0, cq0, cp1, cq1, CAPACITY)
                if count < 0:
                    continue
        far_low, far_high = width_low, width_high  # along B: whose cross-sections must be merged
        if not flat:
            far_low, far_high = wide_low, wide_high
            if mode != STRICT:
                far_low, far_high = shifts(pattern.height, 0.0, eye_b, 0.0, far_low, far_high)
                for l in range(len(lights)):
                    light_b = towards[l, 0] * bx + towards[l, 1] * by
                    far_low, far_high = shifts(pattern.height, 0.0, eye_b, light_b, far_low, far_high)

        # Each piece found: out of reach, parallel, or what makes this a special case.
        grooves = 0
        for k in range(count):
            piece = pattern.pieces[found.piece[k]]
            groove = pattern.grooves[piece.groove]
            profile = pattern.profiles[groove.profile]
            s, distance = locate(piece, view.p - found.shift[k, 0], view.q - found.shift[k, 1])
            ux, uy = tangent_at(piece, s if piece.curvature == 0.0 else min(max(s, 0.0), piece.length))
            sine, cosine = tx * uy - ty * ux, tx * ux + ty * uy
            most = max(abs(profile.left), abs(profile.right)) * groove.scale_max * piece.size
            if mode == STRICT:
                spread = max(-near_low, near_high) + max(-wide_low, wide_high)
                curved = spread * spread * abs(piece.curvature)
                if abs(distance) > spread + most + curved and (piece.curvature == 0.0 or piece.closed == 1):
                    continue
                if abs(sine) * spread > PARALLEL * pattern.width and abs(sine) > PARALLEL:
                    if piece.curvature != 0.0 and abs(distance) > spread + most + curved:
                        continue
                    mine = False
                    break
            elif abs(sine) > 0.05:
                continue
            sign = 1.0 if cosine >= 0.0 else -1.0
            if piece.closed == 0:
                s0 = s + (near_low if sign > 0.0 else -near_high)
                s1 = s + (near_high if sign > 0.0 else -near_low)
                if s1 < -margin or s0 > piece.length + margin:
                    continue
                if mode == STRICT:
                    if s0 < 0.0 and piece.start_end != SMOOTH or s1 > piece.length and piece.finish_end != SMOOTH:
                        mine = False
                        break
                if s < 0.0 or s > piece.length:
                    continue
            f, slope = scale_at(pattern.scale_table, groove, piece, s)
            if mode == STRICT:
                spread = max(-near_low, near_high)
                across = min(width_high - width_low, most)
                bend = 0.5 * spread * spread * abs(piece.curvature)
                if bend > STRAIGHT * across or abs(slope) * max(spread, pattern.depth, most) > STRAIGHT * f:
                    mine = False
                    break
            left = -sign * distance + f * (profile.left if sign > 0.0 else -profile.right)
            right = -sign * distance + f * (profile.right if sign > 0.0 else -profile.left)
            if right <= far_low or left >= far_high or right <= left:
                continue
            at = grooves
            while at > 0 and (start[at - 1] > left or start[at - 1] == left and near[at - 1] > found.piece[k]):
                near[at], start[at], finish[at] = near[at - 1], start[at - 1], finish[at - 1]
                axis[at], turned[at], scale[at] = axis[at - 1], turned[at - 1], scale[at - 1]
                at -= 1
            near[at], start[at], finish[at] = found.piece[k], left, right
            axis[at], turned[at], scale[at] = -sign * distance, sign, f
            grooves += 1
        if mine and mode == STRICT:
            for k in range(1, grooves):
                mine = mine and start[k] >= finish[k - 1] - 1e-9 * (finish[k] - start[k])
        if mode == STRICT and not mine:
            continue
        if grooves == 0:
            method[index] = BASE
        else:
            method[index] = SEGMENT_METHOD if mode == PAPER else LINE

        centre = bx * view.p + by * view.q
        half = 0.0
        if mode == PAPER:  # the larger projection of the footprint's two axes stands for it (000, 4.2)
            rp, rq = on_plane(view, 1.0, 0.5)
            up, uq = on_plane(view, 0.5, 0.0)
            half = max(abs((rp - view.p) * bx + (rq - view.q) * by), abs((up - view.p) * bx + (uq - view.q) * by))
        eye_h = 0.0 if mode == PAPER else 1.0
        eye_w = dw
        eye_d = (frame.eye[0] - view.p) * bx + (frame.eye[1] - view.q) * by
        for l in range(len(lights)):
            d = light_to_pattern(frame, lights[l])
            shadow[l, 0] = (d[0] - d[3] * view.p) * bx + (d[1] - d[3] * view.q) * by
            if (footprint.blocked >> np.uint64(l)) & np.uint64(1):
                shadow[l, 3] = 0.0
            if mode == PAPER and d[2] > 0.0:
                shadow[l, 2] = 0.0

        # One cross-section a groove where nothing stands above the plane, else one of all with the plane between.
        ground = 1.0
        k = 0
        while k < grooves or (k == 0 and not flat and grooves > 0):
            n = 0
            last = k + 1 if flat else grooves
            if not flat:
                b[0], w[0] = min(far_low, start[0]) - 1.0 - (far_high - far_low), 0.0
                owner[0] = facet[0] = -1
                n = 1
            for g in range(k, last):
                piece = pattern.pieces[near[g]]
                profile = pattern.profiles[pattern.grooves[piece.groove].profile]
                if n + profile.count + 1 >= POINTS:
                    break
                for i in range(profile.count):
                    j = i if turned[g] > 0.0 else profile.count - 1 - i
                    place = axis[g] + turned[g] * scale[g] * pattern.points[profile.start + j, 0]
                    if n > 0 and place < b[n - 1]:
                        place = b[n - 1]
                    if i == 0 and n > 0 and place == b[n - 1] and w[n - 1] == 0.0:
                        n -= 1  # grooves that touch share a point
                    b[n], w[n] = place, scale[g] * pattern.points[profile.start + j, 1]
                    owner[n] = g
                    facet[n] = j if turned[g] > 0.0 else j - 1
                    n += 1
                owner[n - 1] = facet[n - 1] = -1
            if not flat:
                b[n], w[n] = max(far_high, b[n - 1]) + 1.0 + (far_high - far_low), 0.0
                n += 1
            k = last
            if flat and mode != PAPER:
                band = along(view, bx, by, centre + b[n - 1]) - along(view, bx, by, centre + b[0])
                ground -= band
                if band <= 0.0 and eye_b == 0.0:
                    continue
            elif flat:
                ground -= min(max(0.5 + 0.5 * b[n - 1] / half, 0.0), 1.0) - min(max(0.5 + 0.5 * b[0] / half, 0.0), 1.0)
            else:
                ground = 0.0
            for l in range(len(lights)):
                if shadow[l, 3] != 0.0:
                    for i in range(n):
                        x[i] = onto_base(b[i], w[i], shadow[l, 0], shadow[l, 1], shadow[l, 2])
                    spans(b, x, lit_low[l], lit_high[l], n, foot_of(shadow[l, 0], shadow[l, 2]))
            for i in range(n):
                x[i] = onto_base(b[i], w[i], eye_d, eye_w, eye_h)
            spans(b, x, low, high, n, foot_of(eye_d, eye_h))
            for i in range(n - 1):
                if high[i] <= low[i] or high[i] <= width_low or low[i] >= width_high:
                    continue
                if mode == PAPER:
                    whole0, whole1 = min(max(0.5 + 0.5 * low[i] / half, 0.0), 1.0), min(max(0.5 + 0.5 * high[i] / half, 0.0), 1.0)
                else:
                    whole0, whole1 = along(view, bx, by, centre + low[i]), along(view, bx, by, centre + high[i])
                part = whole1 - whole0
                if part <= 0.0:
                    continue
                # The facet's colour under each light, found once where the lights are far.
                row = -1
                slot = 0
                if owner[i] >= 0:
                    where = pattern.grooves[pattern.pieces[near[owner[i]]].groove].slot + facet[i]
                    slot = pattern.facet_slot[where] + 1
                    row = 2 * where + (1 if turned[owner[i]] > 0.0 else 0)
                if not distant or tinted[row] != index:
                    tinted[row] = index
                    rise, run = w[i + 1] - w[i], b[i + 1] - b[i]
                    n_world = normal_to_world(frame, (-rise * bx, -rise * by, run))
                    material = materials[slots[slot]]
                    mid = 0.5 * (max(low[i], width_low) + min(high[i], width_high))
                    u = min(max(fraction_at(mid, b[i], w[i], b[i + 1], w[i + 1], eye_d, eye_w, eye_h), 0.0), 1.0)
                    depth = w[i] + u * rise
                    pb = b[i] + u * run
                    pt = eye_t * depth * (1.0 if eye_h == 0.0 else (eye_w - depth) / eye_w)
                    at_world = to_world(frame, view.p + pb * bx + pt * tx, view.q + pb * by + pt * ty, depth)
                    for l in range(len(lights)):
                        colour = lit_by(lights[l], material, n_world, e, at_world)
                        tint[row, l, 0], tint[row, l, 1], tint[row, l, 2] = colour
                    colour = ambient(material, lighting.sky, albedo, n_world, e)
                    tint[row, len(lights), 0], tint[row, len(lights), 1], tint[row, len(lights), 2] = colour
                for c in range(3):
                    radiance[index, c] += part * tint[row, len(lights), c]
                for l in range(len(lights)):
                    if shadow[l, 3] == 0.0 or lit_high[l, i] <= lit_low[l, i]:
                        continue
                    db, dl, dh = shadow[l, 0], shadow[l, 1], shadow[l, 2]
                    from_x, to_x = low[i], high[i]
                    if lit_low[l, i] > onto_base(b[i], w[i], db, dl, dh):
                        u = fraction_at(lit_low[l, i], b[i], w[i], b[i + 1], w[i + 1], db, dl, dh)
                        cut_b, cut_w = b[i] + u * (b[i + 1] - b[i]), w[i] + u * (w[i + 1] - w[i])
                        from_x = max(from_x, onto_base(cut_b, cut_w, eye_d, eye_w, eye_h))
                    if lit_high[l, i] < onto_base(b[i + 1], w[i + 1], db, dl, dh):
                        u = fraction_at(lit_high[l, i], b[i], w[i], b[i + 1], w[i + 1], db, dl, dh)
                        cut_b, cut_w = b[i] + u * (b[i + 1] - b[i]), w[i] + u * (w[i + 1] - w[i])
                        to_x = min(to_x, onto_base(cut_b, cut_w, eye_d, eye_w, eye_h))
                    if to_x <= from_x:
                        continue
                    lit = part
                    if from_x != low[i] or to_x != high[i]:
                        if mode == PAPER:
                            lit = min(max(0.5 + 0.5 * to_x / half, 0.0), 1.0) - min(max(0.5 + 0.5 * from_x / half, 0.0), 1.0)
                        else:
                            lit = along(view, bx, by, centre + to_x) - along(view, bx, by, centre + from_x)
                    for c in range(3):
                        radiance[index, c] += lit * tint[row, l, c]
        if ground > 1e-12:
            n_world = normal_to_world(frame, (0.0, 0.0, 1.0))
            material = materials[slots[0]]
            at_world = to_world(frame, view.p, view.q, 0.0)
            colour = ambient(material, lighting.sky, albedo, n_world, e)
            radiance[index, 0] += ground * colour[0]
            radiance[index, 1] += ground * colour[1]
            radiance[index, 2] += ground * colour[2]
            for l in range(len(lights)):
                if shadow[l, 3] != 0.0:
                    colour = lit_by(lights[l], material, n_world, e, at_world)
                    radiance[index, 0] += ground * colour[0]
                    radiance[index, 1] += ground * colour[1]
                    radiance[index, 2] += ground * colour[2]
