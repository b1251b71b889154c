"""Method `csg`: rays against the spans of added and removed material (003), n even samples a footprint.

Right for every case, however slow. `auto` sends it what no cheaper method takes. Where light is followed further, or
another object may stand in its way, it is told which samples to take (`sampling`). Else a footprint near one or two
grooves whose corners and first few samples all fall on one facet, all lit alike, is left at those: what one straight
edge cuts off a footprint has one of its corners in it. Any other gets as many as bring the predicted error within the
tolerance: that of a mean of strata, whose variances the differences of neighbours tell. A part of a pixel, as next to
an outline, gets fewer the smaller it is: of a pixel's parts the errors are independent.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.curve import is_curved, turned, unsure
from renderer.geometry.query import find, nearby
from renderer.geometry.random import EIGHTHS, PLACE, drawn, jitter, seed_of
from renderer.geometry.rays import follow
from renderer.geometry.shapes import NEXT_TO
from renderer.geometry.shell import STRAY, is_round, is_shaded, placed, raised, seen_from
from renderer.geometry.solid import DOWN, lift, meet, normal_of, polish, shadow_ray, thin_of
from renderer.geometry.spans import END, PLANE, events
from renderer.geometry.straight import light_over, sight_over, straightened
from renderer.geometry.view import on_plane, thinnest, through_screen, view_of
from renderer.kernel import borrow, fixed, keep, kernel
from renderer.scattering import is_mirrored, scatter
from renderer.shading import (
    ambient,
    dot,
    light_to_pattern,
    lit_by,
    normal_to_world,
    sky_from,
    to_world,
    unit,
    white,
)
from renderer.tables import BESIDE, CSG, NOT_MINE, POINT, Camera, Lighting, Pattern

SHARED = fixed(32)  # up to so many pieces are found once for all samples of a footprint
FEW = 2  # with a tolerance, and no more pieces near than this, it begins with
PROBE = 4  # the corners and PROBE * PROBE samples,
FIRST = 8  # else or then takes FIRST * FIRST,
MOST = 64  # and at most MOST * MOST; a part of a pixel fewer
WORTH = 32  # ... of which, sparing, it takes no more than WORTH * WORTH: exact areas are as fast
GRAINY = 0.01  # the tolerance, at least, where a curved base makes rays bend much: many footprints at low light
BENT = 0.3  # ... by this part of its slope
UNSEEN = 0.1  # of white over n: what the parts that no sample has met may be
STRATIFIED = 0.72  # of what sets neighbours apart is a stratum's own error: an edge between two counts (measured);
# all of it is, where neighbours are as far apart as any two samples: strata that each hold many grooves
SURE = 0.5  # how much of the tolerance the standard error may take
BOWED = 0.15  # so far chords may be from rays on round shapes, times the tolerance, in pixels' least widths
SHADED = 4.0  # ... and those of shadows this times as far


@kernel
def csg(
    numbers: NDArray[np.int64], bounces: int, indirect: bool, shown: bool, tolerance: float, sparing: bool, seed: int,
    leaving: NDArray[np.void], gone: NDArray[np.int64], asking: NDArray[np.void], asked: NDArray[np.int64],
    pattern: Pattern, footprints: NDArray[np.void], chosen: NDArray[np.int64], objects: NDArray[np.void],
    frames: NDArray[np.void], camera: Camera, lighting: Lighting, materials: NDArray[np.void],
    slots: NDArray[np.int32], albedo: NDArray[np.float64], radiance: NDArray[np.float64], method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance, predicted error and cost (n, 5) and method.

    numbers: (n, 2) the samples to take of each, from the first to before the last, which are spread evenly, the first n
    for every n. What those of an eighth of the first to the last add up to is added to radiance (EIGHTHS n, 5). Where
    there are none, as many as the tolerance asks for, with no bounces, for their mean. sparing: NOT_MINE, where that is
    more than it is worth. tolerance: relative to a white surface in the same light; on round shapes rays keep to their
    curves as it asks. bounces: how often light is followed from facet to facet; indirect: that light alone, added to
    what is there; shown: without what mirrors show, which is there too. leaving: room for each sample's RAY
    (`rays.follow`), if others are to meet them; `gone` (1,) is how many there are. asking, asked: the same for light
    that another object may keep from where a footprint is `torn`; its `number` is the light's. slots: rows of
    `materials` for the pattern's facets, the object's own first.
    """
    capacity = max(pattern.near, SHARED)
    owned = nearby(pattern, capacity), events(pattern), nearby(pattern, capacity)
    found, spans, around = borrow(owned[0]), borrow(owned[1]), borrow(owned[2])
    pattern, frames, lighting, camera = borrow(pattern), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    leaving, gone, asking, asked = borrow(leaving), borrow(gone), borrow(asking), borrow(asked)
    lights, eye = lighting.lights, camera.origin
    high, low = pattern.height, -pattern.depth
    thin = thin_of(pattern)
    above = np.zeros(MOST)
    told = len(numbers) > 0
    for turn in range(len(chosen)):
        index = chosen[turn]
        footprint = footprints[index]
        frame = frames[footprint.frame]
        obj = objects[frame.object]
        view = view_of(footprint, frame, camera)
        curved, rounded = is_curved(frame), is_round(obj, frame) or footprint.open == BESIDE
        stray = strayed = STRAY * (high - low)  # of sight and of light
        near = BOWED * tolerance * thinnest(view, 1.0) / footprint.size if rounded else math.inf
        if near < stray:
            stray, strayed = near, min(strayed, SHADED * near)
        dw = frame.eye[2]
        top = min(high + thin, dw * (1.0 - 1e-9))

        # The pieces that any sample may meet, where they are few.
        p0, p1, q0, q1 = math.inf, -math.inf, math.inf, -math.inf
        for k in range(4):
            cp, cq = on_plane(view, float(k & 1), float(k >> 1))
            gp, gq = (frame.eye[0] - cp) / dw, (frame.eye[1] - cq) / dw
            if curved:
                cp, cq, gp, gq = sight_over(frame, cp, cq, gp, gq, top, low - thin)
            for w in (low, top):
                p0, p1 = min(p0, cp + w * gp), max(p1, cp + w * gp)
                q0, q1 = min(q0, cq + w * gq), max(q1, cq + w * gq)
        fp0, fp1, fq0, fq1 = p0, p1, q0, q1
        apart = False  # what light must pass is not the same all over the footprint
        for l in range(len(lights)):
            d = light_over(pattern.height, pattern.width, frame, lights[l], view.p, view.q, low, high)
            if curved:
                for k in range(4):
                    cp, cq = on_plane(view, float(k & 1), float(k >> 1))
                    c = light_over(pattern.height, pattern.width, frame, lights[l], cp, cq, low, high)
                    apart = apart or (c[2] > 0.0) != (d[2] > 0.0)
                    d = (d[0], d[1], min(d[2], c[2]), d[3])
            if d[2] > 0.0 and d[3] == 0.0:
                gp, gq = (high - low) * d[0] / d[2], (high - low) * d[1] / d[2]
                fp0, fp1, fq0, fq1 = min(fp0, p0 + gp), max(fp1, p1 + gp), min(fq0, q0 + gq), max(fq1, q1 + gq)
            elif d[2] > 0.0:
                way = min((high - low) / (d[2] - low), 1.0)  # the part of the way to the light that leads by grooves
                fp0, fp1 = min(fp0, p0 + way * (d[0] - p0)), max(fp1, p1 + way * (d[0] - p1))
                fq0, fq1 = min(fq0, q0 + way * (d[1] - q0)), max(fq1, q1 + way * (d[1] - q1))
        margin = pattern.reach
        shared = -1
        if not apart and footprint.open != BESIDE:
            shared = find(pattern, found, fp0 - margin, fq0 - margin, fp1 + margin, fq1 + margin, SHARED)

        part = math.sqrt(footprint.weight)
        ease = math.sqrt(part)  # half of what independent errors allow: few samples tell little of their own error
        begin = max(int(math.ceil(FIRST * part)), PROBE)
        most = max(int(math.ceil(MOST * ease)), begin)
        across = down = begin
        corners = 0
        if 0 <= shared <= FEW:
            across, down, corners = PROBE, PROBE, 4
        target, bright = tolerance, 1.0
        first, stop, row = 0, 0, index
        if told:
            first, stop = numbers[turn, 0], numbers[turn, 1]
            across, down, corners = stop - first, 1, 0
        else:
            bends = curved and not rounded
            if bends and straightened(pattern, frame, view.p, view.q, footprint.blocked, lights) > BENT:
                target = max(tolerance, GRAINY)
            bright = white(lighting, to_world(frame, view.p, view.q, 0.0))
            target *= SURE / ease * bright
        state = seed_of(seed, footprint.x, footprint.y)
        red = green = blue = error = own = 0.0
        taken = looked = 0
        while True:
            red = green = blue = 0.0
            taken = 0
            unlike = squares = 0.0
            last = 0.0
            alike = True
            first_facet, first_found, first_lit = 0, 0, np.uint64(0)
            for i in range(first - corners, first + across * down):  # the corners are looked at, not counted
                before = red + green + blue
                if i < 0:
                    u, v = float((-1 - i) & 1), float((-1 - i) >> 1)
                elif told:
                    row = EIGHTHS * index + i * EIGHTHS // stop
                    _, u, v = drawn(i, PLACE, seed, footprint.x, footprint.y)
                else:
                    state, ju = jitter(state)
                    state, jv = jitter(state)
                    u, v = (i % across + ju) / across, (i // across + jv) / down
                if rounded:
                    sight = unit(
                        through_screen(camera, footprint.x + u * footprint.size, footprint.y + v * footprint.size)
                    )
                    passed = seen_from(
                        pattern, found, spans, obj, (eye[0], eye[1], eye[2]), sight, footprint.open == BESIDE, stray
                    )
                    m, x, y, at, gp, gq = passed.meeting, passed.x, passed.y, passed.w, passed.gp, passed.gq
                else:
                    p, q = on_plane(view, u, v)
                    gp, gq = (frame.eye[0] - p) / dw, (frame.eye[1] - q) / dw
                    if curved:
                        p, q, gp, gq = sight_over(frame, p, q, gp, gq, top, low - thin)
                    m = meet(pattern, found, spans, shared, p, q, gp, gq, top, low - thin, DOWN)
                    at = max(polish(pattern, found, m, p, q, gp, gq), low)
                    x, y = p + at * gp, q + at * gq
                missed = rounded and m.w == -math.inf and not indirect
                n = normal_of(pattern, found, m, x, y, gp, gq)
                if rounded and not passed.descends:
                    n = (-n[0], -n[1], -n[2])
                if rounded and m.facet == END and m.found == PLANE:  # of a cylinder
                    n = (0.0, math.copysign(1.0, y - obj.mapping[3] - 0.5 * obj.mapping[1]), 0.0)
                slot = 0
                if m.found >= 0:
                    item = found.piece[m.found]
                    if m.facet >= 0:
                        slot = pattern.facet_slot[pattern.grooves[pattern.pieces[item].groove].slot + m.facet] + 1
                else:
                    item = -1
                material = materials[slots[slot]]
                if rounded:
                    n_world, at_world = raised(obj, x, y, at, n), placed(obj, x, y, at)
                else:
                    facing = turned(frame, x - frame.pq[0], y - frame.pq[1], at, n) if curved else n
                    n_world, at_world = normal_to_world(frame, facing), to_world(frame, x, y, at)
                e = unit((eye[0] - at_world[0], eye[1] - at_world[1], eye[2] - at_world[2]))
                if curved and not rounded and dot(n_world, e) <= 0.0:  # next to the outline, by the second order
                    facing, n_world = n, normal_to_world(frame, n)
                colour = (material.emissive[0], material.emissive[1], material.emissive[2])
                if bounces == 0:
                    colour = ambient(material, lighting, albedo, n_world, e)
                if missed:  # by the outline, to what is behind
                    colour = (0.0, 0.0, 0.0)
                    if len(leaving) == 0:
                        colour = sky_from(lighting, sight)
                    else:
                        ray = leaving[gone[0]]
                        gone[0] += 1
                        for axis in range(3):
                            ray.origin[axis], ray.way[axis], ray.through[axis] = eye[axis], sight[axis], 1.0
                        ray.row, ray.number, ray.bounces, ray.object = row, i, bounces + 1, frame.object
                        ray.within, ray.clear = 0, 0.0
                if not indirect:
                    red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
                lit = np.uint64(0)
                off = lift(pattern, found, m) / math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
                sx, sy, sw = x + off * n[0], y + off * n[1], at + off * n[2]
                for l in range(0 if indirect or missed else len(lights)):
                    torn = len(asking) > 0 and (footprint.torn >> np.uint64(l)) & np.uint64(1) != 0
                    if not torn and (footprint.blocked >> np.uint64(l)) & np.uint64(1):
                        continue
                    colour = lit_by(lights[l], material, n_world, e, at_world)
                    if colour[0] <= 0.0 and colour[1] <= 0.0 and colour[2] <= 0.0:
                        continue
                    if rounded:
                        if is_shaded(pattern, found, spans, obj, lights[l], sx, sy, sw, strayed):
                            continue
                    else:
                        d = light_to_pattern(frame, lights[l])
                        lp, lq, lw = d[0] - d[3] * x, d[1] - d[3] * y, d[2] - d[3] * at
                        if facing[0] * lp + facing[1] * lq + facing[2] * lw <= 0.0:
                            continue
                        if curved:
                            d = light_over(pattern.height, pattern.width, frame, lights[l], x, y, at, at)
                        if d[2] <= 0.0:
                            continue
                        lp, lq, roof, ground, up = shadow_ray(pattern, d, sx, sy, sw)
                        if roof > ground:
                            s = meet(
                                pattern, found, spans, shared, sx - sw * lp, sy - sw * lq, lp, lq, roof, ground, up
                            )
                            if s.w > -math.inf:
                                continue
                    if torn:
                        ray, place = asking[asked[0]], to_world(frame, sx, sy, sw)
                        if rounded:
                            place = placed(obj, sx, sy, sw)
                        near = lights[l].kind == POINT
                        asked[0] += 1
                        for axis in range(3):
                            ray.origin[axis], ray.through[axis] = place[axis], colour[axis]
                            ray.way[axis] = lights[l].vector[axis] - (place[axis] if near else 0.0)
                        ray.row, ray.number, ray.object = row, l, frame.object
                        ray.clear = NEXT_TO if near else math.inf
                        continue
                    lit |= np.uint64(1) << np.uint64(l)
                    red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
                if bounces > 0 and not missed:
                    lobe, bu, bv = drawn(i, 0, seed, footprint.x, footprint.y)
                    out, through = scatter(material, albedo, n_world, e, lobe, bu, bv, False)
                    if max(through[0], through[1], through[2]) > 0.0:
                        within = dot(n_world, out) < 0.0
                        known = shown and is_mirrored(material, n_world, e, out)
                        if within:
                            sx, sy, sw = sx - 2.0 * off * n[0], sy - 2.0 * off * n[1], sw - 2.0 * off * n[2]
                        colour = follow(
                            bounces, known, through, out, (sx, sy, sw), (0.0, 0.0), within, i, seed, row, footprint.x,
                            footprint.y, footprint.blocked, pattern, obj, frame, lighting, materials, slots, albedo,
                            around, spans, leaving, gone,
                        )  # fmt: skip
                        red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
                if i == -corners:
                    first_facet, first_found, first_lit = m.facet, item, lit
                elif m.facet != first_facet or item != first_found or lit != first_lit:
                    alike = False
                    if corners > 0:
                        break
                if i == -1:
                    red = green = blue = 0.0
                elif told:
                    taken += 1
                    radiance[row, 0] += red
                    radiance[row, 1] += green
                    radiance[row, 2] += blue
                    red = green = blue = 0.0
                elif i >= 0:
                    taken += 1
                    value = (red + green + blue - before) / 3.0
                    squares += value * value
                    column = i % across
                    if column > 0:
                        unlike += (value - last) ** 2
                    if i >= across:
                        unlike += (value - above[column]) ** 2
                    above[column] = last = value
            looked += taken
            if told:
                break
            if corners == 0 or alike:
                pairs = across * (down - 1) + down * (across - 1)
                apart_by, mean = unlike / (2.0 * pairs), (red + green + blue) / (3.0 * taken)
                spread = squares / taken - mean * mean
                own = STRATIFIED + (1.0 - STRATIFIED) * apart_by / max(apart_by, spread, 1e-300)
                error = own * math.sqrt(apart_by / taken)
                if corners == 0:
                    error = math.hypot(error, UNSEEN * bright / taken)
                if error <= target or across >= most:
                    break
            if corners > 0:
                across, down, corners = begin, begin, 0
                continue
            # errors go with the number of samples to the power of 3/4, or, where strata do not help, of 1/2
            crowded = (own - STRATIFIED) / (1.0 - STRATIFIED)
            across = int(math.ceil(1.05 * across * min((error / target) ** ((2.0 + crowded) / 3.0), float(MOST))))
            if sparing and across > WORTH:
                taken = 0
                break
            across = down = min(across, most)
        if taken == 0:
            method[index] = NOT_MINE
            continue
        method[index] = CSG
        if not told:
            radiance[index, 0], radiance[index, 1], radiance[index, 2] = red / taken, green / taken, blue / taken
            radiance[index, 3], radiance[index, 4] = error / SURE * ease / bright if bright > 0.0 else 0.0, 0.0
        if curved and not rounded:
            radiance[row, 3] += unsure(frame, max(p0 - fp0, fp1 - p1, q0 - fq0, fq1 - q1, pattern.width))
        radiance[row, 4] += float(looked) * max(shared, 1)
    keep(owned)
