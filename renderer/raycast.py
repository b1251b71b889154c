"""Rays against the bare shapes of a scene. Embree holds the meshes; only `trace` knows it besides.

Embree finds the triangle, in single precision; where on it the ray passes is found again in double precision, so that
a footprint on a mesh is as exact as on a plane.
"""

from __future__ import annotations

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from renderer.geometry.shapes import (
    NEXT_TO,
    NO_TRIANGLES,
    Triangles,
    block,
    cast,
    cast_triangles,
    frames_at,
    shade,
    shade_hits,
    shells,
)
from renderer.tables import FRAME, HIT, POINT, Floats, Ints

Bools = NDArray[np.bool_]

START = 1e-5  # rays leave a mesh by this part of half the meshes' extent: single precision meets it again


def ways(light: np.void, points: Floats) -> tuple[Floats, Floats]:
    """From points (n, 3) to a light, (n, 3), and how many times that far (n,) it is."""
    if light["kind"] == POINT:
        return light["vector"] - points, np.full(len(points), NEXT_TO)
    return np.broadcast_to(light["vector"], points.shape), np.full(len(points), np.inf)


class Caster:
    """The shapes of a scene, ready for rays."""

    def __init__(
        self, objects: NDArray[np.void], triangles: Triangles = NO_TRIANGLES, bent: bool = False,
        heights: Floats | None = None,
    ) -> None:  # fmt: skip
        """bent: the frames of bare surfaces know how they are curved, too, as what they mirror asks for. heights:
        (n, 2) of each row of OBJECT, how high and how deep its grooves are, pattern units; nought, where it is None."""
        self.bent = bent
        self.objects = objects
        self.shells = None if heights is None else shells(objects, heights)
        self.triangles = triangles
        self._embree: EmbreeScene | None = None
        self._size = 1.0
        if len(triangles.corners):
            # Single precision is finest around 0.
            self._middle = 0.5 * (triangles.corners.min(axis=(0, 1)) + triangles.corners.max(axis=(0, 1)))
            corners = triangles.corners - self._middle
            self._size = float(np.abs(corners).max())
            self._embree = EmbreeScene(robust=True)
            TriangleMesh(self._embree, np.ascontiguousarray(corners, np.float32))

    @property
    def start(self) -> float:
        """How far off a mesh rays must begin, world units."""
        return START * self._size if self._embree is not None else 0.0

    @property
    def shadows(self) -> bool:
        """Whether one part of the scene may stand in the light of another: not on a single convex shape."""
        return len(self.objects) > 1 or self._embree is not None

    def shell_hits(self, origin: Floats, directions: Floats) -> NDArray[np.void]:
        """The nearest HIT (n,) of rays from `origin` (3,) with the outsides of shells."""
        assert self.shells is not None
        hits = np.zeros(len(directions), HIT)
        origins = np.ascontiguousarray(np.broadcast_to(origin, directions.shape))
        cast(self.shells.outer, origins, directions, np.full(len(hits), -1, np.int32), hits)
        return hits

    def hits(self, origin: Floats, directions: Floats, own: Ints | None = None) -> NDArray[np.void]:
        """The nearest HIT (n,) of each ray from `origin` (3,) or (n, 3) along `directions` (n, 3).

        own: (n,) as `shapes.cast`: of OBJECT the row that each ray leaves and, if it is no mesh, does not meet again.
        """
        hits = np.zeros(len(directions), HIT)
        origins = np.ascontiguousarray(np.broadcast_to(origin, directions.shape))
        cast(self.objects, origins, directions, np.full(len(hits), -1, np.int32) if own is None else own, hits)
        if self._embree is not None and len(directions):
            found = self._embree.run(
                (origins - self._middle).astype(np.float32), directions.astype(np.float32), output=1
            )
            cast_triangles(self.triangles, origins, directions, found["primID"].astype(np.int32), hits)
        return hits

    def frames(self, origin: Floats, directions: Floats, hits: NDArray[np.void]) -> tuple[NDArray[np.void], Ints]:
        """The tangent FRAMEs at the hits (n,), and which (n,) is each one's, -1 a miss's; the origin is (3,) or (n, 3).
        On a side of a rectangle all have the first one's."""
        frames, of = np.empty(len(hits), FRAME), np.empty(len(hits), np.int32)
        origins = np.ascontiguousarray(np.broadcast_to(origin, directions.shape))
        made = frames_at(self.objects, self.triangles, origins, directions, hits, self.bent, frames, of)
        return frames[:made], of

    def blocked(
        self, origin: Floats, directions: Floats, hits: NDArray[np.void], lights: NDArray[np.void]
    ) -> NDArray[np.uint64]:
        """For each hit (n,) a mask whose bit l says that something stands between it and light l.

        A convex shape does not block itself: its facets know which way they face.
        """
        mask = np.zeros(len(hits), np.uint64)
        if not self.shadows:
            return mask
        origins = np.ascontiguousarray(np.broadcast_to(origin, directions.shape))
        shade_hits(self.objects, lights, origins, directions, hits, mask)
        if self._embree is not None:
            which = np.flatnonzero(hits["object"] >= 0)
            points = origins[which] + hits["t"][which, None] * directions[which]
            normals = hits["normal"][which]
            normals *= -np.copysign(1.0, np.einsum("ij,ij->i", normals, directions[which]))[:, None]
            start = points + normals * self.start
            for index, light in enumerate(lights):
                bit, to_light = np.uint64(1) << np.uint64(index), ways(light, points)[0]
                facing = (mask[which] & bit == 0) & (np.einsum("ij,ij->i", normals, to_light) > 0.0)
                if facing.any():
                    stopped = self._occluded(start[facing], to_light[facing], light["kind"] == POINT)
                    mask[which[facing][stopped]] |= bit
        return mask

    def blocked_off(self, points: Floats, own: Ints, lights: NDArray[np.void]) -> NDArray[np.uint64]:
        """The same for points (n, 3) of the grooves of the objects `own` (n,), none of them a mesh."""
        mask = np.zeros(len(points), np.uint64)
        if not self.shadows:
            return mask
        shade(self.objects, lights, points, own, mask)
        if self._embree is not None and len(points):
            for index, light in enumerate(lights):
                stopped = self._occluded(points, ways(light, points)[0], light["kind"] == POINT)
                mask[stopped] |= np.uint64(1) << np.uint64(index)
        return mask

    def stopped(self, points: Floats, towards: Floats, far: Floats, own: Ints) -> Bools:
        """Whether another object stands in each of the ways `towards` (n, 3) from points (n, 3) of the objects `own`
        (n,), none of them a mesh, before `far` (n,) times that."""
        blocked = np.zeros(len(points), np.bool_)
        block(self.objects, np.ascontiguousarray(points), np.ascontiguousarray(towards), far, own, blocked)
        if self._embree is not None and len(points):
            blocked |= self._occluded(points, towards, bool(np.isfinite(far).all()))
        return blocked

    def _occluded(self, start: Floats, to_light: Floats, bounded: bool) -> Bools:
        """Whether a mesh stands in the way from each point (n, 3), for lights at a place not beyond it."""
        assert self._embree is not None
        far = np.sqrt(np.einsum("ij,ij->i", to_light, to_light))
        distances = far if bounded else np.full(len(start), 1e30)
        along = to_light / far[:, None]
        hits = self._embree.run(
            (start - self._middle).astype(np.float32), along.astype(np.float32),
            distances.astype(np.float32), query="OCCLUDED",
        )  # fmt: skip
        return np.asarray(hits >= 0)


class Mirrored:
    """The shapes of a scene as the eye's image sees them, through the rectangle that it is the image in."""

    def __init__(self, shapes: Caster, row: int) -> None:
        """row: of OBJECT, the mirror."""
        self._shapes, self._row = shapes, row
        self.objects, self.shells, self.shadows = shapes.objects, shapes.shells, shapes.shadows
        self.frames, self.blocked, self.blocked_off = shapes.frames, shapes.blocked, shapes.blocked_off

    def _through(self, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
        """Where rays pass the mirror's plane, (n, 3), and how far off that is (n,) in lengths of their directions."""
        normal, place = self.objects["rotation"][self._row][:, 2], self.objects["translation"][self._row]
        far = float(normal @ (place - origin)) / (directions @ normal)
        return origin + far[:, None] * directions, far

    def hits(self, origin: Floats, directions: Floats) -> NDArray[np.void]:
        """As `Caster.hits`, of rays from the eye's image; of those that have an origin each, as they are."""
        if origin.ndim > 1:
            return self._shapes.hits(origin, directions)
        start, far = self._through(origin, directions)
        hits = self._shapes.hits(start, directions, np.full(len(directions), self._row, np.int32))
        hits["t"] += far
        return hits

    def shell_hits(self, origin: Floats, directions: Floats) -> NDArray[np.void]:
        """As `Caster.shell_hits`."""
        start, far = self._through(origin, directions)
        hits = self._shapes.shell_hits(start, directions)
        hits["t"] += far
        return hits
