"""The colour of a part of a face: what it sends to the eye on the mean."""

from __future__ import annotations

import numpy as np

from renderer.geometry.faces import Faces
from renderer.geometry.query import Nearby
from renderer.geometry.sight import Seen, colour_at
from renderer.kernel import leaf
from renderer.tables import Floats, Lighting, Pattern

EVEN = 0.5  # one colour for all of a part loses f'' h^2 / 24, about a tenth of this part of the tolerance
FINER = 4  # parts of a triangle's side, where a colour changes much


@leaf
def colour_over(
    f: int, light: int, part: Floats, corners: int, total: float, even: float, most: float, footprint: np.void,
    pattern: Pattern, frame: np.void, lighting: Lighting, material: np.void, albedo: Floats, bent: bool, found: Nearby,
    faces: Faces, seen: Seen,
) -> tuple[float, float, float, float]:  # fmt: skip
    """The radiance that a part of face f sends to the eye, times the part's share `total` of the footprint, and about
    how wrong it is, mean of the channels: of one light; of sky and glow.

    part: (corners, 2) a convex polygon of the footprint's square, anticlockwise. One place stands for parts no longer
    than `even`. Else each triangle about the middle is integrated from the middles of its edges, exactly for quadratic
    functions. What they differ from the middle's colour, in parts of it, is about how wrong they are in parts of that.
    Where this is more than `most` the triangles are divided.
    """
    mx, my = centroid(part, corners, total)
    long = 0.0
    for j in range(corners):
        long = max(long, abs(part[j, 0] - mx), abs(part[j, 1] - my))
    last = corners - 1
    before = doubled(part, last, 0, mx, my)
    red = green = blue = one = 0.0
    for k in range(1 if 2.0 * long <= even else 1 + 2 * corners):
        x, y, share = mx, my, total
        if k > 0:
            j = (k - 1) >> 1
            i = j + 1 if j < last else 0
            after = doubled(part, j, i, mx, my)
            if k & 1:
                x, y, share = 0.5 * (mx + part[j, 0]), 0.5 * (my + part[j, 1]), (before + after) / 6.0
            else:
                x, y, share = 0.5 * (part[j, 0] + part[i, 0]), 0.5 * (part[j, 1] + part[i, 1]), after / 6.0
                before = after
        x, y = footprint.x + footprint.size * x, footprint.y + footprint.size * y
        r, g, b = colour_at(f, light, x, y, pattern, frame, lighting, material, albedo, bent, found, faces, seen)
        if k == 1:
            one = red + green + blue
            red = green = blue = 0.0
        red, green, blue = red + share * r, green + share * g, blue + share * b
    off = doubt(one, red + green + blue) if 2.0 * long > even else 0.0
    if off > most:
        one = red + green + blue
        red, green, blue = finely(
            f, light, part, corners, mx, my, footprint, pattern, frame, lighting, material, albedo, bent, found, faces,
            seen,
        )  # fmt: skip
        off = doubt(one, red + green + blue)
    return red, green, blue, off


@leaf
def doubt(rough: float, fine: float) -> float:
    """About how wrong the finer of two sums over the channels is, mean of the channels; rounding is no difference."""
    apart, most = abs(fine - rough), max(fine, rough)
    return apart * apart / (3.0 * most) if apart > 1e-9 * most else 0.0


@leaf
def finely(
    f: int, light: int, part: Floats, corners: int, mx: float, my: float, footprint: np.void, pattern: Pattern,
    frame: np.void, lighting: Lighting, material: np.void, albedo: Floats, bent: bool, found: Nearby, faces: Faces,
    seen: Seen,
) -> tuple[float, float, float]:  # fmt: skip
    """As `colour_over`, from triangles a FINER-th as large each way."""
    red = green = blue = 0.0
    for j in range(corners):
        i = j + 1 if j + 1 < corners else 0
        ax, ay, bx, by = part[j, 0] - mx, part[j, 1] - my, part[i, 0] - mx, part[i, 1] - my
        share = (ax * by - bx * ay) / (6.0 * FINER * FINER)
        for k in range(3 * FINER * FINER):
            row, column, edge = k // (3 * FINER), k // 3 % FINER, k % 3
            u, v = float(row), float(column)  # the triangle's corner, and the ways to the others
            way = 1.0
            if row + column >= FINER:  # those that stand on their heads fill the other half of the square
                u, v, way = FINER - u, FINER - v, -1.0
            u, v = (u + (0.5 * way if edge != 1 else 0.0)) / FINER, (v + (0.5 * way if edge != 0 else 0.0)) / FINER
            x, y = mx + u * ax + v * bx, my + u * ay + v * by
            x, y = footprint.x + footprint.size * x, footprint.y + footprint.size * y
            r, g, b = colour_at(f, light, x, y, pattern, frame, lighting, material, albedo, bent, found, faces, seen)
            red, green, blue = red + share * r, green + share * g, blue + share * b
    return red, green, blue


@leaf
def centroid(part: Floats, corners: int, total: float) -> tuple[float, float]:
    """Of a polygon with this area; a corner where it has next to none."""
    x0, y0 = part[0, 0], part[0, 1]
    x = y = 0.0
    for j in range(2, corners):
        ax, ay, bx, by = part[j - 1, 0] - x0, part[j - 1, 1] - y0, part[j, 0] - x0, part[j, 1] - y0
        twice = ax * by - bx * ay
        x, y = x + twice * (ax + bx), y + twice * (ay + by)
    return (x0 + x / (6.0 * total), y0 + y / (6.0 * total)) if total > 0.0 else (x0, y0)


@leaf
def doubled(part: Floats, j: int, i: int, x: float, y: float) -> float:
    """Twice the area of the triangle of corners j and i with (x, y)."""
    return (part[j, 0] - x) * (part[i, 1] - y) - (part[i, 0] - x) * (part[j, 1] - y)
