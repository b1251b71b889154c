"""A curved base to second order around a footprint (FRAME.form), as rays over it meet it.

In the frame of the tangent plane the point (p, q, w) of pattern space lies, with x = (p, q) from the frame's place,

- by 1/2 x.F x lower, where F is the form: the surface falls away from its tangent plane;
- by w M x farther out, where M = sigma^2 g^-1 F and g is the metric: heights go along normals, which spread;
- on spheres, by 1/2 C(x, x) aside, with Christoffel's symbols C, and by w l . x higher, where l is the slope of
  ln(sigma) (FRAME.drift).

What is left out is of third order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.kernel import leaf
from renderer.shading import Vector
from renderer.tables import Floats

BOWED = 0.03  # the error that is left, in parts of the angle by which the base turns within reach (measured)


class Bow(NamedTuple):
    """The form in the frame of parallel grooves, pattern units: along B and T."""

    bb: float
    bt: float
    tt: float
    spread: float  # of heights along B: M's part


@leaf
def is_curved(frame: np.void) -> bool:
    return bool(frame.form[0] != 0.0 or frame.form[1] != 0.0 or frame.form[2] != 0.0)


@leaf
def unsure(frame: np.void, far: float) -> float:
    """About the error that is left where what matters reaches so far beyond a footprint, relative to white."""
    f = frame.form
    return BOWED * max(abs(f[0]), abs(f[1]), abs(f[2])) * far


@leaf
def applied(frame: np.void, x: float, y: float) -> tuple[float, float]:
    """F x: the slope of the surface at x, downwards."""
    return frame.form[0] * x + frame.form[1] * y, frame.form[1] * x + frame.form[2] * y


@leaf
def spreading(frame: np.void, x: float, y: float) -> tuple[float, float]:
    """M x: how far a height of 1 leans out at x."""
    a = frame.axes
    e = a[0, 0] * a[0, 0] + a[1, 0] * a[1, 0] + a[2, 0] * a[2, 0]
    f = a[0, 0] * a[0, 1] + a[1, 0] * a[1, 1] + a[2, 0] * a[2, 1]
    g = a[0, 1] * a[0, 1] + a[1, 1] * a[1, 1] + a[2, 1] * a[2, 1]
    area = math.sqrt(e * g - f * f)
    u, v = applied(frame, x, y)
    return (g * u - f * v) / area, (e * v - f * u) / area


@leaf
def drifting(frame: np.void, x: float, y: float, u: float, v: float) -> tuple[float, float]:
    """C(x, u): how coordinates bend along the surface."""
    return frame.drift[1] * (x * v + y * u), frame.drift[0] * x * u


@leaf
def turned(frame: np.void, x: float, y: float, w: float, n: Vector) -> Vector:
    """A normal of pattern space at x and the height w, in the tangent frame, to first order."""
    u, v = applied(frame, x, y)
    mx, my = spreading(frame, x, y)
    m00, m10 = spreading(frame, 1.0, 0.0)
    m01, m11 = spreading(frame, 0.0, 1.0)
    d = frame.drift
    return (
        n[0] - w * (m00 * n[0] + m10 * n[1]) + u * n[2] - d[1] * y * n[0] - d[0] * x * n[1],
        n[1] - w * (m01 * n[0] + m11 * n[1]) + v * n[2] - d[1] * x * n[0] - w * d[2] * n[2],
        n[2] - mx * n[0] - my * n[1] - d[2] * y * n[2],
    )


@leaf
def bent(frame: np.void, p: float, q: float, w: float) -> Vector:
    """Where in the tangent frame a point of pattern space lies."""
    x, y = p - frame.pq[0], q - frame.pq[1]
    u, v = applied(frame, x, y)
    mx, my = spreading(frame, x, y)
    cx, cy = drifting(frame, x, y, x, y)
    return p + w * mx + 0.5 * cx, q + w * my + 0.5 * cy, w * (1.0 + frame.drift[2] * y) - 0.5 * (u * x + v * y)


@leaf
def bow_of(frame: np.void, bx: float, by: float) -> Bow:
    u, v = applied(frame, bx, by)
    x, y = applied(frame, by, -bx)  # T
    mx, my = spreading(frame, bx, by)
    return Bow(u * bx + v * by, u * by - v * bx, x * by - y * bx, mx * bx + my * by)


@leaf
def reach_over(slope: float, bend: float, height: float) -> float:
    """How long a ray rises from the surface until it is `height` above it, over `height`.

    It rises by slope s + 1/2 bend s^2 along s. With no curvature it is 1 / slope.
    """
    return 2.0 / (slope + math.sqrt(max(slope * slope + 2.0 * bend * height, 0.0)))


@leaf
def sink(
    bow: Bow, across: float, along: float, centre: float, b: Floats, w: Floats, count: int, height: Floats
) -> None:
    """Write the heights (count,) over the tangent plane of a cross-section's points (b, w), where rays meet them.

    The rays of one source through a line across the grooves fill a plane, in which t = across b + along h, with h the
    height; so h is the root of a quadratic. b is counted from `centre`.
    """
    second = 0.5 * bow.tt * along * along
    first = (bow.bt + bow.tt * across) * along
    fall = 0.5 * (bow.bb + (2.0 * bow.bt + bow.tt * across) * across)
    for i in range(count):
        x = b[i] - centre
        c, d = w[i] - fall * x * x, 1.0 + first * x
        if d <= 0.0:
            height[i] = c
            continue
        height[i] = 2.0 * c / (d + math.sqrt(max(d * d + 4.0 * second * c, 0.0)))
