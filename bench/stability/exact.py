"""A truth in double precision, for straight grooves that lie below the plane.

Each groove then removes a convex prism. A ray that enters one at the plane leaves it at a known place, where either
another groove goes on or the solid begins: from prism to prism the ray is followed with no mesh, no grid and no
tolerance but one of rounding. Nothing of the renderer is used but its random numbers, so that the very samples of
`csg` and `geometry` can be drawn.
"""

from __future__ import annotations

import math

import numpy as np

from bench.scenes import Floats
from bench.stability.scenes import WIDTH, Case, Setting, axes
from renderer.geometry.random import PLACE, drawn, jitter, seed_of
from renderer.kernel import kernel, leaf

ROUNDING = 1e-12  # of a groove width
STEPS = 100_000  # from groove to groove, at most


MANY = 100  # grooves in a footprint, from which on it sees all places of a period alike


def far(setting: Setting, case: Case) -> bool:
    """Whether a footprint holds so many periods, along B and along the crossings, that it stands for all places."""
    turns = sorted({family.angle for family in setting.families})
    across = case.footprint * WIDTH / setting.families[0].pitch
    return across >= MANY and (len(turns) == 1 or across * math.sin(turns[1] - turns[0]) >= MANY)


def truth(setting: Setting, pixels: tuple[int, int], samples: int, seed: int, whole_period: bool = False) -> Floats:
    """The mean radiance (H, W) of the pixels, from `samples` each, where `csg` takes them.

    whole_period: at least as many, a grid of a period of the grooves in place of the footprint, each along one of the
    pixel's rays: next to no noise, and off by about 1 / MANY^2 for a pixel's part of a period.
    """
    assert setting.families, "not all straight"
    angles = sorted({family.angle for family in setting.families})
    cell = np.zeros((2, 2))
    if whole_period:
        pitch = setting.families[0].pitch
        if len(angles) == 1:
            cell[0] = -pitch * math.sin(angles[0]), pitch * math.cos(angles[0])
        else:
            sine = math.sin(angles[1] - angles[0])
            for row, angle in enumerate(angles):  # along one family, from one groove of the other to the next
                cell[row] = pitch / sine * math.cos(angle), pitch / sine * math.sin(angle)
    camera = setting.scene["camera"]
    origin, forward, right, down = axes(camera, pixels)
    corner = forward - 0.5 * pixels[0] * right - 0.5 * pixels[1] * down
    rows = [
        (f.origin[0], f.origin[1], math.cos(f.angle), math.sin(f.angle), f.pitch, f.low, f.high)
        for f in setting.families
    ]
    points = np.array(setting.profile)
    columns = math.ceil(math.sqrt(samples)) if whole_period else samples
    out = np.zeros((pixels[1], pixels[0]))
    shoot(
        origin, corner, right, down, columns, math.ceil(samples / columns), seed, np.array(rows, float), points,
        np.array(setting.light), cell, out,
    )  # fmt: skip
    return out


@leaf
def march(
    families: Floats, points: Floats, x: float, y: float, w: float, dx: float, dy: float, dw: float,
    family: int, item: int, facet: int,
) -> tuple[float, int, int, int]:  # fmt: skip
    """How far a ray gets from (x, y, w), where it stands in the open, and what ends it: family, groove, facet.

    The arguments say on what it begins: -1 the plane. Infinite: it gets away, above the plane.
    """
    half = points[-1, 0]
    hair = ROUNDING * 2.0 * half
    t = 0.0
    for step in range(STEPS):
        best, bf, bk, bi = t, -1, -1, -1
        for f in range(len(families)):
            ox, oy, tx, ty, pitch = families[f, 0], families[f, 1], families[f, 2], families[f, 3], families[f, 4]
            b0, b1 = -(x - ox) * ty + (y - oy) * tx, -dx * ty + dy * tx
            b = b0 + t * b1
            low = max(math.ceil((b - half - hair) / pitch), families[f, 5])
            high = min(math.floor((b + half + hair) / pitch), families[f, 6])
            for k in range(int(low), int(high) + 1):
                enter, leave, last = -math.inf, math.inf, -1
                for i in range(len(points) - 1):
                    nb, nw = points[i, 1] - points[i + 1, 1], points[i + 1, 0] - points[i, 0]
                    size = math.hypot(nb, nw)
                    nb, nw = nb / size, nw / size
                    v0 = nb * (b0 - k * pitch - points[i, 0]) + nw * (w - points[i, 1])
                    v1 = nb * b1 + nw * dw
                    if step == 0 and f == family and k == item and i == facet:
                        v0 = 0.0  # it begins here, and faces the ray
                    if v1 < 0.0:
                        if -v0 / v1 < leave:
                            leave, last = -v0 / v1, i
                    elif v1 > 0.0:
                        enter = max(enter, -v0 / v1)
                    elif v0 < 0.0:
                        leave = -math.inf
                if enter <= t + hair and leave > best:
                    best, bf, bk, bi = leave, f, k, last
        if bf < 0:
            return t, family, item, facet
        t, family, item, facet = best, bf, bk, bi
        if math.isinf(t) or (dw > 0.0 and w + t * dw >= -hair):
            return math.inf, family, item, facet
    return math.nan, family, item, facet


@kernel
def shoot(
    origin: Floats, corner: Floats, right: Floats, down: Floats, columns: int, rows: int, seed: int,
    families: Floats, points: Floats, light: Floats, cell: Floats,
    out: Floats,
) -> None:  # fmt: skip
    """Fill `out` (H, W): white, matt, irradiance pi. cell: (2, 2) periods to sample in place of footprints, or 0."""
    whole_period = cell[0, 0] != 0.0 or cell[0, 1] != 0.0
    one_way = cell[1, 0] == 0.0 and cell[1, 1] == 0.0
    for py in range(out.shape[0]):
        for px in range(out.shape[1]):
            state = seed_of(seed, float(px), float(py))
            total = 0.0
            for i in range(columns * rows):
                if whole_period:  # its strata are those of the period
                    state, u = jitter(state)
                    state, v = jitter(state)
                else:
                    _, u, v = drawn(i, PLACE, seed, float(px), float(py))
                u, v = px + u, py + v
                dx = corner[0] + u * right[0] + v * down[0]
                dy = corner[1] + u * right[1] + v * down[1]
                dw = corner[2] + u * right[2] + v * down[2]
                length = math.sqrt(dx * dx + dy * dy + dw * dw)
                dx, dy, dw = dx / length, dy / length, dw / length
                s = -origin[2] / dw
                x, y = origin[0] + s * dx, origin[1] + s * dy
                if whole_period:
                    state, ju = jitter(state)
                    state, jv = jitter(state)
                    a, c = (i % columns + ju) / columns, (i // columns + jv) / rows
                    if one_way:
                        a = (i + ju) / (columns * rows)
                    x, y = a * cell[0, 0] + c * cell[1, 0], a * cell[0, 1] + c * cell[1, 1]
                t, family, item, facet = march(families, points, x, y, 0.0, dx, dy, dw, -1, -1, -1)
                if family < 0:
                    total += max(light[2], 0.0)
                    continue
                tx, ty = families[family, 2], families[family, 3]
                nb, nw = points[facet, 1] - points[facet + 1, 1], points[facet + 1, 0] - points[facet, 0]
                size = math.hypot(nb, nw)
                cosine = (-nb * ty * light[0] + nb * tx * light[1] + nw * light[2]) / size
                if cosine <= 0.0:
                    continue
                free, _, _, _ = march(
                    families, points, x + t * dx, y + t * dy, t * dw, light[0], light[1], light[2], family, item, facet
                )
                if math.isinf(free):
                    total += cosine
            out[py, px] = total / (columns * rows)
