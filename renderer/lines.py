"""Method `lines`: line samples of a footprint, two perpendicular ones or more (000, 5.6).

On a line across the footprint's square what a face shows of itself is an interval, and so is what hides or shades it:
the convex regions of method `area` cut by the line, exact under perspective and for point lights. So each line's
radiance is exact but for the colour within an interval, as there. What is left to error is what the lines miss.

Half of the lines run across the screen, half down it: one of each through the middle, as the report has it, or more,
one at a random place in each of as many strata. An edge at the angle alpha to a line is sampled the better the larger
that is: along the line at alpha = 90 degrees, a step from one line to the next at 0. Jones and Perry (2000) weigh a
line by the sum of sin^2 alpha over the edges that it meets; so does the report, and so are here the means of the lines
across and of those down. As both tend to the footprint's radiance with more lines, so does the weighted mean.

An edge is where what is seen along a line passes from one facet to another of another slope or material, and where a
shadow ends. It counts once for each shadow that ends there.

Two lines are exact for one straight edge that runs across or down the screen, or that crosses one of them alone and
leaves the footprint by the sides that this line runs between. They are wrong by no more than 1/8 of its contrast for
any: that much lies in the corner that a diagonal edge through both lines' ends cuts off, which neither meets.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import is_plain
from renderer.geometry.faces import FACES, Faces
from renderer.geometry.local import FULL, local_of
from renderer.geometry.polygon import CORNERS, Counts
from renderer.geometry.query import Nearby
from renderer.geometry.random import jitter, seed_of
from renderer.geometry.sight import (
    Seen,
    bend_of,
    colour_at,
    hidden_by,
    is_over,
    may_light,
    place_on,
    see,
    seen_of,
    slot_of,
    tinge,
)
from renderer.kernel import borrow, keep, kernel, leaf
from renderer.shading import are_distant
from renderer.tables import LINES, NOT_MINE, Camera, Floats, Lighting, Pattern

LEAST = 1e-12  # intervals as short as this, of a line's length, are nothing
WHOLE = 1e-6  # the intervals of a line sum to its length within this, or the footprint is left to another method
CHORDED = 2.0  # ... tolerances, where chords stand for arcs and steps for scales: they are then divided by their sum
AT_ONCE = 8  # lines
ROOM = FACES + 2  # for intervals of a line
ASIDE = 1e-7  # how far from the middle a single line runs, where scenes that are symmetrical have an edge
LONG = 0.2  # the colour in a longer interval is taken at Gauss's two places
GAUSS = 0.5 / math.sqrt(3.0)
ALIKE = 1e-12  # squared sine of the angle between facets that count as one

LOW, HIGH, SINE_LOW, SINE_HIGH = range(4)  # an interval: where it begins and ends, sin^2 of the edges there; 0: none


class Samples(NamedTuple):
    """Some lines of a footprint, 0 to 1 along each; memory of one thread."""

    down: Counts  # (AT_ONCE,) 0: across the screen, 1: down
    place: Floats  # (AT_ONCE,) at which v, or u, of the footprint's square
    part: Floats  # (2, AT_ONCE, ROOM, 4) what is seen of a face, and what of that is lit
    parts: Counts  # (2, AT_ONCE) how many
    seen: Floats  # (AT_ONCE, ROOM, 4) what is seen of all faces
    face: Counts  # (AT_ONCE, ROOM) of which
    many: Counts  # (AT_ONCE,) how many
    sine: Floats  # (AT_ONCE,) sums of sin^2
    colour: Floats  # (AT_ONCE, 4) RGB, and the length that the intervals cover
    mean: Floats  # (2, 5) of lines across and down: sums of RGB and sin^2, how many
    plane: Floats  # (CORNERS, 3) half-planes of the footprint's square


@leaf
def samples_of() -> Samples:
    return Samples(
        np.empty(AT_ONCE, np.int64), np.empty(AT_ONCE), np.empty((2, AT_ONCE, ROOM, 4)),
        np.empty((2, AT_ONCE), np.int64), np.empty((AT_ONCE, ROOM, 4)), np.empty((AT_ONCE, ROOM), np.int64),
        np.empty(AT_ONCE, np.int64), np.empty(AT_ONCE), np.empty((AT_ONCE, 4)), np.empty((2, 5)),
        np.empty((CORNERS, 3)),
    )  # fmt: skip


@leaf
def sine_of(along: float, across: float) -> float:
    """sin^2 of the angle between a line and the edge of the half-plane along t + across s + c >= 0, t along it."""
    return along * along / (along * along + across * across)


@leaf
def show(f: int, down: int, place: float, footprint: np.void, faces: Faces, seen: Seen, out: Floats) -> int:
    """Write what of face f lies on a line to out (1, 4): 1, or 0 if nothing does."""
    size, count = footprint.size, faces.corners[f]
    along, across = down, 1 - down
    start_a, start_b = (footprint.x, footprint.y) if down == 0 else (footprint.y, footprint.x)
    # homogeneous, so that what lies behind the eye does no harm; a corner on the line counts to one side
    met = 0
    a0 = w0 = s0 = a1 = w1 = s1 = 0.0
    c = seen.corner[f, count - 1]
    ta, tb, tw = (c[along] - start_a * c[2]) / size, (c[across] - start_b * c[2]) / size, c[2]
    td = tb - place * tw
    for i in range(count):
        c = seen.corner[f, i]
        a, b, w = (c[along] - start_a * c[2]) / size, (c[across] - start_b * c[2]) / size, c[2]
        d = b - place * w
        if (td > 0.0) != (d > 0.0):
            t = td / (td - d)
            sine = sine_of(tb * w - tw * b, tw * a - ta * w)
            if met == 0:
                a0, w0, s0 = ta + t * (a - ta), tw + t * (w - tw), sine
            else:
                a1, w1, s1 = ta + t * (a - ta), tw + t * (w - tw), sine
            met += 1
        ta, tb, tw, td = a, b, w, d
    if met < 2:
        return 0
    for side in range(2):
        d0, d1 = (a0, a1) if side == 0 else (w0 - a0, w1 - a1)
        if d0 < 0.0 and d1 < 0.0:
            return 0
        if d0 < 0.0:
            t = d0 / (d0 - d1)
            a0, w0, s0 = (0.0 if side == 0 else a0 + t * (a1 - a0)), w0 + t * (w1 - w0), 0.0
        elif d1 < 0.0:
            t = d0 / (d0 - d1)
            a1, w1, s1 = (0.0 if side == 0 else a0 + t * (a1 - a0)), w0 + t * (w1 - w0), 0.0
    if not (w0 > 0.0 and w1 > 0.0):
        return 0
    low, high = min(max(a0 / w0, 0.0), 1.0), min(max(a1 / w1, 0.0), 1.0)
    if low > high:
        low, high, s0, s1 = high, low, s1, s0
    if high - low <= LEAST:
        return 0
    out[0, LOW], out[0, HIGH], out[0, SINE_LOW], out[0, SINE_HIGH] = low, high, s0, s1
    return 1


@leaf
def subtract(parts: Floats, n: int, low: float, high: float, sine_low: float, sine_high: float) -> int:
    """Take an interval, with the sin^2 of its ends, out of parts[:n], in place: how many are left."""
    for i in range(n - 1, -1, -1):
        part = parts[i]
        if high <= part[LOW] or low >= part[HIGH]:
            continue
        before, after = low - part[LOW] > LEAST, part[HIGH] - high > LEAST
        if before and after:
            parts[n, LOW], parts[n, HIGH] = high, part[HIGH]
            parts[n, SINE_LOW], parts[n, SINE_HIGH] = sine_high, part[SINE_HIGH]
            n += 1
        if before:
            part[HIGH], part[SINE_HIGH] = low, sine_low
        elif after:
            part[LOW], part[SINE_LOW] = high, sine_high
        else:
            n -= 1
            for k in range(4):
                part[k] = parts[n, k]
    return n


@leaf
def hide(
    s: int, f: int, which: int, lines: int, footprint: np.void, frame: np.void, faces: Faces, seen: Seen,
    samples: Samples,
) -> bool:  # fmt: skip
    """Take what source s does not see of face f out of `samples.part[which]`. False where there is no room."""
    for k in range(seen.heres[s]):
        count = hidden_by(seen.away[s, seen.here[s, k]], s, f, footprint, frame, faces, seen, samples.plane)
        if count < 0:
            return False
        if count == 0:
            continue
        left = 0
        for l in range(lines):
            n = samples.parts[which, l]
            if n == 0:
                continue
            down, place = samples.down[l], samples.place[l]
            low, high, sine_low, sine_high = 0.0, 1.0, 0.0, 0.0
            for i in range(count):
                along, across = samples.plane[i, down], samples.plane[i, 1 - down]
                c = samples.plane[i, 2] + across * place
                if along > 0.0:
                    if -c > low * along:
                        low, sine_low = -c / along, sine_of(along, across)
                elif along < 0.0:
                    if c < -high * along:
                        high, sine_high = -c / along, sine_of(along, across)
                elif c < 0.0:
                    low = math.inf
                if low >= high:
                    break
            if high - low > LEAST:
                n = subtract(samples.part[which, l], n, low, high, sine_low, sine_high)
                samples.parts[which, l] = n
            left += n
        if left == 0:
            break
    return True


@leaf
def one_surface(f: int, g: int, pattern: Pattern, found: Nearby, faces: Faces) -> bool:
    """Whether where faces f and g meet there is no edge: a facet's next chord or step, or the same slope."""
    one, two = faces.tag[f], faces.tag[g]
    if one[0] == two[0] and one[1] == two[1] and one[2] == two[2] and one[3] == two[3]:
        return True
    a, b = faces.plane[f], faces.plane[g]
    x, y, z = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    sizes = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
    if x * x + y * y + z * z > ALIKE * sizes or a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.0:
        return False
    return bool(slot_of(pattern, f, found, faces) == slot_of(pattern, g, found, faces))


@leaf
def edges_met(l: int, pattern: Pattern, found: Nearby, faces: Faces, samples: Samples) -> float:
    """The sum of sin^2 over the edges between the faces seen along a line; sorts them."""
    n, part, face = samples.many[l], samples.seen[l], samples.face[l]
    for i in range(1, n):
        for j in range(i, 0, -1):
            if part[j - 1, LOW] <= part[j, LOW]:
                break
            for k in range(4):
                part[j - 1, k], part[j, k] = part[j, k], part[j - 1, k]
            face[j - 1], face[j] = face[j], face[j - 1]
    total = 0.0
    for i in range(1, n):
        if not one_surface(face[i - 1], face[i], pattern, found, faces):
            total += 0.5 * (part[i - 1, SINE_HIGH] + part[i, SINE_LOW])
    return total


@kernel
def line_sampling(
    count: int, seed: int, tolerance: float, most: int, flat: bool, pattern: Pattern, footprints: NDArray[np.void],
    chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera, lighting: Lighting,
    materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats, radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance and cost (n, 5) and method.

    count: lines. tolerance: of chords. flat: the footprints share one frame. NOT_MINE where more than `most` strips are
    near, or where the intervals of a line do not cover it. slots: rows of `materials` for the pattern's facets, the
    object's own first.
    """
    owned = local_of(pattern), seen_of(len(lighting.lights), FACES), samples_of()
    local, seen, samples = borrow(owned[0]), borrow(owned[1]), borrow(owned[2])
    found, faces, square = local.found, local.faces, local.square[0]
    pattern, frames, lighting, camera = borrow(pattern), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    lights = lighting.lights
    eye = len(lights)
    distant = are_distant(lights)
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        method[index] = NOT_MINE
        if see(pattern, frame, footprint, flat, camera, lights, tolerance, most, 0.0, local, seen) == FULL:
            continue
        x0, y0, size = footprint.x, footprint.y, footprint.size
        state = seed_of(seed, x0, y0)
        samples.mean[:] = 0.0
        room = True
        for begin in range(0, count, AT_ONCE):
            lines = min(AT_ONCE, count - begin)
            for l in range(lines):
                down = (begin + l) & 1
                strata = (count + 1 - down) >> 1
                state, place = jitter(state)
                samples.down[l] = down
                samples.place[l] = (((begin + l) >> 1) + place) / strata if strata > 1 else 0.5 + ASIDE
                samples.many[l] = 0
                samples.sine[l] = 0.0
                samples.colour[l] = 0.0
            chorded = False
            for f in range(faces.made[0]):
                if seen.facing[eye, f] <= 0.0:
                    continue
                box = seen.box[f]
                if not is_over(box, footprint):
                    continue
                shown = 0
                for l in range(lines):
                    down, place = samples.down[l], samples.place[l]
                    level = y0 + size * place if down == 0 else x0 + size * place
                    samples.parts[0, l] = 0
                    if box[1 - down] <= level <= box[3 - down]:
                        samples.parts[0, l] = show(f, down, place, footprint, faces, seen, samples.part[0, l])
                    shown += samples.parts[0, l]
                if shown == 0:
                    continue
                bent = bend_of(pattern, f, found, faces) > 0.0
                material = materials[slots[slot_of(pattern, f, found, faces)]]
                plain = distant and not bent and is_plain(material)
                if plain:
                    tinge(f, square, pattern, frame, lighting, material, albedo, found, faces, seen)
                for source in range(eye, -1, -1):
                    light = source if source < eye else -1
                    which = 0 if light < 0 else 1
                    if light >= 0:
                        if not may_light(light, f, footprint, seen):
                            continue
                        for l in range(lines):
                            samples.parts[1, l] = samples.parts[0, l]
                            for i in range(samples.parts[0, l]):
                                part, lit = samples.part[0, l, i], samples.part[1, l, i]
                                lit[LOW], lit[HIGH], lit[SINE_LOW], lit[SINE_HIGH] = part[LOW], part[HIGH], 0.0, 0.0
                    if not hide(source, f, which, lines, footprint, frame, faces, seen, samples):
                        room = False
                        break
                    left = 0
                    for l in range(lines):
                        colour = samples.colour[l]
                        left += samples.parts[which, l]
                        for i in range(samples.parts[which, l]):
                            part = samples.part[which, l, i]
                            long = part[HIGH] - part[LOW]
                            if light < 0:
                                at = samples.many[l]
                                if at == ROOM:
                                    room = False
                                    break
                                samples.many[l] = at + 1
                                samples.face[l, at] = f
                                for k in range(4):
                                    samples.seen[l, at, k] = part[k]
                                colour[3] += long
                                if left == samples.parts[0, l] and i == 0:  # the first of all
                                    t = 0.5 * (part[LOW] + part[HIGH])
                                    u, v = (t, samples.place[l]) if samples.down[l] == 0 else (samples.place[l], t)
                                    place_on(f, footprint, u, v, seen)
                            else:
                                samples.sine[l] += part[SINE_LOW] + part[SINE_HIGH]
                            if plain:
                                tint = seen.tint[f, source]
                                for k in range(3):
                                    colour[k] += long * tint[k]
                                continue
                            places = 2 if long > LONG else 1
                            for k in range(places):
                                t = 0.5 * (part[LOW] + part[HIGH])
                                if places == 2:
                                    t += GAUSS * (2.0 * k - 1.0) * long
                                u, v = (t, samples.place[l]) if samples.down[l] == 0 else (samples.place[l], t)
                                r, g, b = colour_at(
                                    f, light, x0 + size * u, y0 + size * v, pattern, frame, lighting, material, albedo,
                                    bent, found, faces, seen,
                                )  # fmt: skip
                                share = long / places
                                colour[0] += share * r
                                colour[1] += share * g
                                colour[2] += share * b
                    if light < 0:
                        chorded = chorded or (bent and left > 0)
                    if left == 0 and light < 0:
                        break
                if not room:
                    break
            for l in range(lines):
                colour, mean = samples.colour[l], samples.mean[samples.down[l]]
                if not abs(colour[3] - 1.0) <= (CHORDED * tolerance if chorded else WHOLE):
                    room = False
                    break
                for k in range(3):
                    mean[k] += colour[k] / colour[3]
                mean[3] += samples.sine[l] + edges_met(l, pattern, found, faces, samples)
                mean[4] += 1.0
            if not room:
                break
        if not room:
            continue
        one, two = samples.mean[0], samples.mean[1]
        a, b = one[3], two[3]
        if a + b == 0.0 or count == 1:
            a, b = one[4], two[4]
        method[index] = LINES
        radiance[index, 4] = count * faces.made[0] + (local.strips.made[0] * size / square.size) ** 2
        for k in range(3):
            radiance[index, k] = (a * one[k] / one[4] + b * two[k] / max(two[4], 1.0)) / (a + b)
    keep(owned)
