"""A cross-section seen and lit from a point or direction D = (db, dw, h) of its plane (DESIGN 2.1, in two dimensions).

(b, w) are the place along B and the height, pattern units; h = 1: D is a point, h = 0: a direction.
"""

from __future__ import annotations

import math

from renderer.geometry.share import share
from renderer.geometry.view import View
from renderer.kernel import leaf
from renderer.tables import Floats

ACROSS = -1.0
"""h of a direction that may be as low as it likes: places count square to it, in lengths of (db, dw), not along the
base line."""


@leaf
def onto_base(b: float, w: float, db: float, dw: float, h: float) -> float:
    """Where the line from D through (b, w) meets the base line w = 0; w below D."""
    if h == 0.0:
        return b - w * db / dw
    if h < 0.0:
        return b * dw - w * db
    return db + (b - db) * dw / (dw - w)


@leaf
def foot_of(db: float, h: float) -> float:
    """The place below D on the base line: an end of it for a direction."""
    if h <= 0.0:
        return math.inf if db > 0.0 else -math.inf
    return db


@leaf
def spans(b: Floats, x: Floats, low: Floats, high: Floats, count: int, foot: float) -> None:
    """The visible interval (low, high) of each facet between projected points x; low >= high: hidden (000, eq. 4).

    b, x: (count,) points from left to right and their projections; low, high: (count - 1,). A point is masked by
    those between it and the foot of D, on either side of it.
    """
    farthest = -math.inf
    for i in range(count - 1):
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
    """Where on the facet from (b0, w0) to (b1, w1) the point lies that projects to x: 0 at its start, 1 at its end."""
    if h <= 0.0:
        x0, x1 = onto_base(b0, w0, db, dw, h), onto_base(b1, w1, db, dw, h)
        return (x - x0) / (x1 - x0)
    c = (x - db) / dw
    return (c * (dw - w0) - (b0 - db)) / (b1 - b0 + c * (w1 - w0))


@leaf
def carried(
    x: float, b0: float, w0: float, b1: float, w1: float, h0: float, h1: float, light: Floats, db: float, dw: float,
    h: float,
) -> float:  # fmt: skip
    """The point of a facet that the light (D_b, D_w, h, ...) projects to x, projected from D instead.

    For D the facet's ends are at the heights h0 and h1.
    """
    u = fraction_at(x, b0, w0, b1, w1, light[0], light[1], light[2])
    return onto_base(b0 + u * (b1 - b0), h0 + u * (h1 - h0), db, dw, h)


@leaf
def along(view: View, bx: float, by: float, y: float) -> float:
    """The share of the footprint where B . x <= y."""
    return share(
        bx * view.pu + by * view.qu - y * view.wu,
        bx * view.pv + by * view.qv - y * view.wv,
        bx * view.p1 + by * view.q1 - y * view.w1,
    )


@leaf
def shifts(height: float, depth: float, eye: float, light: float, lowest: float, highest: float) -> tuple[float, float]:
    """[lowest, highest] widened to the shifts along one axis from a point of the base plane to what is seen through it
    at heights -depth .. height, and on to what may shade that.

    `eye` and `light`: the shift for a unit of height towards each, pattern units.
    """
    deep, high = -depth * eye, height * eye
    lit = deep + (height + depth) * light
    return min(lowest, deep, high, lit), max(highest, deep, high, lit)
