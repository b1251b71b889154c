"""Shares of a footprint beside paths that bend within it: the mean of those of its slices, where they are straight.

A path leaves its tangent by curvature t^2 / 2. A slice's own tangent is left by that of the slice's length.
"""

from __future__ import annotations

from renderer.geometry.reach import Reach
from renderer.geometry.share import share
from renderer.geometry.view import View, on_plane
from renderer.kernel import fixed, leaf
from renderer.tables import Floats

SLICES = fixed(16)  # at most


@leaf
def slice_up(count: int, curvature: float, view: View, r: Reach, slices: Floats) -> None:
    """Fill `slices` (count, 6), equal parts of the screen's square, one after the other along the paths: so that its
    share before the path whose mean place is y along B from the footprint's centre is that of row[:3] - y row[3:].

    curvature: of all paths, positive towards B.
    """
    p0, q0 = on_plane(view, 1.0, 0.5)
    p1, q1 = on_plane(view, 0.5, 1.0)
    right = (p0 - view.p) * r.tx + (q0 - view.q) * r.ty
    down = (p1 - view.p) * r.tx + (q1 - view.q) * r.ty
    across = abs(right) >= abs(down)
    u, v = (1.0 / count, 1.0) if across else (1.0, 1.0 / count)
    around = ((right * u) ** 2 + (down * v) ** 2) / 3.0 - r.spread * r.spread
    for i in range(count):
        s, x, y = slices[i], i * u if across else 0.0, 0.0 if across else i * v
        p, q = on_plane(view, x + 0.5 * u, y + 0.5 * v)
        t = (p - view.p) * r.tx + (q - view.q) * r.ty
        ax, ay = -r.ty - curvature * t * r.tx, r.tx - curvature * t * r.ty  # B, turned
        at = 0.5 * curvature * (around - t * t) + ax * view.p + ay * view.q
        s[3], s[4], s[5] = view.wu * u, view.wv * v, view.w1 + view.wu * x + view.wv * y
        s[0], s[1] = (ax * view.pu + ay * view.qu) * u - at * s[3], (ax * view.pv + ay * view.qv) * v - at * s[4]
        s[2] = ax * (view.p1 + view.pu * x + view.pv * y) + ay * (view.q1 + view.qu * x + view.qv * y) - at * s[5]


@leaf
def along_bent(count: int, y: float, slices: Floats) -> float:
    """The share of the footprint before a path, of slices as `slice_up` has left them."""
    total = 0.0
    for i in range(count):
        s = slices[i]
        total += share(s[0] - y * s[3], s[1] - y * s[4], s[2] - y * s[5])
    return total / count
