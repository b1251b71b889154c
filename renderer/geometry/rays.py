"""Rays from mirror to mirror over the solid, one by one, met by the spans of added and removed material (003)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.query import Nearby
from renderer.geometry.solid import (
    DOWN,
    OPEN,
    UP,
    Meeting,
    leveled,
    lift,
    meet,
    normal_of,
    polish,
    shadow_ray,
    thin_of,
)
from renderer.geometry.spans import Events
from renderer.kernel import callee
from renderer.shading import (
    Vector,
    ambient,
    direction_to_pattern,
    dot,
    light_to_pattern,
    lit_by,
    mirrored,
    normal_to_world,
    to_world,
)
from renderer.tables import Floats, Lighting, Pattern


@callee
def meet_far(
    pattern: Pattern, found: Nearby, spans: Events, x: float, y: float, w: float, gp: float, gq: float, top: float,
    bottom: float, way: int,
) -> Meeting:  # fmt: skip
    """What the ray through (x, y, w) meets between two heights."""
    if top <= bottom:
        return OPEN
    return meet(pattern, found, spans, -1, x - w * gp, y - w * gq, gp, gq, top, bottom, way)


@callee
def follow(
    bounces: int, through: Vector, n: Vector, e: Vector, start: Vector, blocked: np.uint64, pattern: Pattern,
    frame: np.void, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    found: Nearby, spans: Events,
) -> Vector:  # fmt: skip
    """The radiance that a mirror with the unit normal n (world) sends to E of what it shows, from mirror to mirror.

    through: the part that the mirror sends on. start: off its surface, pattern space. blocked: lights that do not
    reach the footprint.
    """
    lights, sky = lighting.lights, lighting.sky
    red = green = blue = 0.0
    x, y, w = start
    for _ in range(bounces):
        cosine = 2.0 * dot(n, e)
        e = (e[0] - cosine * n[0], e[1] - cosine * n[1], e[2] - cosine * n[2])  # from what is seen to the mirror
        d = direction_to_pattern(frame, (-e[0], -e[1], -e[2]))
        rise = leveled(d[0], d[1], d[2])
        gp, gq = d[0] / rise, d[1] / rise
        top, bottom, way = w, -pattern.depth - thin_of(pattern), DOWN
        if rise > 0.0:
            top, bottom, way = pattern.height + thin_of(pattern), w, UP
        m = meet_far(pattern, found, spans, x, y, w, gp, gq, top, bottom, way)
        if m.w == -math.inf:
            if rise > 0.0:
                red, green, blue = red + through[0] * sky[0], green + through[1] * sky[1], blue + through[2] * sky[2]
            break
        p, q = x - w * gp, y - w * gq
        w = polish(pattern, found, m, p, q, gp, gq)
        x, y = p + w * gp, q + w * gq
        across = normal_of(pattern, found, m, x, y, gp, gq)
        if rise > 0.0:  # which is the side seen from above
            across = (-across[0], -across[1], -across[2])
        slot = 0
        if m.found >= 0 and m.facet >= 0:
            slot = pattern.facet_slot[pattern.grooves[pattern.pieces[found.piece[m.found]].groove].slot + m.facet] + 1
        material = materials[slots[slot]]
        off = lift(pattern, found, m) / math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
        at = to_world(frame, x, y, w)
        n = normal_to_world(frame, across)
        x, y, w = x + off * across[0], y + off * across[1], w + off * across[2]
        colour = ambient(material, sky, albedo, n, e)
        for l in range(len(lights)):
            if (blocked >> np.uint64(l)) & np.uint64(1):
                continue
            light = light_to_pattern(frame, lights[l])
            lit = lit_by(lights[l], material, n, e, at)
            if light[2] <= 0.0 or max(lit[0], lit[1], lit[2]) <= 0.0:
                continue
            lp, lq, top, bottom, way = shadow_ray(pattern, light, x, y, w)
            if meet_far(pattern, found, spans, x, y, w, lp, lq, top, bottom, way).w == -math.inf:
                colour = (colour[0] + lit[0], colour[1] + lit[1], colour[2] + lit[2])
        red, green, blue = red + through[0] * colour[0], green + through[1] * colour[1], blue + through[2] * colour[2]
        clear = mirrored(material, dot(n, e))
        through = (through[0] * clear[0], through[1] * clear[1], through[2] * clear[2])
        if max(through[0], through[1], through[2]) <= 0.0:
            break
    return red, green, blue
