"""Method `area`: the exact area of every seen and lit part of a footprint (000, section 5; 001, section 6).

The papers treat crossings, ends and corners one by one, each by projecting profiles. Here they are one case (DESIGN
2.1, 2.3): the surface of the local solid is made of convex faces (`faces`), and on the screen

- what a face shows of itself is a convex polygon, as the eye is a point;
- what hides a face is what of the faces turned away from the eye stands before it, and what shades it is the same seen
  from the light: convex regions of the screen too, as from one point a plane's points are seen through another plane
  by a homography.

So each share is found by cutting convex polygons by half-planes, exact under perspective and for point lights.
Everything is computed in the screen's pixels, relative to the footprint: areas are shares. What is left to error is the
colour within a part, taken at its middle, or at several places where it changes; chords for arcs; and straight rays
over a curved base, which a second look places by what the first has seen.

On flat objects the faces are made once for a block of pixels.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import is_plain, peak, sharpness, turns
from renderer.geometry.colour import EVEN, centroid, colour_over
from renderer.geometry.curve import is_curved
from renderer.geometry.faces import FACES
from renderer.geometry.images import COST as STEPS
from renderer.geometry.images import OFF as UNSEEN
from renderer.geometry.images import VIEWS, WINDOWS, Images, images_of, look_into_all, open_windows
from renderer.geometry.local import BLOCKS, FULL, Local, local_of
from renderer.geometry.parts import Parts, hide, light_up, parts_of, show
from renderer.geometry.polygon import area
from renderer.geometry.sight import (
    Seen,
    bend_of,
    may_light,
    place_on,
    see,
    see_again,
    seen_of,
    slot_of,
    tinge,
)
from renderer.geometry.straight import left_out
from renderer.geometry.view import view_of
from renderer.kernel import borrow, keep, kernel, leaf
from renderer.shading import are_distant, to_world, white
from renderer.tables import AREA, CROWDED, NOT_MINE, Camera, Floats, Lighting, Pattern

SUMMED = 0.1  # in tolerances: the shares of a footprint sum to one within this, or it is left to another method
CHORDED = 2.0  # ... where chords stand for arcs and steps for scales; shares are divided by their sum
SHARE = 0.1  # of the tolerance, that the colour of one part may use up
# Chords are for this part of it, no less, where facets may be brighter than white: few are as bright as can be.
GLOSSY = 0.25
BENT = 0.5  # the error where chords stand for arcs, in tolerances
REFLECTED, ALL = 1, 2  # of light that comes by facets, what `shown` says is done: that of mirrors, or there is no other
REACH = 4.0  # of the grooves' height: so far beyond all else faces are made where mirrors show them
SLIVER = 1e-3  # parts of a footprint as small as this do not say between which heights straight rays are to be right
RED, GREEN, BLUE, WHOLE, OFF, CHORDS, COST, LOW, HIGH, TOP, ASIDE, DOWN, ACROSS = range(13)


@leaf
def add_up(
    tolerance: float, bright: float, long: float, turn: Floats, distant: bool, footprint: np.void, pattern: Pattern,
    frame: np.void, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    local: Local, seen: Seen, parts: Parts, images: Images,
) -> bool:  # fmt: skip
    """Add up what a footprint sees of the faces in `parts.total`, and open windows to mirrors, if `images` is to have
    any. False where there is no room."""
    found, faces, square, total = local.found, local.faces, local.square[0], parts.total
    lights = lighting.lights
    eye = len(lights)
    red = green = blue = whole = off = 0.0
    cost = float(faces.made[0])
    chorded = False
    low, high, top = math.inf, -math.inf, 0.0
    weight = aside = down = even_x = even_y = 0.0
    for f in range(faces.made[0]):
        top = max(top, faces.box[f, 5])
        if seen.facing[eye, f] <= 0.0:
            continue
        count = show(f, footprint, faces, seen, parts)
        if count == 0:
            continue
        parts.corners[0, 0] = count
        n = hide(eye, f, 0, 1, footprint, frame, faces, seen, parts)
        if n < 0:
            return False
        if n == 0:
            continue
        material = materials[slots[slot_of(pattern, f, found, faces)]]
        bend = bend_of(pattern, f, found, faces)
        bent = bend > 0.0
        chorded = chorded or bent
        if images.made[2] == 0:
            open_windows(f, bent, n, material, parts, images)
        cost += seen.heres[eye]
        plain = distant and not bent and is_plain(material) and not is_curved(frame)
        if plain:
            tinge(f, square, pattern, frame, lighting, material, albedo, found, faces, seen)
        for source in range(eye, -1, -1):
            light = source if source < eye else -1
            which, m = 0, n
            if light >= 0:
                if not may_light(light, f, footprint, seen):
                    continue
                cost += n * seen.heres[light]
                which, m = light_up(light, f, n, footprint, frame, faces, seen, parts)
                if m < 0:
                    return False
            even = math.sqrt(EVEN * tolerance / sharpness(material)) / (turn[source] + bend * long)
            largest, u, v = 0.0, 0.5, 0.5
            for i in range(m):
                part, corners = parts.polygon[which, i], parts.corners[which, i]
                share = area(part, corners)
                if light < 0:
                    whole += share
                if light < 0 and seen.pairs[0] == 1:
                    s, t = centroid(part, corners, share)
                    if share > largest:
                        largest, u, v = share, s, t
                    if share > SLIVER:
                        place_on(f, footprint, s, t, seen)
                        deep = share * abs(seen.place[2])
                        weight, aside, down = weight + deep, aside + deep * (s - 0.5), down + deep * (t - 0.5)
                        nx, ny = faces.plane[f, 0], faces.plane[f, 1]
                        lean = share / (nx * nx + ny * ny + faces.plane[f, 2] ** 2)
                        even_x, even_y = even_x + lean * (nx * nx - ny * ny), even_y + 2.0 * lean * nx * ny
                        for j in range(corners):
                            place_on(f, footprint, part[j, 0], part[j, 1], seen)
                            low, high = min(low, seen.place[2]), max(high, seen.place[2])
                if plain:
                    tint = seen.tint[f, source]
                    red, green, blue = red + share * tint[0], green + share * tint[1], blue + share * tint[2]
                    continue
                r, g, b, unsure = colour_over(
                    f, light, part, corners, share, even, SHARE * tolerance * bright, footprint, pattern, frame,
                    lighting, material, albedo, bent, found, faces, seen,
                )  # fmt: skip
                red, green, blue, off = red + r, green + g, blue + b, off + unsure
            if largest > 0.0:
                place_on(f, footprint, u, v, seen)
    total[RED], total[GREEN], total[BLUE], total[WHOLE], total[OFF] = red, green, blue, whole, off
    total[CHORDS], total[COST], total[LOW], total[HIGH], total[TOP] = chorded, cost, low, high, top
    total[ASIDE] = aside / weight if weight > 0.0 else 0.0
    total[DOWN] = down / weight if weight > 0.0 else 0.0
    total[ACROSS] = 0.5 * math.atan2(even_y, even_x)
    return True


def in_blocks(footprints: NDArray[np.void], chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """The footprints `chosen` in the order in which neighbours follow one another: the same faces serve them."""
    x, y = footprints["x"][chosen], footprints["y"][chosen]
    return chosen[np.lexsort((x, y, *(at // side for side in reversed(BLOCKS) if side for at in (x, y))))]


@kernel
def area_sampling(
    tolerance: float, rough: float, most: int, flat: bool, bounces: int, last: Lighting, shown: NDArray[np.uint8],
    pattern: Pattern, footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void],
    camera: Camera, lighting: Lighting, materials: NDArray[np.void], slots: NDArray[np.int32], albedo: Floats,
    radiance: Floats, method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance, predicted error and cost (n, 5) and method.

    tolerance: the error to keep within, relative to a white surface in the same light. rough: the error, at most, that
    straight rays over a curved base may make. flat: they share one frame. bounces: how often light that mirrors send on
    is followed, over a flat base alone; `shown` (n,) says of which footprints that was done: REFLECTED, or ALL. last:
    the light on what a last bounce meets.
    CROWDED where more than `most` strips are near; NOT_MINE where the shares do not sum to one, or too much is left to
    error. slots: rows of `materials` for the pattern's facets, the object's own first.
    """
    mirrors = bounces > 0
    owned = (
        local_of(pattern), seen_of(len(lighting.lights), FACES), parts_of(),
        seen_of(len(lighting.lights), FACES if mirrors else 1),
        images_of(VIEWS if mirrors else 1, WINDOWS if mirrors else 1),
    )  # fmt: skip
    local, seen, parts = borrow(owned[0]), borrow(owned[1]), borrow(owned[2])
    image, images, last, shown = borrow(owned[3]), borrow(owned[4]), borrow(last), borrow(shown)
    far = REACH * (pattern.height + pattern.depth) if mirrors else 0.0
    square, total = local.square[0], parts.total
    pattern, frames, lighting, camera = borrow(pattern), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    lights = lighting.lights
    turn = np.empty(len(lights) + 1)
    distant = are_distant(lights)
    chords = tolerance
    for slot in slots:
        chords = min(chords, max(GLOSSY, 1.0 / math.sqrt(peak(materials[slot]))) * tolerance)
    for index in chosen:
        footprint = footprints[index]
        frame = frames[footprint.frame]
        method[index] = NOT_MINE
        view = view_of(footprint, frame, camera)
        if see(pattern, frame, footprint, flat, camera, lights, chords, most, far, local, seen) == FULL:
            method[index] = CROWDED
            continue
        bright = white(lighting, to_world(frame, view.p, view.q, 0.0))
        long = turns(frame, view, lights, turn)
        images.made[0], images.made[1], images.made[2], images.made[3] = 0, 0, not mirrors, 0
        room = add_up(
            tolerance, bright, long, turn, distant, footprint, pattern, frame, lighting, materials, slots, albedo,
            local, seen, parts, images,
        )  # fmt: skip
        bowed = 0.0
        if room and is_curved(frame):
            bowed = left_out(frame, view, total[LOW], total[HIGH], total[TOP], 0.0, footprint.blocked, lights)
            if not bowed <= rough:
                continue
            red, green, blue = total[RED], total[GREEN], total[BLUE]
            room = see_again(
                total[LOW], total[HIGH], total[TOP], 0.5 + total[ASIDE], 0.5 + total[DOWN], total[ACROSS], pattern,
                frame, footprint, camera, lights, local, seen,
            )  # fmt: skip
            room = room and add_up(
                tolerance, bright, long, turn, distant, footprint, pattern, frame, lighting, materials, slots, albedo,
                local, seen, parts, images,
            )  # fmt: skip
            apart = abs(total[RED] - red) + abs(total[GREEN] - green) + abs(total[BLUE] - blue)
            bowed = left_out(
                frame, view, total[LOW], total[HIGH], total[TOP], apart / (3.0 * bright), footprint.blocked, lights
            )
            if not bowed <= rough:
                continue
        whole = total[WHOLE]
        if not room or not abs(whole - 1.0) <= tolerance * (CHORDED if total[CHORDS] > 0.0 else SUMMED):
            continue
        error = abs(whole - 1.0) + bowed + (BENT * tolerance if total[CHORDS] > 0.0 else 0.0)
        if total[OFF] > 0.0:
            off = total[OFF] / bright
            if not off <= tolerance:
                continue
            error += off
        method[index] = AREA
        radiance[index, 3] = error
        radiance[index, 4] = total[COST] + (local.strips.made[0] * footprint.size / square.size) ** 2
        for k in range(3):
            radiance[index, k] = total[k] / whole
        if not mirrors or images.made[2] == 1:
            continue
        room = look_into_all(
            tolerance, bright, long, turn, bounces, footprint, pattern, frame, lighting, last, materials, slots, albedo,
            local, seen, image, parts, images,
        )  # fmt: skip
        off = images.total[UNSEEN] / bright if bright > 0.0 else 0.0
        if room and error + off <= tolerance:
            shown[index] = REFLECTED if images.made[3] == 1 else ALL
            radiance[index, 3] += off
            radiance[index, 4] += images.total[STEPS]
            for k in range(3):
                radiance[index, k] += images.total[k]
    keep(owned)
