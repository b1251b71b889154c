"""Method `area`: the exact area of every seen and lit part of a footprint (000, section 5; 001, section 6).

The papers treat crossings, ends and corners one by one, each by projecting profiles. Here they are one case (DESIGN
2.1, 2.3): the surface of the local solid is made of convex faces (`faces`), and on the screen

- what a face shows of itself is a convex polygon, as the eye is a point;
- what hides a face is what of the faces turned away from the eye stands before it, and what shades it is the same seen
  from the light: convex regions of the screen too, as from one point a plane's points are seen through another plane
  by a homography.

So each share is found by cutting convex polygons by half-planes, exact under perspective and for point lights.
Everything is computed in the screen's pixels, relative to the footprint: areas are shares. What is left to error is the
colour within a part, taken at its middle, or at several places where it changes; chords for arcs; and straight rays
over a curved base, which a second look places by what the first has seen.

On flat objects the faces are made once for a block of pixels.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import is_plain, peak, sharpness, turns
from renderer.geometry.colour import EVEN, centroid, colour_over
from renderer.geometry.curve import is_curved
from renderer.geometry.faces import Faces
from renderer.geometry.local import BLOCKS, FULL, Local, local_of
from renderer.geometry.polygon import CORNERS, Counts, area, enclose, overlap, subtract
from renderer.geometry.sight import (
    Seen,
    bend_of,
    hidden_by,
    is_over,
    may_light,
    place_on,
    see,
    see_again,
    seen_of,
    slot_of,
    tinge,
)
from renderer.geometry.straight import left_out
from renderer.geometry.view import view_of
from renderer.kernel import borrow, keep, kernel, leaf
from renderer.shading import are_distant, to_world, white
from renderer.tables import AREA, CROWDED, NOT_MINE, Camera, Floats, Lighting, Pattern

PARTS = 2048  # polygons that are left of one face
LEAST = 1e-12  # parts of a footprint as small as this are nothing
SUMMED = 0.1  # in tolerances: the shares of a footprint sum to one within this, or it is left to another method
CHORDED = 2.0  # ... where chords stand for arcs and steps for scales; shares are divided by their sum
SHARE = 0.1  # of the tolerance, that the colour of one part may use up
# Chords are for this part of it, no less, where facets may be brighter than white: few are as bright as can be.
GLOSSY = 0.25
BENT = 0.5  # the error where chords stand for arcs, in tolerances
SLIVER = 1e-3  # parts of a footprint as small as this do not say between which heights straight rays are to be right
RED, GREEN, BLUE, WHOLE, OFF, CHORDS, COST, LOW, HIGH, TOP, ASIDE, DOWN, ACROSS = range(13)


class Parts(NamedTuple):
    """Polygons of the footprint's square, 0 to 1; memory of one thread."""

    polygon: Floats  # (2, PARTS, CORNERS, 2) what is seen of a face, and what of that is lit
    corners: Counts  # (2, PARTS)
    planes: Floats  # (CORNERS, 3)
    one: Floats  # (CORNERS, 3)
    two: Floats
    box: Floats  # (4,) of what is seen of a face, pixels
    total: Floats  # (13,) what `add_up` has found: RED to ACROSS


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
def add_up(
    tolerance: float, bright: float, long: float, turn: Floats, distant: bool, footprint: np.void, pattern: Pattern,
    frame: np.void, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    local: Local, seen: Seen, parts: Parts,
) -> bool:  # fmt: skip
    """Add up what a footprint sees of the faces in `parts.total`. False where there is no room."""
    found, faces, square, total = local.found, local.faces, local.square[0], parts.total
    lights = lighting.lights
    eye = len(lights)
    red = green = blue = whole = off = 0.0
    cost = float(faces.made[0])
    chorded = False
    low, high, top = math.inf, -math.inf, 0.0
    weight = aside = down = even_x = even_y = 0.0
    for f in range(faces.made[0]):
        top = max(top, faces.box[f, 5])
        if seen.facing[eye, f] <= 0.0:
            continue
        count = show(f, footprint, faces, seen, parts)
        if count == 0:
            continue
        parts.corners[0, 0] = count
        n = hide(eye, f, 0, 1, footprint, frame, faces, seen, parts)
        if n < 0:
            return False
        if n == 0:
            continue
        material = materials[slots[slot_of(pattern, f, found, faces)]]
        bend = bend_of(pattern, f, found, faces)
        bent = bend > 0.0
        chorded = chorded or bent
        cost += seen.heres[eye]
        plain = distant and not bent and is_plain(material) and not is_curved(frame)
        if plain:
            tinge(f, square, pattern, frame, lighting, material, albedo, found, faces, seen)
        for source in range(eye, -1, -1):
            light = source if source < eye else -1
            which, m = 0, n
            if light >= 0:
                if not may_light(light, f, footprint, seen):
                    continue
                if seen.heres[light] > 0:
                    which = 1
                    for i in range(n):
                        for j in range(parts.corners[0, i]):
                            parts.polygon[1, i, j, 0] = parts.polygon[0, i, j, 0]
                            parts.polygon[1, i, j, 1] = parts.polygon[0, i, j, 1]
                        parts.corners[1, i] = parts.corners[0, i]
                    cost += n * seen.heres[light]
                    m = hide(light, f, 1, n, footprint, frame, faces, seen, parts)
                    if m < 0:
                        return False
            even = math.sqrt(EVEN * tolerance / sharpness(material)) / (turn[source] + bend * long)
            largest, u, v = 0.0, 0.5, 0.5
            for i in range(m):
                part, corners = parts.polygon[which, i], parts.corners[which, i]
                share = area(part, corners)
                if light < 0:
                    whole += share
                if light < 0 and seen.pairs[0] == 1:
                    s, t = centroid(part, corners, share)
                    if share > largest:
                        largest, u, v = share, s, t
                    if share > SLIVER:
                        place_on(f, footprint, s, t, seen)
                        deep = share * abs(seen.place[2])
                        weight, aside, down = weight + deep, aside + deep * (s - 0.5), down + deep * (t - 0.5)
                        nx, ny = faces.plane[f, 0], faces.plane[f, 1]
                        lean = share / (nx * nx + ny * ny + faces.plane[f, 2] ** 2)
                        even_x, even_y = even_x + lean * (nx * nx - ny * ny), even_y + 2.0 * lean * nx * ny
                        for j in range(corners):
                            place_on(f, footprint, part[j, 0], part[j, 1], seen)
                            low, high = min(low, seen.place[2]), max(high, seen.place[2])
                if plain:
                    tint = seen.tint[f, source]
                    red, green, blue = red + share * tint[0], green + share * tint[1], blue + share * tint[2]
                    continue
                r, g, b, unsure = colour_over(
                    f, light, part, corners, share, even, SHARE * tolerance * bright, footprint, pattern, frame,
                    lighting, material, albedo, bent, found, faces, seen,
                )  # fmt: skip
                red, green, blue, off = red + r, green + g, blue + b, off + unsure
            if largest > 0.0:
                place_on(f, footprint, u, v, seen)
    total[RED], total[GREEN], total[BLUE], total[WHOLE], total[OFF] = red, green, blue, whole, off
    total[CHORDS], total[COST], total[LOW], total[HIGH], total[TOP] = chorded, cost, low, high, top
    total[ASIDE] = aside / weight if weight > 0.0 else 0.0
    total[DOWN] = down / weight if weight > 0.0 else 0.0
    total[ACROSS] = 0.5 * math.atan2(even_y, even_x)
    return True


def in_blocks(footprints: NDArray[np.void], chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """The footprints `chosen` in the order in which neighbours follow one another: the same faces serve them."""
    x, y = footprints["x"][chosen], footprints["y"][chosen]
    return chosen[np.lexsort((x, y, *(at // side for side in reversed(BLOCKS) if side for at in (x, y))))]


@kernel
def area_sampling(
    tolerance: float, rough: float, most: int, flat: bool, pattern: Pattern, footprints: NDArray[np.void],
    chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera, lighting: Lighting,
    materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats, radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance, predicted error and cost (n, 5) and method.

    tolerance: the error to keep within, relative to a white surface in the same light. rough: the error, at most, that
    straight rays over a curved base may make. flat: they share one frame.
    CROWDED where more than `most` strips are near; NOT_MINE where the shares do not sum to one, or too much is left to
    error. slots: rows of `materials` for the pattern's facets, the object's own first.
    """
    owned = local_of(pattern), seen_of(len(lighting.lights)), parts_of()
    local, seen, parts = borrow(owned[0]), borrow(owned[1]), borrow(owned[2])
    square, total = local.square[0], parts.total
    pattern, frames, lighting, camera = borrow(pattern), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    lights = lighting.lights
    turn = np.empty(len(lights) + 1)
    distant = are_distant(lights)
    chords = tolerance
    for slot in slots:
        chords = min(chords, max(GLOSSY, 1.0 / math.sqrt(peak(materials[slot]))) * tolerance)
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        method[index] = NOT_MINE
        view = view_of(footprint, frame, camera)
        if see(pattern, frame, footprint, flat, camera, lights, chords, most, local, seen) == FULL:
            method[index] = CROWDED
            continue
        bright = white(lighting, to_world(frame, view.p, view.q, 0.0))
        long = turns(frame, view, lights, turn)
        room = add_up(
            tolerance, bright, long, turn, distant, footprint, pattern, frame, lighting, materials, slots, albedo,
            local, seen, parts,
        )  # fmt: skip
        bowed = 0.0
        if room and is_curved(frame):
            bowed = left_out(frame, view, total[LOW], total[HIGH], total[TOP], 0.0, footprint.blocked, lights)
            if not bowed <= rough:
                continue
            red, green, blue = total[RED], total[GREEN], total[BLUE]
            room = see_again(
                total[LOW], total[HIGH], total[TOP], 0.5 + total[ASIDE], 0.5 + total[DOWN], total[ACROSS], pattern,
                frame, footprint, camera, lights, local, seen,
            )  # fmt: skip
            room = room and add_up(
                tolerance, bright, long, turn, distant, footprint, pattern, frame, lighting, materials, slots, albedo,
                local, seen, parts,
            )  # fmt: skip
            apart = abs(total[RED] - red) + abs(total[GREEN] - green) + abs(total[BLUE] - blue)
            bowed = left_out(
                frame, view, total[LOW], total[HIGH], total[TOP], apart / (3.0 * bright), footprint.blocked, lights
            )
            if not bowed <= rough:
                continue
        whole = total[WHOLE]
        if not room or not abs(whole - 1.0) <= tolerance * (CHORDED if total[CHORDS] > 0.0 else SUMMED):
            continue
        error = abs(whole - 1.0) + bowed + (BENT * tolerance if total[CHORDS] > 0.0 else 0.0)
        if total[OFF] > 0.0:
            off = total[OFF] / bright
            if not off <= tolerance:
                continue
            error += off
        method[index] = AREA
        radiance[index, 3] = error
        radiance[index, 4] = total[COST] + (local.strips.made[0] * footprint.size / square.size) ** 2
        for k in range(3):
            radiance[index, k] = total[k] / whole
    keep(owned)
