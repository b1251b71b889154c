"""The part of the base plane that matters to a footprint: what may be seen through it, hide it or shade it.

It is bounded by slabs, low <= a . x <= high: along p and q, and across the ways that sight and light take, which may
lead far where they are low.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.polygon import CORNERS, Counts, clipped
from renderer.geometry.view import View, on_plane
from renderer.kernel import leaf
from renderer.tables import Floats, Pattern

AXES = 6  # p, q, across sight, across the light of the first three


class Domain(NamedTuple):
    """Memory of one thread."""

    axis: Floats  # (AXES, 2) unit vectors
    slab: Floats  # (AXES, 2) low, high
    outline: Floats  # (CORNERS, 2) the polygon that the slabs bound
    made: Counts  # (2,) axes; corners of the outline
    planes: Floats  # (2 AXES, 3) its half-planes
    spare: Floats  # (CORNERS, 2)


@leaf
def domain_of() -> Domain:
    return Domain(
        np.zeros((AXES, 2)), np.zeros((AXES, 2)), np.empty((CORNERS, 2)), np.zeros(2, np.int64),
        np.empty((2 * AXES, 3)), np.empty((CORNERS, 2)),
    )  # fmt: skip


@leaf
def aim(view: View, source: Floats, domain: Domain) -> None:
    """Choose the axes for a footprint."""
    domain.axis[0, 0], domain.axis[0, 1], domain.axis[1, 0], domain.axis[1, 1] = 1.0, 0.0, 0.0, 1.0
    n = 2
    for l in range(-1, len(source) - 1):  # the eye first
        d = source[l]
        x, y = d[0] - d[3] * view.p, d[1] - d[3] * view.q
        if l >= 0 and d[2] <= 0.0:
            continue
        long = math.hypot(x, y)
        if n < AXES and long > 0.0:
            domain.axis[n, 0], domain.axis[n, 1] = -y / long, x / long
            n += 1
    domain.made[0] = n


@leaf
def spread(pattern: Pattern, view: View, source: Floats, margin: float, far: float, domain: Domain) -> bool:
    """Write the slabs of a footprint along the axes chosen, by this part of them and so far wider on either side; False
    where they have no end."""
    high, low, eye = pattern.height, -pattern.depth, source[len(source) - 1]
    n, slab = domain.made[0], domain.slab
    for k in range(n):
        slab[k, 0], slab[k, 1] = math.inf, -math.inf
    top = min(high, eye[2])
    for i in range(8):
        cp, cq = on_plane(view, float(i & 1), float((i >> 1) & 1))
        w = low if i < 4 else top
        x, y = cp + w * (eye[0] - cp) / eye[2], cq + w * (eye[1] - cq) / eye[2]
        for k in range(n):
            along = domain.axis[k, 0] * x + domain.axis[k, 1] * y
            slab[k, 0], slab[k, 1] = min(slab[k, 0], along), max(slab[k, 1], along)
        for l in range(len(source) - 1):
            d = source[l]
            if d[2] <= 0.0:
                continue
            way = (high - w) / d[2] if d[3] == 0.0 else min((high - w) / max(d[2] - w, 1e-300), 1.0)
            px, py = x + way * (d[0] - d[3] * x), y + way * (d[1] - d[3] * y)
            for k in range(n):
                along = domain.axis[k, 0] * px + domain.axis[k, 1] * py
                slab[k, 0], slab[k, 1] = min(slab[k, 0], along), max(slab[k, 1], along)
    finite = True
    for k in range(n):
        wide = margin * (slab[k, 1] - slab[k, 0]) + far
        slab[k, 0], slab[k, 1] = slab[k, 0] - wide, slab[k, 1] + wide
        finite = finite and slab[k, 1] - slab[k, 0] < math.inf
    return finite


@leaf
def settle(domain: Domain) -> None:
    """Draw the outline that the slabs bound."""
    n = domain.made[0]
    outline, planes = domain.outline, domain.planes
    for k in range(n):
        for side in range(2):
            sign = 1.0 - 2.0 * side
            planes[2 * k + side, 0], planes[2 * k + side, 1] = sign * domain.axis[k, 0], sign * domain.axis[k, 1]
            planes[2 * k + side, 2] = -sign * domain.slab[k, side]
    for k in range(4):
        outline[k, 0] = domain.slab[0, 1 if k == 1 or k == 2 else 0]
        outline[k, 1] = domain.slab[1, 1 if k >= 2 else 0]
    domain.made[1] = clipped(outline, 4, planes, 4, 2 * n, domain.spare)
