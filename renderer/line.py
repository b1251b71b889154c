"""Methods `line` and `segment`: grooves that run parallel within a footprint (000, section 4; 001, section 5).

The cross-section is projected along B onto the base line, masked from the eye and shadowed from each light by the
order of the projected points (000, eq. 4), and each visible, lit interval weighs as much of the footprint as it fills.
Two changes to the papers, which `line` makes and `segment` does not (DESIGN 2.1, 2.2):

- the eye and point lights project as points, not along one direction a pixel: exact under perspective;
- an interval's weight is the exact area of the pixel's square between its two lines, not its length on a segment that
  stands for the footprint (000, eq. 3).

On a curved base the points lie lower the farther they are from the footprint's centre, by its second fundamental form,
and their normals turn (`curve`). An eye or a light, and the line through the centre from which its places are counted,
span a plane; the cross-section is what that plane cuts out of the solid. Over ridges the light may come from below the
tangent plane.

Where nothing stands above the plane, grooves do not mask each other, and each is a cross-section of its own; those
that overlap share one. Then light that matt facets exchange is in closed form too (`strings`), however often it
bounces, and what they get of a picture of the sky (`opening`). So is a first bounce where facets are ideal mirrors in
part. A coat, which is not matt where light leaves it, is left to samples, as all gloss is.

A profile that overhangs is no cross-section for this: `auto` leaves its grooves to `area`, and as methods of the
whole image `line` and `segment` leave them out, so that the plane is seen there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import peak, sharpness
from renderer.geometry.curve import bow_of, is_curved, sink, turned
from renderer.geometry.layout import (
    KNOWN,
    LEVEL,
    POINTS,
    ROUND,
    Work,
    chord_of,
    direction,
    find_around,
    find_within,
    fold_within,
    lay,
    longer,
    meet_lights,
    near_groove,
    pick,
    reach_along,
    turn_lights,
    wider_of,
    work_for,
)
from renderer.geometry.reach import Reach
from renderer.geometry.reflection import reflections
from renderer.geometry.section import along, carried, foot_of, fraction_at, onto_base, spans
from renderer.geometry.slices import SLICES, along_bent, slice_up
from renderer.geometry.straight import left_by_lines
from renderer.geometry.strings import (
    APART,
    BEYOND,
    NEAR_LAMP,
    exchange,
    gathered,
    light_up,
    nearest_lamp,
    open_up,
    place,
    recall,
    stretch_of,
)
from renderer.geometry.tint import FLAT, WIDE, Spread, bent_at, facet_at, liven, spread_of, tint_over
from renderer.geometry.view import View, on_plane, view_of
from renderer.kernel import borrow, keep, kernel, leaf
from renderer.shading import (
    DIFFUSE,
    GLOSSY,
    MIRROR,
    Vector,
    ambient,
    answers,
    are_distant,
    dot,
    has_picture,
    lit_by,
    mirrored,
    normal_to_world,
    to_world,
    unit,
    white,
)  # fmt: skip
from renderer.tables import BASE, LINE, NOT_MINE, SEGMENT_METHOD, Camera, Floats, Lighting, Pattern

# How the kernel treats what is not parallel, isolated and straight.
STRICT = 0  # `auto`: mark it as not its own
LOOSE = 1  # `line` for the whole image: the grooves parallel to the nearest one, nothing else
PAPER = 2  # `segment` for the whole image

NARROW = 1e-4  # of a facet
BESIDE = 0.35  # of the brightest: facets that are not seen or not lit here may be so next to it
FINE = 0.25  # of the error that may be left: slices of a footprint are so many that paths bow by no more in each
# What paths that bow by 1 over a footprint 1 wide fill of its two rims where they run along them: twice the integral of
# (1 / 3 - u^2) / 2 over where that is positive.
RIM = 0.257

GAUSS = 0.5 / math.sqrt(3.0)


@leaf
def up_to(view: View, bx: float, by: float, centre: float, y: float, entries: int, work: Work) -> float:
    """The share of the footprint below y and its copies by `work.sums`. The last few are kept: intervals share ends."""
    for k in range(KNOWN):
        if work.known[k, 0] == y:
            return float(work.known[k, 1])
    total = 0.0
    for k in range(entries):
        total += work.sums[k, 1] * along(view, bx, by, centre + work.sums[k, 0] + y)
    at = int(work.known[KNOWN, 0])
    work.known[at, 0], work.known[at, 1] = y, total
    work.known[KNOWN, 0] = (at + 1) % KNOWN
    return total


@leaf
def weigh(
    folded: bool, entries: int, cuts: int, paper: bool, view: View, bx: float, by: float,
    centre: float, half: float, low: float, high: float, work: Work,
) -> float:  # fmt: skip
    """The share of the footprint between two places along B: of its area, or of the papers' segment [-half, half]; for
    all that a groove stands for. cuts: so many slices are there, where paths bend; 1: none."""
    if paper:
        return (min(max(high, -half), half) - min(max(low, -half), half)) / (2.0 * half)
    if folded and entries == 0:
        return float(work.sums[0, 1] * (high - low))
    if folded and entries > 1:
        return up_to(view, bx, by, centre, high, entries, work) - up_to(view, bx, by, centre, low, entries, work)
    if cuts > 1:
        return along_bent(cuts, high, work.slices) - along_bent(cuts, low, work.slices)
    return along(view, bx, by, centre + high) - along(view, bx, by, centre + low)


@leaf
def hidden_of(
    low: float, high: float, change: Floats, curved: bool, spread: Spread, frame: np.void, view: View,
    r: Reach, eye_d: float, eye_h: float, lighting: Lighting, material: np.void, albedo: Floats, work: Work,
) -> Vector:  # fmt: skip
    """What the plane would send to the eye between two places of the base line."""
    red = green = blue = 0.0
    low, high = max(low, r.low), min(high, r.high)
    for l in range(len(change)):
        if l < len(work.light) and work.light[l, 3] == 0.0:
            continue
        colour = tint_over(
            -1, l, low, high, change[l], False, False, False, curved, 0.0, work.b, work.w, 0.0, spread, frame, view, r,
            eye_d, eye_h, lighting, material, albedo, work,
        )  # fmt: skip
        red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
    return red, green, blue


@leaf
def complete_section(curved: bool, pattern: Pattern, slots: NDArray[np.int32], n: int, work: Work) -> None:
    """Complete `work.section`: which material its facets have, and which part of each is lit.

    Mirrors and light from facet to facet take a curved base for its tangent plane: what they show is near.
    """
    section, places = work.section, work.bent if curved else work.b
    for i in range(n - 1):
        slot = 0
        if work.owner[i] >= 0:
            groove = pattern.grooves[pattern.pieces[work.near[work.owner[i]].piece].groove]
            slot = pattern.facet_slot[groove.slot + work.facet[i]] + 1
        section.material[i] = slots[slot]
        b0, b1 = places[i], places[i + 1]
        for l in range(len(work.light)):
            d, lit = work.light[l], section.lit[l, i]
            heights = work.sunk[l] if curved else work.w
            w0, w1 = heights[i], heights[i + 1]
            low, high = work.lit_low[l, i], work.lit_high[l, i]
            lit[0] = lit[1] = 0.0
            if d[3] != 0.0 and high > low:
                if low > onto_base(b0, w0, d[0], d[1], d[2]):
                    lit[0] = fraction_at(low, b0, w0, b1, w1, d[0], d[1], d[2])
                lit[1] = 1.0
                if high < onto_base(b1, w1, d[0], d[1], d[2]):
                    lit[1] = fraction_at(high, b0, w0, b1, w1, d[0], d[1], d[2])


@kernel
def line(
    mode: int, rough: float, bounces: int, pattern: Pattern, footprints: NDArray[np.void],
    chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera, lighting: Lighting,
    materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats, radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance (n, 3) and the method each took.

    What has too many grooves in it is not its own, whatever the mode: STRICT, LOOSE or PAPER. rough: the error, at
    most, that STRICT leaves on a curved base, relative to a white surface. bounces: how often light is followed; this
    does so from mirror to mirror and from matt to matt where nothing stands above the plane. slots: rows of `materials`
    for the pattern's facets, the object's own first.
    """
    owned = work_for(pattern, len(lighting.lights))
    work, pattern, frames, lighting = borrow(owned), borrow(pattern), borrow(frames), borrow(lighting)
    camera, materials, slots, albedo = borrow(camera), borrow(materials), borrow(slots), borrow(albedo)
    lights = lighting.lights
    strict, paper = mode == STRICT, mode == PAPER
    distant = are_distant(lights)
    matte = bare = True
    for slot in slots:
        bare = bare and materials[slot].f90 == 0.0
        matte = matte and materials[slot].metallic == 0.0 and materials[slot].f90 == 0.0
    answer = answers(materials, slots) if bounces > 0 else 0
    shows, gathers = answer & MIRROR != 0, answer & DIFFUSE != 0
    samples = answer & GLOSSY != 0 or (shows and gathers and (bounces > 1 or not bare))
    mutual = BEYOND * pattern.width if gathers else 0.0
    diagonal = math.hypot(pattern.width, pattern.depth)
    ridged = pattern.height > 0.0
    if has_picture(lighting) and (answer & (MIRROR | GLOSSY) != 0 or (paper and gathers)):
        for index in chosen:  # rays get more of the picture than a few directions, and the papers' T turns along arcs
            method[index] = NOT_MINE
        return
    stretched, stretch_x, stretch_y, stretch = -1, 0.0, 0.0, 0.0  # a frame and T, and what `stretch_of` says of them
    sharp = bright = 1.0
    for slot in slots:
        if sharpness(materials[slot]) > sharp:
            sharp, bright = sharpness(materials[slot]), peak(materials[slot])
    pale = 0.0  # the brightest matt facet
    for slot in slots:
        base, material = materials[slot].base_color, materials[slot]
        body = (1.0 - material.metallic) * (1.0 - material.transmission)
        pale = max(pale, body * (base[0] + base[1] + base[2]) / 3.0)
    change = np.zeros(len(lights) + 1)  # of colours, under each light and under the sky
    most = 0  # points of a cross-section
    for profile in pattern.profiles:
        most = max(most, profile.count)
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        eye_w = frame.eye[2]
        method[index] = NOT_MINE
        curved = not paper and is_curved(frame)
        clear = meet_lights(curved, pattern, frame, view, footprint.blocked, lights, work)
        if strict and (not clear or eye_w <= LEVEL * pattern.height or (shows and ridged)):
            continue
        if (samples or gathers) and ridged:
            continue
        lamp = math.inf
        if gathers and not distant:
            lamp = nearest_lamp(frame, view, lights)
            if lamp < NEAR_LAMP * pattern.width:
                continue
        eye_p, eye_q = (frame.eye[0] - view.p) / eye_w, (frame.eye[1] - view.q) / eye_w
        beyond = mutual
        if shows:  # mirrors leave the part of a ray's way along T as it is: it gets so far while it crosses a groove
            beyond = max(mutual, pattern.width + bounces * diagonal * math.hypot(eye_p, eye_q))
        grooves, entries, crooked = 0, 0, 0.0
        if not paper and clear and len(pattern.families) > 0 and eye_w > LEVEL * pattern.height:
            grooves, entries, crooked, r = fold_within(curved, beyond, pattern, frame, view, lights, work)
        folded = grooves > 0
        if entries > 1:
            work.known[:, 0] = np.inf
            work.known[KNOWN, 0] = 0.0
        if not folded:
            count = find_around(strict, pattern, view, eye_p, eye_q, work)
            if count < 0:
                continue
            # an eye among the ridges is not for a cross-section: it sees the plane
            if eye_w <= LEVEL * pattern.height or not near_groove(pattern, count, view, eye_p, eye_q, work):
                count = 0
            tx, ty = direction(pattern, work.found, count, view)
            wider = wider_of(pattern, frame, eye_p, eye_q) if curved else 1.0
            r = reach_along(paper, wider, pattern, view, eye_p, eye_q, tx, ty, work)
            if strict and count > 0 and not pattern.parallel:
                count = find_within(pattern, view, longer(r, beyond), work)
                if count < 0:
                    continue
            grooves, crooked = pick(strict, beyond, pattern, view, longer(r, beyond), count, work)
        chords = ROUND if curved else 0
        if samples and grooves > 0:
            continue
        if grooves < 0 or (ridged and not folded and grooves * (most + 1 + chords) + 2 + chords > POINTS):
            continue
        error = 0.0
        if curved and grooves > 0:
            far = max(r.wide_high - r.high, r.low - r.wide_low, pattern.width)
            deep = pattern.height + pattern.depth
            error = left_by_lines(frame, view, far, r.length, deep, footprint.blocked, lights)
        cuts, still, groups, once, restless = 1, matte and distant and not curved, 0, False, False
        bowed = some = sway = 0.0
        if not paper:
            curvature, left, right = 0.0, math.inf, -math.inf  # to the right the least, to the left the most
            for k in range(grooves):
                for side in range(2):
                    near = work.near[k]
                    at = max(near.start, r.low) if side == 0 else min(near.finish, r.high)
                    bend = bent_at(near.turned * pattern.pieces[near.piece].curvature, at - near.axis)
                    curvature, left, right = max(curvature, abs(bend)), min(left, bend), max(right, bend)
            if gathers and has_picture(lighting) and (curved or curvature > 0.0):
                continue
            if not folded or entries > 0:  # else their mean is taken, and no path ends up on another side of a rim
                bowed = 0.5 * curvature * r.length**2 / (r.high - r.low)
            if curved:
                f = frame.form
                sway = max(abs(f[0]), abs(f[1]), abs(f[2])) * 2.0 * max(r.high, -r.low, r.length)
            bend = curvature * 2.0 * r.length + sway
            if folded:
                groups = int(work.near[grooves - 1].group) + 1
                once = groups == 1
            crowd, some = liven(still, matte, sharp, bright, bend, sway, groups, frame, view, lights, change)
            if bounces > 0:  # rays would do it instead, from facet to facet
                bowed = some = 0.0
            elif crowd > WIDE:
                error += crowd / WIDE
            if bowed > 0.0 and not folded:
                cuts = int(min(max(math.ceil(math.sqrt(RIM * bowed / (FINE * rough))), 1.0), SLICES + 0.0))
                if cuts > 1:  # along one path for all
                    bowed *= 1.0 / (cuts * cuts) + 0.5 * (right - left) / curvature
            for l in range(len(lights) + 1):
                restless = restless or change[l] > FLAT
        if strict and not error <= rough:
            continue
        method[index] = BASE

        bx, by = -r.ty, r.tx
        centre = bx * view.p + by * view.q
        turn_lights(curved, frame, view, bx, by, lights, paper, work)
        half = 0.0
        if paper:  # the larger projection of the footprint's two axes stands for it (000, 4.2)
            rp, rq = on_plane(view, 1.0, 0.5)
            dp, dq = on_plane(view, 0.5, 0.0)
            half = max(abs((rp - view.p) * bx + (rq - view.q) * by), abs((dp - view.p) * bx + (dq - view.q) * by))
        eye_d = (frame.eye[0] - view.p) * bx + (frame.eye[1] - view.q) * by
        eye_t = (frame.eye[0] - view.p) * r.tx + (frame.eye[1] - view.q) * r.ty
        eye_h = 0.0 if paper else 1.0
        if gathers and (footprint.frame != stretched or r.tx != stretch_x or r.ty != stretch_y):
            stretched, stretch_x, stretch_y = footprint.frame, r.tx, r.ty
            stretch = stretch_of(frame, r.tx, r.ty)
        bow = bow_of(frame, bx, by)
        chord = chord_of(pattern, bow, len(lights), work) if curved and ridged else math.inf
        red = green = blue = 0.0
        plain = 1.0  # the share of the plane around the grooves
        faintest, strongest = math.inf, 0.0  # of what is seen, the sum of channels
        unsure = 0.0  # of colours, the sum of channels
        spread = spread_of(paper, view, r)
        if cuts > 1:
            slice_up(cuts, 0.5 * (left + right), view, r, work.slices)
        bare_of = restless and not folded and not shows  # what grooves hide of the plane is taken off it part by part
        full = False  # there is more than this has room for, or knows
        first = 0
        while first < grooves:
            last = grooves if ridged and not folded else first + 1
            finish = work.near[first].finish
            if strict and not (ridged or folded or curved) and (finish <= r.low or work.near[first].start >= r.high):
                first += 1  # beside the footprint, and nothing overlaps
                continue
            method[index] = SEGMENT_METHOD if paper else LINE
            copies = work.near[first].copies  # the plane goes with the groove to its left
            if folded:
                while ridged and last < grooves and work.near[last].group == work.near[first].group:
                    last += 1
            else:
                while last < grooves and work.near[last].start < finish - 1e-9 * (finish - work.near[first].start):
                    finish = max(finish, work.near[last].finish)
                    last += 1
            # where repeats are folded, a period stands for those all over the footprint
            amid = 0.5 * (work.near[first].start + work.near[last - 1].finish) if folded else 0.0
            n = lay(pattern, r, chord, first, last, work)
            lone = last - first == 1
            near = work.near[first]
            first = last
            b, h = work.b, work.w
            if curved:
                b, h = work.bent, work.sunk[len(lights)]
                for i in range(n):
                    b[i] = work.b[i] + bow.spread * (work.b[i] - amid) * work.w[i]
                sink(bow, 0.0, r.eye_t, amid, work.b, work.w, n, h)
            for l in range(len(lights)):
                if work.light[l, 3] != 0.0:
                    light = work.light[l]
                    if curved:
                        sink(bow, light[4], light[5], amid, work.b, work.w, n, work.sunk[l])
                    lit_h = work.sunk[l] if curved else work.w
                    for i in range(n):
                        work.x[i] = onto_base(b[i], lit_h[i], light[0], light[1], light[2])
                    spans(b, work.x, work.lit_low[l], work.lit_high[l], n, foot_of(light[0], light[2]))
            for i in range(n):
                work.x[i] = onto_base(b[i], h[i], eye_d, eye_w, eye_h)
            spans(b, work.x, work.low, work.high, n, foot_of(eye_d, eye_h))
            if not (ridged and (folded or curved)):
                low, high = (work.x[0], work.x[n - 1]) if curved else (work.b[0], work.b[n - 1])
                part = copies * weigh(folded, entries, cuts, paper, view, bx, by, centre, half, low, high, work)
                plain -= part
                if bare_of and part > 0.0:
                    hidden = hidden_of(
                        low, high, change, curved, spread, frame, view, r, eye_d, eye_h, lighting,
                        materials[slots[0]], albedo, work,
                    )  # fmt: skip
                    red, green, blue = red - part * hidden[0], green - part * hidden[1], blue - part * hidden[2]
            cavity, ready = -1, True
            if gathers:
                if not lone:  # what is left of grooves that overlap is no profile
                    full = True
                    break
                shared = not curved and not paper and r.high - r.low <= APART * lamp
                like = pattern.grooves[pattern.pieces[near.piece].groove].like
                cavity, ready = recall(
                    shared, like, near.turned, n, stretch, footprint.frame if distant else index, footprint.blocked, r,
                    pattern, slots, work.strings,
                )  # fmt: skip
                if cavity < 0:
                    full = True
                    break
            if shows or not (ready or shared):
                complete_section(curved, pattern, slots, n, work)
            if not ready:
                s = work.strings
                lit_b, lit_w, of, lit_parts = work.b, work.w, work.section.material, work.section.lit
                if shared:
                    place(like, near.turned, 1.0 if distant else near.scale, pattern, slots, s)
                    light_up(n, work.light, s)
                    lit_b, lit_w, of, lit_parts = s.b, s.w, s.material, s.lit
                open_up(cavity, stretch, footprint.frame, frame, r, lit_b, lit_w, lighting, s)
                exchange(
                    cavity, bounces, curved, amid, frame, view, r, lit_b, lit_w, of, lit_parts, lighting, materials, s
                )  # fmt: skip
            if shows:
                d = work.mirrors.eye[0]
                d[0], d[1], d[2], d[3] = eye_d, eye_t, eye_w, eye_h
            for i in range(n - 1):
                if work.owner[i] >= 0:
                    copies = work.near[work.owner[i]].copies
                low, high = work.low[i], work.high[i]
                if (
                    copies == 0.0
                    or high <= low
                    or (not folded and (high <= min(r.low, -half) or low >= max(r.high, half)))
                ):
                    continue
                hue, slot, turn = facet_at(i, pattern, work)
                part = copies * weigh(folded, entries, cuts, paper, view, bx, by, centre, half, low, high, work)
                if part <= 0.0:
                    continue
                if ridged and (folded or curved):
                    plain -= part
                    if bare_of:
                        hidden = hidden_of(
                            low, high, change, curved, spread, frame, view, r, eye_d, eye_h, lighting,
                            materials[slots[0]], albedo, work,
                        )  # fmt: skip
                        red, green, blue = red - part * hidden[0], green - part * hidden[1], blue - part * hidden[2]
                tint = work.tint[hue]
                x0, x1 = (low, high) if folded else (max(low, r.low), min(high, r.high))
                if not still or restless or work.tinted[hue] != index:
                    for l in range(0 if still else len(lights), len(lights) + 1):
                        colour = tint_over(
                            i, l, x0, x1, change[l], folded, once, gathers, curved, amid, b, h, turn, spread, frame,
                            view, r, eye_d, eye_h, lighting, materials[slots[slot]], albedo, work,
                        )  # fmt: skip
                        tint[l, 0], tint[l, 1], tint[l, 2] = colour[0], colour[1], colour[2]
                        unsure += part * colour[3]
                    work.tinted[hue] = index
                red += part * tint[len(lights), 0]
                green += part * tint[len(lights), 1]
                blue += part * tint[len(lights), 2]
                faint = strong = tint[len(lights), 0] + tint[len(lights), 1] + tint[len(lights), 2]
                b0, w0, b1, w1 = b[i], h[i], b[i + 1], h[i + 1]
                for l in range(len(lights)):
                    light = work.light[l]
                    lit_h = work.sunk[l] if curved else work.w
                    v0, v1 = lit_h[i], lit_h[i + 1]
                    lit_low, lit_high = work.lit_low[l, i], work.lit_high[l, i]
                    if light[3] == 0.0 or lit_high <= lit_low:
                        continue
                    from_x, to_x = low, high
                    if lit_low > onto_base(b0, v0, light[0], light[1], light[2]):
                        from_x = max(from_x, carried(lit_low, b0, v0, b1, v1, w0, w1, light, eye_d, eye_w, eye_h))
                    if lit_high < onto_base(b1, v1, light[0], light[1], light[2]):
                        to_x = min(to_x, carried(lit_high, b0, v0, b1, v1, w0, w1, light, eye_d, eye_w, eye_h))
                    if to_x <= from_x:
                        continue
                    lit = part
                    if from_x != low or to_x != high:
                        lit = copies * weigh(
                            folded, entries, cuts, paper, view, bx, by, centre, half, from_x, to_x, work
                        )  # fmt: skip
                    colour = (tint[l, 0], tint[l, 1], tint[l, 2], 0.0)
                    if not still:
                        if not folded:
                            from_x, to_x = max(from_x, r.low), min(to_x, r.high)
                        colour = tint_over(
                            i, l, from_x, to_x, change[l], folded, once, gathers, curved, amid, b, h, turn, spread,
                            frame, view, r, eye_d, eye_h, lighting, materials[slots[slot]], albedo, work,
                        )  # fmt: skip
                    red, green, blue = red + lit * colour[0], green + lit * colour[1], blue + lit * colour[2]
                    unsure += lit * colour[3]
                    strong += colour[0] + colour[1] + colour[2]
                    if lit == part:
                        faint += colour[0] + colour[1] + colour[2]
                faintest, strongest = min(faintest, faint), max(strongest, strong)
                if gathers:
                    here, there, inner, outer = low, high, math.inf, math.inf
                    if not (folded or paper):
                        here, there, inner, outer = max(low, r.low), min(high, r.high), spread.inner, spread.outer
                    elif paper:
                        here, there = max(low, -half), min(high, half)
                    u0, u1 = 0.0, 1.0
                    if here > work.x[i]:
                        u0 = min(max(fraction_at(here, b0, w0, b1, w1, eye_d, eye_w, eye_h), 0.0), 1.0)
                    if there < work.x[i + 1]:
                        u1 = min(max(fraction_at(there, b0, w0, b1, w1, eye_d, eye_w, eye_h), 0.0), 1.0)
                    if u1 - u0 < NARROW:  # a difference of sums has too few digits left
                        inner, u0 = math.inf, min(max(0.5 * (u0 + u1 - NARROW), 0.0), 1.0 - NARROW)
                        u1 = u0 + NARROW
                    given = gathered(cavity, i, u0, u1, here, there, inner, outer, work.strings)
                    red, green, blue = red + part * given[0], green + part * given[1], blue + part * given[2]
                if not shows:
                    continue
                clear_of = mirrored(materials[work.section.material[i]], 0.0)
                if max(clear_of[0], clear_of[1], clear_of[2]) <= 0.0:
                    continue
                if not folded:  # colours are those of the middle of what is seen
                    low, high = max(low, min(r.low, -half)), min(high, max(r.high, half))
                made = reflections(
                    i, low, high, n, bounces, r.spread, frame, view, r.tx, r.ty, lighting, materials, albedo,
                    work.section, work.mirrors,
                )  # fmt: skip
                full = full or made < 0
                for k in range(made):
                    row = work.mirrors.seen[k]
                    lit = copies * weigh(
                        folded, entries, cuts, paper, view, bx, by, centre, half, row[0], row[1], work
                    )  # fmt: skip
                    red, green, blue = red + lit * row[2], green + lit * row[3], blue + lit * row[4]
        if full:
            method[index] = NOT_MINE
            continue
        if folded and plain < 0.0:  # what a fold is off by
            red, green, blue = red / (1.0 - plain), green / (1.0 - plain), blue / (1.0 - plain)
        if bare_of:
            plain = 1.0
        if plain > 1e-12:
            n_world = normal_to_world(frame, (0.0, 0.0, 1.0))
            material = materials[slots[0]]
            side = 2 if not distant or material.metallic > 0.0 or material.f90 > 0.0 or curved else 1
            eye = to_world(frame, frame.eye[0], frame.eye[1], eye_w)
            part = plain / (side * side)
            before = red + green + blue
            for k in range(side * side):  # at the places of Gauss in the pixel's square, where the light changes in it
                p, q = view.p, view.q
                if side == 2:
                    p, q = on_plane(view, 0.5 + GAUSS * (2 * (k & 1) - 1), 0.5 + GAUSS * (2 * (k >> 1) - 1))
                if curved:
                    n_world = normal_to_world(frame, turned(frame, p - view.p, q - view.q, 0.0, (0.0, 0.0, 1.0)))
                at = to_world(frame, p, q, 0.0)
                e = unit((eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]))
                given = ambient(material, lighting, albedo, n_world, e)
                red, green, blue = red + part * given[0], green + part * given[1], blue + part * given[2]
                if shows:
                    shown = mirrored(material, dot(n_world, e))
                    red += part * shown[0] * lighting.sky[0]
                    green += part * shown[1] * lighting.sky[1]
                    blue += part * shown[2] * lighting.sky[2]
                for l in range(len(lights)):
                    if work.light[l, 3] != 0.0:
                        given = lit_by(lights[l], material, n_world, e, at)
                        red, green, blue = red + part * given[0], green + part * given[1], blue + part * given[2]
            level = (red + green + blue - before) / plain
            faintest, strongest = min(faintest, level), max(strongest, level)
        if bounces > 0:
            unsure = 0.0
        if bowed > 0.0 or some > 0.0 or crooked > 0.0 or unsure > 0.0:
            unit_of = 3.0 * white(lighting, to_world(frame, view.p, view.q, 0.0))
            apart = max(strongest - faintest, 0.0)
            unsure += RIM * bowed * apart + crooked * max(apart, BESIDE * pale * unit_of)
            unsure += some * min(strongest, bright * unit_of)
            error += unsure / unit_of
            if strict and not error <= rough:
                method[index] = NOT_MINE
                continue
        radiance[index, 3] = error
        radiance[index, 0], radiance[index, 1], radiance[index, 2] = red, green, blue
    keep(owned)
