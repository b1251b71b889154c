"""Straight rays that stand for those over a curved base, which are bent in pattern space (`curve`)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import applied, drifting, is_curved, spreading, unsure
from renderer.geometry.view import View, on_plane
from renderer.kernel import leaf
from renderer.shading import light_to_pattern
from renderer.tables import Floats, Pattern

THIRD = 0.05  # the error that is left, in parts of the cube of the angle by which a groove's depth turns the base
AGAIN = 3.0  # ... by this times that angle more than by what a second look changes
LOW_LIGHT = 0.004  # ... in parts of how much the lowest light bends (all three measured)
ACROSS, DRIFTED, LINED = 2.0, 0.25, 0.05  # of a cross-section: of `unsure`, of the change of scale, of that light


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
    top, bottom = high * (1.0 + frame.drift[2] * (y + high * gq)), low * (1.0 + frame.drift[2] * (y + low * gq))
    down_high = 2.0 * (c - top) / (a + math.sqrt(max(a * a - 2.0 * bend * (c - top), 0.0)))
    down_low = 2.0 * (c - bottom) / (a + math.sqrt(max(a * a - 2.0 * bend * (c - bottom), 0.0)))
    x0, y0, x1, y1 = x - down_high * gp, y - down_high * gq, x - down_low * gp, y - down_low * gq
    mx, my = spreading(frame, x0, y0)
    cx, cy = drifting(frame, x0, y0, x0, y0)
    x0, y0 = x0 - high * mx - 0.5 * cx, y0 - high * my - 0.5 * cy
    mx, my = spreading(frame, x1, y1)
    cx, cy = drifting(frame, x1, y1, x1, y1)
    x1, y1 = x1 - low * mx - 0.5 * cx, y1 - low * my - 0.5 * cy
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
def straighten(pattern: Pattern, frame: np.void, view: View, lights: NDArray[np.void], source: Floats) -> None:
    """Write to `source` (lights + 1, 4) where straight rays come from, the eye last, that do as those over a curved
    base where these pass all of the grooves."""
    eye = source[len(lights)]
    eye[0], eye[1], eye[3] = frame.eye[0], frame.eye[1], 1.0
    eye[2] = eye_over(pattern.height, pattern.depth, pattern.width, frame)
    for l in range(len(lights)):
        d = light_over(pattern.height, pattern.width, frame, lights[l], view.p, view.q, -pattern.depth, pattern.height)
        source[l, 0], source[l, 1], source[l, 2], source[l, 3] = d[0], d[1], d[2], d[3]


@leaf
def straighten_between(
    low: float, high: float, top: float, p: float, q: float, across: float, pattern: Pattern, frame: np.void,
    view: View, lights: NDArray[np.void], source: Floats,
) -> View:  # fmt: skip
    """As `straighten`, where these pass from `high` to `low` about the plane's point (p, q), and light from there to
    `top`. Gives the view through which such sight goes.

    A bundle of rays over a curved base has no one eye: from beside that place it is right `across` (an angle) alone.
    """
    eye = source[len(lights)]
    up = float(frame.eye[2])
    gp, gq = (frame.eye[0] - p) / up, (frame.eye[1] - q) / up
    step = 1e-3 * (pattern.height + pattern.depth)
    high = max(high, low + step)
    p0, q0, sp, sq = sight_over(frame, p, q, gp, gq, high, low)
    bx, by = math.cos(across), math.sin(across)
    p1, q1, rp, rq = sight_over(
        frame, p + step * bx, q + step * by, gp - step * bx / up, gq - step * by / up, high, low
    )
    kp, kq = (p1 - p0) / step - bx, (q1 - q0) / step - by
    wide = (p1 - p0) * bx + (q1 - q0) * by
    near = ((sp - rp) * bx + (sq - rq) * by) / wide if wide > 0.0 else 1.0 / up
    up = 1.0 / max(near, 1e-3 / up)
    eye[0], eye[1], eye[2], eye[3] = p0 + up * sp, q0 + up * sq, up, 1.0
    for l in range(len(lights)):
        d = light_over(top, pattern.width, frame, lights[l], p0 + low * sp, q0 + low * sq, low, top)
        source[l, 0], source[l, 1], source[l, 2], source[l, 3] = d[0], d[1], d[2], d[3]
    # p + d + k (b . (p - at)), with numerators and denominators
    dp, dq = p0 - p - kp * (bx * p + by * q), q0 - q - kq * (bx * p + by * q)
    bu, bv, b1 = bx * view.pu + by * view.qu, bx * view.pv + by * view.qv, bx * view.p1 + by * view.q1
    return View(
        view.pu + dp * view.wu + kp * bu, view.pv + dp * view.wv + kp * bv, view.p1 + dp * view.w1 + kp * b1,
        view.qu + dq * view.wu + kq * bu, view.qv + dq * view.wv + kq * bv, view.q1 + dq * view.w1 + kq * b1,
        view.wu, view.wv, view.w1, p0, q0,
    )  # fmt: skip


@leaf
def straightened(
    pattern: Pattern, frame: np.void, p: float, q: float, blocked: np.uint64, lights: NDArray[np.void]
) -> float:
    """The part by which `eye_over` and `light_over` change a slope of sight or light at (p, q), the most.

    Of grooves that rise and sink the changes for the two make up for one another, the errors do not.
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
    return most


@leaf
def bends_of(frame: np.void, view: View, deep: float, blocked: np.uint64, lights: NDArray[np.void]) -> float:
    """How much the light that bends most does so within grooves so `deep`: k deep / slope^2, with k the curvature along
    its way. Where it is too low to come in at all there is none to bend.

    It is large next to the terminator, where light from under the tangent plane runs along grooves from beyond it.
    """
    most = 0.0
    for l in range(len(lights)):
        if (blocked >> np.uint64(l)) & np.uint64(1):
            continue
        d = light_to_pattern(frame, lights[l])
        x, y = d[0] - d[3] * view.p, d[1] - d[3] * view.q
        far = math.hypot(x, y)
        if far <= 1e-12 * abs(d[2]):
            continue
        x, y = x / far, y / far
        u, v = applied(frame, x, y)
        slope, bend = d[2] / far + u * (view.p - frame.pq[0]) + v * (view.q - frame.pq[1]), u * x + v * y
        if slope < 0.0 and slope * slope > 2.0 * max(bend, 0.0) * deep:
            continue
        most = max(most, abs(bend) * deep / max(slope * slope, 1e-300))
    return most


@leaf
def sag_of(frame: np.void, view: View, deep: float) -> float:
    """How far sight that passes through so `deep` is from its chord, in parts of the footprint along it."""
    x, y = frame.eye[0] - view.p, frame.eye[1] - view.q
    far = math.hypot(x, y)
    if far <= 1e-12 * frame.eye[2]:
        return 0.0
    x, y = x / far, y / far
    u, v = applied(frame, x, y)
    slope = frame.eye[2] / far
    p0, q0 = on_plane(view, 0.0, 0.5)
    p1, q1 = on_plane(view, 1.0, 0.5)
    p2, q2 = on_plane(view, 0.5, 0.0)
    p3, q3 = on_plane(view, 0.5, 1.0)
    long = abs((p1 - p0) * x + (q1 - q0) * y) + abs((p3 - p2) * x + (q3 - q2) * y)
    run = deep / slope
    return abs(u * x + v * y) * run * run / (8.0 * slope * max(long, 1e-300))


@leaf
def left_out(
    frame: np.void, view: View, low: float, high: float, top: float, apart: float, blocked: np.uint64,
    lights: NDArray[np.void],
) -> float:  # fmt: skip
    """About the error of straight rays that stand for bent ones, relative to white: what the second order leaves out of
    points so high over the surface or deep under it, and what rays between `low` and `high`, where all that is seen
    lies, and from there to `top`, where light comes in, bend by. apart: what a second look has changed."""
    f = frame.form
    turn = max(abs(f[0]), abs(f[1]), abs(f[2])) * max(-low, top)
    error = THIRD * turn * turn * turn + (1.0 + AGAIN * turn) * apart
    if high > low:
        error += sag_of(frame, view, high - low)
    if top > low:
        error += LOW_LIGHT * bends_of(frame, view, top - low, blocked, lights)
    return float(min(error, 1.0))


@leaf
def left_by_lines(
    frame: np.void, view: View, far: float, long: float, deep: float, blocked: np.uint64, lights: NDArray[np.void]
) -> float:  # fmt: skip
    """The same of a cross-section: what matters to it reaches so far across the grooves beyond a footprint, and so
    `long` along them; they are so `deep`."""
    drift = max(abs(frame.drift[0]), abs(frame.drift[1]), abs(frame.drift[2]))
    error = ACROSS * unsure(frame, far) + DRIFTED * drift * long
    return float(min(error + LINED * bends_of(frame, view, deep, blocked, lights), 1.0))
