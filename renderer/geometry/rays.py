"""Rays from facet to facet of the solid, one by one, met by the spans of added and removed material (003)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import bent, is_curved, turned
from renderer.geometry.query import Nearby
from renderer.geometry.random import drawn
from renderer.geometry.shapes import local
from renderer.geometry.shell import LEVEL, STRAY, carried, is_round, is_shaded, pass_through, placed, raised
from renderer.geometry.solid import (
    DOWN,
    OPEN,
    RISE,
    SINK,
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
from renderer.geometry.spans import BODY, NO, PLANE, Events
from renderer.kernel import callee
from renderer.scattering import TOUCH, is_mirrored, scatter
from renderer.shading import (
    Vector,
    ambient,
    direction_to_pattern,
    dot,
    light_to_pattern,
    lit_by,
    normal_to_world,
    sky_from,
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
    if len(pattern.pieces) == 0:  # bare
        return Meeting(0.0, PLANE, -1, BODY) if way in (DOWN, RISE) else OPEN
    return meet(pattern, found, spans, -1, x - w * gp, y - w * gq, gp, gq, top, bottom, way)


@callee
def follow(
    bounces: int, shown: bool, through: Vector, way: Vector, start: Vector, steer: tuple[float, float], within: bool,
    number: int, seed: int, row: int, px: float, py: float, blocked: np.uint64, pattern: Pattern, obj: np.void,
    frame: np.void, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    found: Nearby, spans: Events, leaving: NDArray[np.void], gone: NDArray[np.int64],
) -> Vector:  # fmt: skip
    """What comes back along the ray that leaves `start` (off the surface, pattern space) by `way` (unit, world), times
    `through`, RGB: the light of what it meets, and of what the rays from there meet, up to so many `bounces`.

    shown: the light of what is met first is known, on this surface or another, and so is what mirrors send on from
    there: both are left out.
    steer: by how much its first slopes to the plane differ from those of `way`, over a mesh. within: it is inside the
    body. Each of a footprint's samples, of that number, draws its own rays; (px, py) is the footprint's
    place on the screen. Where the last one meets the surface, that is lit by all of the sky; from within it shows no
    light but its own. A ray that leaves the surface meets the sky, or becomes the RAY `leaving[gone[0]]` of this `row`,
    where there is room for any.
    """
    lights = lighting.lights
    rounded = is_round(obj, frame)
    curved = not rounded and is_curved(frame)
    stray = STRAY * (pattern.height + pattern.depth)
    red = green = blue = 0.0
    emerged = False
    x, y, w = start
    for left in range(bounces, 0, -1):
        clear = 0.0  # within a sphere or a cylinder the farthest place is met, whatever is before
        if rounded:
            o = carried(obj, x, y, w)
            d = local(obj, way[0], way[1], way[2])
            passed = pass_through(pattern, found, spans, obj, o, d, (x, y, w), 0.0, math.inf, within, NO, stray)
            m, gp, gq, rises = passed.meeting, passed.gp, passed.gq, not passed.descends
            leaves = passed.leaves
        else:
            d = direction_to_pattern(frame, way)
            rise = leveled(d[0], d[1], d[2], LEVEL)
            gp, gq, rises = d[0] / rise, d[1] / rise, rise > 0.0
            if left == bounces:
                gp, gq = gp + steer[0], gq + steer[1]
            top, bottom, sense = w, -pattern.depth - thin_of(pattern), SINK if within else DOWN
            if rises:
                top, bottom, sense = pattern.height + thin_of(pattern), w, RISE if within else UP
            m = OPEN
            if within or not rises or w < pattern.height:
                m = meet_far(pattern, found, spans, x, y, w, gp, gq, top, bottom, sense)
            leaves = rises != within
            if m.w == -math.inf:
                clear = max((bottom if within else 0.0) - w, 0.0) / rise
        if m.w == -math.inf:
            if leaves and not shown and len(leaving) > 0:
                ray = leaving[gone[0]]
                gone[0] += 1
                ox, oy, ow = bent(frame, x, y, w) if curved else (x, y, w)
                place = placed(obj, x, y, w) if rounded else to_world(frame, ox, oy, ow)
                back = 0.0  # what a body stands on begins where it ends
                if emerged:
                    back = TOUCH * (1.0 + math.sqrt(dot(place, place)))
                for c in range(3):
                    ray.origin[c], ray.way[c], ray.through[c] = place[c] - back * way[c], way[c], through[c]
                ray.row, ray.number, ray.bounces, ray.object = row, number, left, frame.object
                ray.within = int(within)
                ray.clear = clear
            elif leaves and not shown:
                sky = sky_from(lighting, way)
                red, green, blue = red + through[0] * sky[0], green + through[1] * sky[1], blue + through[2] * sky[2]
            break
        if rounded:
            x, y, w = passed.x, passed.y, passed.w
        else:
            p, q = x - w * gp, y - w * gq
            w = polish(pattern, found, m, p, q, gp, gq)
            x, y = p + w * gp, q + w * gq
        across = normal_of(pattern, found, m, x, y, gp, gq)
        if rises:  # which is the side seen from above
            across = (-across[0], -across[1], -across[2])
        slot = 0
        if m.found >= 0 and m.facet >= 0:
            slot = pattern.facet_slot[pattern.grooves[pattern.pieces[found.piece[m.found]].groove].slot + m.facet] + 1
        material = materials[slots[slot]]
        off = lift(pattern, found, m) / math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
        at = placed(obj, x, y, w) if rounded else to_world(frame, x, y, w)
        e = (-way[0], -way[1], -way[2])
        n = raised(obj, x, y, w, across) if rounded else normal_to_world(frame, across)
        if curved:
            over = normal_to_world(frame, turned(frame, x - frame.pq[0], y - frame.pq[1], w, across))
            if dot(over, e) > 0.0:
                n = over
        x, y, w = x + off * across[0], y + off * across[1], w + off * across[2]
        last = left == 1
        colour = (material.emissive[0], material.emissive[1], material.emissive[2])
        if last and not within:
            colour = ambient(material, lighting, albedo, n, e)
        for l in range(0 if within or shown else len(lights)):
            if (blocked >> np.uint64(l)) & np.uint64(1):
                continue
            lit = lit_by(lights[l], material, n, e, at)
            if max(lit[0], lit[1], lit[2]) <= 0.0:
                continue
            if rounded:
                shaded = is_shaded(pattern, found, spans, obj, lights[l], x, y, w, stray)
            else:
                light = light_to_pattern(frame, lights[l])
                if light[2] <= 0.0:
                    continue
                lp, lq, top, bottom, sense = shadow_ray(pattern, light, x, y, w)
                shaded = meet_far(pattern, found, spans, x, y, w, lp, lq, top, bottom, sense).w > -math.inf
            if not shaded:
                colour = (colour[0] + lit[0], colour[1] + lit[1], colour[2] + lit[2])
        if not shown:
            red, green = red + through[0] * colour[0], green + through[1] * colour[1]
            blue = blue + through[2] * colour[2]
        if last:
            break
        lobe, u, v = drawn(number, left, seed, px, py)
        way, weight = scatter(material, albedo, n, e, lobe, u, v, within)
        shown = shown and is_mirrored(material, n, e, way)
        emerged = dot(n, way) < 0.0 and within
        if dot(n, way) < 0.0:  # through the facet
            within = not within
            x, y, w = x - 2.0 * off * across[0], y - 2.0 * off * across[1], w - 2.0 * off * across[2]
        through = (through[0] * weight[0], through[1] * weight[1], through[2] * weight[2])
        if max(through[0], through[1], through[2]) <= 0.0:
            break
    return red, green, blue
