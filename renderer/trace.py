"""Method `geometry`: real geometry, traced by Embree with n even samples a pixel, each a ray of its own.

The ground truth and the peer of the analytic methods: it shares no geometry with them, no footprints, frames or spans.
Paths go on by directions drawn as the materials answer, as often as the scene says. Embree's single precision is finest
where a body fills [-1, 1], so each is traced in a space of its own; what Embree finds is met again in double precision.
Rays from a surface start OFFSET off their triangle. Too small an offset makes facets shade themselves, too large a one
lets light leak under ridges: the part of a groove's width that is wrongly lit at a shadow's edge is about OFFSET over
that width, which for a groove of 1/250 of the body is 1e-4.

Normals are not those of the chords: facets swept along an arc have the arc's, and pattern space is carried into the
world by the map's derivatives at the very point.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from renderer.body import Base, Body, facing
from renderer.geometry.random import PLACE, drawn
from renderer.kernel import borrow, kernel, leaf
from renderer.scattering import TOUCH, scatter
from renderer.shading import Vector, ambient, dot, lit_by, sky_from, unit
from renderer.tables import CYLINDER, GEOMETRY, MESH, NONE, POINT, RECTANGLE, Camera, Floats, Ints, Lighting

OFFSET = 4e-7
RAYS = 1 << 18  # traced at a time

Bools = NDArray[np.bool_]


class Hits(NamedTuple):
    """What rays meet first."""

    t: Floats  # (n,) in lengths of the direction; inf: nothing
    body: Ints  # (n,) index of the truth's bodies; -1: nothing
    triangle: Ints  # (n,) of the body; -1: the plane of a bare rectangle
    back: Bools  # (n,) seen from behind: what is opaque is bare there, and turned to the viewer. Of rays' starts: they
    # leave that side
    point: Floats  # (n, 3) world
    normal: Floats  # (n, 3) world, unit: what light meets
    slot: Ints  # (n,) material slot: -1 the object's own


def nowhere(count: int) -> Hits:
    """Rays that have met nothing."""
    return Hits(
        np.full(count, np.inf), np.full(count, -1, np.int32), np.full(count, -1, np.int32), np.zeros(count, np.bool_),
        np.zeros((count, 3)), np.zeros((count, 3)), np.full(count, -1, np.int32),
    )  # fmt: skip


class Traced:
    """A body, ready for rays."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self.dual: Floats = np.asarray(np.linalg.inv(body.axes), np.float64)
        self.top = 0.0
        self.floor, self.under = -math.inf, 0.0  # a plate's bottom, as traced; a height between that and all else
        self._scene: EmbreeScene | None = None
        if len(body.corners):
            low, high = body.corners.min(axis=(0, 1)), body.corners.max(axis=(0, 1))
            self.middle = 0.5 * (low + high)
            if body.shape == RECTANGLE:
                self.middle[2] = 0.0
            self.scale = 2.0 / float((high - low)[: 2 if body.shape == RECTANGLE else 3].max())
            self.top = float(high[2])
            self.corners = np.ascontiguousarray((body.corners - self.middle) * self.scale)
            self.normals = body.normals if body.shape == RECTANGLE else facing(self.corners)
            if body.shape == RECTANGLE:
                self.floor = float(self.corners[..., 2].min())
                heights = body.corners[..., 2]
                self.under = 0.5 * float(heights.min() + heights[heights > heights.min()].min())
            self._scene = EmbreeScene(robust=True)
            TriangleMesh(self._scene, self.corners.astype(np.float32))

    def cast(self, index: int, start: Hits, directions: Floats, hits: Hits) -> None:
        """Enter itself as `index` where it is nearer than what `hits` has. Rays begin at the points of `start`."""
        body = self.body
        own = start.body == index
        which = np.arange(len(directions))
        if body.shape == RECTANGLE:
            cross_window(index, body.window, body.origin, self.dual, start, directions, hits)
            which = np.flatnonzero(own & (body.clear | ~start.back))  # from one place of its grooves to another
        if self._scene is not None and len(which):
            origins, inside, _ = self._leave(start, directions[which], np.inf, which, own[which])
            row = self._first(origins.astype(np.float32), inside)
            meet_triangles(
                index, body.shape == RECTANGLE, self.floor, which, body.origin, self.dual, self.corners, self.normals,
                self.middle, self.scale, row, start, directions, hits,
            )  # fmt: skip

    def resolve(self, index: int, start: Hits, directions: Floats, hits: Hits) -> None:
        """Find point, normal and slot of the hits that are its own."""
        which = np.flatnonzero(hits.body == index)
        body = self.body
        if body.shape != RECTANGLE:
            place_on_shell(
                which, body.origin, body.axes, self.corners, self.normals, self.middle, self.scale, body.normals,
                body.coordinates, body.slot, body.bend, body.cell, body.base, body.clear, start.point, directions, hits,
            )  # fmt: skip
            return
        bare = (hits.back[which] & (not body.clear)) | (self._scene is None)
        place_on_plane(which[bare], body.axes, start.point, directions, hits)
        for own in (False, True):
            part = which[~bare & ((start.body[which] == index) == own)]
            if not len(part):
                continue
            origins, inside = np.empty((len(part), 3)), np.empty((len(part), 3))
            top, under = max(self.top, 0.0) + 1e-3 / self.scale, self.under
            if own:
                top, under = math.inf, -math.inf
            shoot(
                part, body.origin, self.dual, top, under, self.middle, self.scale, start.point, directions, origins,
                inside,
            )  # fmt: skip
            row = hits.triangle[part] if own else self._first(origins.astype(np.float32), inside)
            place_on_plate(
                part, body.origin, body.axes, self.dual, self.corners, self.normals, self.middle, self.scale, body.slot,
                body.bend, row, origins, inside, start.point, directions, hits,
            )  # fmt: skip

    def block(self, index: int, hits: Hits, towards: Floats, far: float, which: NDArray[np.int64]) -> Bools:
        """Whether it stands in the way (n,) from the points `which` of `hits` along far times `towards` (n, 3)."""
        body = self.body
        own = hits.body[which] == index
        if body.shape == RECTANGLE:
            blocked = ~own & cross_segment(body.window, body.origin, self.dual, hits.point, towards, far, which)
            own &= ~hits.back[which]
            if self._scene is None or not own.any():
                return np.asarray(blocked)
            blocked[own] = self._occluded(hits, towards[own], far, which[own])
            return np.asarray(blocked)
        return self._occluded(hits, towards, far, which, own)

    def _occluded(
        self, hits: Hits, towards: Floats, far: float, which: NDArray[np.int64], own: Bools | None = None
    ) -> Bools:
        """Whether its triangles are met. own: which of the points lie on it; all, where it is None."""
        assert self._scene is not None
        origins, directions, lengths = self._leave(hits, towards, far, which, own)
        found = self._scene.run(
            origins.astype(np.float32), directions.astype(np.float32), lengths.astype(np.float32), query="OCCLUDED"
        )
        return np.asarray(found >= 0)

    def _leave(
        self, hits: Hits, towards: Floats, far: float, which: NDArray[np.int64], own: Bools | None
    ) -> tuple[Floats, Floats, Floats]:
        """Rays from hits[which] where the body is traced: origins, unit directions, lengths."""
        count = len(which)
        origins, directions, lengths = np.empty((count, 3)), np.empty((count, 3)), np.empty(count)
        leave(
            which, np.ones(count, np.bool_) if own is None else own, self.body.origin, self.dual, self.normals,
            self.middle, self.scale, OFFSET, far, towards, hits, origins, directions, lengths,
        )  # fmt: skip
        return origins, directions, lengths

    def _first(self, origins: NDArray[np.float32], directions: Floats) -> Ints:
        assert self._scene is not None
        return np.asarray(self._scene.run(origins, directions.astype(np.float32), output=1)["primID"], np.int32)


class Truth:
    """A scene as real geometry."""

    def __init__(self, bodies: list[Body]) -> None:
        self.bodies = [Traced(body) for body in bodies]
        self.bytes = sum(body.bytes for body in bodies)

    def render(
        self, samples: int, bounces: int, seed: int, x: int, y: int, width: int, height: int, camera: Camera,
        lighting: Lighting, materials: NDArray[np.void], slots: tuple[NDArray[np.int32], ...], albedo: Floats,
        image: Floats, method: NDArray[np.uint8],
    ) -> None:  # fmt: skip
        """Write the pixels of a tile: their radiance (n, 3) and method (n,).

        samples: so many a pixel, the same places as those of `csg`. bounces: so often light is followed. slots: as
        CompiledScene.
        """
        names = np.concatenate(slots) if slots else np.zeros(0, np.int32)
        first = np.cumsum([0, *(len(slot) for slot in slots)])[[traced.body.row for traced in self.bodies]]
        clear = np.array([traced.body.clear for traced in self.bodies] + [False])
        batch = max(RAYS // samples, 1)
        for begin in range(0, width * height, batch):
            stop = min(begin + batch, width * height)
            count = (stop - begin) * samples
            directions = np.empty((count, 3))
            rays(camera, x, y, width, begin, samples, seed, directions)
            start = nowhere(count)
            start.point[:] = camera.origin
            pixel = np.repeat(np.arange(begin, stop), samples)
            number = np.tile(np.arange(samples), stop - begin)
            weight = np.full((count, 3), 1.0 / samples)
            for bounce in range(bounces + 1):
                hits = self._meet(start, directions)
                if bounce == 0:
                    method[begin:stop] = np.where((hits.body >= 0).reshape(-1, samples).any(1), GEOMETRY, NONE)
                lit = np.zeros((len(lighting.lights), len(directions)), np.bool_)
                for row, light in enumerate(lighting.lights):
                    lit[row] = self._lit(light, hits)
                last = bounce == bounces
                within = hits.back & clear[hits.body]
                gather(
                    lighting, materials, names, first, albedo, last, directions, pixel, weight, within, hits, lit, image
                )
                if not last:
                    goes = go_on(
                        materials, names, first, albedo, seed, bounce, x, y, width, pixel, number, within, directions,
                        weight, hits,
                    )  # fmt: skip
                    which = np.flatnonzero(goes)
                    if not len(which):
                        break
                    start = Hits._make(column[which] for column in hits)
                    directions, weight, pixel, number = directions[which], weight[which], pixel[which], number[which]

    def _meet(self, start: Hits, directions: Floats) -> Hits:
        """What rays from the points of `start` meet."""
        hits = nowhere(len(directions))
        for index, traced in enumerate(self.bodies):
            traced.cast(index, start, directions, hits)
        for index, traced in enumerate(self.bodies):
            traced.resolve(index, start, directions, hits)
        return hits

    def _lit(self, light: np.void, hits: Hits) -> Bools:
        """Which of the hits a light reaches."""
        towards = np.empty((len(hits.t), 3))
        which = np.flatnonzero(aim(light["kind"] == POINT, light["vector"], hits, towards))
        for index, traced in enumerate(self.bodies):
            if len(which):
                which = which[
                    ~traced.block(index, hits, towards[which], 1.0 if light["kind"] == POINT else np.inf, which)
                ]
        lit = np.zeros(len(hits.t), np.bool_)
        lit[which] = True
        return lit


@kernel
def rays(camera: Camera, x: int, y: int, width: int, begin: int, samples: int, seed: int, directions: Floats) -> None:
    """The world directions (n, 3) of the samples of a tile's pixels from number `begin` on."""
    for j in range(len(directions) // samples):
        px, py = float(x + (begin + j) % width), float(y + (begin + j) // width)
        for i in range(samples):
            _, u, v = drawn(i, PLACE, seed, px, py)
            for c in range(3):
                directions[j * samples + i, c] = (
                    camera.corner[c] + (px + u) * camera.right[c] + (py + v) * camera.down[c]
                )


@leaf
def turned(m: Floats, v: Vector) -> Vector:
    """A matrix times a vector."""
    return (
        m[0, 0] * v[0] + m[0, 1] * v[1] + m[0, 2] * v[2],
        m[1, 0] * v[0] + m[1, 1] * v[1] + m[1, 2] * v[2],
        m[2, 0] * v[0] + m[2, 1] * v[1] + m[2, 2] * v[2],
    )


@kernel
def cross_window(
    index: int, window: Floats, origin: Floats, dual: Floats, start: Hits, directions: Floats, hits: Hits
) -> None:
    """A rectangle where rays that do not begin on it cross it nearer than what they have met."""
    for k in range(len(directions)):
        if start.body[k] == index:
            continue
        at = start.point[k]
        eye = turned(dual, (at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]))
        d = turned(dual, (directions[k, 0], directions[k, 1], directions[k, 2]))
        if d[2] == 0.0:
            continue
        t = -eye[2] / d[2]
        p, q = eye[0] + t * d[0], eye[1] + t * d[1]
        if 0.0 < t < hits.t[k] and window[0] <= p <= window[2] and window[1] <= q <= window[3]:
            hits.t[k], hits.body[k], hits.triangle[k], hits.back[k] = t, index, -1, eye[2] < 0.0


@kernel
def cross_segment(
    window: Floats, origin: Floats, dual: Floats, points: Floats, towards: Floats, far: float, which: NDArray[np.int64]
) -> Bools:
    """Whether the ways from points[which] towards (n, 3) cross a rectangle."""
    crossed = np.zeros(len(which), np.bool_)
    for k in range(len(which)):
        at = points[which[k]]
        x = turned(dual, (at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]))
        d = turned(dual, (towards[k, 0], towards[k, 1], towards[k, 2]))
        if d[2] != 0.0:
            t = -x[2] / d[2]
            p, q = x[0] + t * d[0], x[1] + t * d[1]
            crossed[k] = 0.0 < t < far and window[0] <= p <= window[2] and window[1] <= q <= window[3]
    return crossed


@leaf
def reached(n: Floats, corner: Floats, origin: Floats, direction: Vector) -> float:
    """t where a ray meets a plane; NaN: nowhere."""
    slope = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2]
    if slope == 0.0:
        return math.nan
    return (n[0] * (corner[0] - origin[0]) + n[1] * (corner[1] - origin[1]) + n[2] * (corner[2] - origin[2])) / slope


@kernel
def meet_triangles(
    index: int, plate: bool, floor: float, which: NDArray[np.int64], place: Floats, dual: Floats, corners: Floats,
    normals: Floats, middle: Floats, scale: float, row: Ints, start: Hits, directions: Floats, hits: Hits,
) -> None:  # fmt: skip
    """The triangles `row` that Embree found for the rays `which`, where they are nearer than what the rays have met.

    Of a plate only the side that a ray comes from, and not the bottom, at the height `floor`.
    """
    x = np.empty(3)
    for j in range(len(which)):
        if row[j] < 0:
            continue
        k = which[j]
        corner = corners[row[j]]
        if plate and corner[0, 2] == floor and corner[1, 2] == floor and corner[2, 2] == floor:
            continue
        at = start.point[k]
        inside = turned(dual, (at[0] - place[0], at[1] - place[1], at[2] - place[2]))
        for c in range(3):
            x[c] = (inside[c] - middle[c]) * scale
        d = turned(dual, (directions[k, 0], directions[k, 1], directions[k, 2]))
        n = normals[row[j]]
        back = n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0.0
        t = reached(n, corner[0], x, d) / scale
        if 0.0 < t < hits.t[k] and not (plate and back != start.back[k]):
            hits.t[k], hits.body[k], hits.triangle[k], hits.back[k] = t, index, row[j], back


@kernel
def place_on_plane(which: NDArray[np.int64], axes: Floats, points: Floats, directions: Floats, hits: Hits) -> None:
    """The hits on a bare rectangle, or on the back of one."""
    n = unit((axes[0, 2], axes[1, 2], axes[2, 2]))
    for k in which:
        sign = -1.0 if hits.back[k] else 1.0
        for c in range(3):
            hits.point[k, c] = points[k, c] + hits.t[k] * directions[k, c]
            hits.normal[k, c] = sign * n[c]


@kernel
def shoot(
    which: NDArray[np.int64], place: Floats, dual: Floats, top: float, under: float, middle: Floats, scale: float,
    points: Floats, directions: Floats, origins: Floats, inside: Floats,
) -> None:  # fmt: skip
    """Rays for a plate's solid, where it is traced, from no higher than `top`, or no lower than `under` on their way
    up; directions are unit vectors."""
    for j in range(len(which)):
        k = which[j]
        at = points[k]
        eye = turned(dual, (at[0] - place[0], at[1] - place[1], at[2] - place[2]))
        d = turned(dual, (directions[k, 0], directions[k, 1], directions[k, 2]))
        t = max(((top if d[2] < 0.0 else under) - eye[2]) / d[2], 0.0) if d[2] != 0.0 else 0.0
        length = math.sqrt(dot(d, d))
        for c in range(3):
            origins[j, c] = (eye[c] + t * d[c] - middle[c]) * scale
            inside[j, c] = d[c] / length


@leaf
def bent(normal: Floats, bend: Floats, p: float, q: float) -> Vector:
    """The normal at (p, q): on facets swept along an arc not that of the chord."""
    if bend[2] != 0.0 or bend[3] != 0.0:
        x, y = p - bend[0], q - bend[1]
        length = math.sqrt(x * x + y * y)
        if length > 0.0:
            return bend[2] * x / length, bend[2] * y / length, bend[3]
    return normal[0], normal[1], normal[2]


@kernel
def place_on_plate(
    which: NDArray[np.int64], corner: Floats, axes: Floats, dual: Floats, corners: Floats, normals: Floats,
    middle: Floats, scale: float, slot: Ints, bend: Floats, row: Ints, origins: Floats, inside: Floats, points: Floats,
    directions: Floats, hits: Hits,
) -> None:  # fmt: skip
    """The hits on a plate's solid; where there is none the plane stands for it."""
    for j in range(len(which)):
        k, n = which[j], (0.0, 0.0, 1.0)
        t = math.nan
        d = (inside[j, 0], inside[j, 1], inside[j, 2])
        if row[j] >= 0:
            t = reached(normals[row[j]], corners[row[j], 0], origins[j], d)
        if not math.isnan(t):
            x = (
                (origins[j, 0] + t * d[0]) / scale + middle[0],
                (origins[j, 1] + t * d[1]) / scale + middle[1],
                (origins[j, 2] + t * d[2]) / scale + middle[2],
            )
            for c in range(3):
                hits.point[k, c] = corner[c] + axes[c, 0] * x[0] + axes[c, 1] * x[1] + axes[c, 2] * x[2]
            n = bent(normals[row[j]], bend[row[j]], x[0], x[1])
            hits.triangle[k], hits.slot[k] = row[j], slot[row[j]]
        else:
            for c in range(3):
                hits.point[k, c] = points[k, c] + hits.t[k] * directions[k, c]
        if hits.back[k]:
            n = (-n[0], -n[1], -n[2])
        world = unit(
            (
                n[0] * dual[0, 0] + n[1] * dual[1, 0] + n[2] * dual[2, 0],
                n[0] * dual[0, 1] + n[1] * dual[1, 1] + n[2] * dual[2, 1],
                n[0] * dual[0, 2] + n[1] * dual[1, 2] + n[2] * dual[2, 2],
            )
        )
        hits.normal[k, 0], hits.normal[k, 1], hits.normal[k, 2] = world


@leaf
def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@leaf
def carried(n: Vector, a: Vector, b: Vector, c: Vector) -> Vector:
    """A normal of pattern space, where its axes are a, b and c: times the inverse transpose."""
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    sign = 1.0 if dot(ab, c) >= 0.0 else -1.0
    return unit(
        (
            sign * (n[0] * bc[0] + n[1] * ca[0] + n[2] * ab[0]),
            sign * (n[0] * bc[1] + n[1] * ca[1] + n[2] * ab[1]),
            sign * (n[0] * bc[2] + n[1] * ca[2] + n[2] * ab[2]),
        )
    )


@leaf
def on_quadric(base: Base, normal: Floats, bend: Floats, p: float, q: float, w: float) -> Vector:
    """The normal on a sphere or a cylinder, in the object's axes, by the derivatives of `body.carry`."""
    m = base.mapping
    n = bent(normal, bend, p, q)
    lon = 2.0 * math.pi / m[0]
    turn = lon * (p - m[2])
    ct, st = math.cos(turn), math.sin(turn)
    if base.shape == CYLINDER:
        sigma = math.sqrt(lon * base.size[0] * base.size[1] / m[1])
        along = (base.size[0] + w * sigma) * lon
        return carried(
            n, (-along * st, along * ct, 0.0), (0.0, 0.0, base.size[1] / m[1]), (sigma * ct, sigma * st, 0.0)
        )
    lat = math.pi / m[1]
    tilt = lat * (q - m[3]) - 0.5 * math.pi
    cosine, sine = max(math.cos(tilt), 1e-12), math.sin(tilt)
    sigma = base.size[0] * math.sqrt(lon * lat * cosine)
    radius, change = base.size[0] + w * sigma, -0.5 * w * sigma * sine / cosine * lat
    out = (cosine * ct, cosine * st, sine)
    north = (-sine * ct, -sine * st, cosine)
    a = (-radius * lon * cosine * st, radius * lon * cosine * ct, 0.0)
    b = (
        radius * lat * north[0] + change * out[0],
        radius * lat * north[1] + change * out[1],
        radius * lat * north[2] + change * out[2],
    )
    return carried(n, a, b, (sigma * out[0], sigma * out[1], sigma * out[2]))


@leaf
def on_mesh(base: Base, cell: int, normal: Floats, bend: Floats, v: float, w: float, height: float) -> Vector:
    """The normal on a triangle mesh, by its smooth normals; v, w weigh the triangle's second and third corner."""
    x, pq, smooth, rise = base.corners[cell], base.pq[cell], base.normals[cell], base.rise[cell]
    u = 1.0 - v - w
    up = unit(
        (
            u * smooth[0, 0] + v * smooth[1, 0] + w * smooth[2, 0],
            u * smooth[0, 1] + v * smooth[1, 1] + w * smooth[2, 1],
            u * smooth[0, 2] + v * smooth[1, 2] + w * smooth[2, 2],
        )
    )
    p1, q1, p2, q2 = pq[1, 0] - pq[0, 0], pq[1, 1] - pq[0, 1], pq[2, 0] - pq[0, 0], pq[2, 1] - pq[0, 1]
    area = p1 * q2 - p2 * q1
    if area == 0.0 or (normal[0] == 0.0 and normal[1] == 0.0 and bend[2] == 0.0):
        return up if normal[2] >= 0.0 else (-up[0], -up[1], -up[2])
    one, two = np.empty(3), np.empty(3)
    for c in range(3):  # the edges of the triangle raised to this height
        ground = x[0, c] + height * rise[0] * smooth[0, c]
        one[c] = x[1, c] + height * rise[1] * smooth[1, c] - ground
        two[c] = x[2, c] + height * rise[2] * smooth[2, c] - ground
    for c in range(3):
        one[c], two[c] = (q2 * one[c] - q1 * two[c]) / area, (p1 * two[c] - p2 * one[c]) / area
    i = one[0] * up[0] + one[1] * up[1] + one[2] * up[2]
    j = two[0] * up[0] + two[1] * up[1] + two[2] * up[2]
    sigma = u * rise[0] + v * rise[1] + w * rise[2]
    return carried(
        bent(normal, bend, pq[0, 0] + v * p1 + w * p2, pq[0, 1] + v * q1 + w * q2),
        (one[0] - i * up[0], one[1] - i * up[1], one[2] - i * up[2]),
        (two[0] - j * up[0], two[1] - j * up[1], two[2] - j * up[2]),
        (sigma * up[0], sigma * up[1], sigma * up[2]),
    )


@kernel
def place_on_shell(
    which: NDArray[np.int64], place: Floats, axes: Floats, corners: Floats, normals: Floats, middle: Floats,
    scale: float, patterned: Floats, coordinates: Floats, slot: Ints, bend: Floats, cell: Ints, base: Base,
    clear: bool, points: Floats, directions: Floats, hits: Hits,
) -> None:  # fmt: skip
    """The hits on a curved body. Seen from behind an opaque surface is bare."""
    bare, straight = np.array([0.0, 0.0, 1.0]), np.zeros(4)
    for k in which:
        row = hits.triangle[k]
        n = (normals[row, 0], normals[row, 1], normals[row, 2])
        at = np.empty(3)
        for c in range(3):
            at[c] = points[k, c] + hits.t[k] * directions[k, c]
            hits.point[k, c] = at[c]
        if cell[row] >= 0:
            # Where in the triangle, and so where in pattern space.
            x = np.empty(3)
            for c in range(3):
                inside = 0.0
                for m in range(3):
                    inside += axes[m, c] * (at[m] - place[m])  # a rotation: its inverse is its transpose
                x[c] = (inside - middle[c]) * scale
            e1 = (
                corners[row, 1, 0] - corners[row, 0, 0],
                corners[row, 1, 1] - corners[row, 0, 1],
                corners[row, 1, 2] - corners[row, 0, 2],
            )
            e2 = (
                corners[row, 2, 0] - corners[row, 0, 0],
                corners[row, 2, 1] - corners[row, 0, 1],
                corners[row, 2, 2] - corners[row, 0, 2],
            )
            r = (x[0] - corners[row, 0, 0], x[1] - corners[row, 0, 1], x[2] - corners[row, 0, 2])
            area = dot(cross(e1, e2), n)
            v = min(max(dot(cross(r, e2), n) / area, 0.0), 1.0) if area > 0.0 else 0.0
            w = min(max(dot(cross(e1, r), n) / area, 0.0), 1.0 - v) if area > 0.0 else 0.0
            y = coordinates[row]
            p = y[0, 0] + v * (y[1, 0] - y[0, 0]) + w * (y[2, 0] - y[0, 0])
            q = y[0, 1] + v * (y[1, 1] - y[0, 1]) + w * (y[2, 1] - y[0, 1])
            h = y[0, 2] + v * (y[1, 2] - y[0, 2]) + w * (y[2, 2] - y[0, 2])
            shown = clear or not hits.back[k]
            facet, arc = patterned[row] if shown else bare, bend[row] if shown else straight
            if base.shape == MESH:
                smooth = on_mesh(base, cell[row], facet, arc, p, q, h)
                d = (directions[k, 0], directions[k, 1], directions[k, 2])
                if dot(smooth, d) * dot(n, d) > 0.0:  # else the viewer would see it from behind
                    n = smooth
            else:
                n = on_quadric(base, facet, arc, p, q, h)
        sign = -1.0 if hits.back[k] else 1.0
        if clear or not hits.back[k]:
            hits.slot[k] = slot[row]
        for c in range(3):
            hits.normal[k, c] = sign * (axes[c, 0] * n[0] + axes[c, 1] * n[1] + axes[c, 2] * n[2])


@kernel
def aim(point: bool, vector: Floats, hits: Hits, towards: Floats) -> Bools:
    """Which hits face a light; the ways to it (n, 3), for a light at a point as long as they are."""
    faces = np.zeros(len(towards), np.bool_)
    for k in range(len(towards)):
        if hits.body[k] >= 0:
            along = 0.0
            for c in range(3):
                towards[k, c] = vector[c] - hits.point[k, c] if point else vector[c]
                along += towards[k, c] * hits.normal[k, c]
            faces[k] = along > 0.0
    return faces


@kernel
def leave(
    which: NDArray[np.int64], own: Bools, place: Floats, dual: Floats, normals: Floats, middle: Floats, scale: float,
    offset: float, far: float, towards: Floats, hits: Hits, origins: Floats, directions: Floats, lengths: Floats,
) -> None:  # fmt: skip
    """Rays from hits, where a body is traced: origins, off the surface where it is `own`, unit directions, lengths."""
    for j in range(len(which)):
        k = which[j]
        at = hits.point[k]
        x = turned(dual, (at[0] - place[0], at[1] - place[1], at[2] - place[2]))
        d = turned(dual, (towards[j, 0], towards[j, 1], towards[j, 2]))
        length = math.sqrt(dot(d, d))
        off = 0.0
        row = hits.triangle[k]
        if own[j]:
            off = -offset if hits.back[k] else offset
        for c in range(3):
            origins[j, c] = (x[c] - middle[c]) * scale
            if off != 0.0:
                origins[j, c] += off * (normals[row, c] if row >= 0 else (1.0 if c == 2 else 0.0))
            directions[j, c] = d[c] / length
        lengths[j] = min(far * length * scale, 1e30)


@kernel
def gather(
    lighting: Lighting, materials: NDArray[np.void], names: Ints, first: NDArray[np.int64], albedo: Floats, last: bool,
    directions: Floats, pixel: NDArray[np.int64], weight: Floats, within: Bools, hits: Hits, lit: Bools, image: Floats,
) -> None:  # fmt: skip
    """Add what the rays see to their pixels. names: material rows of all bodies, each from `first` on.

    The last time surfaces are lit by all of the sky; before that rays go on to find what they see of it. From `within`
    clear bodies (n,) surfaces show no light but their own.
    """
    lighting = borrow(lighting)
    lights = lighting.lights
    for k in range(len(directions)):
        if hits.body[k] < 0:
            red, green, blue = sky_from(lighting, unit((directions[k, 0], directions[k, 1], directions[k, 2])))
        else:
            n = (hits.normal[k, 0], hits.normal[k, 1], hits.normal[k, 2])
            at = (hits.point[k, 0], hits.point[k, 1], hits.point[k, 2])
            e = unit((-directions[k, 0], -directions[k, 1], -directions[k, 2]))
            material = materials[names[first[hits.body[k]] + hits.slot[k] + 1]]
            red, green, blue = material.emissive[0], material.emissive[1], material.emissive[2]
            if last and not within[k]:
                red, green, blue = ambient(material, lighting, albedo, n, e)
            for l in range(0 if within[k] else len(lights)):
                if lit[l, k]:
                    colour = lit_by(lights[l], material, n, e, at)
                    red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
        image[pixel[k], 0] += weight[k, 0] * red
        image[pixel[k], 1] += weight[k, 1] * green
        image[pixel[k], 2] += weight[k, 2] * blue


@kernel
def go_on(
    materials: NDArray[np.void], names: Ints, first: NDArray[np.int64], albedo: Floats, seed: int, bounce: int, x: int,
    y: int, width: int, pixel: NDArray[np.int64], number: NDArray[np.int64], within: Bools, directions: Floats,
    weight: Floats, hits: Hits,
) -> Bools:  # fmt: skip
    """Which rays are followed on from what they hit; their directions and weights are made those of the next ones.

    number: of a pixel's samples, over which directions are spread evenly.
    """
    goes = np.zeros(len(directions), np.bool_)
    for k in range(len(directions)):
        if hits.body[k] < 0:
            continue
        n = (hits.normal[k, 0], hits.normal[k, 1], hits.normal[k, 2])
        e = unit((-directions[k, 0], -directions[k, 1], -directions[k, 2]))
        material = materials[names[first[hits.body[k]] + hits.slot[k] + 1]]
        px, py = float(x + pixel[k] % width), float(y + pixel[k] // width)
        lobe, u, v = drawn(number[k], bounce, seed, px, py + 0.5)
        direction, colour = scatter(material, albedo, n, e, lobe, u, v, within[k])
        if max(colour[0], colour[1], colour[2]) <= 0.0:
            continue
        goes[k] = True
        if dot(n, direction) < 0.0:
            hits.back[k] = not hits.back[k]
            at = (hits.point[k, 0], hits.point[k, 1], hits.point[k, 2])
            back = TOUCH * (1.0 + math.sqrt(dot(at, at))) if within[k] else 0.0  # it may touch another body there
            for c in range(3):
                hits.point[k, c] -= back * direction[c]
        for c in range(3):
            directions[k, c] = direction[c]
            weight[k, c] *= colour[c]
    return goes
