"""What of a face is seen within a footprint, and what of that is lit: convex polygons of the footprint's square."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from renderer.geometry.faces import Faces
from renderer.geometry.polygon import CORNERS, Counts, area, enclose, overlap, subtract
from renderer.geometry.sight import Seen, hidden_by, is_over
from renderer.kernel import leaf
from renderer.tables import Floats

PARTS = 2048  # polygons that are left of one face
LEAST = 1e-12  # parts of a footprint as small as this are nothing


class Parts(NamedTuple):
    """Polygons of the footprint's square, 0 to 1; memory of one thread."""

    polygon: Floats  # (2, PARTS, CORNERS, 2) what is seen of a face, and what of that is lit
    corners: Counts  # (2, PARTS)
    planes: Floats  # (CORNERS, 3)
    one: Floats  # (CORNERS, 3)
    two: Floats
    box: Floats  # (4,) of what is seen of a face, pixels
    total: Floats  # (13,) what `area` has found, by its own names


@leaf
def parts_of() -> Parts:
    return Parts(
        np.empty((2, PARTS, CORNERS, 2)), np.empty((2, PARTS), np.int64), np.empty((CORNERS, 3)),
        np.empty((CORNERS, 3)), np.empty((CORNERS, 3)), np.empty(4), np.empty(13),
    )  # fmt: skip


@leaf
def hide(
    s: int, f: int, which: int, n: int, footprint: np.void, frame: np.void, faces: Faces, seen: Seen, parts: Parts
) -> int:
    """Take what source s does not see of face f out of the n polygons `parts.polygon[which]`: how many are left.

    Polygons are in the footprint's square, 0 to 1. Negative where there is no room.
    """
    for k in range(seen.heres[s]):
        i = seen.here[s, k]
        if not overlap(seen.cover[s, i], parts.box):
            continue
        count = hidden_by(seen.away[s, i], s, f, footprint, frame, faces, seen, parts.planes)
        if count < 0:
            return -1
        if count == 0:
            continue
        n = subtract(parts.polygon[which], parts.corners[which], n, parts.planes, count, LEAST, parts.one, parts.two)
        if n <= 0:
            break
    return n


@leaf
def show(f: int, footprint: np.void, faces: Faces, seen: Seen, parts: Parts) -> int:
    """Write what of face f lies within the footprint to parts.polygon[0, 0]: how many corners it has."""
    size = footprint.size
    x0, y0 = footprint.x, footprint.y
    if not is_over(seen.box[f], footprint):
        return 0
    # homogeneous, so that what lies behind the eye does no harm
    one, two = parts.one, parts.two
    count = faces.corners[f]
    for i in range(count):
        c = seen.corner[f, i]
        one[i, 0], one[i, 1], one[i, 2] = (c[0] - x0 * c[2]) / size, (c[1] - y0 * c[2]) / size, c[2]
    for side in range(4):
        made = 0
        u0, v0, w0 = one[count - 1, 0], one[count - 1, 1], one[count - 1, 2]
        d0 = u0 if side == 0 else v0 if side == 1 else w0 - u0 if side == 2 else w0 - v0
        for i in range(count):
            u1, v1, w1 = one[i, 0], one[i, 1], one[i, 2]
            d1 = u1 if side == 0 else v1 if side == 1 else w1 - u1 if side == 2 else w1 - v1
            if (d0 > 0.0 and d1 < 0.0) or (d0 < 0.0 and d1 > 0.0):
                t = d0 / (d0 - d1)
                two[made, 0], two[made, 1] = u0 + t * (u1 - u0), v0 + t * (v1 - v0)
                two[made, 2] = w0 + t * (w1 - w0)
                made += 1
            if d1 >= 0.0:
                two[made, 0], two[made, 1], two[made, 2] = u1, v1, w1
                made += 1
            u0, v0, w0, d0 = u1, v1, w1, d1
        if made < 3:
            return 0
        one, two = two, one
        count = made
    part = parts.polygon[0, 0]
    for i in range(count):
        if not one[i, 2] > 0.0:
            return 0
        part[i, 0], part[i, 1] = one[i, 0] / one[i, 2], one[i, 1] / one[i, 2]
    if area(part, count) < 0.0:  # the screen's y points down: let all run anticlockwise
        for i in range(count // 2):
            j = count - 1 - i
            for k in range(2):
                part[i, k], part[j, k] = part[j, k], part[i, k]
    box = parts.box
    enclose(part, count, box)
    for k in range(4):
        box[k] = (x0 if k & 1 == 0 else y0) + size * box[k]
    return count


@leaf
def light_up(
    light: int, f: int, n: int, footprint: np.void, frame: np.void, faces: Faces, seen: Seen, parts: Parts
) -> tuple[int, int]:
    """Which of `parts.polygon` has what a light reaches of the n polygons `parts.polygon[0]` of face f, and how many
    they are. Negative where there is no room."""
    if seen.heres[light] == 0:
        return 0, n
    for i in range(n):
        for j in range(parts.corners[0, i]):
            parts.polygon[1, i, j, 0] = parts.polygon[0, i, j, 0]
            parts.polygon[1, i, j, 1] = parts.polygon[0, i, j, 1]
        parts.corners[1, i] = parts.corners[0, i]
    return 1, hide(light, f, 1, n, footprint, frame, faces, seen, parts)
