"""Objects as real geometry: the solid of DESIGN 1.2 as triangles, on flat objects exact, on others carried over.

A flat object's solid stays in pattern space, which an affine map joins to the world. On a curved one the point
(p, q, w) of pattern space is carried to S(p, q) + w G(p, q), with S the surface and G = sigma N the way that one
pattern unit of height goes. Each triangle is first cut along the cells of a grid (on triangle meshes: along their
triangles), so fine that cutting it finer changes nothing. On meshes sigma is the mean at the corners, as it must be
the same for all triangles that meet there, and G goes linearly between them.

Nothing here is shared with the analytic methods but the compiled tables.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from manifold3d import CrossSection, FillRule, triangulate
from numpy.typing import NDArray

from renderer import mesh
from renderer.geometry.overlay import bins, cut_by_grid, cut_by_triangles
from renderer.geometry.shapes import Triangles
from renderer.tables import BARE, CYLINDER, MESH, POINT, RECTANGLE, SPHERE, Floats, Ints, Pattern

CELL = 0.009  # of the grid on spheres and cylinders, radians: chords leave the surface by 1e-5 of its radius
LIMIT = 12_000_000
"""The most triangles of a body."""

_BOUNCE = 8.0
"""Heights and widths of the pattern's grooves: how far beyond a plate's edge a bounce is followed along them."""
_SLIVER = 1e-7  # of the seam's length squared: less of a wall is none
_FAR = 400.0  # heights of the pattern: how far beyond a plate's edge grooves still stand in the light


class Base(NamedTuple):
    """What a curved object's pattern is carried onto. Vectors and points are in the object's axes."""

    shape: int  # SPHERE, CYLINDER, MESH
    size: Floats  # (2,) as OBJECT
    mapping: Floats  # (4,) as OBJECT
    corners: Floats  # (n, 3, 3) of a mesh, world
    pq: Floats  # (n, 3, 2) pattern coordinates of its corners
    normals: Floats  # (n, 3, 3) at its corners
    rise: Floats  # (n, 3) sigma at its corners


@dataclass(frozen=True)
class Body:
    """An object's triangles: `corners` where they are traced, `coordinates` in pattern space.

    Rectangles are traced in pattern space itself, spheres and cylinders in the object's axes, meshes in the world.
    """

    row: int  # of OBJECT
    shape: int
    origin: Floats  # (3,) world, and
    axes: Floats  # (3, 3): world = origin + axes x, for x as in `corners`
    window: Floats  # (4,) p0, q0, p1, q1 of the object in pattern space
    corners: Floats  # (m, 3, 3); (0, 3, 3): a bare rectangle
    normals: Floats  # (m, 3) unit, in pattern space
    coordinates: Floats  # (m, 3, 3) (p, q, w); on meshes the weights of the base's second and third corner, and w
    slot: Ints  # (m,) as SolidMesh
    bend: Floats  # (m, 4) as SolidMesh
    cell: Ints  # (m,) the mesh's triangle, for other curved shapes not negative; -1: a cap of a cylinder
    base: Base
    clear: bool  # light goes on inside
    bytes: int  # memory of the mesh alone, as a tracer needs it: single precision, shared corners


_NOTHING = np.zeros((0, 3, 3))
_NO_BASE = Base(RECTANGLE, np.zeros(2), np.ones(4), _NOTHING, np.zeros((0, 3, 2)), _NOTHING, np.zeros((0, 3)))


def build(
    row: int, obj: np.void, pattern: Pattern, triangles: Triangles, eye: Floats, lights: NDArray[np.void], bounces: int
) -> Body:  # fmt: skip
    """The body of an object, row `row` of OBJECT. Raises ValueError where it would have too many triangles.

    eye (3,), lights (LIGHT) and how often light is followed say how far a plate's surroundings matter.
    """
    if obj["shape"] == RECTANGLE:
        return _plate(row, obj, pattern, eye, lights, bounces)
    return _shell(row, obj, pattern, triangles)


def plate_axes(obj: np.void) -> tuple[Floats, Floats]:
    """Of a rectangle: the world point of the pattern's origin, and the columns dP/dp, dP/dq, sigma N."""
    su, sv, du, dv = obj["mapping"]
    turn = np.asarray(obj["rotation"], np.float64)
    a, b = turn[:, 0] * obj["size"][0] / su, turn[:, 1] * obj["size"][1] / sv
    sigma = math.sqrt(obj["size"][0] / su * obj["size"][1] / sv)
    corner = obj["translation"] - 0.5 * (turn[:, 0] * obj["size"][0] + turn[:, 1] * obj["size"][1])
    return corner - du * a - dv * b, np.stack([a, b, sigma * turn[:, 2]], axis=1)


def _window(obj: np.void) -> Floats:
    su, sv, du, dv = (float(value) for value in obj["mapping"])
    return np.array([du, dv, du + su, dv + sv])


def _plate(row: int, obj: np.void, pattern: Pattern, eye: Floats, lights: NDArray[np.void], bounces: int) -> Body:
    origin, axes = plate_axes(obj)
    window = _window(obj)
    corners, normals, slot, bend, size = _NOTHING, np.zeros((0, 3)), np.zeros(0, np.int32), np.zeros((0, 4)), 0
    if len(pattern.pieces):
        margin = _margin(pattern, window, origin, axes, eye, lights)
        margin += bounces * _BOUNCE * (pattern.height + pattern.depth + 2.0 * pattern.width)
        made = mesh.build(pattern, tuple(window), margin=margin)
        corners, slot, bend = np.ascontiguousarray(made.vertices[made.triangles]), made.slot, made.bend
        normals = facing(corners)
        size = 12 * (len(made.vertices) + len(made.triangles))
    return Body(
        row, RECTANGLE, origin, axes, window, corners, normals, corners, slot, bend, np.zeros(len(slot), np.int32),
        _NO_BASE, bool(obj["clear"]), size,
    )  # fmt: skip


def _margin(
    pattern: Pattern, window: Floats, origin: Floats, axes: Floats, eye: Floats, lights: NDArray[np.void]
) -> float:  # fmt: skip
    """How far the solid goes on past the object's edge, to be seen under it and to throw shadows, pattern units."""
    tall = pattern.height + pattern.depth
    dual = np.linalg.inv(axes)
    ends = np.array([[window[i], window[j]] for i in (0, 2) for j in (1, 3)])

    def reach(place: Floats, point: bool) -> float:
        """How far a line from the window's deepest point to `place` goes sideways on its way through the grooves."""
        if not point:
            x = dual @ place
            return tall * float(np.hypot(x[0], x[1])) / float(x[2]) if x[2] > 0.0 else 0.0
        x = dual @ (place - origin)
        far = float(np.hypot(ends[:, 0] - x[0], ends[:, 1] - x[1]).max())
        return 0.0 if x[2] <= -pattern.depth else far * min(tall / (x[2] + pattern.depth), 1.0)

    # How far beyond the window what is seen through it lies, or what hides it; and then what shades that.
    x = dual @ (eye - origin)
    far = float(np.hypot(ends[:, 0] - x[0], ends[:, 1] - x[1]).max())
    seen = far * max(pattern.depth, pattern.height) / float(x[2]) if x[2] > 0.0 else 0.0
    shaded = max((reach(light["vector"], light["kind"] == POINT) for light in lights), default=0.0)
    size = max(window[2] - window[0], window[3] - window[1])
    return float(min(seen + shaded, _FAR * tall, 4.0 * size) + 0.01 * size)


def _shell(row: int, obj: np.void, pattern: Pattern, triangles: Triangles) -> Body:
    window = _window(obj)
    shape = int(obj["shape"])
    origin, axes = np.array(obj["translation"], np.float64), np.array(obj["rotation"], np.float64)
    base = round_base(obj)
    if shape == MESH:
        origin, axes = np.zeros(3), np.eye(3)
        base = mesh_base(row, obj, triangles, carries=pattern is not BARE)
        window = np.array([*base.pq.min(axis=(0, 1)), *base.pq.max(axis=(0, 1))])
        if pattern is BARE:
            count = len(base.corners)
            coordinates = np.tile([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], (count, 1, 1))
            return Body(
                row, shape, origin, axes, window, base.corners, np.tile([0.0, 0.0, 1.0], (count, 1)), coordinates,
                np.full(count, -1, np.int32), np.zeros((count, 4)), np.arange(count, dtype=np.int32), base,
                bool(obj["clear"]), 18 * count,
            )  # fmt: skip
    flat, slot, bend = sheet(pattern, window)
    if shape != MESH:
        kept, walls = _seamed(flat, window)
        flat = np.concatenate([flat[kept], walls])
        slot = np.concatenate([slot[kept], np.full(len(walls), -1, np.int32)])
        bend = np.concatenate([bend[kept], np.zeros((len(walls), 4))])
    coordinates, source, cell = cut(base, flat, CELL, LIMIT)
    if shape == MESH:
        coordinates[..., :2] = barycentric(base.pq[cell], coordinates[..., :2])[..., 1:]
    corners = carry(base, coordinates, cell)
    normals, slot, bend = facing(flat)[source], slot[source], bend[source]
    if shape == CYLINDER:
        caps = _caps(base, float(flat[:, :, 2].min()))
        corners, coordinates = np.concatenate([corners, caps]), np.concatenate([coordinates, np.zeros_like(caps)])
        normals = np.concatenate([normals, np.tile([0.0, 0.0, 1.0], (len(caps), 1))])
        slot = np.concatenate([slot, np.full(len(caps), -1, np.int32)])
        bend, cell = np.concatenate([bend, np.zeros((len(caps), 4))]), np.concatenate([cell, np.full(len(caps), -1)])
    return Body(
        row, shape, origin, axes, window, np.ascontiguousarray(corners), np.ascontiguousarray(normals),
        np.ascontiguousarray(coordinates), slot, bend, cell.astype(np.int32), base, bool(obj["clear"]),
        18 * len(corners),
    )  # fmt: skip


def sheet(pattern: Pattern, window: Floats, limit: int = mesh.LIMIT) -> tuple[Floats, Ints, Floats]:
    """The solid's surface over a window as triangles (n, 3, 3), with its sides, as grooves may end at a seam, but
    without its bottom; slots and bends. `limit` is `mesh.build`'s."""
    p0, q0, p1, q1 = window
    if not len(pattern.pieces):
        square = np.array([[p0, q0, 0.0], [p1, q0, 0.0], [p1, q1, 0.0], [p0, q1, 0.0]])
        return square[[[0, 1, 2], [0, 2, 3]]], np.full(2, -1, np.int32), np.zeros((2, 4))
    made = mesh.build(pattern, (p0, q0, p1, q1), margin=0.0, limit=limit)
    corners = made.vertices[made.triangles]
    keep = (corners[:, :, 2] > corners[:, :, 2].min()).any(axis=1)
    return np.ascontiguousarray(corners[keep]), made.slot[keep], np.ascontiguousarray(made.bend[keep])


def round_base(obj: np.void) -> Base:
    """The base of a sphere or a cylinder."""
    return _NO_BASE._replace(
        shape=int(obj["shape"]), size=np.array(obj["size"], np.float64), mapping=np.array(obj["mapping"], np.float64)
    )


def cut(base: Base, flat: Floats, step: float, limit: int) -> tuple[Floats, Ints, Ints]:
    """The sheet's triangles cut by the base's cells: parts (k, 3, 3), the triangles they come from, their cells.

    The cells of spheres and cylinders are `step` wide, radians. Raises ValueError where there are more than `limit`.
    """
    su, sv, du, dv = base.mapping
    room = 4 * len(flat) + 1_000_000
    for _ in range(2):
        parts = np.empty((room, 3, 3))
        sources, cells = np.empty(room, np.int32), np.empty(room, np.int32)
        if base.shape == MESH:
            low, high = flat[:, :, :2].min(axis=(0, 1)), flat[:, :, :2].max(axis=(0, 1))
            side = int(min(max(math.sqrt(len(flat)), 1), 1024))
            shape = np.array([side, side], np.int32)
            size = np.maximum(high - low, 1e-300) / side
            made = cut_by_triangles(
                flat, base.pq, low, size, shape, *bins(flat, low, size, shape), parts, sources, cells
            )
        else:
            columns = math.ceil(2.0 * math.pi / step)
            rows = math.ceil(math.pi / step) if base.shape == SPHERE else 1
            p, q = np.linspace(du, du + su, columns + 1), np.linspace(dv, dv + sv, rows + 1)
            made = cut_by_grid(flat, p, q, parts, sources, cells)
        if made > limit:
            raise ValueError(f"the solid would need {made} triangles, more than {limit}")
        if made <= room:
            break
        room = made
    return parts[:made], sources[:made], cells[:made]


def carry(base: Base, coordinates: Floats, cell: Ints) -> Floats:
    """`Body.coordinates` (n, k, 3) in each of the cells as points in the object's axes (n, k, 3)."""
    p, q, w = coordinates[..., 0], coordinates[..., 1], coordinates[..., 2]
    su, sv, du, dv = base.mapping
    if base.shape == MESH:
        weight = np.stack([1.0 - p - q, p, q], axis=-1)
        surface = np.einsum("nkc,ncx->nkx", weight, base.corners[cell])
        return np.asarray(
            surface + w[..., None] * np.einsum("nkc,nc,ncx->nkx", weight, base.rise[cell], base.normals[cell])
        )
    turn = 2.0 * math.pi * (p - du) / su
    if base.shape == SPHERE:
        tilt = math.pi * ((q - dv) / sv - 0.5)
        cosine = np.maximum(np.cos(tilt), 0.0)
        radius = base.size[0] * (1.0 + w * math.pi * np.sqrt(2.0 * cosine / (su * sv)))
        return np.stack(
            [radius * cosine * np.cos(turn), radius * cosine * np.sin(turn), radius * np.sin(tilt)], axis=-1
        )
    radius = base.size[0] + w * math.sqrt(2.0 * math.pi * base.size[0] * base.size[1] / (su * sv))
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), base.size[1] * ((q - dv) / sv - 0.5)], axis=-1)


def barycentric(corners: Floats, points: Floats) -> Floats:
    """Weights (n, k, 3) of the corners (n, 3, 2) of triangles at points (n, k, 2) of their plane."""
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    x = points - corners[:, None, 0]
    v = (x[..., 0] * two[:, None, 1] - x[..., 1] * two[:, None, 0]) / area[:, None]
    w = (one[:, None, 0] * x[..., 1] - one[:, None, 1] * x[..., 0]) / area[:, None]
    return np.stack([1.0 - v - w, v, w], axis=-1)


def facing(corners: Floats) -> Floats:
    """The unit normals (n, 3) of triangles (n, 3, 3), 0 where they have none."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0), np.float64)


def mesh_base(row: int, obj: np.void, triangles: Triangles, carries: bool) -> Base:
    """The triangles of a mesh object, with the sigma of their corners."""
    mine = triangles.object == row
    corners, normals = triangles.corners[mine], triangles.normals[mine]
    mapping = np.array(obj["mapping"])
    pq = np.ascontiguousarray(triangles.uv[mine] * mapping[:2] + mapping[2:])
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(one, two), axis=1)
    flat = pq[:, 1:] - pq[:, :1]
    plane = np.abs(flat[:, 0, 0] * flat[:, 1, 1] - flat[:, 0, 1] * flat[:, 1, 0])
    sigma = np.sqrt(np.divide(area, plane, out=np.zeros_like(area), where=plane > 0.0))
    rise = np.zeros((len(corners), 3))
    if carries:
        place = places(corners).reshape(-1)
        weight = np.repeat(area, 3)
        total = np.bincount(place, weight * np.repeat(sigma, 3)) / np.bincount(place, weight)
        rise = total[place].reshape(-1, 3)
    return Base(MESH, np.zeros(2), mapping, corners, pq, normals, rise)


def places(corners: Floats) -> Ints:
    """Which corners (n, 3, 3) of triangles are at the same place: (n, 3) its number."""
    grid = np.round(corners.reshape(-1, 3) / (1e-9 * float(np.abs(corners).max())))
    return np.unique(grid, axis=0, return_inverse=True)[1].reshape(-1, 3).astype(np.int32)


def _seamed(flat: Floats, window: Floats) -> tuple[NDArray[np.bool_], Floats]:
    """Which of the sheet's triangles (n, 3, 3) are no sides along the seam, and the sides (m, 3, 3) that spheres and
    cylinders have there: where the solid goes on only one way."""
    on = [(flat[:, :, 0] == window[side]).all(axis=1) for side in (0, 2)]
    scale = window[3] - window[1]  # as cross-sections are rounded to 1e-8
    walls = [CrossSection(list(flat[side][:, :, 1:] / scale), FillRule.NonZero) for side in on]
    made = [np.zeros((0, 3, 3))]
    for side, (wall, other) in enumerate((walls, walls[::-1])):
        parts = [part for part in (wall - other).decompose() if part.area() > _SLIVER]
        polygons = [polygon for part in parts for polygon in part.to_polygons()]
        if polygons:
            corners = np.concatenate(polygons)[triangulate(polygons)] * scale
            wide = np.insert(corners, 0, window[2 * side], axis=2)
            made.append(wide if side else wide[:, ::-1])
    return ~(on[0] | on[1]), np.concatenate(made)


def _caps(base: Base, bottom: float) -> Floats:
    """A cylinder's two ends as triangles, as far as the sheet's sides there, which go down to the height `bottom`."""
    radius = float(carry(base, np.array([[[*base.mapping[2:], bottom]]]), np.zeros(1, np.int32))[0, 0, 0])
    turn = np.linspace(0.0, 2.0 * math.pi, math.ceil(2.0 * math.pi / CELL) + 1)
    parts = []
    for side in (-1.0, 1.0):
        rim = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full_like(turn, 0.5 * side * base.size[1])], 1)
        middle = np.broadcast_to([0.0, 0.0, 0.5 * side * base.size[1]], (len(turn) - 1, 3))
        ring = (rim[:-1], rim[1:]) if side > 0.0 else (rim[1:], rim[:-1])
        parts.append(np.stack([middle, *ring], axis=1))
    return np.concatenate(parts)
