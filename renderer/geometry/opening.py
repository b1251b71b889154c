"""A picture of the sky through the opening of a straight groove, in closed form but for one table a direction T.

A direction is cos(phi) (cos(theta) B + sin(theta) N) + sin(phi) T. What stands before a facet is the same all along T,
so that it sees the sky between two thetas, at every phi, and gets from there, if its normal lies at angle a,

    integral of cos(theta - a) A(theta),    A(theta) = integral of cos^2(phi) L(theta, phi) over phi.

That is a sum of two integrals of A, by the cosine and by the sine of theta, whatever the facet: both are kept as sums
from 0 up. All angles are those of the world. No paper has this.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.reach import Reach
from renderer.kernel import callee, fixed, leaf
from renderer.shading import dot, looked_up, unit
from renderer.tables import Floats, Surroundings

KEPT = fixed(4)  # directions T of which a thread keeps sums
THETAS = fixed(256)  # from B over N to -B,
PHIS = fixed(256)  # and from T to -T: 0.7 degrees


class Openings(NamedTuple):
    """Memory of one thread."""

    known: Floats  # (KEPT, 3) the frame and T whose sums these are; -1: none
    last: NDArray[np.int64]  # (1,) the row filled last
    sums: Floats  # (KEPT, THETAS + 1, 9) RGB of A / pi from here on; its sum by the cosine of theta so far, by the sine


@leaf
def openings() -> Openings:
    return Openings(np.full((KEPT, 3), -1.0), np.zeros(1, np.int64), np.empty((KEPT, THETAS + 1, 9)))


@callee
def sums_along(index: int, frame: np.void, r: Reach, picture: Surroundings, o: Openings) -> int:
    """The row of sums for a flat object's frame, of that index, and T."""
    for k in range(KEPT):
        if o.known[k, 0] == index and o.known[k, 1] == r.tx and o.known[k, 2] == r.ty:
            return k
    at = (o.last[0] + 1) % KEPT
    o.last[0] = at
    o.known[at, 0], o.known[at, 1], o.known[at, 2] = index, r.tx, r.ty
    sums = o.sums[at]
    x = frame.axes
    n = unit((x[0, 2], x[1, 2], x[2, 2]))
    t = unit((x[0, 0] * r.tx + x[0, 1] * r.ty, x[1, 0] * r.tx + x[1, 1] * r.ty, x[2, 0] * r.tx + x[2, 1] * r.ty))
    b = (x[0, 1] * r.tx - x[0, 0] * r.ty, x[1, 1] * r.tx - x[1, 0] * r.ty, x[2, 1] * r.tx - x[2, 0] * r.ty)
    skew = dot(b, t)  # of a stretched mapping: across T in the world is what counts
    b = unit((b[0] - skew * t[0], b[1] - skew * t[1], b[2] - skew * t[2]))
    sums[0, :] = 0.0
    step, turn = math.pi / THETAS, math.pi / PHIS
    for i in range(THETAS):
        theta = (i + 0.5) * step
        cosine, sine = math.cos(theta), math.sin(theta)
        m = (cosine * b[0] + sine * n[0], cosine * b[1] + sine * n[1], cosine * b[2] + sine * n[2])
        red = green = blue = weight = 0.0
        for j in range(PHIS):
            phi = (j + 0.5) * turn - 0.5 * math.pi
            up, along = math.cos(phi), math.sin(phi)
            seen = looked_up(picture, 0, (up * m[0] + along * t[0], up * m[1] + along * t[1], up * m[2] + along * t[2]))
            part = up * up
            weight += part
            red, green, blue = red + part * seen[0], green + part * seen[1], blue + part * seen[2]
        turned_by = math.sin(theta + 0.5 * step) - math.sin(theta - 0.5 * step)
        risen_by = math.cos(theta - 0.5 * step) - math.cos(theta + 0.5 * step)
        for c, value in ((0, red), (1, green), (2, blue)):
            mean = 0.5 * value / weight  # over pi: of a radiance 1 the integral over phi is pi / 2
            sums[i, c] = mean
            sums[i + 1, 3 + c] = sums[i, 3 + c] + mean * turned_by
            sums[i + 1, 6 + c] = sums[i, 6 + c] + mean * risen_by
    return at


@leaf
def _sum_to(theta: float, cosine: float, sine: float, c: int, sums: Floats) -> float:
    i = min(int(theta / math.pi * THETAS), THETAS - 1)
    begin, row = i * math.pi / THETAS, sums[i]
    by_cosine = row[3 + c] + row[c] * (math.sin(theta) - math.sin(begin))
    by_sine = row[6 + c] + row[c] * (math.cos(begin) - math.cos(theta))
    return float(cosine * by_cosine + sine * by_sine)


@leaf
def seen_between(low: float, high: float, cosine: float, sine: float, c: int, sums: Floats) -> float:
    """The radiance, channel c, of a white matt facet with the normal (cosine, sine) by the sky from theta `low` to
    `high`, within 0 and pi."""
    return max(_sum_to(high, cosine, sine, c, sums) - _sum_to(low, cosine, sine, c, sums), 0.0)
