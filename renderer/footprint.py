"""Footprints: the squares of the screen that are integrated as one.

A pixel whose corners and centre see one smooth surface, in one light, is one footprint. Any other is split in four
again and again along the edge that runs through it, so that a silhouette is antialiased and the inside of a surface
is still looked at once. Footprints of the last level take what one random point in them sees; the tolerance says how
small they are. Where ridges may stand over the outline of a sphere or a cylinder, or grooves run out at its rim, a
pixel stays whole, for `csg` to sample.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.shapes import Shells, touching
from renderer.tables import BESIDE, CYLINDER, FOOTPRINT, FRAME, HIT, MESH, RECTANGLE, THROUGH, Camera, Floats, Ints

LEVELS = 2, 7  # splits of a pixel on an edge, by tolerance
CROWD = 5, 8  # but after the first number of splits, only while an edge meets no more than the second of parts a row
LAST = 0.25  # of the side of a square that is split no further is looked at, next to a point known to be its own
SMOOTH_COSINE = 0.9  # normals within a footprint are never more than about 25 degrees off its middle's
TURN = 0.25, 2  # ... nor by more than 1 - cosine = TURN * tolerance (measured); up to so many splits for that alone
MESH_TURN = 2.5, 6  # ... on meshes by MESH_TURN * tolerance^2: the edges of triangles err as normals turn there
CLOSE = 1e-3  # of a radius: no other object stands so near
WITHIN = 1.0 - 1e-6  # of a cylinder's height: a place at its rim counts as one of its side
OPEN = 1.5  # times the depth of the grooves: a footprint's corners may be seen at less slope than its centre


class Shapes(Protocol):
    """What meets the camera's rays: `raycast.Caster`."""

    objects: NDArray[np.void]

    @property
    def shadows(self) -> bool:
        """Whether one part of the scene may stand in the light of another."""

    def hits(self, origin: Floats, directions: Floats) -> NDArray[np.void]:
        """The nearest HIT (n,) of each ray from `origin` (3,) along `directions` (n, 3)."""

    def frames(self, origin: Floats, directions: Floats, hits: NDArray[np.void]) -> tuple[NDArray[np.void], Ints]:
        """The tangent FRAMEs at the hits, and which (n,) each has."""

    @property
    def shells(self) -> Shells | None:
        """What the grooves of spheres and cylinders fill."""

    def shell_hits(self, origin: Floats, directions: Floats) -> NDArray[np.void]:
        """The nearest HIT (n,) of each ray with the outsides of shells."""

    def blocked(
        self, origin: Floats, directions: Floats, hits: NDArray[np.void], lights: NDArray[np.void]
    ) -> NDArray[np.uint64]:
        """For each hit (n,) a mask of the lights that something stands before."""

    def blocked_off(self, points: Floats, own: Ints, lights: NDArray[np.void]) -> NDArray[np.uint64]:
        """The same for points (n, 3) of the grooves of the objects `own` (n,)."""


class Tile(NamedTuple):
    """A rectangle of pixels."""

    x: int
    y: int
    width: int
    height: int


class Footprints(NamedTuple):
    """What a tile's pixels see of the scene; squares that see no object are left out."""

    footprints: NDArray[np.void]  # (n,) FOOTPRINT, in the order of their pixels at each level
    frames: NDArray[np.void]  # (m,) FRAME


def rays(camera: Camera, x: Floats, y: Floats) -> Floats:
    """Directions (n, 3) of the rays through screen points, pixels; not unit vectors."""
    return np.stack(
        [c + x * r + y * d for c, r, d in zip(camera.corner, camera.right, camera.down, strict=True)], axis=1
    )


def levels(tolerance: float) -> int:
    """How often a pixel on an edge is split. Each of n parts along it is in or out by chance, off by 1 / sqrt(6) on
    root mean square; what that is of the pixel, n^-1.5 of it, is the tolerance. For an edge of half of white that is
    two deviations."""
    parts = (1.0 / math.sqrt(6.0) / tolerance) ** (2.0 / 3.0)
    return min(max(round(math.log2(parts)), LEVELS[0]), LEVELS[1])


def flat_frames(shapes: Shapes, origin: Floats) -> dict[int, NDArray[np.void]]:
    """The one FRAME of each rectangle that the camera sees from the front, by row of OBJECT."""
    frames = {}
    for row, obj in enumerate(shapes.objects):
        normal = obj["rotation"][:, 2]
        if obj["shape"] == RECTANGLE and float(normal @ (origin - obj["translation"])) > 0.0:
            hit = np.zeros(1, HIT)
            hit["object"], hit["t"], hit["u"], hit["v"], hit["normal"] = row, 1.0, 0.5, 0.5, normal
            frames[row], _ = shapes.frames(origin, (obj["translation"] - origin)[None, :], hit)
    return frames


def footprints(
    shapes: Shapes, camera: Camera, lights: NDArray[np.void], tile: Tile, flat: dict[int, NDArray[np.void]],
    heights: Floats, tolerance: float, seed: int,
) -> Footprints:  # fmt: skip
    """The footprints of a tile. heights: (n, 2) of each row of OBJECT, how high and how deep its grooves are, pattern
    units. tolerance: the error of a pixel relative to white that its surface's turning may bring."""
    ys, xs = np.mgrid[0 : tile.height + 1, 0 : tile.width + 1]  # corners, shared by the pixels around
    corners = (xs + tile.x).ravel().astype(float), (ys + tile.y).ravel().astype(float)
    x, y = (xs[:-1, :-1] + tile.x).ravel().astype(float), (ys[:-1, :-1] + tile.y).ravel().astype(float)
    pixel = np.arange(tile.width * tile.height, dtype=np.int32)
    wide = tile.width + 1
    first = (pixel // tile.width) * wide + pixel % tile.width
    around = np.stack([first, first + 1, first + wide, first + wide + 1])  # (4, n)
    squares = x, y, np.ones(len(x))
    return _split(shapes, camera, lights, pixel, squares, corners, around, flat, heights, tolerance, seed)


def footprints_within(
    shapes: Shapes, camera: Camera, lights: NDArray[np.void], squares: NDArray[np.void],
    flat: dict[int, NDArray[np.void]], heights: Floats, tolerance: float, seed: int,
) -> Footprints:  # fmt: skip
    """The same for the squares of FOOTPRINTs (n,); `pixel` is which of these each is a part of."""
    x, y, size = squares["x"], squares["y"], squares["size"]
    corners, around = _own_corners(x, y, size)
    pixel = np.arange(len(squares), dtype=np.int32)
    return _split(shapes, camera, lights, pixel, (x, y, size), corners, around, flat, heights, tolerance, seed)


def _own_corners(x: Floats, y: Floats, size: Floats) -> tuple[tuple[Floats, Floats], NDArray[np.int64]]:
    """The corners of squares (n,), and which (4, n) are each one's."""
    corners = np.concatenate([x, x + size, x, x + size]), np.concatenate([y, y, y + size, y + size])
    return corners, np.arange(4 * len(x)).reshape(4, -1)


def _split(
    shapes: Shapes, camera: Camera, lights: NDArray[np.void], pixel: Ints, squares: tuple[Floats, Floats, Floats],
    places: tuple[Floats, Floats], around: NDArray[np.int64], flat: dict[int, NDArray[np.void]], heights: Floats,
    tolerance: float, seed: int,
) -> Footprints:  # fmt: skip
    """The footprints in squares: left, top and edge, (n,) each, `around` (4, n) which of the `places` are corners."""
    x, y, size = squares
    corner_rays = rays(camera, *places)
    corners = shapes.hits(camera.origin, corner_rays)
    corner_mask = shapes.blocked(camera.origin, corner_rays, corners, lights)
    finest = levels(tolerance)
    done: list[Footprints] = []
    for level in range(finest + 1):
        last = np.full(len(pixel), level == finest)
        if level >= CROWD[0]:
            last |= np.bincount(pixel)[pixel] > CROWD[1] * 2**level
        u, v = np.full(len(pixel), 0.5), np.full(len(pixel), 0.5)
        u[last], v[last] = _inside(x[last], y[last], seed), _inside(y[last], x[last], seed)
        middle_rays = rays(camera, x + size * u, y + size * v)
        middle = shapes.hits(camera.origin, middle_rays)
        mask = shapes.blocked(camera.origin, middle_rays, middle, lights)
        smooth = last.copy()
        if level < finest:
            bends = (middle["object"] >= 0) & (shapes.objects["shape"][middle["object"]] == MESH)
            limits = ((MESH_TURN, tolerance * tolerance), (TURN, tolerance))  # an edge meets 2^level of 4^level parts
            turn = np.where(bends, *(part * of * 2**level if level < most else 1.0 for (part, most), of in limits))
            cosine = np.maximum(SMOOTH_COSINE, 1.0 - turn)
            smooth |= touching(middle, mask, corners, corner_mask, around, cosine)
        eyes, beside = np.broadcast_to(camera.origin, middle_rays.shape), np.zeros(len(middle), np.bool_)
        if level == 0 and shapes.shells is not None:
            outer = shapes.shell_hits(camera.origin, corner_rays)[around]
            outer = np.concatenate([outer, shapes.shell_hits(camera.origin, middle_rays)[None]])
            row = at_outline(shapes.objects, shapes.shells, np.concatenate([corners[around], middle[None]]), outer)
            eyes = eyes.copy()
            for k in np.unique(row[row >= 0]):
                which = np.flatnonzero(row == k)
                starts, ways = beside_outline(shapes.objects[k], camera.origin, middle_rays[which])
                hits = shapes.hits(starts, ways)
                on = (hits["object"] == k) & (hits["face"] == 0)
                which, starts, ways, hits = which[on], starts[on], ways[on], hits[on]
                eyes[which], middle_rays[which], middle[which], beside[which] = starts, ways, hits, True
                mask[which] = shapes.blocked(starts, ways, hits, lights)
        smooth |= beside
        keep = np.flatnonzero(smooth & (middle["object"] >= 0))
        within = size * np.where(beside | (level < finest), 1.0, LAST)
        place = x + u * (size - within), y + v * (size - within), within
        done.append(_framed(shapes, eyes, flat, pixel, *place, size, middle_rays, middle, mask, beside, keep))
        split = ~smooth
        if not split.any():
            break
        pixel, size = np.repeat(pixel[split], 4), np.repeat(0.5 * size[split], 4)
        x = np.repeat(x[split], 4) + size * np.resize([0.0, 1.0, 0.0, 1.0], len(size))
        y = np.repeat(y[split], 4) + size * np.resize([0.0, 0.0, 1.0, 1.0], len(size))
        if level + 1 < finest:
            places, around = _own_corners(x, y, size)
            corner_rays = rays(camera, *places)
            corners = shapes.hits(camera.origin, corner_rays)
            corner_mask = shapes.blocked(camera.origin, corner_rays, corners, lights)
    out = _joined(done)
    if shapes.shadows:
        mark_torn(shapes, camera, lights, heights, out)
    mark_open(shapes, heights, out)
    return out


def mark_torn(
    shapes: Shapes, camera: Camera, lights: NDArray[np.void], heights: Floats, seen: Footprints
) -> None:  # fmt: skip
    """Find the lights that something keeps from a part of a footprint's grooves: what its corners see of them at their
    highest and at their lowest is not lit as the bare surface is."""
    prints = seen.footprints
    own = seen.frames["object"][prints["frame"]]
    grooved = (seen.frames["grooved"][prints["frame"]] != 0) & (shapes.objects["shape"][own] != MESH)
    for side in range(2):
        which = np.flatnonzero(grooved & (heights[own, side] > 0.0))
        some, frames = prints[which], seen.frames[prints["frame"][which]]
        up = frames["dual"][:, 2]  # what of a way is height
        start = np.einsum("nk,nk->n", up, camera.origin - frames["origin"])
        height = np.minimum(heights[own[which], side] * (1.0 - 2.0 * side), 0.5 * start)
        for corner in range(4 if len(which) else 0):
            x, y = some["x"] + (corner & 1) * some["size"], some["y"] + (corner >> 1) * some["size"]
            way = rays(camera, x, y)
            fall = np.einsum("nk,nk->n", up, way)
            meets = fall < 0.0
            t = np.divide(height - start, fall, out=np.zeros_like(fall), where=meets)
            points = camera.origin + t[:, None] * way
            differ = shapes.blocked_off(points, own[which].astype(np.int32), lights) ^ some["blocked"]
            prints["torn"][which] |= np.where(meets, differ, np.uint64(0))


def mark_open(shapes: Shapes, heights: Floats, seen: Footprints) -> None:
    """Find the footprints where sight, gone on from the bare shape, comes out again above the grooves' depth: at a
    slope s to a surface that falls by b along it, it gets s^2 / (2 b) deep. Or it comes to the end of a cylinder."""
    frames = seen.frames
    own = frames["object"]
    slope, (x, y), (a, b, c) = frames["eye"][:, 2], (frames["eye"][:, :2] - frames["pq"]).T, frames["form"].T
    falls = 2.0 * (a * x * x + 2.0 * b * x * y + c * y * y)
    carries = (frames["grooved"] != 0) & (frames["within"] == 0) & (shapes.objects["shape"][own] != MESH)
    deep = OPEN * heights[own, 1]
    mapping, q = shapes.objects["mapping"][own], frames["pq"][:, 1]
    past = np.abs((q - deep * y / np.maximum(slope, 1e-12) - mapping[:, 3]) / mapping[:, 1] - 0.5) > 0.5
    past &= (shapes.objects["shape"][own] == CYLINDER) & (deep > 0.0)
    through = (carries & (past | (slope * slope < falls * deep)))[seen.footprints["frame"]]
    seen.footprints["open"] = np.where(seen.footprints["open"] == BESIDE, BESIDE, np.where(through, THROUGH, 0))


def at_outline(objects: NDArray[np.void], shells: Shells, seen: NDArray[np.void], outer: NDArray[np.void]) -> Ints:
    """On whose outline each of n squares lies, where ridges may stand over it, or whose rim, where grooves may run out:
    the row of OBJECT; -1: on none.

    seen, outer: (5, n) HITs at its corners and middle, with the bare shapes and with the outsides of shells. All else
    that is seen there stands behind.
    """
    far = np.where(outer["object"] >= 0, outer["t"], np.inf)
    row = np.take_along_axis(outer["object"], far.argmin(axis=0)[None], axis=0)[0]
    own = seen["object"] == row
    behind = ~own & (seen["t"] > far.min(axis=0))
    cap = own & (objects["shape"][row] == CYLINDER) & (seen["face"] == 1)
    over_end = own & ~cap & (outer["face"] == 1) & (objects["shape"][row] == CYLINDER)
    rim = (over_end | cap & (np.hypot(seen["u"], seen["v"]) > shells.inner[row])).any(axis=0)
    ridges = (behind & (shells.outer["size"][row, 0] > objects["size"][row, 0])).any(axis=0)
    clear = (cap & (objects["clear"][row] != 0)).any(axis=0)
    return np.where((own | behind).all(axis=0) & (ridges | rim) & ~clear, row, -1).astype(np.int32)


def beside_outline(obj: np.void, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    """Rays, (n, 3) each, that meet a sphere, or a cylinder's side, upright where other rays (n, 3) pass it."""
    flat = np.diag([1.0, 1.0, 0.0 if obj["shape"] == CYLINDER else 1.0])
    eye, way = (origin - obj["translation"]) @ obj["rotation"], directions @ obj["rotation"]
    across = way @ flat
    t = -(across @ eye) / np.maximum((across * across).sum(axis=1), 1e-300)
    place = eye + t[:, None] * way
    if obj["shape"] == CYLINDER:
        half = 0.5 * obj["size"][1] * WITHIN
        place[:, 2] = np.clip(place[:, 2], -half, half)
    out = place @ flat
    long = np.linalg.norm(out, axis=1)[:, None]
    out = np.where(long > 0.0, out / np.maximum(long, 1e-300), [1.0, 0.0, 0.0])
    start = place @ (np.eye(3) - flat) + (1.0 + CLOSE) * obj["size"][0] * out
    turn = obj["rotation"].T
    return obj["translation"] + start @ turn, -out @ turn


def _inside(x: Floats, y: Floats, seed: int) -> Floats:
    """A random number in [0, 1) for each place, the same for every tile."""
    bits = (x * 4096.0).astype(np.int64).astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    bits ^= (y * 4096.0).astype(np.int64).astype(np.uint64) * np.uint64(0xC2B2AE3D27D4EB4F) + np.uint64(seed)
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return (bits >> np.uint64(11)).astype(np.float64) / 9007199254740992.0


def _framed(
    shapes: Shapes, eyes: Floats, flat: dict[int, NDArray[np.void]], pixel: Ints, x: Floats, y: Floats, size: Floats,
    side: Floats, directions: Floats, hits: NDArray[np.void], mask: NDArray[np.uint64], beside: NDArray[np.bool_],
    keep: NDArray[np.int64],
) -> Footprints:  # fmt: skip
    """The footprints among the squares (n,) that `keep` lists, which stand for parts of a pixel with these sides, with
    frames; those of a rectangle share one."""
    out = np.zeros(len(keep), FOOTPRINT)
    out["pixel"], out["x"], out["y"], out["blocked"] = pixel[keep], x[keep], y[keep], mask[keep]
    out["size"], out["weight"], out["open"] = size[keep], side[keep] ** 2, np.where(beside[keep], BESIDE, 0)
    shared: list[NDArray[np.void]] = []
    rest = np.ones(len(keep), np.bool_)
    seen = hits["object"][keep]
    for row, frame in flat.items():
        of = seen == row
        if of.any():
            out["frame"][of] = len(shared)
            shared.append(frame)
            rest &= ~of
    curved = keep[rest]
    if len(curved):
        more, which = shapes.frames(eyes[curved], directions[curved], hits[curved])
        out["frame"][rest] = len(shared) + which
        shared.append(more)
    return Footprints(out, np.concatenate(shared) if shared else np.zeros(0, FRAME))


def _joined(parts: list[Footprints]) -> Footprints:
    start = 0
    for part in parts:
        part.footprints["frame"] += start
        start += len(part.frames)
    return Footprints(
        np.concatenate([part.footprints for part in parts]), np.concatenate([part.frames for part in parts])
    )
