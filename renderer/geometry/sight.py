"""The faces of the local solid as the eye and the lights see them (DESIGN 2.1).

On the screen, pixels (x, y), all is linear: one over the distance of a face's plane along the ray, and the half-planes
of what hides or shades a face.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import applied, is_curved, turned
from renderer.geometry.faces import Faces
from renderer.geometry.graze import graze
from renderer.geometry.local import FULL, MADE, Local, surround
from renderer.geometry.polygon import CORNERS, Counts
from renderer.geometry.query import Nearby
from renderer.geometry.solid import Meeting, normal_of
from renderer.geometry.straight import straighten_between
from renderer.geometry.view import View, on_plane, view_of
from renderer.kernel import leaf
from renderer.shading import ambient, light_to_pattern, lit_by, normal_to_world, to_world, unit
from renderer.tables import SCALE_CONSTANT, Camera, Floats, Lighting, Pattern

HALVES = 262144  # half-planes of what hides or shades


class Seen(NamedTuple):
    """The faces as one eye and the lights see them; memory of one thread.

    Sources of light and sight are counted: the lights, then the eye. Linear functions of the screen's point (x, y),
    pixels, are triples (a, b, c).
    """

    made: Counts  # (1,) half-planes so far
    eye: Floats  # (3,) where the light goes
    mirror: Counts  # (1,) the face that all is seen in; -1: none
    ray: Floats  # (3, 3) the ray's direction through (x, y): ray (x, y, 1)
    back: Floats  # (3, 3) its inverse
    source: Floats  # (sources, 4) D_p, D_q, D_w, h
    least: Floats  # (sources, 4) the lights, as low as any straight rays stand for them
    own: Floats  # (lights, 4) the lights where they are, over a curved base
    between: Floats  # (4,) and for two faces
    place: Floats  # (3,) a point that is seen of the face looked at
    pairs: Counts  # (1,) 1: over a curved base, where each two faces have a light of their own (`graze`)
    corner: Floats  # (FACES, CORNERS, 3) on the screen, homogeneous
    box: Floats  # (FACES, 4) on the screen: x0, y0, x1, y1
    near: Floats  # (FACES, 3) one over the distance of a face's plane along the ray
    facing: Floats  # (sources, FACES) positive where a face is turned towards the source
    away: Counts  # (sources, FACES) the faces turned away from a source
    aways: Counts  # (sources,) how many
    cover: Floats  # (sources, FACES, 4) x0, y0, x1, y1 on the screen of what each of those may keep from it
    here: Counts  # (sources, FACES) those of them, by their places there, that may do so in one footprint
    heres: Counts  # (sources,) how many
    half: Counts  # (sources, FACES, 2) the first of a face's half-planes and how many; -1: not made yet
    halves: Floats  # (HALVES, 4) g and a: g . (x, y, 1) + a near(x, y) >= 0
    tint: Floats  # (FACES, lights + 1, 3) colours of a face that has the same everywhere
    tinted: Counts  # (FACES,)


@leaf
def seen_of(lights: int, most: int) -> Seen:
    """Memory for as many faces as `most`."""
    n = lights + 1
    return Seen(
        np.zeros(1, np.int64), np.empty(3), np.full(1, -1, np.int64), np.empty((3, 3)), np.empty((3, 3)),
        np.empty((n, 4)), np.empty((n, 4)), np.empty((n, 4)), np.empty(4), np.empty(3), np.zeros(1, np.int64),
        np.empty((most, CORNERS, 3)), np.empty((most, 4)), np.empty((most, 3)), np.empty((n, most)),
        np.empty((n, most), np.int64), np.zeros(n, np.int64), np.empty((n, most, 4)), np.empty((n, most), np.int64),
        np.zeros(n, np.int64), np.full((n, most, 2), -1, np.int64), np.empty((HALVES, 4)), np.empty((most, n, 3)),
        np.full(most, -1, np.int64),
    )  # fmt: skip


@leaf
def see(
    pattern: Pattern, frame: np.void, footprint: np.void, flat: bool, camera: Camera, lights: NDArray[np.void],
    tolerance: float, most: int, far: float, local: Local, seen: Seen,
) -> int:  # fmt: skip
    """Make ready the faces that a footprint needs, and how they are seen: HELD, MADE or FULL, as `surround`.

    flat: its frame is that of all footprints. far: as there.
    """
    held, view = surround(pattern, frame, footprint, flat, camera, lights, tolerance, most, far, seen.source, local)
    for k in range(3):
        seen.eye[k] = frame.eye[k]
    if held == MADE:
        lower(view.p, view.q, frame, lights, seen)
    if held == MADE and not look(view, local.square[0], lights, local.faces, seen):
        return FULL
    if held != FULL:
        draw_near(footprint, seen)
    return held


@leaf
def see_again(
    low: float, high: float, top: float, x: float, y: float, across: float, pattern: Pattern, frame: np.void,
    footprint: np.void, camera: Camera, lights: NDArray[np.void], local: Local, seen: Seen,
) -> bool:  # fmt: skip
    """See the faces anew, over a curved base, from what a first look has found: False as `look`.

    low, high: all that is seen lies between. top: the highest there is. x, y: about where what is deep is seen, in the
    footprint's square. across: the angle of the way across grooves, most of them.
    """
    view = view_of(footprint, frame, camera)
    p, q = on_plane(view, x, y)
    view = straighten_between(low, high, top, p, q, across, pattern, frame, view, lights, seen.source)
    eye = seen.source[len(lights)]
    lower(view.p + low * (eye[0] - view.p) / eye[2], view.q + low * (eye[1] - view.q) / eye[2], frame, lights, seen)
    if not look(view, local.square[0], lights, local.faces, seen):
        return False
    draw_near(footprint, seen)
    return True


@leaf
def lower(p: float, q: float, frame: np.void, lights: NDArray[np.void], seen: Seen) -> None:
    """Fill `seen.own` and `seen.least` about a place on the plane."""
    seen.pairs[0] = is_curved(frame)
    seen.least[:] = seen.source
    u, v = applied(frame, p - frame.pq[0], q - frame.pq[1])
    for l in range(len(lights)):
        d, own, least = light_to_pattern(frame, lights[l]), seen.own[l], seen.least[l]
        own[0], own[1], own[2], own[3] = d[0], d[1], d[2], d[3]
        least[2] = min(least[2], d[2] + u * (d[0] - d[3] * p) + v * (d[1] - d[3] * q))


@leaf
def look(view: View, footprint: np.void, lights: NDArray[np.void], faces: Faces, seen: Seen) -> bool:
    """See the faces from a footprint's `seen.source`: fill `seen.ray`, and what depends on it. False where the eye is
    on the plane."""
    ray, back = seen.ray, seen.back
    d0, d1, d2 = seen.source[len(lights), 0], seen.source[len(lights), 1], seen.source[len(lights), 2]
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
    look_along(faces, seen)
    return True


@leaf
def look_along(faces: Faces, seen: Seen) -> None:
    """See the faces from `seen.source` along `seen.ray`: fill what depends on these."""
    ray, back = seen.ray, seen.back
    n, eye = faces.made[0], len(seen.source) - 1
    d0, d1, d2 = seen.source[eye, 0], seen.source[eye, 1], seen.source[eye, 2]
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
    low = math.inf
    for j in range(n):
        seen.tinted[j] = -1
        low = min(low, faces.box[j, 2])
        box = seen.box[j]
        box[0] = box[1] = math.inf
        box[2] = box[3] = -math.inf
        for i in range(faces.corners[j]):
            x0, x1, x2 = faces.corner[j, i, 0] - d0, faces.corner[j, i, 1] - d1, faces.corner[j, i, 2] - d2
            corner = seen.corner[j, i]
            for k in range(3):
                corner[k] = back[k, 0] * x0 + back[k, 1] * x1 + back[k, 2] * x2
            widen(box, corner[0], corner[1], corner[2])
    for s in range(eye + 1):
        source = seen.least[s]
        for i in range(seen.aways[s]):
            j = seen.away[s, i]
            cover = seen.cover[s, i]
            for k in range(4):
                cover[k] = seen.box[j, k]
            if s == eye:
                continue
            for m in range(faces.corners[j]):  # and where its shadow falls at the lowest
                x0, x1, x2 = faces.corner[j, m, 0], faces.corner[j, m, 1], faces.corner[j, m, 2]
                r0, r1, r2 = source[0] - source[3] * x0, source[1] - source[3] * x1, source[2] - source[3] * x2
                t = (x2 - low) / r2 if r2 > 0.0 else math.inf
                if not t < math.inf:
                    cover[0] = cover[1] = -math.inf
                    cover[2] = cover[3] = math.inf
                    break
                x0, x1, x2 = x0 - t * r0 - d0, x1 - t * r1 - d1, low - d2
                widen(
                    cover, back[0, 0] * x0 + back[0, 1] * x1 + back[0, 2] * x2,
                    back[1, 0] * x0 + back[1, 1] * x1 + back[1, 2] * x2,
                    back[2, 0] * x0 + back[2, 1] * x1 + back[2, 2] * x2,
                )  # fmt: skip


@leaf
def widen(box: Floats, a: float, b: float, c: float) -> None:
    """Let a box of the screen hold the point (a, b, c), homogeneous; behind the eye it may be anywhere."""
    if c > 0.0:
        x, y = a / c, b / c
        box[0], box[1], box[2], box[3] = min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)
    else:
        box[0] = box[1] = -math.inf
        box[2] = box[3] = math.inf


@leaf
def is_over(box: Floats, footprint: np.void) -> bool:
    """Whether a box of the screen meets a footprint."""
    x, y, size = footprint.x, footprint.y, footprint.size
    return bool(box[0] < x + size and box[2] > x and box[1] < y + size and box[3] > y)


@leaf
def draw_near(footprint: np.void, seen: Seen) -> None:
    """Fill `seen.here`."""
    for s in range(len(seen.aways)):
        count = 0
        for i in range(seen.aways[s]):
            if is_over(seen.cover[s, i], footprint):
                seen.here[s, count] = i
                count += 1
        seen.heres[s] = count


@leaf
def halves_of(s: int, j: int, faces: Faces, seen: Seen) -> bool:
    """Make the half-planes of what face j keeps from source s: in front of it, within its edges seen from there."""
    first = seen.made[0]
    if first + faces.corners[j] + 1 > HALVES:
        return False
    count = halves_from(seen.source[s], j, first, faces, seen)
    seen.half[s, j, 0], seen.half[s, j, 1] = first, count
    seen.made[0] = first + count
    return True


@leaf
def halves_from(source: Floats, j: int, first: int, faces: Faces, seen: Seen) -> int:
    """Write to `seen.halves`, from `first` on, the half-planes of what face j keeps from a source: how many."""
    count, ray = faces.corners[j], seen.ray
    eye = seen.source[len(seen.source) - 1]
    n = first
    plane = faces.plane[j]
    for k in range(3):
        seen.halves[n, k] = plane[0] * ray[0, k] + plane[1] * ray[1, k] + plane[2] * ray[2, k]
    seen.halves[n, 3] = plane[0] * eye[0] + plane[1] * eye[1] + plane[2] * eye[2] + plane[3]
    n += 1
    box = faces.box[j]
    # shorter edges may be rounding's alone, and lead anywhere
    short = 1e-9 * max(box[3] - box[0], box[4] - box[1], box[5] - box[2])
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
    return n - first


@leaf
def may_hide(s: int, f: int, b: int, faces: Faces, seen: Seen) -> bool:
    """Whether face b may stand between face f and source s, by their boxes."""
    one, two, source = faces.box[f], faces.box[b], seen.least[s]
    if two[5] <= one[2]:
        return False
    if source[2] <= 0.0:
        return True
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
def is_before(f: int, b: int, faces: Faces) -> bool:
    """Whether any of face b stands out of the plane of face f."""
    plane = faces.plane[f]
    least = 1e-12 * (abs(plane[0]) + abs(plane[1]) + abs(plane[2]) + abs(plane[3]))
    for i in range(faces.corners[b]):
        corner = faces.corner[b, i]
        if plane[0] * corner[0] + plane[1] * corner[1] + plane[2] * corner[2] + plane[3] > least:
            return True
    return False


@leaf
def hidden_by(
    b: int, s: int, f: int, footprint: np.void, frame: np.void, faces: Faces, seen: Seen, planes: Floats
) -> int:
    """Write the half-planes of what face b keeps from source s of face f, in the footprint's square, 0 to 1, to
    `planes` (CORNERS, 3): how many; 0 where it keeps nothing. Negative where there is no room."""
    mirror = seen.mirror[0] if s == len(seen.source) - 1 else -1
    if b == f or (mirror >= 0 and not is_before(mirror, b, faces)):
        return 0
    if (mirror < 0 and not may_hide(s, f, b, faces, seen)) or not is_before(f, b, faces):
        return 0
    size, near = footprint.size, seen.near[f]
    if seen.pairs[0] == 1 and s < len(seen.source) - 1:
        first = seen.made[0]
        if first + faces.corners[b] + 1 > HALVES:
            return -1
        graze(frame, seen.own[s], seen.place, f, b, faces, seen.between)
        count = halves_from(seen.between, b, first, faces, seen)
    else:
        if seen.half[s, b, 0] < 0 and not halves_of(s, b, faces, seen):
            return -1
        first, count = seen.half[s, b, 0], seen.half[s, b, 1]
    for i in range(count):
        h = seen.halves[first + i]
        x, y = h[0] + h[3] * near[0], h[1] + h[3] * near[1]
        planes[i, 0], planes[i, 1] = x * size, y * size
        planes[i, 2] = h[2] + h[3] * near[2] + x * footprint.x + y * footprint.y
    if mirror >= 0:
        before(mirror, b, footprint, faces, seen, planes[count])
        count += 1
    return int(count)


@leaf
def before(mirror: int, f: int, footprint: np.void, faces: Faces, seen: Seen, half: Floats) -> None:
    """Write the half-plane of the footprint's square through which face f is seen in front of the mirror's plane."""
    plane, ray, near, eye = faces.plane[mirror], seen.ray, seen.near[f], seen.source[len(seen.source) - 1]
    from_eye = plane[0] * eye[0] + plane[1] * eye[1] + plane[2] * eye[2] + plane[3]
    x = plane[0] * ray[0, 0] + plane[1] * ray[1, 0] + plane[2] * ray[2, 0] + from_eye * near[0]
    y = plane[0] * ray[0, 1] + plane[1] * ray[1, 1] + plane[2] * ray[2, 1] + from_eye * near[1]
    z = plane[0] * ray[0, 2] + plane[1] * ray[1, 2] + plane[2] * ray[2, 2] + from_eye * near[2]
    half[0], half[1], half[2] = x * footprint.size, y * footprint.size, z + x * footprint.x + y * footprint.y


@leaf
def may_light(l: int, f: int, footprint: np.void, seen: Seen) -> bool:
    """Whether light l reaches face f in this footprint where no face keeps it off."""
    if seen.facing[l, f] <= 0.0 or seen.source[l, 2] <= 0.0:
        return False
    return (footprint.blocked >> np.uint64(l)) & np.uint64(1) == 0


@leaf
def place_on(f: int, footprint: np.void, u: float, v: float, seen: Seen) -> None:
    """Write to `seen.place` the point of face f that is seen at the point (u, v) of the footprint's square."""
    x, y, ray = footprint.x + footprint.size * u, footprint.y + footprint.size * v, seen.ray
    near = seen.near[f, 0] * x + seen.near[f, 1] * y + seen.near[f, 2]
    for k in range(3):
        way = ray[k, 0] * x + ray[k, 1] * y + ray[k, 2]
        seen.place[k] = seen.source[len(seen.source) - 1, k] + way / near


@leaf
def colour_at(
    f: int, light: int, x: float, y: float, pattern: Pattern, frame: np.void, lighting: Lighting,
    material: np.void, albedo: Floats, bent: bool, found: Nearby, faces: Faces, seen: Seen,
) -> tuple[float, float, float]:  # fmt: skip
    """The radiance that face f sends to the eye through the screen's point (x, y): of one light; of sky and glow."""
    near = seen.near[f, 0] * x + seen.near[f, 1] * y + seen.near[f, 2]
    t = 1.0 / near
    ray, origin = seen.ray, seen.source[len(seen.source) - 1]
    p = origin[0] + t * (ray[0, 0] * x + ray[0, 1] * y + ray[0, 2])
    q = origin[1] + t * (ray[1, 0] * x + ray[1, 1] * y + ray[1, 2])
    w = origin[2] + t * (ray[2, 0] * x + ray[2, 1] * y + ray[2, 2])
    plane = faces.plane[f]
    n0, n1, n2 = plane[0], plane[1], plane[2]
    if bent:
        m = Meeting(w, faces.tag[f, 1], faces.tag[f, 0], faces.tag[f, 2])
        n0, n1, n2 = normal_of(pattern, found, m, p, q, 0.0, 0.0)
        if n0 * plane[0] + n1 * plane[1] + n2 * plane[2] < 0.0:
            n0, n1, n2 = -n0, -n1, -n2
    if is_curved(frame):
        n0, n1, n2 = turned(frame, p - frame.pq[0], q - frame.pq[1], w, (n0, n1, n2))
    n = normal_to_world(frame, (n0, n1, n2))
    at = to_world(frame, p, q, w)
    eye = to_world(frame, seen.eye[0], seen.eye[1], seen.eye[2])
    e = unit((eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]))
    if light < 0:
        return ambient(material, lighting, albedo, n, e)
    return lit_by(lighting.lights[light], material, n, e, at)


@leaf
def slot_of(pattern: Pattern, f: int, found: Nearby, faces: Faces) -> int:
    """Which of the materials of the pattern's facets a face has; 0: the object's own."""
    if faces.tag[f, 0] < 0 or faces.tag[f, 1] < 0:
        return 0
    groove = pattern.grooves[pattern.pieces[found.piece[faces.tag[f, 0]]].groove]
    return int(pattern.facet_slot[groove.slot + faces.tag[f, 1]]) + 1


@leaf
def tinge(
    f: int, square: np.void, pattern: Pattern, frame: np.void, lighting: Lighting, material: np.void, albedo: Floats,
    found: Nearby, faces: Faces, seen: Seen,
) -> None:  # fmt: skip
    """Fill `seen.tint` of a face whose colours are the same everywhere, as seen in the middle of this square."""
    if seen.tinted[f] >= 0:
        return
    seen.tinted[f] = 0
    x, y, eye = square.x + 0.5 * square.size, square.y + 0.5 * square.size, len(lighting.lights)
    for l in range(eye + 1):
        r, g, b = colour_at(
            f, l if l < eye else -1, x, y, pattern, frame, lighting, material, albedo, False, found, faces, seen
        )
        seen.tint[f, l, 0], seen.tint[f, l, 1], seen.tint[f, l, 2] = r, g, b


@leaf
def bend_of(pattern: Pattern, f: int, found: Nearby, faces: Faces) -> float:
    """How fast the normal of a face turns on its way along the groove, radians a pattern unit."""
    if faces.tag[f, 0] < 0 or faces.tag[f, 2] != 0:
        return 0.0
    piece = pattern.pieces[found.piece[faces.tag[f, 0]]]
    stretched = pattern.grooves[piece.groove].scale_kind != SCALE_CONSTANT
    return math.inf if stretched else abs(piece.curvature)
