"""Method `geometry`: the solid as a real mesh, traced by Embree with n stratified samples a footprint.

The ground truth and the peer of the analytic methods. Rays are traced in pattern space, shrunk so that the window
fills [-1, 1]: Embree's single precision is finest there. What Embree finds is met again in double precision, and
shadow rays start OFFSET above it. Too small an offset makes facets shade themselves, too large a one lets light leak
under ridges: the part of a groove's width that is wrongly lit at a shadow's edge is about OFFSET over that width,
which for a groove of 1/250 of the window is 1e-4.
"""

from __future__ import annotations

import math

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from renderer.geometry.random import jitter, seed_of
from renderer.geometry.view import on_plane, view_of
from renderer.kernel import kernel
from renderer.shading import ambient, light_to_pattern, lit_by, normal_to_world, to_world, unit
from renderer.tables import GEOMETRY, Camera, Floats, Ints, Lighting

OFFSET = 4e-7
RAYS = 1 << 18  # traced at a time


class Solid:
    """A flat object's solid, ready for rays."""

    def __init__(self, vertices: Floats, triangles: Ints, slot: Ints) -> None:
        """vertices (n, 3) pattern units, triangles (m, 3) outward, slot (m,) material slots; -1: the object's own."""
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        self.middle = 0.5 * (low + high)
        self.middle[2] = 0.0
        self.scale = 2.0 / float(max(high[0] - low[0], high[1] - low[1]))
        self.top = float(high[2])
        self.corners = np.ascontiguousarray((vertices[triangles] - self.middle) * self.scale)
        self.slot = slot
        normals = np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        self.normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0)
        self._scene = EmbreeScene(robust=True)
        TriangleMesh(self._scene, self.corners.astype(np.float32))

    @property
    def bytes(self) -> int:
        """Memory of the mesh alone, single precision, as a tracer needs it."""
        return len(self.corners) * 3 * 4 + len(np.unique(self.corners.reshape(-1, 3), axis=0)) * 12

    def first(self, origins: Floats, directions: Floats) -> Ints:
        """The nearest triangle (n,) of each ray, -1: none."""
        return np.asarray(
            self._scene.run(origins.astype(np.float32), directions.astype(np.float32), output=1)["primID"], np.int32
        )

    def blocked(self, origins: Floats, directions: Floats, far: Floats) -> NDArray[np.bool_]:
        """Whether anything stands in the way of each ray (n,) within `far`."""
        found = self._scene.run(
            origins.astype(np.float32), directions.astype(np.float32), far.astype(np.float32), query="OCCLUDED"
        )
        return np.asarray(found >= 0)


def trace(
    solid: Solid, samples: int, seed: int, footprints: NDArray[np.void], chosen: NDArray[np.int64],
    frames: NDArray[np.void], camera: Camera, lighting: Lighting, materials: NDArray[np.void],
    slots: NDArray[np.int32], albedo: Floats, radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one flat object; write their radiance (n, 3) and method.

    samples: at least so many a footprint, in a grid of strata. slots: rows of `materials`, the object's own first.
    """
    columns = math.ceil(math.sqrt(samples))
    rows = math.ceil(samples / columns)
    batch = max(RAYS // (columns * rows), 1)
    for begin in range(0, len(chosen), batch):
        part = chosen[begin : begin + batch]
        count = len(part) * columns * rows
        origins, directions = np.empty((count, 3)), np.empty((count, 3))
        shoot(
            footprints,
            part,
            frames,
            camera,
            columns,
            rows,
            seed,
            solid.middle,
            solid.scale,
            solid.top,
            origins,
            directions,
        )
        row = solid.first(origins, directions)
        points = np.empty((count, 3))
        meet(solid.corners, solid.normals, row, origins, directions, points)
        lit = np.zeros((len(lighting.lights), count), np.bool_)
        for index in range(len(lighting.lights)):
            facing = np.zeros(count, np.bool_)
            towards, far = np.zeros((count, 3)), np.zeros(count)
            aim(
                footprints, part, frames, lighting.lights[index : index + 1], index, columns * rows, solid.middle,
                solid.scale,
                points, solid.normals, row, facing, towards, far,
            )  # fmt: skip
            which = np.flatnonzero(facing)
            if len(which):
                start = points[which] + OFFSET * solid.normals[row[which]]
                lit[index, which] = ~solid.blocked(start, towards[which], far[which])
        gather(
            footprints, part, frames, lighting, materials, slots, albedo, columns * rows, solid.middle, solid.scale,
            points, solid.normals, solid.slot, row, lit, radiance,
        )  # fmt: skip
    method[chosen] = GEOMETRY


@kernel
def shoot(
    footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera, columns: int,
    rows: int, seed: int, middle: Floats, scale: float, top: float, origins: Floats, directions: Floats,
) -> None:  # fmt: skip
    """The samples' rays in the solid's space, from just above its highest point."""
    k = 0
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        state = seed_of(seed, footprint.x, footprint.y)
        for i in range(columns * rows):
            state, ju = jitter(state)
            state, jv = jitter(state)
            p, q = on_plane(view, (i % columns + ju) / columns, (i // columns + jv) / rows)
            dp, dq, dw = p - frame.eye[0], q - frame.eye[1], -frame.eye[2]
            height = min(max(top, 0.0) + 1e-3 / scale, frame.eye[2])
            t = height / frame.eye[2]
            origins[k, 0], origins[k, 1] = (p - t * dp - middle[0]) * scale, (q - t * dq - middle[1]) * scale
            origins[k, 2] = height * scale
            length = math.sqrt(dp * dp + dq * dq + dw * dw)
            directions[k, 0], directions[k, 1], directions[k, 2] = dp / length, dq / length, dw / length
            k += 1


@kernel
def meet(corners: Floats, normals: Floats, row: Ints, origins: Floats, directions: Floats, points: Floats) -> None:
    """Where the rays meet the planes of their triangles."""
    for k in range(len(row)):
        t = 0.0
        if row[k] >= 0:
            n, c, o, d = normals[row[k]], corners[row[k], 0], origins[k], directions[k]
            slope = n[0] * d[0] + n[1] * d[1] + n[2] * d[2]
            if slope != 0.0:
                t = (n[0] * (c[0] - o[0]) + n[1] * (c[1] - o[1]) + n[2] * (c[2] - o[2])) / slope
        for c in range(3):
            points[k, c] = origins[k, c] + t * directions[k, c]


@kernel
def aim(
    footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void], lights: NDArray[np.void],
    bit: int, samples: int, middle: Floats, scale: float, points: Floats, normals: Floats, row: Ints,
    facing: NDArray[np.bool_], towards: Floats, far: Floats,
) -> None:  # fmt: skip
    """For each point that faces the light (of one row): the way to it in the solid's space, and how far it is."""
    for j in range(len(chosen)):
        footprint = footprints[chosen[j]]
        if (footprint.blocked >> np.uint64(bit)) & np.uint64(1):
            continue
        d = light_to_pattern(frames[footprint.frame], lights[0])
        if d[2] <= 0.0:
            continue
        for k in range(j * samples, (j + 1) * samples):
            if row[k] < 0:
                continue
            n = normals[row[k]]
            x = (d[0] - d[3] * middle[0]) * scale - d[3] * points[k, 0]
            y = (d[1] - d[3] * middle[1]) * scale - d[3] * points[k, 1]
            z = d[2] * scale - d[3] * points[k, 2]
            if n[0] * x + n[1] * y + n[2] * z <= 0.0:
                continue
            length = math.sqrt(x * x + y * y + z * z)
            facing[k] = True
            towards[k, 0], towards[k, 1], towards[k, 2] = x / length, y / length, z / length
            far[k] = 1e30 if d[3] == 0.0 else length


@kernel
def gather(
    footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void], lighting: Lighting,
    materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats, samples: int, middle: Floats, scale: float,
    points: Floats, normals: Floats, slot: Ints, row: Ints, lit: NDArray[np.bool_], radiance: Floats,
) -> None:  # fmt: skip
    """Shade the samples and write the footprints' means."""
    lights = lighting.lights
    for j in range(len(chosen)):
        index = chosen[j]
        frame = frames[footprints[index].frame]
        eye = to_world(frame, frame.eye[0], frame.eye[1], frame.eye[2])
        red = green = blue = 0.0
        for k in range(j * samples, (j + 1) * samples):
            if row[k] < 0:
                continue
            n = normals[row[k]]
            n_world = normal_to_world(frame, (n[0], n[1], n[2]))
            at = to_world(
                frame, points[k, 0] / scale + middle[0], points[k, 1] / scale + middle[1], points[k, 2] / scale
            )
            e = unit((eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]))
            material = materials[slots[slot[row[k]] + 1]]
            colour = ambient(material, lighting.sky, albedo, n_world, e)
            red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
            for l in range(len(lights)):
                if lit[l, k]:
                    colour = lit_by(lights[l], material, n_world, e, at)
                    red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
        radiance[index, 0], radiance[index, 1], radiance[index, 2] = red / samples, green / samples, blue / samples
