"""Method `area`: the exact area of every seen and lit part of a footprint (000, section 5; 001, section 6).

The papers treat crossings, ends and corners one by one, each by projecting profiles. Here they are one case (DESIGN
2.1, 2.3): the surface of the local solid is made of convex faces (`faces`), and on the screen

- what a face shows of itself is a convex polygon, as the eye is a point;
- what hides a face is what of the faces turned away from the eye stands before it, and what shades it is the same seen
  from the light: convex regions of the screen too, as from one point a plane's points are seen through another plane
  by a homography.

So each share is found by cutting convex polygons by half-planes, exact under perspective and for point lights.
Everything is computed in the screen's pixels, relative to the footprint: areas are shares. What is left to error is the
colour within a part, taken at its middle, or at several places where it changes; chords for arcs; and the tangent
plane of a curved object.

The faces over a rectangle of the plane are made once for all the footprints that need no more than that.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.domain import AXES, Domain, aim, domain_of, holds, settle, spread
from renderer.geometry.faces import FACES, Faces, envelope, faces_of
from renderer.geometry.polygon import CORNERS, Counts, area, subtract
from renderer.geometry.query import Nearby, find, nearby
from renderer.geometry.solid import Meeting, normal_of
from renderer.geometry.strips import Strips, divide, lay, strips_of
from renderer.geometry.view import View, on_plane, view_of
from renderer.kernel import borrow, fixed, keep, kernel, leaf
from renderer.shading import ambient, light_to_pattern, lit_by, normal_to_world, to_world, unit
from renderer.tables import AREA, DIRECTIONAL, SCALE_CONSTANT, Camera, Floats, Lighting, Pattern

NOT_MINE = 255  # in `method`: left to another method
CAPACITY = fixed(512)  # pieces near a rectangle
PARTS = 512  # polygons that are left of one face
HALVES = 65536  # half-planes of what hides or shades
CHORD = 0.008  # how far chords leave arcs, in widths of the footprint
LEAST = 1e-12  # parts of a footprint as small as this are nothing
WHOLE = 1e-6  # the shares of a footprint sum to one within this, or it is left to another method
CHORDED = 4e-3  # ... where chords stand for arcs and steps for scales: the shares are then divided by their sum
AROUND = (7.0, 2.0, 0.0)  # how much more than a footprint needs the faces are made for, in its sizes
BEYOND = (0.5, 0.1, 0.0)  # ... or in the sizes of what it needs
FEW = (12, 32, 512)  # while no more pieces than this are near
BLOCK = 8  # footprints are taken in squares of so many pixels


class Seen(NamedTuple):
    """The faces as one eye and the lights see them; memory of one thread.

    Sources of light and sight are counted: the lights, then the eye. Linear functions of the screen's point (x, y),
    pixels, are triples (a, b, c).
    """

    made: Counts  # (2,) half-planes so far; footprints so far
    ray: Floats  # (3, 3) the ray's direction through (x, y): ray (x, y, 1)
    back: Floats  # (3, 3) its inverse
    source: Floats  # (sources, 4) D_p, D_q, D_w, h
    corner: Floats  # (FACES, CORNERS, 3) on the screen, homogeneous
    box: Floats  # (FACES, 4) on the screen: x0, y0, x1, y1
    near: Floats  # (FACES, 3) one over the distance of a face's plane along the ray
    facing: Floats  # (sources, FACES) positive where a face is turned towards the source
    away: Counts  # (sources, FACES) the faces turned away from a source
    aways: Counts  # (sources,) how many
    half: Counts  # (sources, FACES, 2) the first of a face's half-planes and how many; -1: not made yet
    halves: Floats  # (HALVES, 4) g and a: g . (x, y, 1) + a near(x, y) >= 0
    tint: Floats  # (FACES, lights + 1, 3) colours of a face that has the same everywhere
    tinted: Counts  # (FACES,)
    parts: Floats  # (2, PARTS, CORNERS, 2) what is seen of a face, and what of that is lit
    counts: Counts  # (2, PARTS)
    planes: Floats  # (CORNERS, 3)
    one: Floats  # (CORNERS, 3)
    two: Floats


@leaf
def seen_of(lights: int) -> Seen:
    n = lights + 1
    return Seen(
        np.zeros(2, np.int64), np.empty((3, 3)), np.empty((3, 3)), np.empty((n, 4)), np.empty((FACES, CORNERS, 3)),
        np.empty((FACES, 4)), np.empty((FACES, 3)), np.empty((n, FACES)), np.empty((n, FACES), np.int64),
        np.zeros(n, np.int64), np.full((n, FACES, 2), -1, np.int64), np.empty((HALVES, 4)),
        np.empty((FACES, n, 3)), np.full(FACES, -1, np.int64), np.empty((2, PARTS, CORNERS, 2)),
        np.empty((2, PARTS), np.int64), np.empty((CORNERS, 3)), np.empty((CORNERS, 3)), np.empty((CORNERS, 3)),
    )  # fmt: skip


@leaf
def make(
    pattern: Pattern, domain: Domain, size: float, slab: Floats, found: Nearby, strips: Strips, faces: Faces
) -> bool:  # fmt: skip
    """Make the faces of what a footprint needs, `slab`, and of somewhat more where little is near: `domain`.

    size: of the footprint, pattern units. False where there is too much.
    """
    m = pattern.reach
    stepped = pattern.height > 0.0
    for groove in pattern.grooves:
        stepped = stepped or groove.priority > 0
    for k in range(len(AROUND)):
        more = max(AROUND[k] * size, BEYOND[k] * max(slab[0, 1] - slab[0, 0], slab[1, 1] - slab[1, 0]))
        settle(domain, slab, more)
        rim = domain.slab
        count = find(pattern, found, rim[0, 0] - m, rim[1, 0] - m, rim[0, 1] + m, rim[1, 1] + m, FEW[k])
        room = count >= 0
        for i in range(max(count, 0)):  # what overhangs is no height field
            profile = pattern.grooves[pattern.pieces[found.piece[i]].groove].profile
            room = room and (
                len(pattern.part_first) == 0 or pattern.part_first[profile] == pattern.part_first[profile + 1]
            )
        strips.made[0] = strips.made[1] = strips.made[2] = 0
        for i in range(max(count, 0)):
            if not room:
                break
            chunks = divide(
                pattern, found.piece[i], found.shift[i, 0], found.shift[i, 1], rim, CHORD * size, strips.chunks
            )
            room = room and chunks >= 0
            for j in range(chunks):
                room = room and lay(pattern, found.piece[i], i, strips.chunks[j], domain, stepped, strips)
        if room and envelope(strips, domain, pattern.height + pattern.depth, faces):
            return True
    return False


@leaf
def look(frame: np.void, view: View, footprint: np.void, lights: NDArray[np.void], faces: Faces, seen: Seen) -> bool:
    """See the faces from a footprint's eye: fill `seen`. False where the eye is on the plane."""
    ray, back = seen.ray, seen.back
    d0, d1, d2 = frame.eye[0], frame.eye[1], frame.eye[2]
    # towards the point (P / W, Q / W, 0) of the plane, W < 0 (view), from the footprint's square to pixels
    for k in range(3):
        if k == 0:
            m0, m1, m2, e = view.pu, view.pv, view.p1, d0
        elif k == 1:
            m0, m1, m2, e = view.qu, view.qv, view.q1, d1
        else:
            m0, m1, m2, e = 0.0, 0.0, 0.0, d2
        m0, m1, m2 = e * view.wu - m0, e * view.wv - m1, e * view.w1 - m2
        m0, m1 = m0 / footprint.size, m1 / footprint.size
        ray[k, 0], ray[k, 1], ray[k, 2] = m0, m1, m2 - m0 * footprint.x - m1 * footprint.y
    c00 = ray[1, 1] * ray[2, 2] - ray[1, 2] * ray[2, 1]
    c01 = ray[1, 2] * ray[2, 0] - ray[1, 0] * ray[2, 2]
    c02 = ray[1, 0] * ray[2, 1] - ray[1, 1] * ray[2, 0]
    det = ray[0, 0] * c00 + ray[0, 1] * c01 + ray[0, 2] * c02
    if not abs(det) > 0.0:
        return False
    back[0, 0], back[1, 0], back[2, 0] = c00 / det, c01 / det, c02 / det
    back[0, 1] = (ray[0, 2] * ray[2, 1] - ray[0, 1] * ray[2, 2]) / det
    back[1, 1] = (ray[0, 0] * ray[2, 2] - ray[0, 2] * ray[2, 0]) / det
    back[2, 1] = (ray[0, 1] * ray[2, 0] - ray[0, 0] * ray[2, 1]) / det
    back[0, 2] = (ray[0, 1] * ray[1, 2] - ray[0, 2] * ray[1, 1]) / det
    back[1, 2] = (ray[0, 2] * ray[1, 0] - ray[0, 0] * ray[1, 2]) / det
    back[2, 2] = (ray[0, 0] * ray[1, 1] - ray[0, 1] * ray[1, 0]) / det
    n, eye = faces.made[0], len(lights)
    for l in range(eye):
        d = light_to_pattern(frame, lights[l])
        for k in range(4):
            seen.source[l, k] = d[k]
    seen.source[eye, 0], seen.source[eye, 1], seen.source[eye, 2], seen.source[eye, 3] = d0, d1, d2, 1.0
    seen.made[0] = 0
    for s in range(eye + 1):
        count = 0
        source = seen.source[s]
        for j in range(n):
            plane = faces.plane[j]
            facing = plane[0] * source[0] + plane[1] * source[1] + plane[2] * source[2] + plane[3] * source[3]
            size = abs(plane[0] * source[0]) + abs(plane[1] * source[1]) + abs(plane[2] * source[2])
            if abs(facing) <= 1e-13 * (size + abs(plane[3]) * source[3]):
                facing = 0.0  # edge on
            seen.facing[s, j] = facing
            seen.half[s, j, 0] = -1
            if facing < 0.0:
                seen.away[s, count] = j
                count += 1
        seen.aways[s] = count
    for j in range(n):
        plane, facing = faces.plane[j], seen.facing[eye, j]
        if facing == 0.0:
            continue
        for k in range(3):
            seen.near[j, k] = -(plane[0] * ray[0, k] + plane[1] * ray[1, k] + plane[2] * ray[2, k]) / facing
        if facing < 0.0:
            continue
        seen.tinted[j] = -1
        box = seen.box[j]
        box[0] = box[1] = math.inf
        box[2] = box[3] = -math.inf
        for i in range(faces.corners[j]):
            x0, x1, x2 = faces.corner[j, i, 0] - d0, faces.corner[j, i, 1] - d1, faces.corner[j, i, 2] - d2
            corner = seen.corner[j, i]
            for k in range(3):
                corner[k] = back[k, 0] * x0 + back[k, 1] * x1 + back[k, 2] * x2
            if corner[2] > 0.0:
                x, y = corner[0] / corner[2], corner[1] / corner[2]
                box[0], box[1], box[2], box[3] = min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)
            else:
                box[0] = box[1] = -math.inf
                box[2] = box[3] = math.inf
    return True


@leaf
def halves_of(s: int, j: int, faces: Faces, seen: Seen) -> bool:
    """Make the half-planes of what face j keeps from source s: in front of it, within its edges seen from there."""
    count, source, ray = faces.corners[j], seen.source[s], seen.ray
    eye = seen.source[len(seen.source) - 1]
    first = seen.made[0]
    if first + count + 1 > HALVES:
        return False
    n = first
    plane = faces.plane[j]
    for k in range(3):
        seen.halves[n, k] = plane[0] * ray[0, k] + plane[1] * ray[1, k] + plane[2] * ray[2, k]
    seen.halves[n, 3] = plane[0] * eye[0] + plane[1] * eye[1] + plane[2] * eye[2] + plane[3]
    n += 1
    box = faces.box[j]
    short = 1e-12 * max(box[3] - box[0], box[4] - box[1], box[5] - box[2])
    for i in range(count):
        a, b = faces.corner[j, i], faces.corner[j, i + 1 if i + 1 < count else 0]
        e0, e1, e2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        if max(abs(e0), abs(e1), abs(e2)) <= short:
            continue
        r0, r1, r2 = source[0] - source[3] * a[0], source[1] - source[3] * a[1], source[2] - source[3] * a[2]
        a0, a1, a2 = e1 * r2 - e2 * r1, e2 * r0 - e0 * r2, e0 * r1 - e1 * r0
        for k in range(3):
            seen.halves[n, k] = a0 * ray[0, k] + a1 * ray[1, k] + a2 * ray[2, k]
        seen.halves[n, 3] = a0 * (eye[0] - a[0]) + a1 * (eye[1] - a[1]) + a2 * (eye[2] - a[2])
        n += 1
    seen.half[s, j, 0], seen.half[s, j, 1] = first, n - first
    seen.made[0] = n
    return True


@leaf
def may_hide(s: int, f: int, b: int, faces: Faces, seen: Seen) -> bool:
    """Whether face b may stand between face f and source s, by their boxes."""
    one, two, source = faces.box[f], faces.box[b], seen.source[s]
    if two[5] <= one[2]:
        return False
    if source[3] == 0.0:
        rise = (two[5] - one[2]) / source[2]
        for k in range(2):
            move = rise * source[k]
            if two[3 + k] <= one[k] + min(move, 0.0) or two[k] >= one[3 + k] + max(move, 0.0):
                return False
        return True
    way = 1.0
    if source[2] > two[5]:
        way = (two[5] - one[2]) / (source[2] - one[2])
    for k in range(2):
        low, high = one[k], one[3 + k]
        if two[3 + k] <= min(low, low + way * (source[k] - low)):
            return False
        if two[k] >= max(high, high + way * (source[k] - high)):
            return False
    return True


@leaf
def hide(s: int, f: int, which: int, n: int, footprint: np.void, faces: Faces, seen: Seen) -> int:
    """Take what source s does not see of face f out of the n polygons `seen.parts[which]`: how many are left.

    Polygons are in the footprint's square, 0 to 1. Negative where there is no room.
    """
    size, near, planes = footprint.size, seen.near[f], seen.planes
    for k in range(seen.aways[s]):
        b = seen.away[s, k]
        if b == f or not may_hide(s, f, b, faces, seen):
            continue
        if seen.half[s, b, 0] < 0 and not halves_of(s, b, faces, seen):
            return -1
        first, count = seen.half[s, b, 0], seen.half[s, b, 1]
        for i in range(count):
            h = seen.halves[first + i]
            x, y = h[0] + h[3] * near[0], h[1] + h[3] * near[1]
            c = h[2] + h[3] * near[2] + x * footprint.x + y * footprint.y
            planes[i, 0], planes[i, 1], planes[i, 2] = x * size, y * size, c
            long = abs(planes[i, 0]) + abs(planes[i, 1]) + abs(c)
            if long > 0.0:
                planes[i, 0], planes[i, 1], planes[i, 2] = planes[i, 0] / long, planes[i, 1] / long, c / long
        n = subtract(seen.parts[which], seen.counts[which], n, planes, count, LEAST, seen.one, seen.two)
        if n <= 0:
            break
    return n


@leaf
def show(f: int, footprint: np.void, faces: Faces, seen: Seen) -> int:
    """Write what of face f lies within the footprint to seen.parts[0, 0]: how many corners it has."""
    size = footprint.size
    box = seen.box[f]
    x0, y0 = footprint.x, footprint.y
    if box[0] >= x0 + size or box[2] <= x0 or box[1] >= y0 + size or box[3] <= y0:
        return 0
    # homogeneous, so that what lies behind the eye does no harm
    one, two = seen.one, seen.two
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
    part = seen.parts[0, 0]
    for i in range(count):
        if not one[i, 2] > 0.0:
            return 0
        part[i, 0], part[i, 1] = one[i, 0] / one[i, 2], one[i, 1] / one[i, 2]
    if area(part, count) < 0.0:  # the screen's y points down: let all run anticlockwise
        for i in range(count // 2):
            j = count - 1 - i
            for k in range(2):
                part[i, k], part[j, k] = part[j, k], part[i, k]
    return count


@leaf
def colour_at(
    f: int, light: int, x: float, y: float, pattern: Pattern, frame: np.void, lighting: Lighting,
    material: np.void, albedo: Floats, bent: bool, found: Nearby, faces: Faces, seen: Seen,
) -> tuple[float, float, float]:  # fmt: skip
    """The radiance that face f sends to the eye through the screen's point (x, y): of one light; of sky and glow."""
    near = seen.near[f, 0] * x + seen.near[f, 1] * y + seen.near[f, 2]
    t = 1.0 / near
    ray = seen.ray
    p = frame.eye[0] + t * (ray[0, 0] * x + ray[0, 1] * y + ray[0, 2])
    q = frame.eye[1] + t * (ray[1, 0] * x + ray[1, 1] * y + ray[1, 2])
    w = frame.eye[2] + t * (ray[2, 0] * x + ray[2, 1] * y + ray[2, 2])
    plane = faces.plane[f]
    n0, n1, n2 = plane[0], plane[1], plane[2]
    if bent:
        m = Meeting(w, faces.tag[f, 1], faces.tag[f, 0], faces.tag[f, 2])
        n0, n1, n2 = normal_of(pattern, found, m, p, q, 0.0, 0.0)
        if n0 * plane[0] + n1 * plane[1] + n2 * plane[2] < 0.0:
            n0, n1, n2 = -n0, -n1, -n2
    n = normal_to_world(frame, (n0, n1, n2))
    at = to_world(frame, p, q, w)
    eye = to_world(frame, frame.eye[0], frame.eye[1], frame.eye[2])
    e = unit((eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]))
    if light < 0:
        return ambient(material, lighting.sky, albedo, n, e)
    return lit_by(lighting.lights[light], material, n, e, at)


@leaf
def is_bent(pattern: Pattern, f: int, found: Nearby, faces: Faces) -> bool:
    """Whether the normal of a face is not the same all over."""
    if faces.tag[f, 0] < 0 or faces.tag[f, 2] != 0:
        return False
    piece = pattern.pieces[found.piece[faces.tag[f, 0]]]
    return piece.curvature != 0.0 or pattern.grooves[piece.groove].scale_kind != SCALE_CONSTANT


def in_blocks(footprints: NDArray[np.void], chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """The footprints `chosen` in the order in which neighbours follow one another: the same faces serve them."""
    x, y = footprints["x"][chosen], footprints["y"][chosen]
    return chosen[np.lexsort((x, y, x // BLOCK, y // BLOCK))]


@kernel
def area_sampling(
    pattern: Pattern, footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void],
    camera: Camera, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance (n, 3) and method.

    NOT_MINE where too much is near, or where the shares do not sum to one. slots: rows of `materials` for the
    pattern's facets, the object's own first.
    """
    owned = nearby(pattern, CAPACITY), strips_of(), faces_of(), seen_of(len(lighting.lights)), domain_of()
    found, strips, faces, seen = borrow(owned[0]), borrow(owned[1]), borrow(owned[2]), borrow(owned[3])
    domain = borrow(owned[4])
    pattern, frames, lighting, camera = borrow(pattern), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    lights = lighting.lights
    eye = len(lights)
    slab = np.empty((AXES, 2))
    made_size, looked, usable = 0.0, -1, False
    distant = True
    for l in range(len(lights)):
        distant = distant and lights[l].kind == DIRECTIONAL
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        method[index] = NOT_MINE
        if frame.eye[2] <= 0.0:
            continue
        p0, q0 = on_plane(view, 0.0, 0.0)
        p1, q1 = on_plane(view, 1.0, 0.0)
        p2, q2 = on_plane(view, 0.0, 1.0)
        size = max(math.hypot(p1 - p0, q1 - q0), math.hypot(p2 - p0, q2 - q0))
        thin = abs((p1 - p0) * (q2 - q0) - (p2 - p0) * (q1 - q0)) / size
        fits = usable and 0.5 * made_size <= thin <= 2.0 * made_size and domain.made[0] > 0
        fits = fits and spread(pattern, frame, view, lights, domain, slab) and holds(domain, slab)
        if not fits:
            aim(frame, view, lights, domain)
            usable = spread(pattern, frame, view, lights, domain, slab)
            usable = usable and make(pattern, domain, thin, slab, found, strips, faces)
            made_size, looked = thin, -1
            if not usable:
                continue
        if looked != footprint.frame:
            if not look(frame, view, footprint, lights, faces, seen):
                continue
            looked = footprint.frame
        red = green = blue = whole = 0.0
        room, chorded = True, False
        for f in range(faces.made[0]):
            if seen.facing[eye, f] <= 0.0:
                continue
            count = show(f, footprint, faces, seen)
            if count == 0:
                continue
            seen.counts[0, 0] = count
            n = hide(eye, f, 0, 1, footprint, faces, seen)
            if n < 0:
                room = False
                break
            if n == 0:
                continue
            slot = 0
            if faces.tag[f, 0] >= 0 and faces.tag[f, 1] >= 0:
                groove = pattern.grooves[pattern.pieces[found.piece[faces.tag[f, 0]]].groove]
                slot = pattern.facet_slot[groove.slot + faces.tag[f, 1]] + 1
            material = materials[slots[slot]]
            bent = is_bent(pattern, f, found, faces)
            chorded = chorded or bent
            plain = distant and not bent and material.metallic == 0.0 and material.f90 == 0.0
            if plain and seen.tinted[f] < 0:
                seen.tinted[f] = 0
                x, y = footprint.x + 0.5 * footprint.size, footprint.y + 0.5 * footprint.size
                for l in range(eye + 1):
                    r, g, b = colour_at(
                        f, l if l < eye else -1, x, y, pattern, frame, lighting, material, albedo, bent, found, faces,
                        seen,
                    )  # fmt: skip
                    seen.tint[f, l, 0], seen.tint[f, l, 1], seen.tint[f, l, 2] = r, g, b
            for source in range(eye, -1, -1):
                light = source if source < eye else -1
                which, m = 0, n
                if light >= 0:
                    if seen.facing[light, f] <= 0.0 or seen.source[light, 2] <= 0.0:
                        continue
                    if (footprint.blocked >> np.uint64(light)) & np.uint64(1):
                        continue
                    if seen.aways[light] > 0:
                        which = 1
                        for i in range(n):
                            for j in range(seen.counts[0, i]):
                                seen.parts[1, i, j, 0] = seen.parts[0, i, j, 0]
                                seen.parts[1, i, j, 1] = seen.parts[0, i, j, 1]
                            seen.counts[1, i] = seen.counts[0, i]
                        m = hide(light, f, 1, n, footprint, faces, seen)
                        if m < 0:
                            room = False
                            break
                for i in range(m):
                    part, corners = seen.parts[which, i], seen.counts[which, i]
                    total = area(part, corners)
                    if light < 0:
                        whole += total
                    if plain:
                        tint = seen.tint[f, source]
                        red, green, blue = red + total * tint[0], green + total * tint[1], blue + total * tint[2]
                        continue
                    # triangle by triangle, the large ones at three places
                    for j in range(1, corners - 1):
                        ax, ay = part[j, 0] - part[0, 0], part[j, 1] - part[0, 1]
                        bx, by = part[j + 1, 0] - part[0, 0], part[j + 1, 1] - part[0, 1]
                        piece = 0.5 * (ax * by - ay * bx)
                        places = 3 if piece > 0.05 else 1
                        for k in range(places):
                            u = v = 1.0 / 3.0
                            if places == 3:
                                u, v = (2.0 / 3.0 if k == 1 else 1.0 / 6.0), (2.0 / 3.0 if k == 2 else 1.0 / 6.0)
                            x = footprint.x + footprint.size * (part[0, 0] + u * ax + v * bx)
                            y = footprint.y + footprint.size * (part[0, 1] + u * ay + v * by)
                            r, g, b = colour_at(
                                f, light, x, y, pattern, frame, lighting, material, albedo, bent, found, faces, seen
                            )
                            share = piece / places
                            red, green, blue = red + share * r, green + share * g, blue + share * b
            if not room:
                break
        if not room or not abs(whole - 1.0) <= (CHORDED if chorded else WHOLE):
            continue
        method[index] = AREA
        radiance[index, 0], radiance[index, 1], radiance[index, 2] = red / whole, green / whole, blue / whole
    keep(owned)
