"""Rays against the bare shapes, and their tangent frames.

Rectangles, spheres and cylinders are met in closed form, in double precision: a tessellation would put facets on
their silhouettes, and single precision would shift footprints by what a fine groove is wide.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import kernel, leaf
from renderer.tables import CYLINDER, MESH, POINT, RECTANGLE, SPHERE, Floats, Ints

Vector = tuple[float, float, float]

NEXT_TO = 1.0 - 1e-9  # of the way to a lamp; what is beyond stands in no one's light


class Triangles(NamedTuple):
    """All mesh objects' triangles, in the world."""

    corners: Floats  # (n, 3, 3)
    uv: Floats  # (n, 3, 2)
    normals: Floats  # (n, 3, 3) unit, at the corners
    object: Ints  # (n,) row of OBJECT


NO_TRIANGLES = Triangles(np.zeros((0, 3, 3)), np.zeros((0, 3, 2)), np.zeros((0, 3, 3)), np.zeros(0, np.int32))


@leaf
def solve(a: float, b: float, c: float) -> tuple[float, float]:
    """The roots of a t^2 + 2 b t + c, the smaller first; NaN where there are none."""
    root = b * b - a * c
    if root < 0.0 or a == 0.0:
        return math.nan, math.nan
    q = -(b + math.copysign(math.sqrt(root), b))
    t0, t1 = q / a, (c / q if q != 0.0 else 0.0)
    return (t0, t1) if t0 < t1 else (t1, t0)


@leaf
def local(obj: np.void, x: float, y: float, z: float) -> Vector:
    """A world vector in the object's axes."""
    r = obj.rotation
    return (
        r[0, 0] * x + r[1, 0] * y + r[2, 0] * z,
        r[0, 1] * x + r[1, 1] * y + r[2, 1] * z,
        r[0, 2] * x + r[1, 2] * y + r[2, 2] * z,
    )


@leaf
def out_of(obj: np.void, x: Vector) -> Vector:
    """A vector in the object's axes in the world."""
    r = obj.rotation
    return (
        r[0, 0] * x[0] + r[0, 1] * x[1] + r[0, 2] * x[2],
        r[1, 0] * x[0] + r[1, 1] * x[1] + r[1, 2] * x[2],
        r[2, 0] * x[0] + r[2, 1] * x[1] + r[2, 2] * x[2],
    )


@leaf
def meet_shape(
    obj: np.void, o: tuple[float, float, float], d: tuple[float, float, float], far: float, within: bool
) -> tuple[float, int]:
    """The nearest t in (0, far) at which o + t d (the object's axes) meets the shape, and the face; inf: nowhere.

    within: the farthest, where a ray leaves that began inside.
    """
    if obj.shape == RECTANGLE:
        if d[2] != 0.0:
            t = -o[2] / d[2]
            if 0.0 < t < far:
                x, y = o[0] + t * d[0], o[1] + t * d[1]
                if abs(x) <= 0.5 * obj.size[0] and abs(y) <= 0.5 * obj.size[1]:
                    return t, 0
        return math.inf, 0
    if obj.shape == SPHERE:
        a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        b = o[0] * d[0] + o[1] * d[1] + o[2] * d[2]
        c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] - obj.size[0] * obj.size[0]
        t0, t1 = solve(a, b, c)
        if 0.0 < t0 < far and not within:
            return t0, 0
        return (t1, 0) if 0.0 < t1 < far else (math.inf, 0)
    if obj.shape == CYLINDER:
        best, face = -math.inf if within else math.inf, 0
        a, b = d[0] * d[0] + d[1] * d[1], o[0] * d[0] + o[1] * d[1]
        t0, t1 = solve(a, b, o[0] * o[0] + o[1] * o[1] - obj.size[0] * obj.size[0])
        half = 0.5 * obj.size[1]
        for k in range(2):
            t = t0 if k == 0 else t1
            nearer = t > best if within else t < best
            if 0.0 < t < far and nearer and abs(o[2] + t * d[2]) <= half:
                best, face = t, 0
        if d[2] != 0.0:
            for k in range(2):
                t = ((half if k == 0 else -half) - o[2]) / d[2]
                nearer = t > best if within else t < best
                if 0.0 < t < far and nearer:
                    x, y = o[0] + t * d[0], o[1] + t * d[1]
                    if x * x + y * y <= obj.size[0] * obj.size[0]:
                        best, face = t, 1
        return (best, face) if best > 0.0 else (math.inf, 0)
    return math.inf, 0


@leaf
def touch(obj: np.void, face: int, x: float, y: float, z: float) -> tuple[float, float, float, float, float]:
    """(u, v) and the outside normal, in the object's axes, of the shape's point (x, y, z)."""
    if obj.shape == SPHERE:
        r = obj.size[0]
        u = math.atan2(y, x) / (2.0 * math.pi)
        v = 0.5 + math.asin(min(max(z / r, -1.0), 1.0)) / math.pi
        return u if u >= 0.0 else u + 1.0, v, x / r, y / r, z / r
    if obj.shape == CYLINDER:
        if face == 1:
            return x, y, 0.0, 0.0, math.copysign(1.0, z)
        u = math.atan2(y, x) / (2.0 * math.pi)
        return (u if u >= 0.0 else u + 1.0), z / obj.size[1] + 0.5, x / obj.size[0], y / obj.size[0], 0.0
    return x / obj.size[0] + 0.5, y / obj.size[1] + 0.5, 0.0, 0.0, 1.0


@kernel
def cast(objects: NDArray[np.void], origins: Floats, directions: Floats, own: Ints, hits: NDArray[np.void]) -> None:
    """The nearest hit of each ray from `origins` (n, 3) along `directions` (n, 3), with all shapes but meshes.

    own: (n,) the row k of OBJECT that a ray leaves and does not meet again, or -2 - k where it goes on inside that; -1:
    none.
    """
    for i in range(len(directions)):
        hit = hits[i]
        hit.object = -1
        hit.t = math.inf
        dx, dy, dz = directions[i, 0], directions[i, 1], directions[i, 2]
        for k in range(len(objects)):
            obj = objects[k]
            within = k == -2 - own[i]
            if obj.shape == MESH or k == own[i] or (within and obj.shape == RECTANGLE):
                continue
            s = obj.translation
            o = local(obj, origins[i, 0] - s[0], origins[i, 1] - s[1], origins[i, 2] - s[2])
            d = local(obj, dx, dy, dz)
            t, face = meet_shape(obj, o, d, hit.t, within)
            if t < hit.t:
                hit.object, hit.face, hit.t = k, face, t
                hit.u, hit.v, nx, ny, nz = touch(obj, face, o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])
                hit.normal[0], hit.normal[1], hit.normal[2] = out_of(obj, (nx, ny, nz))


@kernel
def cast_triangles(
    triangles: Triangles, origins: Floats, directions: Floats, rows: Ints, hits: NDArray[np.void]
) -> None:
    """Take what Embree found, triangle `rows[i]` (n,) or -1, in double precision where it is nearer than `hits`."""
    for i in range(len(rows)):
        row = rows[i]
        if row < 0:
            continue
        a, b, c = triangles.corners[row, 0], triangles.corners[row, 1], triangles.corners[row, 2]
        e1 = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        e2 = (c[0] - a[0], c[1] - a[1], c[2] - a[2])
        n = (e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0])
        area = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        d = directions[i]
        slope = n[0] * d[0] + n[1] * d[1] + n[2] * d[2]
        if area == 0.0 or slope == 0.0:
            continue
        o = (origins[i, 0] - a[0], origins[i, 1] - a[1], origins[i, 2] - a[2])
        t = -(n[0] * o[0] + n[1] * o[1] + n[2] * o[2]) / slope
        if not 0.0 < t < hits[i].t:
            continue
        x = (o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])
        m = (x[1] * e2[2] - x[2] * e2[1], x[2] * e2[0] - x[0] * e2[2], x[0] * e2[1] - x[1] * e2[0])
        beta = (m[0] * n[0] + m[1] * n[1] + m[2] * n[2]) / (area * area)
        m = (e1[1] * x[2] - e1[2] * x[1], e1[2] * x[0] - e1[0] * x[2], e1[0] * x[1] - e1[1] * x[0])
        gamma = (m[0] * n[0] + m[1] * n[1] + m[2] * n[2]) / (area * area)
        hit = hits[i]
        hit.object, hit.face, hit.t = triangles.object[row], row, t
        uv = triangles.uv[row]
        hit.u = uv[0, 0] + beta * (uv[1, 0] - uv[0, 0]) + gamma * (uv[2, 0] - uv[0, 0])
        hit.v = uv[0, 1] + beta * (uv[1, 1] - uv[0, 1]) + gamma * (uv[2, 1] - uv[0, 1])
        corner = triangles.normals[row]
        length = 0.0
        for k in range(3):
            hit.normal[k] = corner[0, k] + beta * (corner[1, k] - corner[0, k]) + gamma * (corner[2, k] - corner[0, k])
            length += hit.normal[k] * hit.normal[k]
        length = math.sqrt(length)
        away = (hit.normal[0] * d[0] + hit.normal[1] * d[1] + hit.normal[2] * d[2]) * slope <= 0.0
        for k in range(3):  # a smooth normal that the viewer sees from behind gives way to the triangle's
            hit.normal[k] = n[k] / area if length == 0.0 or away else hit.normal[k] / length


class Shells(NamedTuple):
    """What the grooves of spheres and cylinders fill."""

    outer: NDArray[np.void]  # (n,) OBJECT, as large as their highest ridges; what has no shell meets no rays
    inner: Floats  # (n,) the radius of a cylinder at its grooves' deepest, world units; else inf


def shells(objects: NDArray[np.void], heights: Floats) -> Shells | None:
    """The shells of spheres with ridges, and of cylinders with any grooves; None if there are no such."""
    high, deep = heights.T
    round_ = (objects["shape"] == SPHERE) & (high > 0.0) | (objects["shape"] == CYLINDER) & (high + deep > 0.0)
    if not round_.any():
        return None
    outer: NDArray[np.void] = objects.copy()
    outer["shape"][~round_] = MESH
    (su, sv), (radius, height) = objects["mapping"][:, :2].T, objects["size"].T
    up = np.where(objects["shape"] == SPHERE, math.pi * radius, height)
    sigma = np.where(round_, np.sqrt(2.0 * math.pi * radius * np.abs(up / (su * sv))), 0.0)  # at a sphere's equator
    outer["size"][:, 0] += high * sigma
    return Shells(outer, np.where(outer["shape"] == CYLINDER, radius - deep * sigma, np.inf))


@leaf
def stands_before(objects: NDArray[np.void], own: int, at: Vector, way: Vector, far: float) -> bool:
    """Whether a shape, meshes and the row `own` of its own object aside, is met from `at` along `way` before `far`."""
    for k in range(len(objects)):
        obj = objects[k]
        if k == own or obj.shape == MESH:
            continue
        s = obj.translation
        o = local(obj, at[0] - s[0], at[1] - s[1], at[2] - s[2])
        t, _ = meet_shape(obj, o, local(obj, way[0], way[1], way[2]), far, False)
        if t < far:
            return True
    return False


@kernel
def block(
    objects: NDArray[np.void], origins: Floats, directions: Floats, far: Floats, own: Ints, blocked: NDArray[np.bool_]
) -> None:
    """Mark each ray that meets a shape, meshes and the row `own[i]` of its own object aside, before t = far[i]."""
    for i in range(len(origins)):
        at, way = origins[i], directions[i]
        if own[i] >= 0 and not blocked[i]:
            blocked[i] = stands_before(objects, own[i], (at[0], at[1], at[2]), (way[0], way[1], way[2]), far[i])


@leaf
def in_shade(objects: NDArray[np.void], lights: NDArray[np.void], own: int, at: Vector, over: Vector) -> np.uint64:
    """The bits of the lights that a shape, meshes aside, keeps from a point of the object `own`.

    over: what is on its side is asked for alone; (0, 0, 0): all.
    """
    mask = np.uint64(0)
    for l in range(len(lights)):
        v, far = lights[l].vector, math.inf
        way = (v[0], v[1], v[2])
        if lights[l].kind == POINT:
            way, far = (v[0] - at[0], v[1] - at[1], v[2] - at[2]), NEXT_TO
        if way[0] * over[0] + way[1] * over[1] + way[2] * over[2] >= 0.0 and stands_before(objects, own, at, way, far):
            mask |= np.uint64(1) << np.uint64(l)
    return mask


@kernel
def shade(
    objects: NDArray[np.void], lights: NDArray[np.void], points: Floats, own: Ints, masks: NDArray[np.uint64]
) -> None:
    """Set the bits of the lights that a shape, meshes aside, keeps from points (n, 3) of the objects `own` (n,)."""
    for i in range(len(points)):
        masks[i] |= in_shade(objects, lights, own[i], (points[i, 0], points[i, 1], points[i, 2]), (0.0, 0.0, 0.0))


@kernel
def shade_hits(
    objects: NDArray[np.void], lights: NDArray[np.void], origins: Floats, directions: Floats, hits: NDArray[np.void],
    masks: NDArray[np.uint64],
) -> None:  # fmt: skip
    """The same for the hits of rays; misses are in no shade, nor rectangles in one from behind."""
    for i in range(len(hits)):
        hit, o, d = hits[i], origins[i], directions[i]
        if hit.object >= 0:
            at = (o[0] + hit.t * d[0], o[1] + hit.t * d[1], o[2] + hit.t * d[2])
            n, over = hit.normal, (0.0, 0.0, 0.0)
            if objects[hit.object].shape == RECTANGLE:
                side = -math.copysign(1.0, n[0] * d[0] + n[1] * d[1] + n[2] * d[2])
                over = (side * n[0], side * n[1], side * n[2])
            masks[i] |= in_shade(objects, lights, hit.object, at, over)


@kernel
def arrange(
    hits: NDArray[np.void], frames: NDArray[np.void], of: Ints, order: NDArray[np.int64], ends: NDArray[np.int64]
) -> None:
    """Fill `order` (n,) with the hits by what they met: nothing, then bare and grooved of the first object, and so on;
    each from ends[k] to ends[k + 1], in their order."""
    ends[:] = 0
    for i in range(len(hits)):
        if hits[i].object >= 0:
            order[i] = 2 * hits[i].object + 2 - (frames[of[i]].grooved == 0)
        else:
            order[i] = 0
        ends[order[i] + 1] += 1
    for k in range(1, len(ends)):
        ends[k] += ends[k - 1]
    kinds, next_of = order.copy(), ends.copy()
    for i in range(len(hits)):
        order[next_of[kinds[i]]] = i
        next_of[kinds[i]] += 1


@leaf
def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@leaf
def fill_frame(
    frame: np.void, p: Vector, a: Vector, b: Vector, n: Vector, origin: Floats,
) -> None:  # fmt: skip
    """Complete a frame with dP/dp = a and dP/dq = b at the world point p; b is turned round where n asks for it."""
    c = cross(a, b)
    area = math.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    if not area > 0.0:  # no coordinates to speak of: any will do, and no groove
        frame.grooved = 0
        a = (1.0, 0.0, 0.0) if abs(n[0]) < 0.7 else (0.0, 1.0, 0.0)
        k = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
        a = (a[0] - k * n[0], a[1] - k * n[1], a[2] - k * n[2])
        b = cross(n, a)
        c = cross(a, b)
        area = math.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    sigma = math.sqrt(area)
    for k in range(3):
        frame.origin[k] = p[k]
        frame.axes[k, 0], frame.axes[k, 1], frame.axes[k, 2] = a[k], b[k], sigma * n[k]
    w = (sigma * n[0], sigma * n[1], sigma * n[2])
    bw, wa, ab = cross(b, w), cross(w, a), cross(a, b)
    part = 1.0 / (ab[0] * w[0] + ab[1] * w[1] + ab[2] * w[2])
    for k in range(3):
        frame.dual[0, k], frame.dual[1, k], frame.dual[2, k] = part * bw[k], part * wa[k], part * ab[k]
    e = (origin[0] - p[0], origin[1] - p[1], origin[2] - p[2])
    d = frame.dual
    frame.eye[0] = d[0, 0] * e[0] + d[0, 1] * e[1] + d[0, 2] * e[2] + frame.pq[0]
    frame.eye[1] = d[1, 0] * e[0] + d[1, 1] * e[1] + d[1, 2] * e[2] + frame.pq[1]
    frame.eye[2] = d[2, 0] * e[0] + d[2, 1] * e[1] + d[2, 2] * e[2]


@leaf
def bend(obj: np.void, triangles: Triangles, hit: np.void, frame: np.void) -> None:
    """Fill `frame.form` and `drift`. The form is minus the normal part of the surface's second derivatives: how its
    normal turns.

    dN/dp . dP/dp and so on. On spheres the normal turns as the place does, by 1 / radius; on cylinders around the axis
    alone; on meshes as the smooth normals go over the triangle.
    """
    x, f = frame.axes, frame.form
    sigma = math.sqrt(x[0, 2] * x[0, 2] + x[1, 2] * x[1, 2] + x[2, 2] * x[2, 2])
    if obj.shape == RECTANGLE:
        return
    if obj.shape == MESH:
        uv, corner, m = triangles.uv[hit.face], triangles.normals[hit.face], obj.mapping
        p1, q1 = (uv[1, 0] - uv[0, 0]) * m[0], (uv[1, 1] - uv[0, 1]) * m[1]
        p2, q2 = (uv[2, 0] - uv[0, 0]) * m[0], (uv[2, 1] - uv[0, 1]) * m[1]
        area = p1 * q2 - p2 * q1
        if area == 0.0:
            return
        for i in range(3):
            one, two = corner[1, i] - corner[0, i], corner[2, i] - corner[0, i]
            by_p, by_q = (q2 * one - q1 * two) / area, (p1 * two - p2 * one) / area
            f[0] += by_p * x[i, 0] / sigma
            f[1] += 0.5 * (by_p * x[i, 1] + by_q * x[i, 0]) / sigma
            f[2] += by_q * x[i, 1] / sigma
        return
    along = (obj.rotation[0, 2], obj.rotation[1, 2], obj.rotation[2, 2])
    over = sigma * obj.size[0]
    for i in range(3):
        f[0] += x[i, 0] * x[i, 0] / over
        f[1] += x[i, 0] * x[i, 1] / over
        f[2] += x[i, 1] * x[i, 1] / over
    if obj.shape == SPHERE:  # the length of dP/dp goes with the latitude's cosine, sigma with its root
        sine = up = square = 0.0
        for i in range(3):
            sine += (frame.origin[i] - obj.translation[i]) * along[i] / obj.size[0]
            up += x[i, 1] * along[i] / obj.size[0]
            square += x[i, 0] * x[i, 0] / (obj.size[0] * obj.size[0])
        cosine = math.sqrt(max(1.0 - sine * sine, 0.0))
        if cosine > 0.0 and up != 0.0:
            rate = up / cosine  # of latitude along q
            frame.drift[0] = square * sine / (cosine * rate)
            frame.drift[1] = -rate * sine / cosine
            frame.drift[2] = -0.5 * rate * sine / cosine
    if obj.shape == CYLINDER:
        p = x[0, 0] * along[0] + x[1, 0] * along[1] + x[2, 0] * along[2]
        q = x[0, 1] * along[0] + x[1, 1] * along[1] + x[2, 1] * along[2]
        f[0], f[1], f[2] = f[0] - p * p / over, f[1] - p * q / over, f[2] - q * q / over


@kernel
def frames_at(
    objects: NDArray[np.void], triangles: Triangles, origins: Floats, directions: Floats, hits: NDArray[np.void],
    bent: bool, frames: NDArray[np.void], of: Ints,
) -> int:  # fmt: skip
    """Write the tangent FRAMEs at the hits (n,) of the rays from `origins` (n, 3) along `directions` (n, 3), and `of`
    which (n,) each is; how many there are. Hits on one side of a rectangle share the first one's, and
    its eye; a miss has none.

    Seen from behind, an opaque surface is bare and turned to the viewer. bent: what carries no pattern has a form, too.
    """
    shared = np.full((len(objects), 2), -1)
    made = 0
    for i in range(len(hits)):
        hit, origin = hits[i], origins[i]
        of[i] = -1
        if hit.object < 0:
            continue
        obj = objects[hit.object]
        d = directions[i]
        n = (hit.normal[0], hit.normal[1], hit.normal[2])
        turned = n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0.0
        if obj.shape == RECTANGLE:
            of[i] = shared[hit.object, int(turned)]
            if of[i] >= 0:
                continue
            shared[hit.object, int(turned)] = made
        of[i] = made
        frame = frames[made]
        made += 1
        p = (origin[0] + hit.t * d[0], origin[1] + hit.t * d[1], origin[2] + hit.t * d[2])
        frame.object = hit.object
        frame.grooved = 1 if obj.pattern >= 0 else 0
        m = obj.mapping
        frame.pq[0], frame.pq[1] = hit.u * m[0] + m[2], hit.v * m[1] + m[3]
        a, b = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        if obj.shape == MESH:
            uv, c = triangles.uv[hit.face], triangles.corners[hit.face]
            u1, v1, u2, v2 = uv[1, 0] - uv[0, 0], uv[1, 1] - uv[0, 1], uv[2, 0] - uv[0, 0], uv[2, 1] - uv[0, 1]
            area = u1 * v2 - u2 * v1
            if area != 0.0:
                e1 = (c[1, 0] - c[0, 0], c[1, 1] - c[0, 1], c[1, 2] - c[0, 2])
                e2 = (c[2, 0] - c[0, 0], c[2, 1] - c[0, 1], c[2, 2] - c[0, 2])
                a = (
                    (v2 * e1[0] - v1 * e2[0]) / area,
                    (v2 * e1[1] - v1 * e2[1]) / area,
                    (v2 * e1[2] - v1 * e2[2]) / area,
                )
                b = (
                    (u1 * e2[0] - u2 * e1[0]) / area,
                    (u1 * e2[1] - u2 * e1[1]) / area,
                    (u1 * e2[2] - u2 * e1[2]) / area,
                )
                k = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]  # into the plane of the smooth normal
                a = (a[0] - k * n[0], a[1] - k * n[1], a[2] - k * n[2])
                k = b[0] * n[0] + b[1] * n[1] + b[2] * n[2]
                b = (b[0] - k * n[0], b[1] - k * n[1], b[2] - k * n[2])
        elif hit.face == 1 and obj.shape == CYLINDER:
            frame.grooved = 0
        else:
            x, y, z = local(obj, p[0] - obj.translation[0], p[1] - obj.translation[1], p[2] - obj.translation[2])
            if obj.shape == RECTANGLE:
                lu, lv = (obj.size[0], 0.0, 0.0), (0.0, obj.size[1], 0.0)
            elif obj.shape == SPHERE:
                ring = math.sqrt(x * x + y * y)
                lu = (-2.0 * math.pi * y, 2.0 * math.pi * x, 0.0)
                lv = (0.0, 0.0, 0.0)
                if ring > 0.0:
                    lv = (-math.pi * z * x / ring, -math.pi * z * y / ring, math.pi * ring)
            else:
                lu = (-2.0 * math.pi * y, 2.0 * math.pi * x, 0.0)
                lv = (0.0, 0.0, obj.size[1])
            a, b = out_of(obj, lu), out_of(obj, lv)
        a = (a[0] / m[0], a[1] / m[0], a[2] / m[0])
        b = (b[0] / m[1], b[1] / m[1], b[2] / m[1])
        frame.within = 1 if turned and obj.clear == 1 else 0
        if turned and obj.clear == 0:
            n = (-n[0], -n[1], -n[2])
            frame.grooved = 0
        fill_frame(frame, p, a, b, n, origin)
        frame.form[:], frame.drift[:] = 0.0, 0.0
        if frame.grooved == 1 or (bent and not turned and not (hit.face == 1 and obj.shape == CYLINDER)):
            bend(obj, triangles, hit, frame)
    return made


@kernel
def touching(
    middle: NDArray[np.void], mask: NDArray[np.uint64], corners: NDArray[np.void], masks: NDArray[np.uint64],
    around: NDArray[np.int64], cosine: Floats,
) -> NDArray[np.bool_]:  # fmt: skip
    """Whether each square's centre (n,) and corners hit one smooth surface in one light, or nothing at all; smooth up
    to a `cosine` (n,) of what normals differ by.

    around: (4, n) rows of `corners` and `masks`.
    """
    smooth = np.ones(len(middle), np.bool_)
    for i in range(len(middle)):
        m = middle[i]
        for k in range(4):
            c = corners[around[k, i]]
            same = c.object == m.object and masks[around[k, i]] == mask[i]
            if same and m.object >= 0:
                turn = m.normal[0] * c.normal[0] + m.normal[1] * c.normal[1] + m.normal[2] * c.normal[2]
                same = turn > cosine[i]
            if not same:
                smooth[i] = False
                break
    return smooth
