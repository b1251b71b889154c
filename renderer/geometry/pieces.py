"""Local coordinates of a line or an arc, and the scale of its cross-section.

(s, b) are the arc length from the piece's start and the signed distance to the left of the path, pattern units.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import leaf
from renderer.tables import SCALE_CONSTANT, SCALE_LINEAR, SCALE_SINE

LEAST_SCALE = 1e-9  # a cross-section shrunk to a point keeps a direction


@leaf
def locate(piece: np.void, x: float, y: float) -> tuple[float, float]:
    """(s, b) of the point (x, y). On an arc s is taken round the circle from the arc's middle."""
    dx, dy = x - piece.x, y - piece.y
    if piece.curvature == 0.0:
        return dx * piece.tx + dy * piece.ty, dy * piece.tx - dx * piece.ty
    radius = 1.0 / piece.curvature  # signed, the centre lies at b = radius
    ux, uy = piece.ty * radius, -piece.tx * radius  # from the centre to the start point
    vx, vy = dx + ux, dy + uy
    distance = math.sqrt(vx * vx + vy * vy)
    turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)
    s = turn * radius
    half = math.pi * abs(radius)
    if s < 0.5 * piece.length - half:
        s += 2.0 * half
    elif s > 0.5 * piece.length + half:
        s -= 2.0 * half
    return s, radius - math.copysign(distance, radius)


@leaf
def tangent_at(piece: np.void, s: float) -> tuple[float, float]:
    """Unit tangent at arc length s."""
    if piece.curvature == 0.0:
        return piece.tx, piece.ty
    c, d = math.cos(s * piece.curvature), math.sin(s * piece.curvature)
    return piece.tx * c - piece.ty * d, piece.tx * d + piece.ty * c


@leaf
def point_at(piece: np.void, s: float) -> tuple[float, float]:
    """The path's point at arc length s."""
    if piece.curvature == 0.0:
        return piece.x + s * piece.tx, piece.y + s * piece.ty
    k = piece.curvature
    along, across = math.sin(s * k) / k, (1.0 - math.cos(s * k)) / k
    return piece.x + along * piece.tx - across * piece.ty, piece.y + along * piece.ty + across * piece.tx


@leaf
def is_beyond(piece: np.void, x: float, y: float, s: float, b: float, radius: float) -> bool:
    """Whether all of the piece's cross-sections lie farther than `radius` from the point (x, y), which is at (s, b)."""
    if (piece.curvature == 0.0 or piece.closed == 1 or 0.0 <= s <= piece.length) and abs(b) > radius + piece.half:
        return True
    if piece.closed == 1 or 0.0 <= s <= piece.length:
        return False
    mitre = max(abs(piece.start_mitre), abs(piece.finish_mitre))
    far = radius + piece.half * math.sqrt(max(1.0 + mitre * mitre, 2.0))
    ex, ey = point_at(piece, piece.length)
    return min(math.hypot(x - piece.x, y - piece.y), math.hypot(x - ex, y - ey)) > far


@leaf
def scale_at(scale_table: NDArray[np.float64], groove: np.void, piece: np.void, s: float) -> tuple[float, float]:
    """The scale of the cross-section at arc length s, placement included, and its derivative by s (1/pattern unit).

    Past the ends it keeps the end's value.
    """
    if groove.scale_kind == SCALE_CONSTANT:
        return groove.scale_a * piece.size, 0.0
    fraction = min(max(s / piece.length, 0.0), 1.0)
    rate = (piece.t1 - piece.t0) / piece.length if 0.0 < fraction < 1.0 else 0.0
    t = piece.t0 + (piece.t1 - piece.t0) * fraction
    if groove.scale_kind == SCALE_LINEAR:
        value = groove.scale_a + (groove.scale_b - groove.scale_a) * t
        slope = groove.scale_b - groove.scale_a
    elif groove.scale_kind == SCALE_SINE:
        turns = 2.0 * math.pi * groove.scale_b
        value = 1.0 + groove.scale_a * math.sin(turns * t + groove.scale_c)
        slope = groove.scale_a * turns * math.cos(turns * t + groove.scale_c)
    else:
        value, slope = interpolate(scale_table, groove.table_start, groove.table_count, t)
    return max(value, LEAST_SCALE) * piece.size, slope * rate * piece.size


@leaf
def row_before(table: NDArray[np.float64], start: int, count: int, t: float) -> int:
    """Of `count` rows (t, value) from row `start` on, the last but one at most, whose t is not above the given."""
    low, high = start, start + count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if table[middle, 0] <= t:
            low = middle
        else:
            high = middle
    return low


@leaf
def interpolate(table: NDArray[np.float64], start: int, count: int, t: float) -> tuple[float, float]:
    """Value and slope at t of the polyline through `count` rows (t, value) from row `start`."""
    row = row_before(table, start, count, t)
    slope = (table[row + 1, 1] - table[row, 1]) / (table[row + 1, 0] - table[row, 0])
    return table[row, 1] + slope * (t - table[row, 0]), slope
