"""The rest of the scene: rays that have left a surface meet the other objects, and their grooves (000, 6.2).

They are gathered and met all together: the bare shapes by the caster, as the camera's rays are, then the solid around
each hit by the rays of `geometry.rays`, which shades it and goes on. What leaves there is met in the next round.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import is_curved
from renderer.geometry.query import nearby
from renderer.geometry.random import EIGHTHS, PLACE, drawn
from renderer.geometry.rays import follow
from renderer.geometry.shapes import arrange, local
from renderer.geometry.shell import LEVEL, ahead, chart, entered, from_world, is_round
from renderer.geometry.solid import leveled, thin_of
from renderer.geometry.spans import events
from renderer.geometry.straight import sight_over
from renderer.kernel import borrow, keep, kernel
from renderer.shading import direction_to_pattern, sky_from, unit
from renderer.tables import BARE, MESH, RAY, RECTANGLE, Camera, Floats, Ints, Lighting, Pattern


@kernel
def look(
    numbers: NDArray[np.int64], bounces: int, seed: int, footprints: NDArray[np.void], chosen: NDArray[np.int64],
    camera: Camera, rays: NDArray[np.void],
) -> None:  # fmt: skip
    """Write the RAYs of the camera through the footprints `chosen` (n,), of each those of `numbers` (n, 2) as `csg`
    takes them.

    bounces: as many as are followed from what they meet.
    """
    made = 0
    for j in range(len(chosen)):
        footprint = footprints[chosen[j]]
        first, stop = numbers[j, 0], numbers[j, 1]
        for i in range(first, stop):
            _, u, v = drawn(i, PLACE, seed, footprint.x, footprint.y)
            x, y = footprint.x + footprint.size * u, footprint.y + footprint.size * v
            ray = rays[made]
            made += 1
            for c in range(3):
                ray.origin[c], ray.through[c] = camera.origin[c], 1.0
                ray.way[c] = camera.corner[c] + x * camera.right[c] + y * camera.down[c]
            way = unit((ray.way[0], ray.way[1], ray.way[2]))
            ray.way[0], ray.way[1], ray.way[2] = way
            ray.row, ray.number = EIGHTHS * chosen[j] + i * EIGHTHS // stop, i
            ray.bounces, ray.object = bounces + 1, -1


@kernel
def depart(
    rays: NDArray[np.void], objects: NDArray[np.void], start: float, origin: Floats, way: Floats, own: Ints
) -> None:
    """Where RAYs (n,) begin and go, (n, 3) each, and what they leave, as `Shapes.hits` wants it. start: how far off a
    mesh they begin."""
    for k in range(len(rays)):
        ray = rays[k]
        own[k] = ray.object
        shape = objects[ray.object].shape if ray.object >= 0 else RECTANGLE
        ahead = ray.clear if shape == MESH or (ray.within and shape != RECTANGLE) else 0.0  # it may meet itself
        if shape == MESH:
            ahead += start
        if ray.within:
            own[k] = -2 - ray.object
        for c in range(3):
            way[k, c] = ray.way[c]
            origin[k, c] = ray.origin[c] + ahead * ray.way[c]


@kernel
def meet_sky(rays: NDArray[np.void], chosen: NDArray[np.int64], lighting: Lighting, radiance: Floats) -> None:
    """Rays RAY that meet nothing: add the sky to the radiance (EIGHTHS n, 5) of their footprints (n,)."""
    lighting = borrow(lighting)
    for k in chosen:
        ray = rays[k]
        sky = sky_from(lighting, (ray.way[0], ray.way[1], ray.way[2]))
        for c in range(3):
            radiance[ray.row, c] += ray.through[c] * sky[c]


@kernel
def meet_surface(
    seed: int, pattern: Pattern, objects: NDArray[np.void], rays: NDArray[np.void], chosen: NDArray[np.int64],
    hits: NDArray[np.void], frames: NDArray[np.void], of: Ints, blocked: NDArray[np.uint64],
    footprints: NDArray[np.void], lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32],
    albedo: Floats, radiance: Floats, leaving: NDArray[np.void], gone: NDArray[np.int64],
) -> None:  # fmt: skip
    """Rays RAY that meet one object, at their `hits` (n,): add what they see to the radiance of their footprints.

    frames, of: FRAMEs, and which each hit has. blocked: (n,) masks of the lights that do not reach the hit. leaving,
    gone: as `csg`.
    """
    owned = nearby(pattern, max(pattern.near, 1)), events(pattern)
    found, spans = borrow(owned[0]), borrow(owned[1])
    pattern, lighting, materials, slots = borrow(pattern), borrow(lighting), borrow(materials), borrow(slots)
    albedo, leaving = borrow(albedo), borrow(leaving)
    high, low = pattern.height + thin_of(pattern), -pattern.depth - thin_of(pattern)
    for k in chosen:
        ray, hit, frame = rays[k], hits[k], frames[of[k]]
        obj = objects[frame.object]
        footprint = footprints[ray.row // EIGHTHS]
        way = (ray.way[0], ray.way[1], ray.way[2])
        steer = (0.0, 0.0)
        if is_round(obj, frame):
            o, d = from_world(obj, (ray.origin[0], ray.origin[1], ray.origin[2])), local(obj, way[0], way[1], way[2])
            at = from_world(obj, (frame.origin[0], frame.origin[1], frame.origin[2]))
            t = (at[0] - o[0]) * d[0] + (at[1] - o[1]) * d[1] + (at[2] - o[2]) * d[2]
            start = chart(obj, ahead(o, d, entered(pattern, obj, o, d, frame.within == 1, t)))
        else:
            d = direction_to_pattern(frame, way)
            rise = leveled(d[0], d[1], d[2], LEVEL)
            w = low if frame.within == 1 else high
            slope_p, slope_q = d[0] / rise, d[1] / rise
            m = obj.mapping
            p, q, gp, gq = hit.u * m[0] + m[2], hit.v * m[1] + m[3], slope_p, slope_q
            if is_curved(frame) and len(pattern.pieces) > 0:  # the chord where it is over the base
                p, q, gp, gq = sight_over(frame, p, q, slope_p, slope_q, high, low)
            start, steer = (p + w * gp, q + w * gq, w), (gp - slope_p, gq - slope_q)
        before = gone[0]
        colour = follow(
            ray.bounces, False, (ray.through[0], ray.through[1], ray.through[2]), way, start, steer,
            frame.within == 1, ray.number, seed, ray.row, footprint.x, footprint.y, blocked[k], pattern, obj,
            frame, lighting, materials, slots, albedo, found, spans, leaving, gone,
        )  # fmt: skip
        if gone[0] > before and frame.within == 1 and leaving[before].within and leaving[before].bounces == ray.bounces:
            gone[0] = before  # it has met nothing on its way out, by rounding, and never would
        for c in range(3):
            radiance[ray.row, c] += colour[c]
    keep(owned)


@kernel
def add(rays: NDArray[np.void], stopped: NDArray[np.bool_], radiance: Floats) -> None:
    """Add the light of the RAYs that are not stopped to their rows of radiance."""
    for k in range(len(rays)):
        if not stopped[k]:
            for c in range(3):
                radiance[rays[k].row, c] += rays[k].through[c]


class Shapes(Protocol):
    """What rays meet: `raycast.Caster`."""

    objects: NDArray[np.void]

    @property
    def start(self) -> float:
        """How far off a mesh rays must begin, world units."""

    def hits(self, origin: Floats, directions: Floats, own: Ints | None = None) -> NDArray[np.void]:
        """The nearest HIT (n,) of each ray from `origin` (n, 3) along `directions` (n, 3)."""

    def frames(self, origin: Floats, directions: Floats, hits: NDArray[np.void]) -> tuple[NDArray[np.void], Ints]:
        """The tangent FRAMEs at the hits, and which (n,) each has."""

    def blocked(
        self, origin: Floats, directions: Floats, hits: NDArray[np.void], lights: NDArray[np.void]
    ) -> NDArray[np.uint64]:
        """For each hit (n,) a mask of the lights that something stands before."""

    def stopped(self, points: Floats, towards: Floats, far: Floats, own: Ints) -> NDArray[np.bool_]:
        """Whether another object stands in the ways `towards` (n, 3) from `points` (n, 3) of the objects `own` (n,)."""


def ask(rays: NDArray[np.void], shapes: Shapes, radiance: Floats) -> None:
    """Add the light of RAYs towards lights, `clear` times their ways off, where no other object stands in them."""
    for number in np.unique(rays["number"]):
        some = rays[rays["number"] == number]
        add(some, shapes.stopped(some["origin"], some["way"], some["clear"], some["object"].astype(np.int32)), radiance)


def meet(
    rays: NDArray[np.void], shapes: Shapes, patterns: Sequence[Pattern], slots: Sequence[NDArray[np.int32]], seed: int,
    footprints: NDArray[np.void], lighting: Lighting, materials: NDArray[np.void], albedo: Floats, radiance: Floats,
) -> None:  # fmt: skip
    """Add what RAYs see, and all that is seen from there, to the radiance (EIGHTHS n, 5) of their footprints (n,).

    patterns, slots: by the column `pattern` and by the row of OBJECT.
    """
    while len(rays):
        origin, way, own = np.empty((len(rays), 3)), np.empty((len(rays), 3)), np.empty(len(rays), np.int32)
        depart(rays, shapes.objects, shapes.start, origin, way, own)
        hits = shapes.hits(origin, way, own)
        (frames, of), blocked = shapes.frames(origin, way, hits), shapes.blocked(origin, way, hits, lighting.lights)
        leaving, gone = np.empty(len(rays), RAY), np.zeros(1, np.int64)
        order, ends = np.empty(len(rays), np.int64), np.empty(2 * len(shapes.objects) + 2, np.int64)
        arrange(hits, frames, of, order, ends)
        meet_sky(rays, order[: ends[1]], lighting, radiance)
        for k in np.flatnonzero(np.diff(ends[1:])) + 1:
            row, grooved = divmod(int(k) - 1, 2)
            meet_surface(
                seed, patterns[shapes.objects["pattern"][row]] if grooved else BARE, shapes.objects, rays,
                order[ends[k] : ends[k + 1]], hits, frames, of, blocked, footprints, lighting, materials, slots[row],
                albedo, radiance, leaving, gone,
            )  # fmt: skip
        rays = leaving[: gone[0]]
