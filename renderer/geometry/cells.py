"""The surface of the local solid as convex faces where grooves overhang: there it is no height field.

Of each strip of the plane a groove removes or adds what lies between two heights, linear in (p, q): a cell. Inside
the bands of the highest priority that holds a place, the solid is what is below the plane or in an added cell, and in
no removed one (DESIGN 1.2; schema.overhang). So the surface consists of parts of the cells' floors and roofs, of the
plane, and of walls; and what of a floor or a roof is no surface lies in other cells: convex regions, as in `faces`.

A removed cell's floor looks up and its roof down; there the groove's own solid stands on the other side, and what
other grooves remove is taken out. An added cell's roof looks up and its floor down; there what others add, and all that
is removed, is taken out. Where two such sides coincide, the first is the surface.

Along each line on which walls may stand the solid on both sides is compared, height by height.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.domain import Domain
from renderer.geometry.faces import EDGE, FACES, Faces, bound, stand, within
from renderer.geometry.pieces import locate, scale_at
from renderer.geometry.polygon import Counts, area, edges, subtract
from renderer.geometry.query import Nearby
from renderer.geometry.spans import (
    ADD,
    BAND,
    CAP_FINISH,
    CAP_START,
    NO,
    PLANE,
    REMOVE,
    TAIL_FINISH,
    TAIL_START,
    YES,
    upright,
)
from renderer.geometry.strips import STRIPS, Strips
from renderer.kernel import fixed, leaf
from renderer.tables import Floats, Pattern

CELLS = 2 * STRIPS
BESIDE = 256  # cells and bands along one line
LEVELS = 512  # heights along one line
STOPS = 4096  # places along one line where something begins or ends
NO_FACET = fixed(-1)
NO_CELL = fixed(-1)
LEFT, RIGHT = fixed(1), fixed(2)

STRIP, KIND, RANK, OPEN, FLOOR, ROOF = range(6)  # columns of Cells.tag


class Cells(NamedTuple):
    """What the strips remove and add; memory of one thread."""

    made: Counts  # (1,)
    tag: Counts  # (CELLS, 6) strip, ADD or REMOVE, rank, 1: it has no roof, the facets of floor and roof; NO_FACET:
    # it is no surface
    height: Floats  # (CELLS, 2, 3) floor and roof: w = h0 p + h1 q + h2
    cut: Floats  # (2, 3) half-planes of the heights
    beside: Floats  # (BESIDE, 6) of a cell or band along a line: from, to; floor and roof at the line's ends
    beside_tag: Counts  # (BESIDE, 3) BAND, ADD or REMOVE, rank, sides: 1 left, 2 right
    level: Floats  # (LEVELS, 2) heights at the line's ends
    level_of: Counts  # (LEVELS,) whose; -1: of all
    order: Counts  # (LEVELS,) from low to high
    stop: Floats  # (STOPS,)
    plane: Floats  # (3,) the height of the base plane
    whole: Floats  # (4,) a box that holds all


@leaf
def cells_of() -> Cells:
    return Cells(
        np.zeros(1, np.int64), np.empty((CELLS, 6), np.int64), np.empty((CELLS, 2, 3)), np.empty((2, 3)),
        np.empty((BESIDE, 6)), np.empty((BESIDE, 3), np.int64), np.empty((LEVELS, 2)), np.empty(LEVELS, np.int64),
        np.empty(LEVELS, np.int64), np.empty(STOPS), np.zeros(3), np.array([-math.inf, -math.inf, math.inf, math.inf]),
    )  # fmt: skip


@leaf
def put_cell(cells: Cells, strip: int, kind: int, rank: int, is_open: bool, floor_facet: int, roof_facet: int) -> int:
    """Add a cell, its heights nought: its row."""
    at = cells.made[0]
    tag = cells.tag[at]
    tag[STRIP], tag[KIND], tag[RANK], tag[OPEN] = strip, kind, rank, 1 if is_open else 0
    tag[FLOOR], tag[ROOF] = floor_facet, roof_facet
    for k in range(3):
        cells.height[at, 0, k] = cells.height[at, 1, k] = 0.0
    cells.made[0] = at + 1
    return int(at)


@leaf
def fill(pattern: Pattern, found: Nearby, strips: Strips, cells: Cells) -> None:
    """Make the cells of all strips."""
    cells.made[0] = 0
    for i in range(strips.made[0]):
        facet, rank, inner, row = strips.tag[i, 1], strips.tag[i, 3], strips.tag[i, 4] == 1, strips.tag[i, 5] - 1
        if row >= 0:
            profile = pattern.profiles[pattern.grooves[pattern.pieces[found.piece[strips.tag[i, 0]]].groove].profile]
            part = pattern.parts[row]
            kind = REMOVE if inner else ADD
            lower, upper = part.lower, part.upper
            if not inner:  # along internal facets all is removed on the other side, which then is the surface
                lower = NO_FACET if profile.inner_first <= lower < profile.inner_last else lower
                upper = NO_FACET if profile.inner_first <= upper < profile.inner_last else upper
            at = put_cell(cells, i, kind, rank, part.upper < 0, lower, upper)
            for k in range(3):
                cells.height[at, 0, k], cells.height[at, 1, k] = strips.height[i, k], strips.roof[i, k]
            continue
        if inner:
            at = put_cell(cells, i, REMOVE, rank, YES, facet, NO_FACET)
            for k in range(3):
                cells.height[at, 0, k] = strips.height[i, k]
        if facet >= 0:
            at = put_cell(cells, i, ADD, rank, NO, NO_FACET, NO_FACET if inner else facet)
            for k in range(3):
                cells.height[at, 1, k] = strips.height[i, k]


@leaf
def peel(
    polygon: Floats, count: int, box: Floats, height: Floats, kind: int, rank: int, up: bool, index: int,
    size: float, tall: float, strips: Strips, cells: Cells, faces: Faces,
) -> int:  # fmt: skip
    """Write what of a polygon at a height is surface to `faces.part`: how many parts. Negative where there is no room.

    up: it looks up. index: of its cell; NO_CELL: the plane, which counts as added. size: of the domain. tall: from the
    lowest to the highest point of the pattern.
    """
    short, least, tie = EDGE * size, 1e-15 * size * size, 1e-10 * tall
    planes = strips.sides
    if area(polygon, count) <= least:  # a sliver's edges have any direction, and would hide anything
        return 0
    for k in range(count):
        faces.part[0, k, 0], faces.part[0, k, 1] = polygon[k, 0], polygon[k, 1]
    faces.part_count[0] = count
    n = 1
    for j in range(strips.made[1]):
        if strips.band_rank[j] <= rank:
            continue
        k = edges(strips.band[j], strips.band_count[j], short, planes)
        if k >= 3:
            n = subtract(faces.part, faces.part_count, n, planes, k, least, strips.one, strips.two)
        if n <= 0:
            return n
    for j in range(cells.made[0]):
        tag = cells.tag[j]
        if j == index or tag[RANK] != rank or (kind == REMOVE and tag[KIND] == ADD):
            continue
        strip = tag[STRIP]
        other = strips.box[strip]
        if other[0] >= box[2] or other[2] <= box[0] or other[1] >= box[3] or other[3] <= box[1]:
            continue
        # What just touches the polygon from outside covers it, by which two cells in touch are one; and so does what
        # is removed where something added ends. Of two sides that coincide and look the same way one stays.
        strict = -1
        if tag[KIND] == kind:
            strict = 0 if (kind == REMOVE) == up else 1
        covers, cuts = True, 0
        for side in range(1 if tag[OPEN] == 1 else 2):
            sign = 1.0 if side == 0 else -1.0
            a = sign * (height[0] - cells.height[j, side, 0])
            b = sign * (height[1] - cells.height[j, side, 1])
            c = sign * (height[2] - cells.height[j, side, 2])
            most = low = a * polygon[0, 0] + b * polygon[0, 1] + c
            for m in range(1, count):
                d = a * polygon[m, 0] + b * polygon[m, 1] + c
                most, low = max(most, d), min(low, d)
            if most <= tie and low >= -tie:
                covers = covers and (side != strict or j < index)
            elif most <= 0.0:
                covers = False
            elif low < 0.0:
                cells.cut[cuts, 0], cells.cut[cuts, 1], cells.cut[cuts, 2] = a, b, c
                cuts += 1
        if not covers:
            continue
        k = edges(strips.polygon[strip], strips.corners[strip], short, planes)
        if k < 3:
            continue
        for i in range(cuts):
            for m in range(3):
                planes[k, m] = cells.cut[i, m]
            k += 1
        n = subtract(faces.part, faces.part_count, n, planes, k, least, strips.one, strips.two)
        if n <= 0:
            return n
    return n


@leaf
def put_faces(n: int, height: Floats, up: bool, found: int, facet: int, part: int, faces: Faces) -> bool:
    """Add the polygons `faces.part[:n]` at a height as faces. False where there is no room."""
    h0, h1, h2 = height[0], height[1], height[2]
    sign = 1.0 if up else -1.0
    for m in range(n):
        at = faces.made[0]
        if at == FACES:
            return False
        count = faces.part_count[m]
        for k in range(count):
            i = k if up else count - 1 - k
            p, q = faces.part[m, i, 0], faces.part[m, i, 1]
            faces.corner[at, k, 0], faces.corner[at, k, 1], faces.corner[at, k, 2] = p, q, h0 * p + h1 * q + h2
        faces.corners[at] = count
        faces.plane[at, 0], faces.plane[at, 1], faces.plane[at, 2] = -sign * h0, -sign * h1, sign
        faces.plane[at, 3] = -sign * h2
        faces.tag[at, 0], faces.tag[at, 1], faces.tag[at, 2], faces.tag[at, 3] = found, facet, part, 0
        bound(faces, at)
        faces.made[0] = at + 1
    return True


@leaf
def carve(
    pattern: Pattern, found: Nearby, strips: Strips, domain: Domain, cells: Cells, faces: Faces
) -> bool:  # fmt: skip
    """Fill `faces` with the surface of what the strips make of the plane. False where there is no room."""
    fill(pattern, found, strips, cells)
    size = max(domain.slab[0, 1] - domain.slab[0, 0], domain.slab[1, 1] - domain.slab[1, 0])
    tall = pattern.height + pattern.depth
    bands = strips.made[1]
    lowest = 0
    for j in range(bands):
        lowest = strips.band_rank[j] if j == 0 else min(lowest, strips.band_rank[j])
    faces.made[0] = 0

    # the plane: beside all bands and in those of the lowest priority; then in each other's, which come one by one
    for j in range(-1, bands):
        if j >= 0 and strips.band_rank[j] == lowest:
            continue
        outline, count, rank = domain.outline, domain.made[1], lowest
        if j >= 0:
            outline, count, rank = strips.band[j], strips.band_count[j], strips.band_rank[j]
        n = peel(outline, count, cells.whole, cells.plane, ADD, rank, YES, NO_CELL, size, tall, strips, cells, faces)
        for i in range(j):
            if n <= 0:
                break
            if strips.band_rank[i] == rank and rank != lowest:
                k = edges(strips.band[i], strips.band_count[i], EDGE * size, strips.sides)
                if k >= 3:
                    n = subtract(
                        faces.part, faces.part_count, n, strips.sides, k, 1e-15 * size * size, strips.one, strips.two
                    )
        if n < 0 or not put_faces(n, cells.plane, YES, PLANE, PLANE, PLANE, faces):
            return False

    for i in range(cells.made[0]):
        tag = cells.tag[i]
        strip = tag[STRIP]
        for side in range(2):
            facet = tag[FLOOR + side]
            if facet < 0:
                continue
            up = (tag[KIND] == REMOVE) == (side == 0)
            height = cells.height[i, side]
            n = peel(
                strips.polygon[strip], strips.corners[strip], strips.box[strip], height, tag[KIND], tag[RANK], up, i,
                size, tall, strips, cells, faces,
            )  # fmt: skip
            if n < 0 or not put_faces(n, height, up, strips.tag[strip, 0], facet, strips.tag[strip, 2], faces):
                return False
    room = True
    for i in range(strips.made[2]):
        room = room and raise_walls(pattern, found, i, lowest, size, tall, strips, cells, faces)
    return room


@leaf
def scale_near(pattern: Pattern, found: Nearby, place: int, part: int, x: float, y: float) -> float:
    """The scale of the cross-section of a piece near a point of it."""
    piece = pattern.pieces[found.piece[place]]
    s, _ = locate(piece, x - found.shift[place, 0], y - found.shift[place, 1])
    if part in (CAP_START, TAIL_START):
        s = 0.0
    elif part in (CAP_FINISH, TAIL_FINISH):
        s = piece.length
    scale, _ = scale_at(pattern.scale_table, pattern.grooves[piece.groove], piece, s)
    return scale


@leaf
def is_solid(t: float, w: float, side: int, n: int, lowest: int, cells: Cells) -> bool:
    """Whether the place at the height w above t of a line is solid, on one side of it, by the n cells and bands along
    it."""
    rank = lowest
    for k in range(n):
        tag, beside = cells.beside_tag[k], cells.beside[k]
        if tag[0] == BAND and tag[2] & side != 0 and beside[0] <= t <= beside[1]:
            rank = max(rank, tag[1])
    solid = w <= 0.0
    for k in range(n):
        tag, beside = cells.beside_tag[k], cells.beside[k]
        if tag[0] == BAND or tag[1] != rank or tag[2] & side == 0 or not beside[0] <= t <= beside[1]:
            continue
        floor, roof = beside[2] + t * (beside[3] - beside[2]), math.inf
        if beside[4] < math.inf:
            roof = beside[4] + t * (beside[5] - beside[4])
        if floor < w < roof:
            if tag[0] == REMOVE:
                return False
            solid = True
    return solid


@leaf
def raise_walls(
    pattern: Pattern, found: Nearby, wall: int, lowest: int, size: float, tall: float, strips: Strips, cells: Cells,
    faces: Faces,
) -> bool:  # fmt: skip
    """Add what stands along one of the lines `strips.wall`. False where there is no room."""
    near, tie = 1e-9 * size, 1e-10 * tall
    x0, y0, x1, y1 = strips.wall[wall, 0], strips.wall[wall, 1], strips.wall[wall, 2], strips.wall[wall, 3]
    long = math.hypot(x1 - x0, y1 - y0)
    dx, dy = (x1 - x0) / long, (y1 - y0) / long
    stop, level = cells.stop, cells.level
    stop[0], stop[1] = 0.0, 1.0
    stops = 2

    # earlier ones along the same line
    for i in range(wall):
        a0 = (strips.wall[i, 0] - x0) * dy - (strips.wall[i, 1] - y0) * dx
        a1 = (strips.wall[i, 2] - x0) * dy - (strips.wall[i, 3] - y0) * dx
        if abs(a0) <= near and abs(a1) <= near:
            t0 = ((strips.wall[i, 0] - x0) * dx + (strips.wall[i, 1] - y0) * dy) / long
            t1 = ((strips.wall[i, 2] - x0) * dx + (strips.wall[i, 3] - y0) * dy) / long
            if stops + 2 > STOPS:
                return False
            stop[stops], stop[stops + 1] = min(max(t0, 0.0), 1.0), min(max(t1, 0.0), 1.0)
            stops += 2

    # what there is along it, and at which heights
    place, point, part = strips.wall_tag[wall, 0], strips.wall_tag[wall, 1], strips.wall_tag[wall, 2]
    profile = pattern.profiles[pattern.grooves[pattern.pieces[found.piece[place]].groove].profile]
    first, last = profile.start, profile.start + profile.count - 1
    n, levels = 0, 1
    level[0, 0] = level[0, 1] = 0.0
    cells.level_of[0] = -1
    f0 = f1 = b = 0.0
    if point >= 0:
        f0 = scale_near(pattern, found, place, part, x0, y0)
        f1 = scale_near(pattern, found, place, part, x1, y1)
        b = pattern.points[first + point, 0]
        for i in range(first, last + 1):  # facets of one b
            if pattern.points[i, 0] == b:
                if levels == LEVELS:
                    return False
                level[levels, 0], level[levels, 1] = f0 * pattern.points[i, 1], f1 * pattern.points[i, 1]
                cells.level_of[levels] = -1
                levels += 1
    for j in range(strips.made[1] + cells.made[0]):
        i = j - strips.made[1]
        polygon, count, kind, rank = strips.band[0], 0, BAND, 0
        if i < 0:
            polygon, count, rank = strips.band[j], strips.band_count[j], strips.band_rank[j]
            if rank == lowest:
                continue
        else:
            strip = cells.tag[i, STRIP]
            polygon, count = strips.polygon[strip], strips.corners[strip]
            kind, rank = cells.tag[i, KIND], cells.tag[i, RANK]
            box = strips.box[strip]
            if max(x0, x1) < box[0] - near or min(x0, x1) > box[2] + near:
                continue
            if max(y0, y1) < box[1] - near or min(y0, y1) > box[3] + near:
                continue
        sided = edges(polygon, count, 1e-3 * near, strips.sides)
        low, high, sides = within(strips.sides, sided, x0, y0, x1, y1, near)
        if (high - low) * long <= near or area(polygon, count) <= 1e-15 * size * size:
            continue  # a sliver's heights and sides are rounding
        if n == BESIDE or levels + 2 > LEVELS or stops + 2 > STOPS:
            return False
        beside = cells.beside[n]
        beside[0], beside[1] = low, high
        cells.beside_tag[n, 0], cells.beside_tag[n, 1], cells.beside_tag[n, 2] = kind, rank, sides
        stop[stops], stop[stops + 1] = low, high
        stops += 2
        for side in range(2 if i >= 0 else 0):
            if side == 1 and cells.tag[i, OPEN] == 1:
                beside[4] = beside[5] = math.inf
                continue
            height = cells.height[i, side]
            beside[2 + 2 * side] = height[0] * x0 + height[1] * y0 + height[2]
            beside[3 + 2 * side] = height[0] * x1 + height[1] * y1 + height[2]
            level[levels, 0], level[levels, 1] = beside[2 + 2 * side], beside[3 + 2 * side]
            cells.level_of[levels] = n
            levels += 1
        n += 1
    for i in range(levels):
        for j in range(i):
            g0, g1 = level[i, 0] - level[j, 0], level[i, 1] - level[j, 1]
            if (g0 > tie and g1 < -tie) or (g0 < -tie and g1 > tie):
                if stops == STOPS:
                    return False
                stop[stops] = g0 / (g0 - g1)
                stops += 1
    stop[:stops].sort()
    for k in range(stops - 1):
        a, c = stop[k], stop[k + 1]
        if (c - a) * long <= near:
            continue
        t = 0.5 * (a + c)
        if is_taken(strips, wall, x0 + t * (x1 - x0), y0 + t * (y1 - y0), dx, dy, near):
            continue
        many = 0
        for i in range(levels):
            of = cells.level_of[i]
            if of >= 0 and not cells.beside[of, 0] <= t <= cells.beside[of, 1]:
                continue
            w = level[i, 0] + t * (level[i, 1] - level[i, 0])
            at = many
            while at > 0:
                before = cells.order[at - 1]
                if level[before, 0] + t * (level[before, 1] - level[before, 0]) <= w:
                    break
                cells.order[at] = before
                at -= 1
            cells.order[at] = i
            many += 1
        for i in range(many - 1):
            lower, upper = cells.order[i], cells.order[i + 1]
            low_a = level[lower, 0] + a * (level[lower, 1] - level[lower, 0])
            low_c = level[lower, 0] + c * (level[lower, 1] - level[lower, 0])
            high_a = level[upper, 0] + a * (level[upper, 1] - level[upper, 0])
            high_c = level[upper, 0] + c * (level[upper, 1] - level[upper, 0])
            if high_a - low_a <= tie and high_c - low_c <= tie:
                continue
            w = 0.25 * (low_a + low_c + high_a + high_c)
            left, right = is_solid(t, w, LEFT, n, lowest, cells), is_solid(t, w, RIGHT, n, lowest, cells)
            if left == right:
                continue
            facet = point
            if point >= 0:
                facet = upright(pattern.points, first, last, b, w / (f0 + t * (f1 - f0)))
            if not stand(faces, x0, y0, x1, y1, a, c, low_a, low_c, high_a, high_c, left, place, facet, part):
                return False
    return True


@leaf
def is_taken(strips: Strips, wall: int, x: float, y: float, dx: float, dy: float, near: float) -> bool:
    """Whether an earlier line than `wall` runs through a place of it in the same direction (dx, dy)."""
    for i in range(wall):
        ax, ay = strips.wall[i, 0] - x, strips.wall[i, 1] - y
        bx, by = strips.wall[i, 2] - x, strips.wall[i, 3] - y
        along = abs(ax * dy - ay * dx) <= near and abs(bx * dy - by * dx) <= near
        if along and (ax * dx + ay * dy) * (bx * dx + by * dy) < 0.0:
            return True
    return False
