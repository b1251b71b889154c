"""Where centre lines cross: found once a set of paths, so that a footprint over a crossing is known at a glance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.pieces import locate
from renderer.kernel import kernel, leaf
from renderer.tables import Floats, Ints

JOINT = 1e-9  # pieces that meet within this part of their lengths from an end of both are joined, not crossing


@leaf
def meet_lines(a: np.void, b: np.void) -> tuple[int, float, float, float, float]:
    """How many points the two lines, drawn on for ever, share, and the point twice."""
    turn = a.tx * b.ty - a.ty * b.tx
    if abs(turn) < 1e-12:
        return 0, 0.0, 0.0, 0.0, 0.0
    s = ((b.x - a.x) * b.ty - (b.y - a.y) * b.tx) / turn
    x, y = a.x + s * a.tx, a.y + s * a.ty
    return 1, x, y, x, y


@leaf
def meet_line_circle(a: np.void, b: np.void) -> tuple[int, float, float, float, float]:
    """How many points line a shares with arc b, both drawn on, and the points."""
    r = 1.0 / b.curvature
    cx, cy = b.x - b.ty * r, b.y + b.tx * r
    s, away = (cx - a.x) * a.tx + (cy - a.y) * a.ty, (cy - a.y) * a.tx - (cx - a.x) * a.ty
    root = r * r - away * away
    if root < 0.0:
        return 0, 0.0, 0.0, 0.0, 0.0
    root = math.sqrt(root)
    return 2, a.x + (s - root) * a.tx, a.y + (s - root) * a.ty, a.x + (s + root) * a.tx, a.y + (s + root) * a.ty


@leaf
def meet_circles(a: np.void, b: np.void) -> tuple[int, float, float, float, float]:
    """How many points the circles of two arcs share, and the points; the same circle shares none."""
    ra, rb = 1.0 / a.curvature, 1.0 / b.curvature
    ax, ay, bx, by = a.x - a.ty * ra, a.y + a.tx * ra, b.x - b.ty * rb, b.y + b.tx * rb
    dx, dy = bx - ax, by - ay
    apart = math.hypot(dx, dy)
    if apart <= 1e-12 * abs(ra):
        return 0, 0.0, 0.0, 0.0, 0.0
    along = (apart * apart + ra * ra - rb * rb) / (2.0 * apart)
    root = ra * ra - along * along
    if root < 0.0:
        return 0, 0.0, 0.0, 0.0, 0.0
    root = math.sqrt(root)
    dx, dy = dx / apart, dy / apart
    x, y = ax + along * dx, ay + along * dy
    return 2, x - root * dy, y + root * dx, x + root * dy, y - root * dx


@leaf
def holds(piece: np.void, x: float, y: float) -> tuple[bool, bool]:
    """Whether a point of the piece's line or circle lies on the piece, and whether at one of its ends."""
    s, _ = locate(piece, x, y)
    slack = JOINT * piece.length
    whole = piece.curvature != 0.0 and piece.length * abs(piece.curvature) > 6.28
    return -slack <= s <= piece.length + slack or whole, not whole and (s < slack or s > piece.length - slack)


@kernel
def find_crossings(
    pieces: NDArray[np.void], low: Floats, cell: Floats, shape: Ints, first: Ints, items: Ints, most: int
) -> Floats:
    """The points (m, 2) at which pieces cross, cell by cell of their grid; none where there are more than `most`.

    pieces: PIECE. A joint of two pieces is no crossing.
    """
    points = np.empty((64, 2))
    count = 0
    for iy in range(shape[1]):
        for ix in range(shape[0]):
            c = iy * shape[0] + ix
            for i in range(first[c], first[c + 1]):
                for j in range(i + 1, first[c + 1]):
                    a, b = pieces[items[i]], pieces[items[j]]
                    if a.curvature == 0.0 and b.curvature == 0.0:
                        n, x0, y0, x1, y1 = meet_lines(a, b)
                    elif a.curvature == 0.0:
                        n, x0, y0, x1, y1 = meet_line_circle(a, b)
                    elif b.curvature == 0.0:
                        n, x0, y0, x1, y1 = meet_line_circle(b, a)
                    else:
                        n, x0, y0, x1, y1 = meet_circles(a, b)
                    for k in range(n):
                        x, y = (x0, y0) if k == 0 else (x1, y1)
                        if math.floor((x - low[0]) / cell[0]) != ix or math.floor((y - low[1]) / cell[1]) != iy:
                            continue  # another cell's
                        on_a, end_a = holds(a, x, y)
                        on_b, end_b = holds(b, x, y)
                        if not on_a or not on_b or (end_a and end_b):
                            continue
                        if count == most:
                            return np.empty((0, 2))
                        if count == len(points):
                            more = np.empty((2 * count, 2))
                            more[:count] = points
                            points = more
                        points[count, 0], points[count, 1] = x, y
                        count += 1
    return points[:count].copy()
