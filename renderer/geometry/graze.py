"""Light from over one face of the local solid to another over a curved base, as a straight ray that does the same.

Rays bend in pattern space (`curve`): how much depends on where they run, which is known for two faces.
"""

from __future__ import annotations

import math

import numpy as np

from renderer.geometry.curve import applied, bent, drifting, spreading
from renderer.geometry.faces import Faces
from renderer.kernel import leaf
from renderer.tables import Floats


@leaf
def graze(frame: np.void, light: Floats, place: Floats, f: int, b: int, faces: Faces, out: Floats) -> None:
    """Write to `out` (4,) where a light stands (D_p, D_q, D_w, h) for straight rays that just pass over face b to land
    on face f where bent ones do.

    light: (4,) where it is. place: (3,) a point of face f. All is in the vertical plane through it and the light; there
    x is the way to the light from the place, w the height over it. A ray rises by slope s + 1/2 bend s^2. It passes
    over b at its point (x, w) that keeps most from the place, and lands s before, where f rises by `steep` x; next to
    the place, as where light grazes f it lands anywhere.
    """
    for k in range(4):
        out[k] = light[k]
    x0, y0 = place[0] - frame.pq[0], place[1] - frame.pq[1]
    px, py, up = light[0] - light[3] * place[0], light[1] - light[3] * place[1], light[2] - light[3] * place[2]
    far = math.hypot(px, py)
    if far <= 1e-12 * abs(up):
        return
    px, py = px / far, py / far
    u, v = applied(frame, px, py)
    slope, bend = up / far + u * x0 + v * y0, u * px + v * py
    most, x, w, aside, crossed = -math.inf, 0.0, 0.0, math.inf, False
    count = faces.corners[b]
    before = faces.corner[b, count - 1]
    t0 = (before[1] - place[1]) * px - (before[0] - place[0]) * py
    for i in range(count):
        after = faces.corner[b, i]
        t1 = (after[1] - place[1]) * px - (after[0] - place[0]) * py
        if (t0 < 0.0) != (t1 < 0.0):
            t = t0 / (t0 - t1)
            cx = (before[0] + t * (after[0] - before[0]) - place[0]) * px
            cx += (before[1] + t * (after[1] - before[1]) - place[1]) * py
            cw = before[2] + t * (after[2] - before[2]) - place[2]
            over = cw - (slope + 0.5 * bend * cx) * cx
            if over > most:
                most, x, w, crossed = over, cx, cw, True
        elif not crossed and abs(t1) < aside:  # beside the plane: the next to it
            aside, x, w = abs(t1), (after[0] - place[0]) * px + (after[1] - place[1]) * py, after[2] - place[2]
        before, t0 = after, t1
    plane = faces.plane[f]
    across, steep, s = plane[0] * px + plane[1] * py, 0.0, max(x, 0.0)
    sheer = abs(plane[2]) <= 1e-9 * abs(across)
    if not sheer:
        steep = -across / plane[2]
        first, rise = slope + bend * x - steep, w - steep * x
        square = first * first - 2.0 * bend * rise
        if first > 0.0 and square >= 0.0:
            s = min(max(2.0 * rise / (first + math.sqrt(square)), 0.0), 2.0 * s)
    d0 = d1 = d2 = 0.0
    for k in range(2):
        # from (x - s) to x straight in space is, between their middles, straight in pattern space so:
        middle, low = x - 0.5 * s, steep * (x - s) if not sheer else 0.0
        mx, my, mw = x0 + middle * px, y0 + middle * py, place[2] + 0.5 * (low + w)
        d0, d1, d2 = light[0], light[1], light[2]
        if light[3] > 0.0:
            lands = bent(frame, place[0] + (x - s) * px, place[1] + (x - s) * py, place[2] + low)
            d0, d1, d2 = d0 - lands[0], d1 - lands[1], d2 - lands[2]
        a0, a1 = applied(frame, d0, d1)
        s0, s1 = spreading(frame, mx, my)
        e0, e1 = spreading(frame, d0, d1)
        c0, c1 = drifting(frame, mx, my, d0, d1)
        d0, d1, d2 = (
            d0 - d2 * s0 - mw * e0 - c0,
            d1 - d2 * s1 - mw * e1 - c1,
            d2 + mx * a0 + my * a1 - frame.drift[2] * (mw * d1 + d2 * my),
        )
        rate = d2 / max(d0 * px + d1 * py, 1e-300)
        if k == 0 and not sheer and rate > steep:
            s = min(max((w - steep * x) / (rate - steep), 0.0), 2.0 * max(x, 0.0))
    out[0], out[1], out[2] = d0, d1, d2
    if light[3] > 0.0:
        left = 1.0 - s / max(far - x + s, 1e-300)
        out[0] = place[0] + x * px + left * d0
        out[1] = place[1] + x * py + left * d1
        out[2] = place[2] + w + left * d2
