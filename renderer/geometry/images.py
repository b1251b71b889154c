"""What mirrors among the faces show: as seen by the eye's mirror image in each, and in what is seen of that (000, 6.1).

A ray through the screen's point (x, y) goes on from the image of the eye in the mirrored direction, which is linear in
(x, y) as before. So faces, and what hides and shades them, are the same linear functions of the screen (`sight`) for a
new eye; what of a face lies behind the mirror's plane is cut off by one more half-plane; and what is seen of the mirror
is the window that all is seen through. What is seen there of another mirror is a window again.

The sky is seen where nothing is: of a picture what is smooth, as a pixel's rays spread little. Next to its edges
samples know more.

The papers follow profiles along one direction and leave crossings out (000, 8); here nothing is left out but what is
too small to matter, and what the faces at hand do not reach.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import sharpness
from renderer.geometry.colour import EVEN, centroid, colour_over
from renderer.geometry.domain import Domain
from renderer.geometry.faces import Faces
from renderer.geometry.local import Local
from renderer.geometry.parts import Parts, hide, light_up, show
from renderer.geometry.polygon import CORNERS, MOST, Counts, area, clipped, edges, enclose
from renderer.geometry.sight import Seen, before, bend_of, draw_near, look_along, may_light, place_on, slot_of
from renderer.kernel import leaf
from renderer.shading import (
    Vector,
    direction_to_pattern,
    dot,
    has_picture,
    mirrored,
    normal_to_world,
    sky_from,
    unit,
)
from renderer.tables import Floats, Lighting, Pattern

VIEWS, WINDOWS = 1024, 4096  # of one footprint
LEAST = 1e-12  # windows as small as this are nothing
WHOLE = 0.999  # of a window: what shows all of the sky
WORTH = 8000  # faces are looked at through mirrors, at most: rays would be as fast
DIM = 0.02  # of the tolerance: what a mirror shows is left out where it is less than this of white, and told;
VIVID = 64.0  # ... of a picture of the sky, where nothing is brighter than so many times white, so much less
RED, GREEN, BLUE, OFF, COST = range(5)


class Images(NamedTuple):
    """The eye's images for one footprint; memory of one thread."""

    made: Counts  # (4,) images, windows; 1 where there is a mirror that has none; 1 where what is seen scatters light
    mirror: Counts  # (VIEWS,) the face that each is behind
    before: Counts  # (VIEWS,) the image that is seen in that; -1: the eye itself
    level: Counts  # (VIEWS,) mirrors on the way
    first: Counts  # (VIEWS, 2) its windows: the first, and the one after the last
    eye: Floats  # (VIEWS, 3) where it is
    ray: Floats  # (VIEWS, 3, 3) as in `Seen`
    back: Floats  # (VIEWS, 3, 3)
    window: Floats  # (WINDOWS, CORNERS, 2) convex polygons of the footprint's square
    corners: Counts  # (WINDOWS,)
    rest: Floats  # (WINDOWS,) the area in which nothing has been seen yet
    planes: Floats  # (CORNERS, 3) half-planes
    total: Floats  # (5,) RED to COST


@leaf
def images_of(views: int, windows: int) -> Images:
    return Images(
        np.zeros(4, np.int64), np.empty(views, np.int64), np.empty(views, np.int64), np.empty(views, np.int64),
        np.empty((views, 2), np.int64), np.empty((views, 3)), np.empty((views, 3, 3)), np.empty((views, 3, 3)),
        np.empty((windows, CORNERS, 2)), np.empty(windows, np.int64), np.empty(windows), np.empty((CORNERS, 3)),
        np.empty(5),
    )  # fmt: skip


@leaf
def reflects(material: np.void) -> bool:
    """Whether it is an ideal mirror in part."""
    straight, grazing = mirrored(material, 1.0), mirrored(material, 0.0)
    return max(straight[0], straight[1], straight[2], grazing[0], grazing[1], grazing[2]) > 0.0


@leaf
def scatters(material: np.void) -> bool:
    """Whether it sends light on in more than the mirror's direction."""
    base = material.base_color
    matt = (1.0 - material.metallic) * (1.0 - material.transmission) * max(base[0], base[1], base[2]) > 0.0
    return bool(matt or (material.alpha > 0.0 and (material.metallic > 0.0 or material.f90 > 0.0)))


@leaf
def open_window(f: int, of: int, share: float, polygon: Floats, corners: int, images: Images) -> bool:
    """Note that this polygon of the footprint's square shows face f, a mirror, to the image `of` (-1: the eye). False
    where there is no room.

    Windows to one mirror come one after the other.
    """
    k, i = images.made[0] - 1, images.made[1]
    if i == len(images.window):
        return False
    if k < 0 or images.mirror[k] != f or images.before[k] != of:
        k += 1
        if k == len(images.mirror):
            return False
        images.made[0] = k + 1
        images.mirror[k], images.before[k], images.first[k, 0] = f, of, i
        images.level[k] = images.level[of] + 1 if of >= 0 else 1
    for j in range(corners):
        images.window[i, j, 0], images.window[i, j, 1] = polygon[j, 0], polygon[j, 1]
    images.corners[i], images.rest[i] = corners, share
    images.first[k, 1] = images.made[1] = i + 1
    return True


@leaf
def open_windows(f: int, bent: bool, n: int, material: np.void, parts: Parts, images: Images) -> None:
    """Open windows to face f, if that is a mirror, of which the eye sees the n polygons `parts.polygon[0]`. bent: it
    stands for an arc, and shows what that does not."""
    if scatters(material):
        images.made[3] = 1
    for i in range(n if reflects(material) else 0):
        polygon, corners = parts.polygon[0, i], parts.corners[0, i]
        share = area(polygon, corners)
        if share > LEAST and (bent or not open_window(f, -1, share, polygon, corners, images)):
            images.made[2] = 1


@leaf
def place_image(k: int, frame: np.void, faces: Faces, seen: Seen, images: Images) -> None:
    """Write where the eye's image k is, and how rays go on from it. In the world, where angles are true."""
    f, of = images.mirror[k], images.before[k]
    plane, foot = faces.plane[f], faces.corner[f, 0]
    n = normal_to_world(frame, (plane[0], plane[1], plane[2]))
    d = direction_to_pattern(frame, n)
    # the same normal as a covector: the distance from the mirror in the world is m . (X - foot)
    a = frame.axes
    m0 = a[0, 0] * n[0] + a[1, 0] * n[1] + a[2, 0] * n[2]
    m1 = a[0, 1] * n[0] + a[1, 1] * n[1] + a[2, 1] * n[2]
    m2 = a[0, 2] * n[0] + a[1, 2] * n[1] + a[2, 2] * n[2]
    ray, back = (images.ray[of], images.back[of]) if of >= 0 else (seen.ray, seen.back)
    eye = images.eye[of] if of >= 0 else seen.eye
    far = 2.0 * (m0 * (eye[0] - foot[0]) + m1 * (eye[1] - foot[1]) + m2 * (eye[2] - foot[2]))
    for i in range(3):
        images.eye[k, i] = eye[i] - far * d[i]
        over = 2.0 * (m0 * ray[0, i] + m1 * ray[1, i] + m2 * ray[2, i])
        along = 2.0 * (back[i, 0] * d[0] + back[i, 1] * d[1] + back[i, 2] * d[2])
        for j in range(3):
            images.ray[k, j, i] = ray[j, i] - over * d[j]
        images.back[k, i, 0] = back[i, 0] - along * m0
        images.back[k, i, 1] = back[i, 1] - along * m1
        images.back[k, i, 2] = back[i, 2] - along * m2


@leaf
def way_at(
    k: int, u: float, v: float, footprint: np.void, frame: np.void, images: Images
) -> Vector:  # fmt: skip
    """Where the ray through the point (u, v) of the square goes on from the mirror of image k, in the world."""
    x, y = footprint.x + footprint.size * u, footprint.y + footprint.size * v
    a, ray = frame.axes, images.ray[k]
    d0 = ray[0, 0] * x + ray[0, 1] * y + ray[0, 2]
    d1 = ray[1, 0] * x + ray[1, 1] * y + ray[1, 2]
    d2 = ray[2, 0] * x + ray[2, 1] * y + ray[2, 2]
    return unit(
        (
            a[0, 0] * d0 + a[0, 1] * d1 + a[0, 2] * d2,
            a[1, 0] * d0 + a[1, 1] * d1 + a[1, 2] * d2,
            a[2, 0] * d0 + a[2, 1] * d1 + a[2, 2] * d2,
        )
    )


@leaf
def passed_on(
    k: int, u: float, v: float, footprint: np.void, frame: np.void, pattern: Pattern, materials: NDArray[np.void],
    slots: NDArray[np.int32], local: Local, images: Images,
) -> Vector:  # fmt: skip
    """The part of radiance, RGB, that the mirrors up to image k pass on through the point (u, v) of the square."""
    red = green = blue = 1.0
    while k >= 0:
        f = images.mirror[k]
        plane, way = local.faces.plane[f], way_at(k, u, v, footprint, frame, images)
        n = normal_to_world(frame, (plane[0], plane[1], plane[2]))
        part = mirrored(materials[slots[slot_of(pattern, f, local.found, local.faces)]], dot(n, way))
        red, green, blue = red * part[0], green * part[1], blue * part[2]
        k = images.before[k]
    return red, green, blue


@leaf
def holds(domain: Domain, p: float, q: float) -> bool:
    """Whether faces are known at a place of the plane."""
    for k in range(domain.made[0]):
        along = domain.axis[k, 0] * p + domain.axis[k, 1] * q
        if not domain.slab[k, 0] <= along <= domain.slab[k, 1]:
            return False
    return True


@leaf
def is_known_to(l: int, footprint: np.void, u: float, v: float, f: int, high: float, local: Local, seen: Seen) -> bool:
    """Whether all that may stand between light l and the point of face f seen at (u, v) is among the faces."""
    place_on(f, footprint, u, v, seen)
    d, x = seen.source[l], seen.place
    rise = d[2] - d[3] * x[2]
    way = max(high - x[2], 0.0) / rise if rise > 0.0 else 1.0
    if d[3] != 0.0:
        way = min(way, 1.0)
    return holds(local.domain, x[0] + way * (d[0] - d[3] * x[0]), x[1] + way * (d[1] - d[3] * x[1]))


@leaf
def gets_away(i: int, footprint: np.void, high: float, local: Local, seen: Seen, images: Images) -> bool:
    """Whether rays that meet none of the faces through window i leave the solid over them, not aside of them."""
    for j in range(images.corners[i]):
        x = footprint.x + footprint.size * images.window[i, j, 0]
        y = footprint.y + footprint.size * images.window[i, j, 1]
        place_on(seen.mirror[0], footprint, images.window[i, j, 0], images.window[i, j, 1], seen)
        ray = seen.ray
        rise = ray[2, 0] * x + ray[2, 1] * y + ray[2, 2]
        if not rise > 0.0:
            return False
        way = max(high - seen.place[2], 0.0) / rise
        p = seen.place[0] + way * (ray[0, 0] * x + ray[0, 1] * y + ray[0, 2])
        q = seen.place[1] + way * (ray[1, 0] * x + ray[1, 1] * y + ray[1, 2])
        if not holds(local.domain, p, q):
            return False
    return True


@leaf
def sky_through(
    k: int, i: int, u: float, v: float, partial: bool, footprint: np.void, frame: np.void, lighting: Lighting,
    images: Images,
) -> tuple[float, float, float, float]:  # fmt: skip
    """The mean of the sky that image k sees through its window i about (u, v), RGB, and what that may be off by.

    Of a picture: in triangles from there to the window's sides, as far as nothing stands before it. Where its corners
    say otherwise than its middle, an edge of the picture may run through it. partial: something does stand there.
    """
    sky = lighting.sky
    if not has_picture(lighting):
        return sky[0], sky[1], sky[2], 0.0
    window, corners = images.window[i], images.corners[i]
    middle = sky_from(lighting, way_at(k, u, v, footprint, frame, images))
    red = green = blue = whole = 0.0
    r = g = b = apart = 0.0
    for j in range(corners):
        p0, p1 = window[j], window[(j + 1) % corners]
        at = sky_from(lighting, way_at(k, p0[0], p0[1], footprint, frame, images))
        r, g, b = r + at[0] / corners, g + at[1] / corners, b + at[2] / corners
        apart = max(apart, max(abs(at[0] - middle[0]), abs(at[1] - middle[1]), abs(at[2] - middle[2])))
        share = abs((p0[0] - u) * (p1[1] - v) - (p1[0] - u) * (p0[1] - v))
        x, y = (u + p0[0] + p1[0]) / 3.0, (v + p0[1] + p1[1]) / 3.0
        at = sky_from(lighting, way_at(k, x, y, footprint, frame, images))
        red, green, blue, whole = red + share * at[0], green + share * at[1], blue + share * at[2], whole + share
    if partial or whole <= 0.0:
        return middle[0], middle[1], middle[2], 0.5 * apart
    red, green, blue = red / whole, green / whole, blue / whole
    apart = max(abs(red - middle[0]), abs(green - middle[1]), abs(blue - middle[2]))
    return red, green, blue, max(apart, 0.5 * max(abs(r - red), abs(g - green), abs(b - blue)))


@leaf
def look_into(
    k: int, tolerance: float, bright: float, long: float, turn: Floats, bounces: int, footprint: np.void,
    pattern: Pattern, frame: np.void, lighting: Lighting, last: Lighting, materials: NDArray[np.void],
    slots: NDArray[np.int32], albedo: Floats, local: Local, seen: Seen, parts: Parts, images: Images,
) -> bool:  # fmt: skip
    """Add what the eye's image k sees through its windows to `images.total`, and open windows to the mirrors there.
    False where there is no room, or something may be in the way that is not known."""
    faces, found, total = local.faces, local.found, images.total
    eye = len(lighting.lights)
    first, end, level = images.first[k, 0], images.first[k, 1], images.level[k]
    high, vivid = pattern.height, VIVID if has_picture(last) else 1.0
    seen.mirror[0] = images.mirror[k]
    for i in range(3):
        seen.eye[i] = seen.source[eye, i] = images.eye[k, i]
        for j in range(3):
            seen.ray[i, j], seen.back[i, j] = images.ray[k, i, j], images.back[k, i, j]
    look_along(faces, seen)
    draw_near(footprint, seen)
    total[COST] += faces.made[0]
    for f in range(faces.made[0]):
        if seen.facing[eye, f] <= 0.0:
            continue
        material = materials[slots[slot_of(pattern, f, found, faces)]]
        bend = bend_of(pattern, f, found, faces)
        lit = lighting if level < bounces else last
        shines = level < bounces and reflects(material)
        for i in range(first, end):
            if images.rest[i] <= LEAST:
                continue
            count = show(f, footprint, faces, seen, parts)
            if count == 0:
                break
            planes = images.planes
            before(seen.mirror[0], f, footprint, faces, seen, planes[0])
            sides = 1 + edges(images.window[i], images.corners[i], 0.0, planes[1:])
            if count + sides > CORNERS or count > MOST:
                return False
            count = clipped(parts.polygon[0, 0], count, planes, 0, sides, parts.one)
            if count == 0 or area(parts.polygon[0, 0], count) <= LEAST:
                continue
            enclose(parts.polygon[0, 0], count, parts.box)
            for side in range(4):  # boxes are the screen's
                parts.box[side] = (footprint.x if side & 1 == 0 else footprint.y) + footprint.size * parts.box[side]
            parts.corners[0, 0] = count
            n = hide(eye, f, 0, 1, footprint, frame, faces, seen, parts)
            if n < 0:
                return False
            total[COST] += seen.heres[eye]
            for source in range(eye, -1, -1):
                light = source if source < eye else -1
                which, m = 0, n
                if light >= 0:
                    if not may_light(light, f, footprint, seen):
                        continue
                    for j in range(n):
                        for c in range(parts.corners[0, j]):
                            u, v = parts.polygon[0, j, c, 0], parts.polygon[0, j, c, 1]
                            if not is_known_to(light, footprint, u, v, f, high, local, seen):
                                return False
                    total[COST] += n * seen.heres[light]
                    which, m = light_up(light, f, n, footprint, frame, faces, seen, parts)
                    if m < 0:
                        return False
                even = math.sqrt(EVEN * tolerance / sharpness(material)) / (turn[source] + bend * long)
                for j in range(m):
                    part, corners = parts.polygon[which, j], parts.corners[which, j]
                    share = area(part, corners)
                    u, v = centroid(part, corners, share)
                    through = passed_on(k, u, v, footprint, frame, pattern, materials, slots, local, images)
                    if light < 0:
                        images.rest[i] -= share
                        if level < bounces and scatters(material):
                            images.made[3] = 1
                        if shines:
                            bound = vivid * share * max(through[0], through[1], through[2])
                            if bound <= DIM * tolerance:
                                total[OFF] += bound * bright
                            elif bend > 0.0 or not open_window(f, k, share, part, corners, images):
                                return False
                    r, g, b, unsure = colour_over(
                        f, light, part, corners, share, even, DIM * tolerance * bright, footprint, pattern, frame,
                        lit, material, albedo, bend > 0.0, found, faces, seen,
                    )  # fmt: skip
                    total[RED] += through[0] * r
                    total[GREEN] += through[1] * g
                    total[BLUE] += through[2] * b
                    total[OFF] += max(through[0], through[1], through[2]) * unsure
    for i in range(first, end):
        window, corners, rest = images.window[i], images.corners[i], images.rest[i]
        share = area(window, corners)
        u, v = centroid(window, corners, share)
        through = passed_on(k, u, v, footprint, frame, pattern, materials, slots, local, images)
        most = max(through[0], through[1], through[2])
        if vivid * abs(rest) * most <= DIM * tolerance:
            total[OFF] += vivid * abs(rest) * most * bright
            continue
        if rest < 0.0 or not gets_away(i, footprint, high, local, seen, images):
            return False
        r, g, b, unsure = sky_through(k, i, u, v, rest < WHOLE * share, footprint, frame, last, images)
        total[RED] += rest * through[0] * r
        total[GREEN] += rest * through[1] * g
        total[BLUE] += rest * through[2] * b
        total[OFF] += rest * most * unsure
    return True


@leaf
def look_into_all(
    tolerance: float, bright: float, long: float, turn: Floats, bounces: int, footprint: np.void, pattern: Pattern,
    frame: np.void, lighting: Lighting, last: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32],
    albedo: Floats, local: Local, seen: Seen, image: Seen, parts: Parts, images: Images,
) -> bool:  # fmt: skip
    """Fill `images.total` with what all mirrors show whose windows are open, up to so many `bounces`. False as
    `look_into`.

    seen: as the eye sees the faces. image: room to see them as its images do. lighting: of what sends its light on;
    last: of what a last bounce meets, which all of the sky is to light.
    """
    images.total[:] = 0.0
    image.source[:], image.least[:] = seen.source, seen.least
    image.pairs[0] = 0
    for k in range(len(images.mirror)):
        if k >= images.made[0]:
            break
        if images.made[0] * local.faces.made[0] > WORTH:
            return False
        place_image(k, frame, local.faces, seen, images)
        if not look_into(
            k, tolerance, bright, long, turn, bounces, footprint, pattern, frame, lighting, last, materials, slots,
            albedo, local, image, parts, images,
        ):  # fmt: skip
            return False
    return True
