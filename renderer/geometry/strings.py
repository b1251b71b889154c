"""Diffuse light between the facets of one straight groove, in closed form (DESIGN 2.5; 000, 6.3).

A groove below the plane is the same all along T. Where it is lit alike all along too, the light that its facets
exchange is that of its cross-section, a cavity with one opening at w = 0, to the sky. The part of an element's light
that reaches another is exact, and so is what hides them from each other: half the lengths of the strings that cross
between their ends, less those of the strings that do not (H. C. Hottel, "Radiant-heat transmission", 1954), all drawn
taut over what stands between. Taut over a polyline that does not overhang is its upper hull: one table of the hulls'
lengths between all pairs of points has all factors in it, and rows sum to one with the sky whatever rounding does.

Facets are cut into ELEMENTS_ABOUT elements, by their lengths and finer at their ends, each of one radiance. Of what a
facet gathers, means over the elements are known, and a smooth curve through their sums, from which even steps are read:
within each it changes evenly. So the mean over any part is known, however a footprint weighs it.
Against 192 elements facets are off by at most 0.0004 of white in a V of 90 degrees and a box, of albedo 0.9 at 16
bounces under a sun and a sky (measured); up to 0.007 in a ditch twice as deep as wide.

Angles are those of the world, so what a stretched mapping makes of the cross-section has factors of its own. They take
some microseconds to find and are kept by each thread, rather than with the compiled pattern.

Light from a lamp changes along T: as it is at the footprint's centre, it is taken all along, and for all like grooves
of a footprint that is small for its distance. So lamps must not be near.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import turned
from renderer.geometry.opening import Openings, openings, seen_between, sums_along
from renderer.geometry.reach import Reach
from renderer.geometry.section import foot_of, fraction_at, onto_base, spans
from renderer.geometry.view import View
from renderer.kernel import callee, fixed, leaf
from renderer.shading import Vector, dot, has_picture, light_to_pattern, normal_to_world, sky_over, to_world, unit
from renderer.tables import DIRECTIONAL, Floats, Lighting, Pattern

ELEMENTS = fixed(288)  # of one cross-section; more are left to sampling
ELEMENTS_ABOUT = 32.0  # of one with few facets
NODES = fixed(2 * 288)  # their ends, for each facet its own
STEPS, STEPS_ABOUT = fixed(2 * 288), 64  # even steps of one cross-section; of a facet, where there is room for so many
KEPT = fixed(16)  # cross-sections of which a thread keeps factors
STRETCHES = 512.0  # steps of the stretch by which they are kept, for a factor of e

CORNER = 1e-3  # of what a footprint weighs most: its corners are not told from their middle
BEYOND = 6.0  # half-widths along T over which a groove must go on: 1 % of what it exchanges comes from farther away
BENT = 0.03  # ... and its half-width, in radii of its path
NEAR_LAMP = 12.0  # half-widths from which on a lamp is far
APART = 0.1  # of a lamp's distance, by which like grooves may lie apart and share their light


class Strings(NamedTuple):
    """Memory of one thread."""

    known: Floats  # (KEPT, 2) the groove and its sense whose factors these are, and the stretch in steps; -1: none
    solved: Floats  # (KEPT, 3) frame or footprint, and T, for which `step` holds; -1: none
    blocked: NDArray[np.uint64]  # (KEPT,) ... and the lights that are blocked
    facets: NDArray[np.int64]  # (KEPT,)
    first: NDArray[np.int64]  # (KEPT, ELEMENTS + 1) the first element of each facet
    node: Floats  # (KEPT, NODES) where elements begin and end on their facets, 0 to 1; the first is first + facet
    factor: Floats  # (KEPT, ELEMENTS, ELEMENTS) [j, i]: the part of what i gets that is of j
    sky: Floats  # (KEPT, ELEMENTS) the part that is of the sky
    steps: NDArray[np.int64]  # (KEPT,) of each facet
    step: Floats  # (KEPT, STEPS, 3, 4) in each channel, radiance by light from the others and from the sky: summed over
    # the facet so far, and that again; its mean in this step times the step's length, and by how much it grows there
    b: Floats  # (ELEMENTS + 1,) a groove's cross-section
    w: Floats
    material: NDArray[np.int64]  # (ELEMENTS,) row of the materials, a facet each
    x: Floats  # (ELEMENTS + 1,) its projection; or the ends of elements
    y: Floats
    low: Floats  # (ELEMENTS,)
    high: Floats
    lit: Floats  # (lights, ELEMENTS, 2) the lit part of each facet: from, to
    hull: NDArray[np.int64]  # (ELEMENTS + 1,)
    along: Floats  # (ELEMENTS + 1,) length of the hull so far
    taut: Floats  # (ELEMENTS + 1, ELEMENTS + 1) lengths of taut strings
    albedo: Floats  # (3, ELEMENTS)
    own: Floats  # (3, ELEMENTS) radiance without light from the others
    sent: Floats  # (3, ELEMENTS) radiance
    got: Floats  # (3, ELEMENTS) the mean of the radiance that comes in
    total: Floats  # (NODES,) what is gathered, summed over the facet so far
    rate: Floats  # (NODES,) the same here
    open: Floats  # (3, ELEMENTS) of it, what comes from the sky
    openings: Openings


@leaf
def strings(lights: int) -> Strings:
    return Strings(
        np.full((KEPT, 2), -1.0), np.full((KEPT, 3), -1.0), np.zeros(KEPT, np.uint64),
        np.zeros(KEPT, np.int64),
        np.empty((KEPT, ELEMENTS + 1), np.int64), np.empty((KEPT, NODES)), np.empty((KEPT, ELEMENTS, ELEMENTS)),
        np.empty((KEPT, ELEMENTS)), np.zeros(KEPT, np.int64), np.empty((KEPT, STEPS, 3, 4)),
        np.empty(ELEMENTS + 1), np.empty(ELEMENTS + 1), np.empty(ELEMENTS, np.int64), np.empty(ELEMENTS + 1),
        np.empty(ELEMENTS + 1),
        np.empty(ELEMENTS), np.empty(ELEMENTS), np.empty((lights, ELEMENTS, 2)),
        np.empty(ELEMENTS + 1, np.int64), np.empty(ELEMENTS + 1), np.empty((ELEMENTS + 1, ELEMENTS + 1)),
        np.empty((3, ELEMENTS)), np.empty((3, ELEMENTS)), np.empty((3, ELEMENTS)), np.empty((3, ELEMENTS)),
        np.empty(NODES), np.empty(NODES), np.empty((3, ELEMENTS)), openings(),
    )  # fmt: skip


@leaf
def stretch_of(frame: np.void, tx: float, ty: float) -> float:
    """How much wider cross-sections along T are in the world, for their height, than in the pattern; in steps."""
    a = frame.axes
    along = math.sqrt(
        (a[0, 0] * tx + a[0, 1] * ty) ** 2 + (a[1, 0] * tx + a[1, 1] * ty) ** 2 + (a[2, 0] * tx + a[2, 1] * ty) ** 2
    )
    up = math.sqrt(a[0, 2] ** 2 + a[1, 2] ** 2 + a[2, 2] ** 2)
    return float(round(STRETCHES * math.log(up / along)))


@leaf
def nearest_lamp(frame: np.void, view: View, lights: NDArray[np.void]) -> float:
    """How far from the footprint's centre the nearest point light above the plane is, pattern units."""
    nearest = math.inf
    for l in range(len(lights)):
        d = light_to_pattern(frame, lights[l])
        if d[3] != 0.0 and d[2] > 0.0:
            nearest = min(nearest, math.sqrt((d[0] - view.p) ** 2 + (d[1] - view.q) ** 2 + d[2] ** 2))
    return nearest


@callee
def cut(at: int, count: int, stretch: float, s: Strings) -> bool:
    """Cut the facets of the cross-section (s.b, s.w) of `count` points into elements and find their factors, row `at`;
    False: they are too many, or a wall goes back over itself."""
    facets = count - 1
    first, node = s.first[at], s.node[at]
    length = 0.0
    for i in range(facets):
        if i > 0 and s.b[i - 1] == s.b[i + 1] and (s.w[i] - s.w[i - 1]) * (s.w[i + 1] - s.w[i]) < 0.0:
            return False
        length += math.hypot(stretch * (s.b[i + 1] - s.b[i]), s.w[i + 1] - s.w[i])
    least = min(max(ELEMENTS_ABOUT / facets, 1.0), 4.0)
    n = 0
    for i in range(facets):
        own = math.hypot(stretch * (s.b[i + 1] - s.b[i]), s.w[i + 1] - s.w[i])
        parts = int(max(ELEMENTS_ABOUT * own / length, least) + 0.5) if own > 0.0 else 1
        first[i] = n
        if n + parts > ELEMENTS:
            return False
        for k in range(parts + 1):
            u = 0.5 * (1.0 - math.cos(math.pi * k / parts))
            node[n + i + k] = u
            s.x[n + k] = stretch * (s.b[i] + u * (s.b[i + 1] - s.b[i]))
            s.y[n + k] = s.w[i] + u * (s.w[i + 1] - s.w[i])
        n += parts
    first[facets] = n
    s.facets[at] = facets
    factors(n, s.x, s.y, s.hull, s.along, s.taut, s.factor[at], s.sky[at])
    return True


@callee
def factors(
    n: int, x: Floats, y: Floats, hull: NDArray[np.int64], along: Floats, taut: Floats, factor: Floats, sky: Floats
) -> None:
    """Fill `factor` [j, i], the part of what element i gets that is of element j, and `sky`.

    Element i joins points i and i + 1 of the `n + 1` from left to right. One of no length gets nothing.
    """
    for a in range(n + 1):
        hull[0], along[0] = a, 0.0
        taut[a, a] = 0.0
        top = 0
        for b in range(a + 1, n + 1):
            while top > 0:
                p, q = hull[top - 1], hull[top]
                if (x[q] - x[p]) * (y[b] - y[p]) < (y[q] - y[p]) * (x[b] - x[p]):
                    break
                top -= 1
            q = hull[top]
            far = along[top] + math.hypot(x[b] - x[q], y[b] - y[q])
            top += 1
            hull[top], along[top] = b, far
            taut[a, b] = taut[b, a] = far
    for i in range(n):
        length = taut[i, i + 1]
        half = 0.5 / length if length > 0.0 else 0.0
        for j in range(n):
            factor[j, i] = half * (taut[i, j] + taut[i + 1, j + 1] - taut[i + 1, j] - taut[i, j + 1])
        factor[i, i] = 0.0
        sky[i] = half * (taut[i, n] + taut[0, i + 1] - taut[0, i] - taut[i + 1, n])


@leaf
def recall(
    shared: bool, like: int, turned_by: float, count: int, stretch: float, index: int, blocked: np.uint64, r: Reach,
    pattern: Pattern, slots: NDArray[np.int32], s: Strings,
) -> tuple[int, bool]:  # fmt: skip
    """The row with the factors of the cross-section, of `count` points, of all grooves `like` this one, -1 where it has
    too many, and whether its light is known.

    shared: so it is for all of them where `index` is the same.
    """
    key = 2.0 * like + (1.0 if turned_by > 0.0 else 0.0)
    at = int(key) % KEPT
    if s.known[at, 0] != key or s.known[at, 1] != stretch:
        s.known[at, 0] = s.solved[at, 0] = -1.0
        if count > ELEMENTS:
            return -1, False
        place(like, turned_by, 1.0, pattern, slots, s)
        if not cut(at, count, math.exp(stretch / STRETCHES), s):
            return -1, False
        s.known[at, 0], s.known[at, 1] = key, stretch
    solved = s.solved[at]
    if shared and solved[0] == index and solved[1] == r.tx and solved[2] == r.ty and s.blocked[at] == blocked:
        return at, True
    solved[0] = index if shared else -1.0
    solved[1], solved[2], s.blocked[at] = r.tx, r.ty, blocked
    return at, False


@callee
def place(groove: int, turned_by: float, scale: float, pattern: Pattern, slots: NDArray[np.int32], s: Strings) -> None:
    """Lay a groove's cross-section out about the footprint's centre, the same for all footprints to the last bit."""
    profile = pattern.profiles[pattern.grooves[groove].profile]
    for i in range(profile.count - 1):
        j = i if turned_by > 0.0 else profile.count - 2 - i
        s.material[i] = slots[pattern.facet_slot[pattern.grooves[groove].slot + j] + 1]
    for i in range(profile.count):
        j = profile.start + (i if turned_by > 0.0 else profile.count - 1 - i)
        s.b[i], s.w[i] = turned_by * scale * pattern.points[j, 0], scale * pattern.points[j, 1]


@callee
def light_up(n: int, light: Floats, s: Strings) -> None:
    """Fill `s.lit` for the cross-section (s.b, s.w) of n points. light: as layout.Work.light."""
    for l in range(len(light)):
        d = light[l]
        for i in range(n):
            s.x[i] = onto_base(s.b[i], s.w[i], d[0], d[1], d[2]) if d[3] != 0.0 else 0.0
        spans(s.b, s.x, s.low, s.high, n, foot_of(d[0], d[2]))
        for i in range(n - 1):
            lit, b0, w0, b1, w1 = s.lit[l, i], s.b[i], s.w[i], s.b[i + 1], s.w[i + 1]
            lit[0] = lit[1] = 0.0
            if d[3] != 0.0 and s.high[i] > s.low[i]:
                lit[1] = 1.0
                if s.low[i] > s.x[i]:
                    lit[0] = fraction_at(s.low[i], b0, w0, b1, w1, d[0], d[1], d[2])
                if s.high[i] < s.x[i + 1]:
                    lit[1] = fraction_at(s.high[i], b0, w0, b1, w1, d[0], d[1], d[2])


@callee
def open_up(
    at: int, stretch: float, index: int, frame: np.void, r: Reach, b: Floats, w: Floats, lighting: Lighting, s: Strings
) -> None:
    """Fill `s.open` for the cross-section (b, w). Of a picture elements see what their middles do, as much as they see
    of an even sky. index: of the frame, one for all that is flat and straight."""
    sky, picture = lighting.sky, has_picture(lighting)
    first, node = s.first[at], s.node[at]
    facets = s.facets[at]
    sums = s.openings.sums[0]
    if picture:
        sums = s.openings.sums[sums_along(index, frame, r, lighting.surroundings, s.openings)]
    wide = math.exp(stretch / STRETCHES)
    for i in range(facets):
        run, rise = wide * (b[i + 1] - b[i]), w[i + 1] - w[i]
        length = math.hypot(run, rise)
        for e in range(first[i], first[i + 1]):
            for c in range(3):
                s.open[c, e] = s.sky[at, e] * sky[c]
            if not picture or length == 0.0:
                continue
            v = 0.5 * (node[e + i] + node[e + i + 1])
            x, y = wide * b[i] + v * run, w[i] + v * rise
            low, high = 0.0, math.pi
            for k in range(facets + 1):
                theta = math.atan2(w[k] - y, wide * b[k] - x)
                if k <= i:
                    high = min(high, theta if theta > -0.5 * math.pi else theta + 2.0 * math.pi)
                else:
                    low = max(low, theta)
            if high <= low:
                continue
            cosine, sine = -rise / length, run / length
            share = cosine * (math.sin(high) - math.sin(low)) - sine * (math.cos(high) - math.cos(low))
            if share <= 0.0:
                continue
            for c in range(3):
                s.open[c, e] += 2.0 * s.sky[at, e] / share * seen_between(low, high, cosine, sine, c, sums)


@callee
def exchange(
    at: int, bounces: int, curved: bool, folded_at: float, frame: np.void, view: View, r: Reach, b: Floats, w: Floats,
    row: NDArray[np.int64], lit: Floats, lighting: Lighting, materials: NDArray[np.void], s: Strings,
) -> None:  # fmt: skip
    """Find what facets gather from each other and from the sky in the last of `bounces`, row `at` of `s.step`.

    (b, w): the cross-section in place; row: of its facets' materials; lit: (lights, facets, 2) their lit parts. What
    they get from the sky is in `s.open`.
    """
    lights = lighting.lights
    first, node = s.first[at], s.node[at]
    facets = s.facets[at]
    n = first[facets]
    bx, by = -r.ty, r.tx
    deepest = 0.0
    for i in range(facets):
        deepest = min(deepest, w[i])
    t = 0.5 * r.eye_t * deepest
    for i in range(facets):
        material = materials[row[i]]
        run, rise = b[i + 1] - b[i], w[i + 1] - w[i]
        base, glow = material.base_color, material.emissive
        diffuse = (1.0 - material.metallic) * (1.0 - material.transmission)
        normal = normal_to_world(frame, (-rise * bx, -rise * by, run))
        around = sky_over(lighting, normal)
        for e in range(first[i], first[i + 1]):
            u0, u1 = node[e + i], node[e + i + 1]
            red = green = blue = 0.0
            for l in range(len(lights)):
                v0, v1 = max(u0, lit[l, i, 0]), min(u1, lit[l, i, 1])
                if v1 <= v0:
                    continue
                v = 0.5 * (v0 + v1)
                here_b, here_w = b[i] + v * run, w[i] + v * rise
                to_light = (lights[l].vector[0], lights[l].vector[1], lights[l].vector[2])
                square = 1.0
                if lights[l].kind != DIRECTIONAL:
                    place = to_world(frame, view.p + here_b * bx + t * r.tx, view.q + here_b * by + t * r.ty, here_w)
                    to_light = (to_light[0] - place[0], to_light[1] - place[1], to_light[2] - place[2])
                    square = dot(to_light, to_light)
                    to_light = unit(to_light)
                if curved:
                    x, y = (here_b - folded_at) * bx + t * r.tx, (here_b - folded_at) * by + t * r.ty
                    normal = normal_to_world(frame, turned(frame, x, y, here_w, (-rise * bx, -rise * by, run)))
                part = (v1 - v0) / (u1 - u0) * max(dot(normal, to_light), 0.0) / (math.pi * square)
                red += part * lights[l].color[0]
                green += part * lights[l].color[1]
                blue += part * lights[l].color[2]
            for c, comes in ((0, red), (1, green), (2, blue)):
                s.albedo[c, e] = diffuse * base[c]
                s.own[c, e] = glow[c] + s.albedo[c, e] * comes
                s.sent[c, e] = s.own[c, e] + s.albedo[c, e] * around[c]
    for _ in range(bounces):
        for c in range(3):
            got, sent = s.got[c], s.sent[c]
            for i in range(n):
                got[i] = s.open[c, i]
            for j in range(n):
                radiance, of = sent[j], s.factor[at, j]
                for i in range(n):
                    got[i] += of[i] * radiance
        change = most = 0.0
        for c in range(3):
            for i in range(n):
                now = s.own[c, i] + s.albedo[c, i] * s.got[c, i]
                change = max(change, abs(now - s.sent[c, i]))
                most = max(most, now)
                s.sent[c, i] = now
        if change <= 1e-7 * most:
            break
    steps = min(STEPS_ABOUT, STEPS // facets)
    s.steps[at] = steps
    total, rate = s.total, s.rate
    for i in range(facets):
        begin, end = first[i] + i, first[i + 1] + i
        for c in range(3):
            total[begin] = 0.0
            for e in range(begin, end):
                total[e + 1] = total[e] + s.albedo[c, e - i] * s.got[c, e - i] * (node[e + 1] - node[e])
            for e in range(begin, end + 1):
                rate[e] = _rate(e, begin, end, node, total)
            e, summed, again, here = begin, 0.0, 0.0, rate[begin]
            for k in range(steps):
                u = (k + 1.0) / steps
                while e < end - 1 and node[e + 1] < u:
                    e += 1
                there, after = _curve(u, e, node, total, rate)
                step = s.step[at, i * steps + k, c]
                step[0], step[1], step[2], step[3] = summed, again, there - summed, (after - here) / steps
                again += (summed + 0.5 * step[2] - step[3] / 12.0) / steps
                summed, here = there, after


@leaf
def _mean(i: int, x: Floats, y: Floats) -> float:
    return (y[i + 1] - y[i]) / (x[i + 1] - x[i])


@leaf
def _rate(i: int, first: int, last: int, x: Floats, y: Floats) -> float:
    """The derivative at node i of the parabola through it and its neighbours; at an end the nearest parabola's, held
    between none and twice the mean beside it."""
    if last - first < 2:
        return _mean(first, x, y)
    j = min(max(i, first + 1), last - 1)
    before, after = _mean(j - 1, x, y), _mean(j, x, y)
    h0, h1 = x[j] - x[j - 1], x[j + 1] - x[j]
    middle = (before * h1 + after * h0) / (h0 + h1)
    if i == j:
        return middle
    beside = before if i < j else after
    return min(max(2.0 * beside - middle, 0.0), 2.0 * beside)


@leaf
def _curve(u: float, i: int, x: Floats, y: Floats, rate: Floats) -> tuple[float, float]:
    """The cubic between nodes i and i + 1 at u, and its derivative."""
    h = x[i + 1] - x[i]
    v, grown = min(max((u - x[i]) / h, 0.0), 1.0), y[i + 1] - y[i]
    r0, r1 = h * rate[i], h * rate[i + 1]
    value = y[i] + v * v * (3.0 - 2.0 * v) * grown + v * (1.0 - v) * ((1.0 - v) * r0 - v * r1)
    return value, (6.0 * v * (1.0 - v) * grown + (1.0 - v) * (1.0 - 3.0 * v) * r0 + v * (3.0 * v - 2.0) * r1) / h


@leaf
def _summed(at: int, i: int, u: float, s: Strings) -> tuple[Vector, Vector]:
    """What is gathered from the start of facet i to u, RGB: a mean radiance times u; and the integral of that."""
    steps = s.steps[at]
    k = min(int(u * steps), steps - 1)
    v, h, row = u * steps - k, 1.0 / steps, s.step[at, i * steps + k]
    square = 0.5 * v * v
    w, x = square - 0.5 * v, square * (v / 3.0 - 0.5)
    return (
        (
            row[0, 0] + v * row[0, 2] + w * row[0, 3],
            row[1, 0] + v * row[1, 2] + w * row[1, 3],
            row[2, 0] + v * row[2, 2] + w * row[2, 3],
        ),
        (
            row[0, 1] + h * (v * row[0, 0] + square * row[0, 2] + x * row[0, 3]),
            row[1, 1] + h * (v * row[1, 0] + square * row[1, 2] + x * row[1, 3]),
            row[2, 1] + h * (v * row[2, 0] + square * row[2, 2] + x * row[2, 3]),
        ),
    )


@leaf
def _trapezoid(x: float, inner: float, outer: float) -> float:
    return 1.0 if abs(x) <= inner else max((outer - abs(x)) / (outer - inner), 0.0)


@leaf
def gathered(
    at: int, i: int, u0: float, u1: float, low: float, high: float, inner: float, outer: float, s: Strings
) -> Vector:  # fmt: skip
    """The mean of what facet i gathers from u0 to u1, RGB, seen from `low` to `high` along B.

    A parallelogram weighs places along B by a trapezoid: evenly up to `inner` on both sides of its centre, and from
    there ever less, down to nothing at `outer`. In parts, the integral of that times a radiance is one of the
    trapezoid's two slopes times the radiance's sum.
    """
    y0, z0 = _summed(at, i, u0, s)
    y1, z1 = _summed(at, i, u1, s)
    red, green, blue, whole = y1[0] - y0[0], y1[1] - y0[1], y1[2] - y0[2], u1 - u0
    if low < -inner or high > inner:
        g0, g1, rate = _trapezoid(low, inner, outer), _trapezoid(high, inner, outer), (u1 - u0) / (high - low)
        red, green, blue = g1 * y1[0] - g0 * y0[0], g1 * y1[1] - g0 * y0[1], g1 * y1[2] - g0 * y0[2]
        total, least = g1 * u1 - g0 * u0, CORNER * whole
        if low < -inner:
            v, z, rise = u1, z1, g1 - g0
            if high > -inner:
                v, rise = min(u0 + (-inner - low) * rate, u1), 1.0 - g0
                _, z = _summed(at, i, v, s)
            if v > u0:
                part = rise / (v - u0)
                red, green = red - part * (z[0] - z0[0]), green - part * (z[1] - z0[1])
                blue, total = blue - part * (z[2] - z0[2]), total - 0.5 * rise * (u0 + v)
        if high > inner:
            v, z, rise = u0, z0, g1 - g0
            if low < inner:
                v, rise = max(u1 - (high - inner) * rate, u0), g1 - 1.0
                _, z = _summed(at, i, v, s)
            if v < u1:
                part = rise / (u1 - v)
                red, green = red - part * (z1[0] - z[0]), green - part * (z1[1] - z[1])
                blue, total = blue - part * (z1[2] - z[2]), total - 0.5 * rise * (v + u1)
        if total > least:
            whole = total
        else:
            red, green, blue = y1[0] - y0[0], y1[1] - y0[1], y1[2] - y0[2]
    part = 1.0 / whole
    return max(part * red, 0.0), max(part * green, 0.0), max(part * blue, 0.0)
