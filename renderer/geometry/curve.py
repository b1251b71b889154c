"""A curved base to second order around a footprint (FRAME.form), as rays over it meet it.

In the frame of the tangent plane the point (p, q, w) of pattern space lies, with x = (p, q) from the frame's place,

- by 1/2 x.F x lower, where F is the form: the surface falls away from its tangent plane;
- by w M x farther out, where M = sigma^2 g^-1 F and g is the metric: heights go along normals, which spread.

What is left out is of third order, and how the pattern's scale and directions change along the surface.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import leaf
from renderer.shading import Vector, light_to_pattern
from renderer.tables import Floats, Pattern

BOWED = 0.03  # the error that is left, in parts of the angle by which the base turns within reach (measured)

BOWED_STRAIGHT = 0.1  # ... where rays are straight, in parts of what their slopes are changed by to make up for it
BOWED_LEAN = 0.5  # ... in parts of the slope of the highest and lowest points, as the size of grooves changes
ROUGH = 0.03  # ... that is left to rays which bend: next to the terminator straight light is wrong all over


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
def turned(frame: np.void, x: float, y: float, w: float, n: Vector) -> Vector:
    """A normal of pattern space at x and the height w, in the tangent frame, to first order."""
    u, v = applied(frame, x, y)
    mx, my = spreading(frame, x, y)
    m00, m10 = spreading(frame, 1.0, 0.0)
    m01, m11 = spreading(frame, 0.0, 1.0)
    return (
        n[0] - w * (m00 * n[0] + m10 * n[1]) + u * n[2],
        n[1] - w * (m01 * n[0] + m11 * n[1]) + v * n[2],
        n[2] - mx * n[0] - my * n[1],
    )


@leaf
def bent(frame: np.void, p: float, q: float, w: float) -> Vector:
    """Where in the tangent frame a point of pattern space lies."""
    x, y = p - frame.pq[0], q - frame.pq[1]
    u, v = applied(frame, x, y)
    mx, my = spreading(frame, x, y)
    return p + w * mx, q + w * my, w - 0.5 * (u * x + v * y)


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


@leaf
def eye_over(height: float, depth: float, width: float, frame: np.void) -> float:
    """How high over the plane the eye stands for straight rays to pass over the lowest and the highest points of the
    grooves where sight over a curved base does; the eye's own height where it is flat."""
    up = float(frame.eye[2])
    if not is_curved(frame) or up <= 0.0:
        return up
    x, y = (frame.eye[0] - frame.pq[0]) / up, (frame.eye[1] - frame.pq[1]) / up
    u, v = applied(frame, x, y)
    deep = depth
    far = math.hypot(x, y)
    if far * deep > 2.0 * width:  # the groove ends before
        deep = 2.0 * width / far
    return up * 0.5 * (1.0 + math.sqrt(max(1.0 + 2.0 * (u * x + v * y) * (height - deep), 0.0)))


@leaf
def sight_over(
    frame: np.void, p: float, q: float, gp: float, gq: float, high: float, low: float
) -> tuple[float, float, float, float]:
    """The straight line (place, slope) that is where a ray of sight over the plane's point (p, q) is at two heights
    over a curved base, `high` and `low`."""
    x, y = p - frame.pq[0], q - frame.pq[1]
    ux, uy = applied(frame, x, y)
    ug, vg = applied(frame, gp, gq)
    c, a, bend = 0.5 * (ux * x + uy * y), 1.0 + ux * gp + uy * gq, ug * gp + vg * gq
    if a <= 0.0:
        return p, q, gp, gq
    down_high = 2.0 * (c - high) / (a + math.sqrt(max(a * a - 2.0 * bend * (c - high), 0.0)))
    down_low = 2.0 * (c - low) / (a + math.sqrt(max(a * a - 2.0 * bend * (c - low), 0.0)))
    x0, y0, x1, y1 = x - down_high * gp, y - down_high * gq, x - down_low * gp, y - down_low * gq
    mx, my = spreading(frame, x0, y0)
    x0, y0 = x0 - high * mx, y0 - high * my
    mx, my = spreading(frame, x1, y1)
    x1, y1 = x1 - low * mx, y1 - low * my
    sp, sq = (x0 - x1) / (high - low), (y0 - y1) / (high - low)
    return frame.pq[0] + x1 - low * sp, frame.pq[1] + y1 - low * sq, sp, sq


@leaf
def light_over(
    height: float, width: float, frame: np.void, light: np.void, p: float, q: float, w: float, top: float
) -> tuple[float, float, float, float]:
    """The light as `light_to_pattern` says, but as high as it is for a straight ray from (p, q, w) that leaves the
    grooves where a ray over the curved base does.

    0: it is so low that the base keeps it from all up to the height `top`.
    """
    d = light_to_pattern(frame, light)
    if not is_curved(frame):
        return d
    x, y = d[0] - d[3] * p, d[1] - d[3] * q
    u, v = applied(frame, x, y)
    slope, bend = d[2] - d[3] * w + u * (p - frame.pq[0]) + v * (q - frame.pq[1]), u * x + v * y
    if height > 0.0 and slope < 0.0 and (bend <= 0.0 or slope * slope > 2.0 * bend * top):
        return d[0], d[1], 0.0, d[3]
    rise = max(height - w, 0.0)
    root = math.sqrt(max(slope * slope + 2.0 * bend * rise, 0.0))
    way = math.inf
    if slope + root > 0.0:
        way = 2.0 * rise / (slope + root)
    if height == 0.0:  # the groove ends before
        long = math.hypot(x, y)
        if long * way > 2.0 * width:
            way = 2.0 * width / long
    if not way < math.inf:
        return d
    return d[0], d[1], slope + 0.5 * bend * way + d[3] * w, d[3]


@leaf
def straightened(
    pattern: Pattern, frame: np.void, p: float, q: float, blocked: np.uint64, lights: NDArray[np.void]
) -> float:
    """About the error of straight rays, relative to white.

    It goes with the part by which `eye_over` and `light_over` change a slope of sight or light at (p, q), the most. Of
    grooves that rise and sink the changes for the two make up for one another, the errors do not. On spheres it goes
    with what is lost of the slope of the highest and lowest points, too.
    """
    most = abs(eye_over(pattern.height, pattern.depth, pattern.width, frame) / frame.eye[2] - 1.0)
    if pattern.height > 0.0:
        tall = eye_over(pattern.height + pattern.depth, 0.0, pattern.width, frame)
        most = max(most, abs(tall / frame.eye[2] - 1.0))
    for l in range(len(lights)):
        if (blocked >> np.uint64(l)) & np.uint64(1):
            continue
        d = light_over(pattern.height, pattern.width, frame, lights[l], p, q, -pattern.depth, pattern.height)
        own = light_to_pattern(frame, lights[l])[2]
        if d[2] > 0.0:
            most = max(most, abs(d[2] - own) / d[2])
    return max(BOWED_STRAIGHT * most, BOWED_LEAN * frame.lean * max(pattern.height, pattern.depth))
