"""The surface of the local solid as convex faces: the envelope of the strips (DESIGN 1.2), and the walls at its steps.

Above a point of the plane the highest priority whose band holds it decides. Of its grooves the lowest internal facet
is the surface, as it removes all above it; where there is none the highest external facet, as all are added first.
What no band holds is the plane. So the part of a strip that is surface is the strip less other strips, or what of them
is lower or higher: convex regions again, as heights are linear.

The surface steps only where a vertical facet stands, a groove ends square, or a band or a removal ends beside
something else. Along each such line the heights on both sides are compared stretch by stretch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.domain import Domain
from renderer.geometry.polygon import CORNERS, Counts, edges, overlap, subtract
from renderer.geometry.regions import BANDS, REMOVALS, Regions
from renderer.geometry.spans import SIDE
from renderer.geometry.strips import Strips
from renderer.kernel import leaf
from renderer.tables import Floats

FACES = 16384
BESIDE = 256  # strips along one line
STOPS = 8192  # places along one line where something begins or ends
EDGE = 1e-12  # of a domain's size: edges no longer than this have no direction
FLAT_PLANE = -1  # the tag of the base plane's faces


class Faces(NamedTuple):
    """Convex faces of the solid's surface above one domain; memory of one thread."""

    made: Counts  # (1,)
    corner: Floats  # (FACES, CORNERS, 3) (p, q, w), anticlockwise from outside
    corners: Counts  # (FACES,) of each
    plane: Floats  # (FACES, 4) n, c: n . X + c = 0, positive outside
    box: Floats  # (FACES, 6) lowest and highest p, q, w
    tag: Counts  # (FACES, 4) place of the piece in `Nearby` (-1: the plane), facet, part, 1: a wall
    part: Floats  # (FACES, CORNERS, 2) scratch: what is left of a strip
    part_count: Counts  # (FACES,)
    beside: Floats  # (BESIDE, 4) of a strip along a line: from, to, its heights at the line's ends
    beside_tag: Counts  # (BESIDE, 5) strip, rank, internal, sides: 1 left, 2 right; its band
    stop: Floats  # (STOPS,)


@leaf
def faces_of() -> Faces:
    return Faces(
        np.zeros(1, np.int64), np.empty((FACES, CORNERS, 3)), np.empty(FACES, np.int64), np.empty((FACES, 4)),
        np.empty((FACES, 6)), np.empty((FACES, 4), np.int64), np.empty((FACES, CORNERS, 2)),
        np.empty(FACES, np.int64), np.empty((BESIDE, 4)), np.empty((BESIDE, 5), np.int64), np.empty(STOPS),
    )  # fmt: skip


@leaf
def envelope(strips: Strips, regions: Regions, domain: Domain, tall: float, faces: Faces) -> bool:
    """Fill `faces` with what of the strips and of the plane is surface. False where there is no room.

    tall: the height from the lowest to the highest point of the pattern.
    """
    n_strips = strips.made[0]
    size = max(domain.slab[0, 1] - domain.slab[0, 0], domain.slab[1, 1] - domain.slab[1, 0])
    short, least, tie = EDGE * size, 1e-15 * size * size, 1e-10 * tall
    faces.made[0] = 0
    for i in range(n_strips):
        strips.edges[i] = edges(strips.polygon[i], strips.corners[i], short, strips.edge[i])
    for i in range(-1, n_strips):
        polygon = faces.part[0]
        n = 1
        if i < 0:
            for k in range(domain.made[1]):
                polygon[k, 0], polygon[k, 1] = domain.outline[k, 0], domain.outline[k, 1]
            faces.part_count[0] = domain.made[1]
            for j in range(regions.made[BANDS]):
                n = subtract(
                    faces.part, faces.part_count, n, regions.edge[BANDS, j], regions.edges[BANDS, j], least,
                    strips.one, strips.two,
                )  # fmt: skip
                if n <= 0:
                    break
        else:
            for k in range(strips.corners[i]):
                polygon[k, 0], polygon[k, 1] = strips.polygon[i, k, 0], strips.polygon[i, k, 1]
            faces.part_count[0] = strips.corners[i]
            box, height, rank, inner = strips.box[i], strips.height[i], strips.tag[i, 3], strips.tag[i, 4]
            place, band = strips.tag[i, 0], strips.tag[i, 6]
            # what decides here whatever the heights
            for j in range(regions.made[BANDS]):
                if n <= 0 or regions.tag[BANDS, j, 1] <= rank or not overlap(regions.box[BANDS, j], box):
                    continue
                n = subtract(
                    faces.part, faces.part_count, n, regions.edge[BANDS, j], regions.edges[BANDS, j], least,
                    strips.one, strips.two,
                )  # fmt: skip
            for j in range(0 if inner else regions.made[REMOVALS]):
                tag = regions.tag[REMOVALS, j]
                if n <= 0 or tag[1] != rank or not overlap(regions.box[REMOVALS, j], box):
                    continue
                if tag[0] == place and (regions.apart[place] == 1 or tag[2] == band):
                    continue
                n = subtract(
                    faces.part, faces.part_count, n, regions.edge[REMOVALS, j], regions.edges[REMOVALS, j], least,
                    strips.one, strips.two,
                )  # fmt: skip
            for j in range(n_strips if n > 0 else 0):
                if j == i or not overlap(strips.box[j], box) or strips.tag[j, 3] != rank or strips.tag[j, 4] != inner:
                    continue
                if strips.tag[j, 0] == place and (regions.apart[place] == 1 or strips.tag[j, 6] == band):
                    continue  # they share edges alone
                k = strips.edges[j]
                if k < 3:
                    continue
                sign = 1.0 if inner else -1.0
                a = sign * (height[0] - strips.height[j, 0])
                b = sign * (height[1] - strips.height[j, 1])
                c = sign * (height[2] - strips.height[j, 2])
                most = low = a * strips.polygon[i, 0, 0] + b * strips.polygon[i, 0, 1] + c
                for m in range(1, strips.corners[i]):
                    d = a * strips.polygon[i, m, 0] + b * strips.polygon[i, m, 1] + c
                    most, low = max(most, d), min(low, d)
                if most <= tie and low >= -tie:  # the same facet twice
                    if j > i:
                        continue
                elif most <= 0.0:
                    continue
                elif low < 0.0:
                    strips.edge[j, k, 0], strips.edge[j, k, 1], strips.edge[j, k, 2] = a, b, c
                    k += 1
                n = subtract(faces.part, faces.part_count, n, strips.edge[j], k, least, strips.one, strips.two)
                if n <= 0:
                    break
        if n < 0:
            return False
        for m in range(n):
            at = faces.made[0]
            if at == FACES:
                return False
            h0, h1, h2 = 0.0, 0.0, 0.0
            if i >= 0:
                h0, h1, h2 = strips.height[i, 0], strips.height[i, 1], strips.height[i, 2]
            for k in range(faces.part_count[m]):
                p, q = faces.part[m, k, 0], faces.part[m, k, 1]
                faces.corner[at, k, 0], faces.corner[at, k, 1] = p, q
                faces.corner[at, k, 2] = h0 * p + h1 * q + h2
            faces.corners[at] = faces.part_count[m]
            faces.plane[at, 0], faces.plane[at, 1], faces.plane[at, 2], faces.plane[at, 3] = -h0, -h1, 1.0, -h2
            for k in range(3):
                faces.tag[at, k] = strips.tag[i, k] if i >= 0 else FLAT_PLANE
            if faces.tag[at, 1] < 0:
                faces.tag[at, 0] = FLAT_PLANE
            faces.tag[at, 3] = 0
            bound(faces, at)
            faces.made[0] = at + 1
    room = True
    for i in range(strips.made[2]):
        room = room and raise_wall(strips, i, 1e-9 * size, tie, faces)
    return room


@leaf
def bound(faces: Faces, at: int) -> None:
    box = faces.box[at]
    for k in range(3):
        box[k], box[3 + k] = math.inf, -math.inf
        for j in range(faces.corners[at]):
            box[k], box[3 + k] = min(box[k], faces.corner[at, j, k]), max(box[3 + k], faces.corner[at, j, k])


@leaf
def stand(
    faces: Faces, x0: float, y0: float, x1: float, y1: float, a: float, b: float,
    low_a: float, low_b: float, high_a: float, high_b: float, to_right: bool, found: int, facet: int, part: int,
) -> bool:  # fmt: skip
    """Add a wall that stands on the line from (x0, y0), 0, to (x1, y1), 1, between a and b, from the one heights there
    to the others. False where there is no room.

    to_right: whether its outside is to the right of the line.
    """
    at = faces.made[0]
    if at == FACES:
        return False
    long = math.hypot(x1 - x0, y1 - y0)
    dx, dy = (x1 - x0) / long, (y1 - y0) / long
    ax, ay, bx, by = x0 + a * (x1 - x0), y0 + a * (y1 - y0), x0 + b * (x1 - x0), y0 + b * (y1 - y0)
    if not to_right:
        ax, ay, bx, by = bx, by, ax, ay
        low_a, low_b, high_a, high_b = low_b, low_a, high_b, high_a
    corner = faces.corner[at]
    corner[0, 0], corner[0, 1], corner[0, 2] = ax, ay, low_a
    corner[1, 0], corner[1, 1], corner[1, 2] = bx, by, low_b
    corner[2, 0], corner[2, 1], corner[2, 2] = bx, by, high_b
    corner[3, 0], corner[3, 1], corner[3, 2] = ax, ay, high_a
    faces.corners[at] = 4
    sign = 1.0 if to_right else -1.0
    faces.plane[at, 0], faces.plane[at, 1], faces.plane[at, 2] = sign * dy, -sign * dx, 0.0
    faces.plane[at, 3] = -sign * (dy * x0 - dx * y0)
    faces.tag[at, 0], faces.tag[at, 1], faces.tag[at, 2], faces.tag[at, 3] = found, facet, part, 1
    bound(faces, at)
    faces.made[0] = at + 1
    return True


@leaf
def within(
    edge: Floats, count: int, x0: float, y0: float, x1: float, y1: float, near: float
) -> tuple[float, float, int]:  # fmt: skip
    """From where to where, 0 to 1, the line from (x0, y0) to (x1, y1) runs in the polygon of these half-planes, of unit
    length, or along its edge; and on which side of the line the polygon lies: 1 left, 2 right, 3 both."""
    low, high, sides = 0.0, 1.0, 3
    for i in range(count):
        a, b, c = edge[i, 0], edge[i, 1], edge[i, 2]
        d0, d1 = a * x0 + b * y0 + c, a * x1 + b * y1 + c
        if d0 >= 0.0 and d1 >= 0.0 and (d0 > near or d1 > near):
            continue
        if abs(d0) <= near and abs(d1) <= near:
            if sides == 3:
                sides = 1 if b * (x1 - x0) - a * (y1 - y0) > 0.0 else 2
        elif d0 <= near and d1 <= near:
            return 0.0, -1.0, sides
        elif d0 < 0.0:
            low = max(low, d0 / (d0 - d1))
        elif d1 < 0.0:
            high = min(high, d0 / (d0 - d1))
    return low, high, sides


@leaf
def top_at(faces: Faces, n: int, t: float, side: int) -> int:
    """Which of the n strips along a line is the surface at t on one side of it; -1: the plane."""
    best, best_rank, best_inner, best_height = -1, np.int64(-1), np.int64(0), 0.0
    for k in range(n):
        if not faces.beside[k, 0] <= t <= faces.beside[k, 1] or faces.beside_tag[k, 3] & side == 0:
            continue
        rank, inner = faces.beside_tag[k, 1], faces.beside_tag[k, 2]
        height = faces.beside[k, 2] + t * (faces.beside[k, 3] - faces.beside[k, 2])
        better = rank > best_rank or (rank == best_rank and inner > best_inner)
        if rank == best_rank and inner == best_inner:
            better = height < best_height if inner else height > best_height
        if better:
            best, best_rank, best_inner, best_height = k, rank, inner, height
    return best


@leaf
def is_calm(faces: Faces, n: int, band: int, tie: float) -> bool:
    """Whether none of the n strips along a line leaves a step there, where the facets of this band, whose profile is
    continuous, meet one another or the plane.

    What another groove removes ends there without one if it is no higher than the profile, as then it decides on both
    sides; and so does what it adds, or at the profile's outer edge if it is no lower.
    """
    own_sides, inner, outer, rank = np.int64(0), False, False, np.int64(0)
    h0 = h1 = 0.0
    for k in range(n):
        if faces.beside_tag[k, 4] == band:
            if faces.beside_tag[k, 3] & own_sides != 0:
                return False
            own_sides |= faces.beside_tag[k, 3]
            rank, h0, h1 = faces.beside_tag[k, 1], faces.beside[k, 2], faces.beside[k, 3]
            inner, outer = inner or faces.beside_tag[k, 2] == 1, outer or faces.beside_tag[k, 2] == 0
    if own_sides == 0:
        return False
    if own_sides != 3 and (abs(h0) > tie or abs(h1) > tie):
        return False
    for k in range(n):
        if faces.beside_tag[k, 4] == band:
            continue
        if faces.beside_tag[k, 1] != rank or faces.beside_tag[k, 3] != 3:
            return False
        g0, g1 = faces.beside[k, 2] - h0, faces.beside[k, 3] - h1
        at_low, at_high = g0 + faces.beside[k, 0] * (g1 - g0), g0 + faces.beside[k, 1] * (g1 - g0)
        low, high = min(at_low, at_high), max(at_low, at_high)
        removes = faces.beside_tag[k, 2] == 1
        if own_sides == 3 and inner and outer:
            calm = high <= tie
        elif inner:
            calm = removes and high <= tie
        else:
            calm = removes or low >= -tie
        if not calm:
            return False
    return True


@leaf
def raise_wall(strips: Strips, wall: int, near: float, tie: float, faces: Faces) -> bool:
    """Add what stands along one of the lines `strips.wall`. False where there is no room."""
    x0, y0, x1, y1 = strips.wall[wall, 0], strips.wall[wall, 1], strips.wall[wall, 2], strips.wall[wall, 3]
    long = math.hypot(x1 - x0, y1 - y0)
    dx, dy = (x1 - x0) / long, (y1 - y0) / long
    n, stops = 0, 2
    faces.stop[0], faces.stop[1] = 0.0, 1.0
    for i in range(strips.made[0]):
        box = strips.box[i]
        if max(x0, x1) < box[0] - near or min(x0, x1) > box[2] + near:
            continue
        if max(y0, y1) < box[1] - near or min(y0, y1) > box[3] + near:
            continue
        low, high, sides = within(strips.edge[i], strips.edges[i], x0, y0, x1, y1, near)
        if (high - low) * long <= near:
            continue
        if n == BESIDE or stops + 2 > STOPS:
            return False
        faces.beside[n, 0], faces.beside[n, 1] = low, high
        height = strips.height[i]
        faces.beside[n, 2] = height[0] * x0 + height[1] * y0 + height[2]
        faces.beside[n, 3] = height[0] * x1 + height[1] * y1 + height[2]
        faces.beside_tag[n, 0], faces.beside_tag[n, 1], faces.beside_tag[n, 2] = i, strips.tag[i, 3], strips.tag[i, 4]
        faces.beside_tag[n, 3], faces.beside_tag[n, 4] = sides, strips.tag[i, 6]
        faces.stop[stops], faces.stop[stops + 1] = low, high
        stops += 2
        n += 1
    if strips.wall_tag[wall, 1] == SIDE and is_calm(faces, n, strips.wall_tag[wall, 3], tie):
        return True
    for i in range(n):
        for j in range(-1, i):
            g0, g1 = faces.beside[i, 2], faces.beside[i, 3]
            if j >= 0:
                g0, g1 = g0 - faces.beside[j, 2], g1 - faces.beside[j, 3]
            if (g0 > tie and g1 < -tie) or (g0 < -tie and g1 > tie):
                if stops == STOPS:
                    return False
                faces.stop[stops] = g0 / (g0 - g1)
                stops += 1
    walls = 0  # earlier ones along the same line
    for i in range(wall):
        a0 = (strips.wall[i, 0] - x0) * dy - (strips.wall[i, 1] - y0) * dx
        a1 = (strips.wall[i, 2] - x0) * dy - (strips.wall[i, 3] - y0) * dx
        if abs(a0) <= near and abs(a1) <= near:
            t0 = ((strips.wall[i, 0] - x0) * dx + (strips.wall[i, 1] - y0) * dy) / long
            t1 = ((strips.wall[i, 2] - x0) * dx + (strips.wall[i, 3] - y0) * dy) / long
            if n + walls == BESIDE or stops + 2 > STOPS:
                return False
            faces.beside[n + walls, 0], faces.beside[n + walls, 1] = min(t0, t1), max(t0, t1)
            faces.stop[stops], faces.stop[stops + 1] = min(max(t0, 0.0), 1.0), min(max(t1, 0.0), 1.0)
            stops += 2
            walls += 1
    for k in range(1, stops):
        for i in range(k, 0, -1):
            if faces.stop[i - 1] <= faces.stop[i]:
                break
            faces.stop[i - 1], faces.stop[i] = faces.stop[i], faces.stop[i - 1]
    for k in range(stops - 1):
        a, b = faces.stop[k], faces.stop[k + 1]
        if (b - a) * long <= near:
            continue
        t = 0.5 * (a + b)
        taken = False
        for i in range(n, n + walls):
            taken = taken or faces.beside[i, 0] < t < faces.beside[i, 1]
        if taken:
            continue
        left, right = top_at(faces, n, t, 1), top_at(faces, n, t, 2)
        if left == right:
            continue
        la = lb = ra = rb = 0.0
        if left >= 0:
            la = faces.beside[left, 2] + a * (faces.beside[left, 3] - faces.beside[left, 2])
            lb = faces.beside[left, 2] + b * (faces.beside[left, 3] - faces.beside[left, 2])
        if right >= 0:
            ra = faces.beside[right, 2] + a * (faces.beside[right, 3] - faces.beside[right, 2])
            rb = faces.beside[right, 2] + b * (faces.beside[right, 3] - faces.beside[right, 2])
        if abs(la - ra) <= tie and abs(lb - rb) <= tie:
            continue
        if not stand(
            faces, x0, y0, x1, y1, a, b, min(la, ra), min(lb, rb), max(la, ra), max(lb, rb), la + lb > ra + rb,
            strips.wall_tag[wall, 0], strips.wall_tag[wall, 1], strips.wall_tag[wall, 2],
        ):  # fmt: skip
            return False
    return True
