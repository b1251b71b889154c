"""Regular families of grooves folded: a footprint over very many periods looks at one of them, or a few.

Along B, period k lies at k d, and a facet that is seen between lo and hi in period 0 fills F(hi + k d) - F(lo + k d)
of the footprint, with F(y) the share of it below y. Where eye and lights are far and the footprint is a parallelogram,
F is quadratic between the footprint's corners, so that the share is linear in k there: n periods fill n times as much
as their middle one, even where that lies between two. So the periods that hold a corner are summed one by one, and the
others in at most three runs: exact for any number of them.

Where the corners lie d and more apart, all that matters less and less. With a and b the extents of the footprint's
edges across the grooves, the share's density is a trapezoid whose slopes of 1 / (a b) end at the corners, and the sum
over k, times d, is off its mean by at most d^2 / 12 for each unit that a slope changes (Euler and Maclaurin: the second
periodic Bernoulli polynomial is at most 1 / 6): by d^2 / (3 a b) in all. Below EVEN of that the mean is taken.

What remains is perspective, under which what is seen changes along the footprint. With c the change of a shift across
it, as a part of d, an end of a facet that comes into sight there makes an error of at most c / 8, the most that the
middle is wrong by for max(0, x - t). Where that is too much, a run is seen at two places of it, m +- s with m its
middle and s^2 = (n^2 - 1) / 12, each for half of the run: the sum of any cubic in k. They are wrong by 0.0223 c, and by
1 / j^2 of it where the run is cut into j. Smooth changes leave squares and fourth powers. Where the mean is taken, the
footprint is cut into equal parts instead, and one period in the middle of each one's share stands for it: j of them are
wrong by c / (8 j^2).

In a row of equal ridges none is hidden or shaded by the second next that is not by the next: a ray towards an eye or a
light passes over it higher up. So each period is laid out with one to the left and one to the right.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from renderer.geometry.pieces import is_beyond, locate
from renderer.geometry.query import Nearby, find_in
from renderer.geometry.reach import SPUN, Reach, aside_by
from renderer.geometry.section import along
from renderer.geometry.view import View, on_plane
from renderer.kernel import fixed, leaf
from renderer.tables import Floats, Pattern

MANY = 12.0  # periods across a footprint, from which on they are folded
KINK = 0.00025  # the error that an end of a facet may make which comes into sight within a run
ONE = 0.0064  # c up to which one period is looked at: an error of 0.0008
EVEN = 0.0004  # the error of the mean that is taken for a sum, as a part of what is seen
FLAT_ENOUGH = 0.02  # how far, relatively, the screen's depth may change for one period to do: its square counts
SKEW = 0.3  # ... along a run seen at two places: its fourth power counts
RUNS = 32.0  # that a run is cut into at most
FAR_OFF = 2.0**24  # periods, where there is no first
SUMS = fixed(1024)  # entries of a sum over periods
SCANNED = fixed(2048)  # pieces of no family that are looked at near a footprint


@leaf
def family_at(family: np.void, p: float, q: float) -> tuple[float, float, float]:
    """T at a point of the plane, and where along B from there the first path lies."""
    x, y = family.x - p, family.y - q
    if family.radius == 0.0:
        axis = y * family.tx - x * family.ty
        if math.isinf(family.count):  # without an end to either side: counted from so far off that none is met
            axis -= (math.floor(axis / family.period) + FAR_OFF) * family.period
        return family.tx, family.ty, axis
    distance = math.hypot(x, y)
    if distance == 0.0:
        return 1.0, 0.0, -family.radius
    return y / distance, -x / distance, distance - family.radius


@leaf
def extent_along(view: View, bx: float, by: float) -> tuple[float, float]:
    """The bounds of the footprint along an axis, from its centre."""
    low = high = 0.0
    for k in range(4):
        p, q = on_plane(view, float(k & 1), float(k >> 1))
        across = (p - view.p) * bx + (q - view.q) * by
        low, high = min(low, across), max(high, across)
    return low, high


@leaf
def crowded(pattern: Pattern, view: View) -> int:
    """The family of which MANY periods or more lie across the footprint's extent: its row, -1 where there is none."""
    for i in range(len(pattern.families)):
        family = pattern.families[i]
        if family.folds == 0:
            continue
        tx, ty, axis = family_at(family, view.p, view.q)
        low, high = extent_along(view, -ty, tx)
        if (
            high - low >= MANY * family.period
            and axis + family.start < high
            and axis + family.finish + (family.count - 1.0) * family.period > low
        ):
            return i
    return -1


@leaf
def is_alone(pattern: Pattern, which: int, view: View, r: Reach, found: Nearby) -> bool:
    """Whether nothing but the one family reaches what matters to the footprint."""
    radius = max(-r.long_low, r.long_high) + max(-r.wide_low, r.wide_high)
    for i in range(len(pattern.families)):
        if i == which:
            continue
        family = pattern.families[i]
        _, _, axis = family_at(family, view.p, view.q)
        span = (family.count - 1.0) * family.period
        if axis + family.start > radius or axis + family.finish + span < -radius:
            continue
        if family.radius == 0.0:
            on = (view.p - family.x) * family.tx + (view.q - family.y) * family.ty
            slip = (family.count - 1.0) * family.slip if family.slip != 0.0 else 0.0
            far = radius + pattern.reach
            if on < min(slip, 0.0) - far or on > family.length + max(slip, 0.0) + far:
                continue
        return False
    if len(pattern.rest.items) == 0:
        return True
    m = radius + pattern.reach
    count = find_in(pattern.rest, found, view.p - m, view.q - m, view.p + m, view.q + m, SCANNED)
    return count >= 0 and not any_within(pattern, found, count, view, radius)


@leaf
def any_within(pattern: Pattern, found: Nearby, count: int, view: View, radius: float) -> bool:
    """Whether any of the first `count` pieces found gets as near to the footprint's centre as this."""
    for k in range(count):
        piece = pattern.pieces[found.piece[k]]
        x, y = view.p - found.shift[k, 0], view.q - found.shift[k, 1]
        s, b = locate(piece, x, y)
        if not is_beyond(piece, x, y, s, b, radius):
            return True
    return False


@leaf
def bends_by(family: np.void, view: View, r: Reach) -> float:
    """What is left to error where the family's paths bend past the footprint, in parts of what facets differ by; more
    than CROOKED where that, or what they bend within it, is too much, or where they end before what matters to it."""
    length = max(-r.long_low, r.long_high)
    axis = family_at(family, view.p, view.q)[2]
    if family.radius > 0.0:
        last = family.radius - (family.count - 1.0) * family.period - (family.finish - family.start)
        least = max(axis + family.radius - r.wide_high, last)
        if least <= 0.0 or r.length**2 > least * (r.high - r.low):
            return math.inf
        return aside_by(1.0 / least, length - r.length, family.half) + SPUN * (r.length / least) ** 2
    if math.isinf(family.length):
        return 0.0
    on = (view.p - family.x) * family.tx + (view.q - family.y) * family.ty
    for side in range(2):
        k = ((r.wide_low if side == 0 else r.wide_high) - axis) / family.period
        s = on - family.slip * min(max(k, -1.0), family.count)
        if s + r.long_low < 0.0 or s + r.long_high > family.length:
            return math.inf
    return 0.0


@leaf
def changes(family: np.void, view: View, r: Reach, eye_w: float, light: Floats) -> tuple[float, float]:
    """What changes across the footprint: the shift between heights, as a part of the period, and the screen's depth."""
    deep = (family.height + family.depth) / family.period
    shift = deep / (eye_w - family.height)
    for l in range(len(light)):
        if light[l, 3] != 0.0 and light[l, 2] > 0.0:
            shift = max(shift, max(deep, 1.0) / (light[l, 1] - family.height))
    middle = abs(view.w1 + 0.5 * (view.wu + view.wv))
    spread = abs(view.wu) + abs(view.wv)
    return (r.high - r.low) * shift, spread / max(middle - 0.5 * spread, 1e-3 * spread) if spread > 0.0 else 0.0


@leaf
def shifted(family: np.void, eye_d: float, eye_w: float, low: float, high: float) -> tuple[float, float]:
    """Where a period is seen on the base line: from so far after its start to so far after its end.

    Its highest point and the one of the period before, towards the eye, bound it. low, high: all along B that matters.
    """
    s0 = (low - eye_d) * family.height / (eye_w - family.height)
    s1 = (high - eye_d) * family.height / (eye_w - family.height)
    if s0 >= 0.0:
        return max(0.0, s0 - family.period), s1
    if s1 <= 0.0:
        return s0, min(0.0, s1 + family.period)
    return s0, s1


@leaf
def put(pattern: Pattern, family: np.void, k: float, copies: float, axis: float, r: Reach, near: Any, n: int) -> int:
    """Append the grooves of period k, and those beside it where they could hide or shade it: the rows in use.

    k may lie between two. More than there is room for are counted, and not written.
    """
    group = near[n - 1].group + 1 if 0 < n <= len(near) else 0
    aside = 1 if pattern.height > 0.0 else 0
    for j in range(-aside, aside + 1):
        at = k + j
        if at < -0.5 or at > family.count - 0.5:
            continue
        for i in range(family.first, family.last):
            if n >= len(near):
                n += 1
                continue
            member = pattern.members[i]
            g = near[n]
            g.piece = member.piece + member.stride * (round(at) if member.stride != 0 else 0)
            profile = pattern.profiles[pattern.grooves[pattern.pieces[g.piece].groove].profile]
            place = axis + member.offset + at * family.period
            if family.radius > 0.0:
                place += 0.5 * r.spread * r.spread / (family.radius - member.offset - at * family.period)
            f, sign = member.scale, member.turned
            g.axis, g.turned, g.scale = place, sign, f
            g.start = place + f * (profile.left if sign > 0.0 else -profile.right)
            g.finish = place + f * (profile.right if sign > 0.0 else -profile.left)
            g.copies, g.group = copies if j == 0 else 0.0, group
            n += 1
    return n


@leaf
def add(sums: Floats, n: int, k: float, copies: float) -> int:
    """Append to a sum over periods: the entries in use, those for which there is no room counted, too."""
    if n < len(sums):
        sums[n, 0], sums[n, 1] = k, copies
    return n + 1


@leaf
def add_run(sums: Floats, n: int, first: float, last: float, cuts: float) -> int:
    """Append what stands for the periods first <= k <= last, none of which holds a corner: their middle (cuts 0), or
    two places in each of so many parts."""
    count = last - first + 1.0
    if cuts == 0.0:
        return add(sums, n, 0.5 * (first + last), count)
    if count <= 2.0 * cuts:
        for k in range(int(count)):
            n = add(sums, n, first + k, 1.0)
        return n
    begin = 0.0
    for i in range(int(cuts)):
        end = math.floor(count * (i + 1) / cuts)
        many = end - begin
        middle = first + begin + 0.5 * (many - 1.0)
        begin = end
        if many == 1.0:
            n = add(sums, n, middle, 1.0)
            continue
        aside = math.sqrt((many * many - 1.0) / 12.0)
        n = add(sums, n, middle - aside, 0.5 * many)
        n = add(sums, n, middle + aside, 0.5 * many)
    return n


@leaf
def periods(
    family: np.void, view: View, r: Reach, zero: float, before: float, after: float, first: float, last: float,
    cuts: float, sums: Floats, rims: Floats,
) -> int:  # fmt: skip
    """Fill `sums` with the periods (k, copies) that stand for first <= k <= last: how many entries, -1 for too many.

    zero: where period 0 begins along B. rims: (6, 2) memory.
    """
    m = 0
    for k in range(6):  # the periods that hold corners, and those at the family's ends, in order
        begin = finish = 0.0 if k == 4 else family.count - 1.0
        if k < 4:
            p, q = on_plane(view, float(k & 1), float(k >> 1))
            corner = (q - view.q) * r.tx - (p - view.p) * r.ty
            begin = math.floor((corner - after - zero) / family.period)
            finish = math.ceil((corner - before - zero) / family.period) - 1.0
        begin, finish = max(begin, first), min(finish, last)
        if begin > finish:
            continue
        at = m
        while at > 0 and rims[at - 1, 0] > begin:
            rims[at, 0], rims[at, 1] = rims[at - 1, 0], rims[at - 1, 1]
            at -= 1
        rims[at, 0], rims[at, 1] = begin, finish
        m += 1
    n = 0
    at_k = first
    for i in range(m):
        if rims[i, 0] > at_k:
            n = add_run(sums, n, at_k, rims[i, 0] - 1.0, cuts)
            at_k = rims[i, 0]
        if rims[i, 1] - at_k > len(sums):
            return -1
        while at_k <= rims[i, 1]:
            n = add(sums, n, at_k, 1.0)
            at_k += 1.0
    if at_k <= last:
        n = add_run(sums, n, at_k, last, cuts)
    return n if n <= len(sums) else -1


@leaf
def fold(
    pattern: Pattern, family: np.void, view: View, r: Reach, eye_d: float, eye_w: float, light: Floats, near: Any,
    sums: Floats, rims: Floats,
) -> tuple[int, int]:  # fmt: skip
    """Fill `near` (NEAR) with the periods to look at, from left to right, and `sums` with what each of them stands for.

    How many rows of both. An entry (shift, copies) of `sums` is so many copies of all that is near, moved along B.
    Without any, each length along B counts sums[0, 1] of the footprint, times the copies of its row. No rows of
    `near`: the family is left as it is.
    """
    change, skew = changes(family, view, r, eye_w, light)
    d = family.period
    axis = family_at(family, view.p, view.q)[2]
    zero = axis + family.start
    before, after = shifted(family, eye_d, eye_w, r.wide_low, r.wide_high)
    end = family.count - 1.0
    first = max(math.floor((r.low - after - zero) / d), 0.0)
    last = min(math.ceil((r.high - before - zero) / d) - 1.0, end)
    if last - first + 1.0 < MANY:
        return 0, 0
    inside = first > 0.0 and last < end
    a, b = abs(extent(view, r, 1.0, 0.5)), abs(extent(view, r, 0.5, 1.0))
    smooth = d * d <= EVEN * 3.0 * 4.0 * a * b
    if change <= ONE and skew <= FLAT_ENOUGH and (inside or pattern.height == 0.0):
        amid = min(max(-zero / d - 0.5, first), last)
        n = put(pattern, family, amid, 1.0, axis, r, near, 0)
        if inside and smooth:
            sums[0, 0], sums[0, 1] = 0.0, 1.0 / d
            return n if n <= len(near) else 0, 0
        m = periods(family, view, r, zero, before, after, first, last, 0.0, sums, rims)
        for i in range(m):
            sums[i, 0] = (sums[i, 0] - amid) * d
        return n if n <= len(near) and m > 1 else 0, m
    if inside and smooth:
        cuts = math.ceil(max(math.sqrt(change * 0.125 / KINK), 2.0 * skew / SKEW, 2.0))
        if not cuts <= 2.0 * RUNS:
            return 0, 0
        sums[0, 0], sums[0, 1] = 0.0, 1.0 / d
        n = spread_out(pattern, family, view, r, axis, zero, int(cuts), near)
        return n if n <= len(near) else 0, 0
    cuts = math.ceil(max(math.sqrt(change * 0.0223 / KINK), skew / SKEW, 1.0))
    if not cuts <= RUNS:
        return 0, 0
    m = periods(family, view, r, zero, before, after, first, last, cuts, sums, rims)
    if m < 0 or 2 * m > last - first:
        return 0, 0
    n = 0
    for i in range(m):
        n = put(pattern, family, sums[i, 0], sums[i, 1], axis, r, near, n)
    sums[0, 0], sums[0, 1] = 0.0, 1.0
    return n if n <= len(near) else 0, 1


@leaf
def spread_out(
    pattern: Pattern, family: np.void, view: View, r: Reach, axis: float, zero: float, cuts: int, near: Any
) -> int:
    """Fill `near` with a period in each of so many equal parts of the footprint, which stands for the share of the
    footprint that lies there, where that is in the mean: the rows in use."""
    bx, by = -r.ty, r.tx
    centre = bx * view.p + by * view.q
    step = (r.high - r.low) / cuts
    before, n = 0.0, 0
    for i in range(cuts):
        x = r.low + i * step
        half, after = along(view, bx, by, centre + x + 0.5 * step), along(view, bx, by, centre + x + step)
        mass = after - before
        if mass > 0.0:  # Simpson's rule for the integral of the share up to each place
            amid = x + step * (after - (before + 4.0 * half + after) / 6.0) / mass
            n = put(pattern, family, (amid - zero) / family.period - 0.5, mass, axis, r, near, n)
        before = after
    return n


@leaf
def extent(view: View, r: Reach, u: float, v: float) -> float:
    """How far along B a place of the pixel's square lies from the centre."""
    p, q = on_plane(view, u, v)
    return (q - view.q) * r.tx - (p - view.p) * r.ty
