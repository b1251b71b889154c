"""A footprint as its method sees it: the screen's square joined with the pattern plane by one projective map.

With the eye at D and a ray's direction v in pattern space, the ray meets the base plane in (D_p v_w - D_w v_p,
D_q v_w - D_w v_q) / v_w. A ray's direction is linear in the place (u, v) in the square, and so are both numerators
and the denominator: exact under perspective, with no matrix to invert (DESIGN 2.1).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.kernel import leaf
from renderer.shading import Vector, direction_to_pattern, has_picture, sky_from, unit
from renderer.tables import Camera, Lighting


class View(NamedTuple):
    """p = (pu u + pv v + p1) / (wu u + wv v + w1), q likewise, for (u, v) in [0, 1]^2; the denominator is negative."""

    pu: float
    pv: float
    p1: float
    qu: float
    qv: float
    q1: float
    wu: float
    wv: float
    w1: float
    p: float  # the centre's point on the base plane
    q: float


FINEST = 16  # places in a square, each way, at which a picture of the sky is looked at, at most
GRAZING = 0.2
"""A corner whose ray meets the plane at less than this part of the centre's slope is near the plane's horizon: the
map is then replaced by its tangent at the centre. It happens on curved objects alone, at their silhouettes."""


@leaf
def through_screen(camera: Camera, x: float, y: float) -> Vector:
    """The direction of the ray through the screen point (x, y), pixels, in the world; no unit vector."""
    c, r, d = camera.corner, camera.right, camera.down
    return c[0] + x * r[0] + y * d[0], c[1] + x * r[1] + y * d[1], c[2] + x * r[2] + y * d[2]


@leaf
def sky_behind(lighting: Lighting, camera: Camera, x: float, y: float, size: float) -> Vector:
    """The mean radiance of the sky in a square of the screen: where it is a picture, no texel is missed."""
    across, red, green, blue = 1, 0.0, 0.0, 0.0  # places in it, each way, at which the sky is looked at
    if has_picture(lighting):
        r, d = camera.right, camera.down
        right, down = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        wide = size * math.sqrt(max(right, down))
        finest = max(lighting.surroundings.tables[0, 1], lighting.surroundings.tables[0, 2] // 2)
        across = min(max(int(math.ceil(wide * finest / math.pi)), 2), FINEST)
    for k in range(across * across):
        u, v = (k % across + 0.5) / across, (k // across + 0.5) / across
        sky = sky_from(lighting, unit(through_screen(camera, x + size * u, y + size * v)))
        red, green, blue = red + sky[0], green + sky[1], blue + sky[2]
    places = across * across
    return red / places, green / places, blue / places


@leaf
def view_of(footprint: np.void, frame: np.void, camera: Camera) -> View:
    """The projective map of a footprint."""
    size = footprint.size
    x, y = footprint.x, footprint.y
    r, d = camera.right, camera.down
    v0 = direction_to_pattern(frame, through_screen(camera, x, y))
    vu = direction_to_pattern(frame, (size * r[0], size * r[1], size * r[2]))
    vv = direction_to_pattern(frame, (size * d[0], size * d[1], size * d[2]))
    dp, dq, dw = frame.eye[0], frame.eye[1], frame.eye[2]
    pu, pv, p1 = dp * vu[2] - dw * vu[0], dp * vv[2] - dw * vv[0], dp * v0[2] - dw * v0[0]
    qu, qv, q1 = dq * vu[2] - dw * vu[1], dq * vv[2] - dw * vv[1], dq * v0[2] - dw * v0[1]
    wu, wv, w1 = vu[2], vv[2], v0[2]
    middle = w1 + 0.5 * (wu + wv)
    p = (p1 + 0.5 * (pu + pv)) / middle
    q = (q1 + 0.5 * (qu + qv)) / middle
    least = w1 + max(wu, 0.0) + max(wv, 0.0)  # the corner nearest to the horizon
    if least > GRAZING * middle:
        pu, pv = (pu - p * wu) / middle, (pv - p * wv) / middle
        qu, qv = (qu - q * wu) / middle, (qv - q * wv) / middle
        p1, q1 = p - 0.5 * (pu + pv), q - 0.5 * (qu + qv)
        pu, pv, p1, qu, qv, q1 = -pu, -pv, -p1, -qu, -qv, -q1
        wu, wv, w1 = 0.0, 0.0, -1.0
    return View(pu, pv, p1, qu, qv, q1, wu, wv, w1, p, q)


@leaf
def on_plane(view: View, u: float, v: float) -> tuple[float, float]:
    """The point of the base plane that (u, v) shows."""
    w = view.wu * u + view.wv * v + view.w1
    return (view.pu * u + view.pv * v + view.p1) / w, (view.qu * u + view.qv * v + view.q1) / w


@leaf
def slope_at(x: float, y: float, frame: np.void, camera: Camera) -> float:
    """How fast the ray through the screen point (x, y) falls to the base plane: the direction's w, below 0."""
    return direction_to_pattern(frame, through_screen(camera, x, y))[2]


@leaf
def thinnest(view: View, part: float) -> float:
    """The least width, pattern units, of a square of this part of a view's sides, in its corners."""
    least = math.inf
    for k in range(4):
        u, v = float(k & 1), float(k >> 1)
        p0, q0 = on_plane(view, u, v)
        p1, q1 = on_plane(view, u + part * (1.0 - 2.0 * u), v)
        p2, q2 = on_plane(view, u, v + part * (1.0 - 2.0 * v))
        long = max(math.hypot(p1 - p0, q1 - q0), math.hypot(p2 - p0, q2 - q0))
        least = min(least, abs((p1 - p0) * (q2 - q0) - (p2 - p0) * (q1 - q0)) / long)
    return least
