"""The solid of an object in the world, closed, as it leaves for a file.

What is exported is what is rendered: the solid of the pattern (DESIGN 1.2, `mesh`) carried to the world by
X = origin + axes (p, q, w), with sigma = sqrt(|dP/dp x dP/dq|) world units a pattern unit of height (DESIGN 1.1). A
rectangle becomes a plate, cut square at its edge; grooves that come from outside cut it too. Spheres and cylinders are
solid to their middle (`wrapped`), and so is what a closed mesh encloses; an open one becomes a sheet (`draped`).

Files hold single precision. So vertices are rounded first, equal ones merged, and what rounding has flattened is
taken out: faces without an area, and pairs of faces that have become one another's backs. Each of these leaves a
closed surface closed, and what comes out is checked edge by edge.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.body import mesh_base, plate_axes
from renderer.compile import CompiledScene
from renderer.draped import Shape, draped, shape_of
from renderer.errors import Fault, RenderError
from renderer.tables import BARE, MESH, RECTANGLE, Floats, Ints, Pattern
from renderer.wrapped import slab, wrapped

LIMIT = 2_000_000
"""The most triangles of a solid."""

_FAR = 1000.0  # the largest coordinate, in sizes of the solid: single precision then holds 1/16,000 of its size
_TINY = 2e-6  # edges this short, and parts this thin, as a share of the largest coordinate, are taken out
_ROUNDS = 20  # of mending

_DEEP = 4.0  # a plate's thickness where nothing else is said, in depths of its deepest groove
_THICK = 0.05  # and its least, as a share of the shorter side


class Body(NamedTuple):
    """A closed solid in the world, outward triangles anticlockwise."""

    vertices: NDArray[np.float32]  # (n, 3) no two equal
    triangles: Ints  # (m, 3)
    material: Ints  # (m,) rows of MATERIAL


def body(scene: CompiledScene, row: int, *, thickness: float | None = None, limit: int = LIMIT) -> Body:
    """The solid of the object `row`. `thickness` is a plate's or an open mesh's, world units.

    Raises RenderError where there is none, or where it has more than `limit` triangles.
    """
    obj = scene.objects[row]
    pattern = scene.patterns[obj["pattern"]] if obj["pattern"] >= 0 else BARE
    try:
        mesh = shape_of(mesh_base(row, obj, scene.triangles, carries=True)) if obj["shape"] == MESH else None
        if thickness is not None and not (obj["shape"] == RECTANGLE if mesh is None else mesh.boundary.any()):
            raise RenderError(
                Fault(
                    f"/objects/{row}/shape/type",
                    "a rectangle or an open mesh, as a thickness is given",
                    "a solid shape",
                )
            )
        _few(pattern, obj["mapping"][:2] if mesh is None else np.ptp(mesh.base.pq, axis=(0, 1)), limit)
        if mesh is not None:
            vertices, triangles, slot = sheet(obj, pattern, mesh, thickness, limit)
        elif obj["shape"] == RECTANGLE:
            vertices, triangles, slot = plate(obj, pattern, thickness, limit)
        else:
            vertices, triangles, slot = wrapped(obj, pattern, limit)
        return closed(vertices, triangles, scene.slots[row][slot + 1], limit)
    except ValueError as error:
        raise RenderError(Fault(f"/objects/{row}", "an object with a closed solid", str(error))) from None


def volume(solid: Body) -> float:
    """What the surface encloses, cubic world units; positive where it faces outward."""
    a, b, c = (solid.vertices[solid.triangles[:, k]].astype(np.float64) - solid.vertices[0] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def _few(pattern: Pattern, window: Floats, limit: int) -> None:
    """Refuse what would take long before its triangles are counted: a piece has a dozen at the least."""
    copies = 1.0
    for size, tile in zip(window, pattern.grid.tile, strict=True):
        copies *= 1.0 + float(size / tile) if tile > 0.0 else 1.0
    if len(pattern.pieces) * copies > limit / 8:
        raise ValueError(f"{int(len(pattern.pieces) * copies)} lines and arcs, more than {limit // 8}")


def plate(obj: np.void, pattern: Pattern, thickness: float | None, limit: int) -> tuple[Floats, Ints, Ints]:
    """A rectangle's solid: vertices (n, 3) in the world, triangles (m, 3), material slots (m,)."""
    origin, axes = plate_axes(obj)
    sigma = float(np.linalg.norm(axes[:, 2]))
    thickness = _thick(thickness, pattern.depth * sigma, float(min(obj["size"])))
    su, sv, du, dv = obj["mapping"]
    solid = slab(pattern, (du, dv, du + su, dv + sv), limit)
    w = solid.vertices[:, 2]
    w[w < 0.5 * (w.min() - pattern.depth)] = -thickness / sigma
    return origin + solid.vertices @ axes.T, solid.triangles, solid.slot


def sheet(
    obj: np.void, pattern: Pattern, mesh: Shape, thickness: float | None, limit: int
) -> tuple[Floats, Ints, Ints]:
    """A mesh's solid, as `plate`'s. An open one is `thickness` thick, a closed one is solid."""
    base = mesh.base
    _, side, _ = sorted(np.ptp(base.corners.reshape(-1, 3) @ obj["rotation"], axis=0).tolist())
    if mesh.boundary.any():
        thickness = _thick(thickness, pattern.depth * float(base.rise.max()), side)
    return draped(mesh, pattern, thickness or 0.0, limit)


def _thick(thickness: float | None, deepest: float, side: float) -> float:
    """The thickness of what is not solid: it holds the deepest groove, and is a part of the shorter side if none is
    given."""
    if thickness is None:
        thickness = max(_DEEP * deepest, _THICK * side)
    if not thickness > 1.001 * deepest:
        raise ValueError(f"a thickness of {thickness:g} does not hold a groove of depth {deepest:g}")
    return thickness


def closed(vertices: Floats, triangles: Ints, material: Ints, limit: int = LIMIT) -> Body:
    """The same solid in single precision, still closed. Raises ValueError where it is not."""
    far, size = float(np.abs(vertices).max()), float(np.ptp(vertices, axis=0).max())
    if far > _FAR * size:
        raise ValueError(f"a place at {far:g}, too far off for single precision to hold its size of {size:g}")
    # The same steps everywhere, not finer ones near 0: readers merge points by an absolute distance.
    step = 2.0 ** (math.ceil(math.log2(far)) - 23)
    rounded = (np.round(vertices / step) * step).astype(np.float32)
    points, index = np.unique(rounded + np.float32(0.0), axis=0, return_inverse=True)
    faces = index.reshape(-1)[triangles].astype(np.int32)
    tiny = _TINY * far
    wrong = edges_of(faces)  # to begin with, any that is too short
    for number in range(_ROUNDS):
        short = wrong[np.linalg.norm(points[wrong[:, 0]] - points[wrong[:, 1]], axis=1) <= tiny]
        if len(short):
            faces = _merged(len(points), short)[faces]
        elif number and not (number < _ROUNDS // 2 and _unfolded(points, faces, wrong, tiny)):  # it may go to and fro
            count = len(points)
            points, faces = _parted(points, faces, wrong, tiny)
            if len(points) == count:
                points, faces, source = _pinched(points, faces, wrong, tiny)
                material = material[source]
        kept = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
        faces, material = _without_flaps(faces[kept], material[kept])
        wrong = unpaired(faces)
        if not len(wrong):
            break
    else:
        raise ValueError("a surface finer than single precision can hold")
    if len(faces) > limit:
        raise ValueError(f"a solid of {len(faces)} triangles, more than {limit}")
    used, faces = np.unique(faces, return_inverse=True)
    return Body(points[used], faces.reshape(-1, 3).astype(np.int32), material)


def edges_of(triangles: Ints) -> Ints:
    """The directed edges (3 n, 2)."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def unpaired(triangles: Ints) -> Ints:
    """The edges (n, 2) that are not shared by exactly two triangles, running along them in opposite directions."""
    edges = edges_of(triangles).astype(np.int64)
    n = int(edges.max(initial=0)) + 1
    there, count = np.unique(edges[:, 0] * n + edges[:, 1], return_counts=True)
    back = np.unique(edges[:, 1] * n + edges[:, 0], return_counts=True)[0]  # sorts, as hashes of these are slow
    wrong = np.union1d(there[count != 1], np.setxor1d(there, back, assume_unique=True))
    return np.stack([wrong // n, wrong % n], axis=1).astype(np.int32)


def _merged(count: int, edges: Ints) -> Ints:
    """For each of the points (count,) the one that takes its place when the edges (n, 2) shrink to points."""
    place = np.arange(count, dtype=np.int32)
    while True:  # as often as the longest chain of edges asks for
        least = np.minimum(place[edges[:, 0]], place[edges[:, 1]])
        before = place.copy()
        np.minimum.at(place, edges.reshape(-1), np.repeat(least, 2))
        place = place[place]
        if np.array_equal(place, before):
            return place


def _unfolded(points: NDArray[np.float32], faces: Ints, wrong: Ints, tiny: float) -> bool:
    """Flip, in place, the edges `wrong` along which the surface is folded back on itself, as at a wall that rounding
    has left thinner than `tiny`: its two sides then become flaps. Whether there were any."""
    found = False
    for first, last in wrong[wrong[:, 0] < wrong[:, 1]].tolist():
        here = np.flatnonzero((faces == first).any(axis=1) & (faces == last).any(axis=1))
        tips = faces[here].sum(axis=1) - first - last
        ahead = ((faces[here] == first) & (np.roll(faces[here], -1, axis=1) == last)).any(axis=1)
        away = points[tips].astype(np.float64) - points[first]
        along = points[last].astype(np.float64) - points[first]
        away -= np.outer(away @ along / (along @ along), along)
        long = np.linalg.norm(away, axis=1).clip(1e-300)
        turned = away @ away.T > 0.0
        apart = np.linalg.norm(np.cross(away[:, None], away), axis=2) / np.maximum(long[:, None], long)
        for i, j in zip(*np.nonzero(turned & (apart <= tiny) & ahead[:, None] & ~ahead), strict=True):
            x, y = tips[i], tips[j]  # (first, last, x) and (last, first, y)
            faces[here[i]], faces[here[j]] = (last, x, y), (x, first, y)
            found = True
            break
    return found


def _parted(points: NDArray[np.float32], faces: Ints, wrong: Ints, gap: float) -> tuple[NDArray[np.float32], Ints]:
    """Parts of the solid that touch along the edges `wrong`, set apart: there each part gets points of its own, moved
    into it by `gap`."""
    ends = np.zeros(len(points), np.bool_)
    ends[wrong] = True
    around: dict[int, list[int]] = {}
    for face in np.flatnonzero(ends[faces].any(axis=1)).tolist():
        for corner in faces[face].tolist():
            if ends[corner]:
                around.setdefault(corner, []).append(face)
    parted = faces.copy()
    made: list[Floats] = []
    for corner, here in around.items():
        parts = _parts(points.astype(np.float64), faces, corner, here)
        for part in parts if len(parts) > 1 else []:
            a, b, c = (points[faces[part, k]].astype(np.float64) for k in range(3))
            outward = np.cross(b - a, c - a)
            outward = (outward / np.linalg.norm(outward, axis=1, keepdims=True).clip(1e-300)).sum(axis=0)
            parted[part] = np.where(faces[part] == corner, len(points) + len(made), parted[part])
            made.append(points[corner] - gap * outward / max(float(np.linalg.norm(outward)), 1e-300))
    return np.concatenate([points, np.array(made, np.float32).reshape(-1, 3)]), parted


def _pinched(
    points: NDArray[np.float32], faces: Ints, wrong: Ints, gap: float
) -> tuple[NDArray[np.float32], Ints, Ints]:
    """Edges `wrong` along which one part touches itself, halved, with a middle of its own, moved into the solid by
    `gap`, for either pair of faces that have the solid between them. Also says which faces come from which."""
    made: list[Floats] = []
    cut: dict[int, tuple[int, int, int]] = {}  # by face, the ends of its edge and the middle
    for first, last in wrong[wrong[:, 0] < wrong[:, 1]].tolist():
        here = np.flatnonzero((faces == first).any(axis=1) & (faces == last).any(axis=1))
        ahead = ((faces[here] == first) & (np.roll(faces[here], -1, axis=1) == last)).any(axis=1)
        if len(here) != 4 or ahead.sum() != 2 or not cut.keys().isdisjoint(here.tolist()):
            continue  # those whose faces are taken have their turn in the next round
        a, b, c = (points[faces[here, k]].astype(np.float64) for k in range(3))
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True).clip(1e-300)
        along = points[last].astype(np.float64) - points[first]
        along /= np.linalg.norm(along)
        away = a + b + c - points[last] - 2.0 * points[first]
        away -= np.outer(away @ along, along)
        (i, other), back = np.flatnonzero(ahead), np.flatnonzero(~ahead)
        angle = np.arctan2(away[back] @ -normal[i], away[back] @ away[i] / np.linalg.norm(away[i]).clip(1e-300))
        near = int(np.where(angle <= 0.0, angle + 2.0 * np.pi, angle).argmin())
        for pair in ((i, back[near]), (other, back[1 - near])):
            outward = normal[list(pair)].sum(axis=0)
            middle = 0.5 * (points[first].astype(np.float64) + points[last])
            for k in pair:
                ends = (first, last) if ahead[k] else (last, first)
                cut[int(here[k])] = (*ends, len(points) + len(made))
            made.append(middle - gap * outward / max(float(np.linalg.norm(outward)), 1e-300))
    if not made:
        raise ValueError(f"a surface that is open, or touches itself, along {len(wrong)} edges")
    rows = np.array(list(cut), np.int32)
    begin, end, middles = np.array(list(cut.values()), np.int32).T[:, :, None]
    old = faces[rows]
    one = np.where(old == end, middles, old)
    two = np.where(old == begin, middles, old)
    halved = faces.copy()
    halved[rows] = one
    source = np.concatenate([np.arange(len(faces)), rows]).astype(np.int32)
    return np.concatenate([points, np.array(made, np.float32)]), np.concatenate([halved, two]), source


def _parts(points: Floats, faces: Ints, corner: int, here: list[int]) -> list[list[int]]:
    """The faces `here` around a corner by the parts of the solid that touch in it: where more than two faces share an
    edge, those belong together that have the solid between them."""
    group = {face: face for face in here}

    def root(face: int) -> int:
        while group[face] != face:
            face = group[face]
        return face

    sharing: dict[int, list[int]] = {}
    for face in here:
        for other in faces[face].tolist():
            if other != corner:
                sharing.setdefault(other, []).append(face)
    for other, some in sharing.items():
        along = points[other] - points[corner]
        along /= np.linalg.norm(along)
        a, b, c = (points[faces[some, k]] for k in range(3))
        away = (a + b + c) - 3.0 * points[corner]
        away -= (away @ along)[:, None] * along
        for i, face in enumerate(some):
            inward = np.cross(c[i] - a[i], b[i] - a[i])
            angle = np.arctan2(away @ inward / np.linalg.norm(inward), away @ away[i] / np.linalg.norm(away[i]))
            angle[i] = 0.0
            angle = np.where(angle <= 0.0, angle + 2.0 * np.pi, angle)
            group[root(face)] = root(some[int(angle.argmin())])
    parts: dict[int, list[int]] = {}
    for face in here:
        parts.setdefault(root(face), []).append(face)
    return list(parts.values())


def _without_flaps(faces: Ints, material: Ints) -> tuple[Ints, Ints]:
    """Without the pairs of triangles that are one another's backs."""
    order = np.argsort(faces, axis=1)
    odd = (np.take_along_axis(order, np.array([[1]]), 1) - order[:, :1]) % 3 != 1  # not a cyclic turn of the sorted one
    _, group = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True)
    sign = np.where(odd[:, 0], -1, 1)
    balance = np.bincount(group.reshape(-1), sign)
    # Of each group as many stay as its balance says, and of that sign.
    stays = np.zeros(len(faces), np.bool_)
    for facing in (1, -1):
        rows = np.flatnonzero((sign == facing) & (np.sign(balance[group.reshape(-1)]) == facing))
        _, first = np.unique(group.reshape(-1)[rows], return_index=True)
        stays[rows[first]] = True
    return faces[stays], material[stays]
