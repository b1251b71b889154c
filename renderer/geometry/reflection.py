"""What the mirrors of a cross-section show, in closed form (000, 6.1; DESIGN 2.1 and 2.5).

The eye's mirror image in a facet sees, through what of that facet is seen, the rest of the cross-section: a new eye
and a new window, and so on. A mirror leaves lines along T as they are, so all happens in the plane of B and w but for
colours. Mirrored is in the world, where angles are true.

The papers invert the masking of rays from under the plane and leave out the facets on the wrong side (000, 6.1). Here
both follow from where rays begin: those that a facet sends to the right pass over the points to its right one by one
until one stands too high, and never see what lies to its left.

Points are (b, t, w) from the footprint's centre, along B, T and the height, pattern units; D = (D_b, D_t, D_w, h) as in
`section`. v is a place on a mirror, 0 at its left end, 1 at its right.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.section import fraction_at, onto_base
from renderer.geometry.view import View
from renderer.kernel import callee, fixed, leaf
from renderer.shading import (
    Vector,
    ambient,
    direction_to_pattern,
    dot,
    lit_by,
    mirrored,
    normal_to_world,
    to_world,
    unit,
)
from renderer.tables import Floats, Lighting

MIRRORS = 17  # bounces that the schema allows, and the eye
GLIMPSES = fixed(4096)  # places seen in the mirrors of one facet
LEAST = 1e-12  # of a mirror: narrower windows show nothing


class Section(NamedTuple):
    """A cross-section: points from left to right; facet i joins points i and i + 1."""

    b: Floats
    w: Floats
    material: NDArray[np.int64]  # row of the materials, a facet each
    lit: Floats  # (lights, facets, 2) the part of each that a light reaches: from, to


class Mirrors(NamedTuple):
    """Memory of one thread."""

    facet: NDArray[np.int64]  # (MIRRORS,) the mirrors on the way, from the eye on
    state: NDArray[np.int64]  # (MIRRORS, 2) it looks right (0) or left (1), or is done (2); the next facet there
    eye: Floats  # (MIRRORS, 4) D of the eye (0) and of its images in them
    window: Floats  # (MIRRORS, 4) v from, to; and of the rays that pass over what has been looked at: from, to
    seen: Floats  # (GLIMPSES, 5) on the eye's base line from, to; radiance


@leaf
def mirrors() -> Mirrors:
    return Mirrors(
        np.zeros(MIRRORS, np.int64), np.zeros((MIRRORS, 2), np.int64), np.zeros((MIRRORS, 4)), np.zeros((MIRRORS, 4)),
        np.empty((GLIMPSES, 5)),
    )  # fmt: skip


@leaf
def crossing(d: Floats, qb: float, qw: float, b0: float, w0: float, b1: float, w1: float) -> float:
    """v where the line from D, behind a mirror, to Q before or on it crosses the mirror."""
    nb, nw = w0 - w1, b1 - b0
    ahead = max(nb * (qb - b0) + nw * (qw - w0), 0.0)
    behind = nb * (d[0] - d[3] * b0) + nw * (d[2] - d[3] * w0)
    over = behind - d[3] * ahead
    b, w = (qb * behind - d[0] * ahead) / over, (qw * behind - d[2] * ahead) / over
    return (-(w - w0) * nb + (b - b0) * nw) / (nb * nb + nw * nw)


@leaf
def is_before(qb: float, qw: float, b0: float, w0: float, b1: float, w1: float) -> bool:
    """Whether Q is on the side of a mirror on which it reflects."""
    return (w0 - w1) * (qb - b0) + (b1 - b0) * (qw - w0) > 0.0


@leaf
def met(d: Floats, b: float, w: float, b0: float, w0: float, b1: float, w1: float) -> float:
    """v where the line from D through (b, w) meets a facet."""
    lb, lw, l1 = d[2] - d[3] * w, d[3] * b - d[0], d[0] * w - d[2] * b
    o0, o1 = lb * b0 + lw * w0 + l1, lb * b1 + lw * w1 + l1
    return min(max(o0 / (o0 - o1), 0.0), 1.0) if o0 != o1 else 0.0


@leaf
def place_in_world(frame: np.void, view: View, tx: float, ty: float, b: float, t: float, w: float) -> Vector:
    return to_world(frame, view.p - b * ty + t * tx, view.q + b * tx + t * ty, w)


@leaf
def normal_of_facet(frame: np.void, tx: float, ty: float, section: Section, i: int) -> Vector:
    """The unit normal in the world."""
    run, rise = section.b[i + 1] - section.b[i], section.w[i + 1] - section.w[i]
    return normal_to_world(frame, (rise * ty, -rise * tx, run))


@leaf
def add_mirror(
    level: int, i: int, low: float, high: float, frame: np.void, view: View, tx: float, ty: float, section: Section,
    memory: Mirrors,
) -> None:  # fmt: skip
    """Look from the image of eye level - 1 in facet i through its part from `low` to `high`."""
    before, image = memory.eye[level - 1], memory.eye[level]
    n = normal_of_facet(frame, tx, ty, section, i)
    if before[3] == 0.0:
        p, q = -before[0] * ty + before[1] * tx, before[0] * tx + before[1] * ty
        a = frame.axes
        x = (
            a[0, 0] * p + a[0, 1] * q + a[0, 2] * before[2],
            a[1, 0] * p + a[1, 1] * q + a[1, 2] * before[2],
            a[2, 0] * p + a[2, 1] * q + a[2, 2] * before[2],
        )
    else:
        at = place_in_world(frame, view, tx, ty, before[0], before[1], before[2])
        foot = place_in_world(frame, view, tx, ty, section.b[i], 0.0, section.w[i])
        x = (at[0] - foot[0], at[1] - foot[1], at[2] - foot[2])
    far = 2.0 * dot(n, x)
    d = direction_to_pattern(frame, (far * n[0], far * n[1], far * n[2]))
    image[0] = before[0] - (d[1] * tx - d[0] * ty)
    image[1] = before[1] - (d[0] * tx + d[1] * ty)
    image[2] = before[2] - d[2]
    image[3] = before[3]
    memory.facet[level] = i
    memory.state[level, 0], memory.state[level, 1] = 0, i + 1
    window = memory.window[level]
    window[0] = window[2] = low
    window[1] = window[3] = high


@leaf
def onto_screen(level: int, b: float, w: float, section: Section, memory: Mirrors) -> float:
    """Where on the base line the eye sees what is seen in the mirror of `level` at (b, w)."""
    for k in range(level, 0, -1):
        i = memory.facet[k]
        b0, w0, b1, w1 = section.b[i], section.w[i], section.b[i + 1], section.w[i + 1]
        v = min(max(crossing(memory.eye[k], b, w, b0, w0, b1, w1), 0.0), 1.0)
        b, w = b0 + v * (b1 - b0), w0 + v * (w1 - w0)
    eye = memory.eye[0]
    return onto_base(b, w, eye[0], eye[2], eye[3])


@leaf
def next_glimpse(level: int, count: int, section: Section, memory: Mirrors) -> tuple[int, float, float]:
    """The next facet that shows in the mirror of `level`, and through which part of it; -1: none is left."""
    d, window, state, i = memory.eye[level], memory.window[level], memory.state[level], memory.facet[level]
    b0, w0, b1, w1 = section.b[i], section.w[i], section.b[i + 1], section.w[i + 1]
    while state[0] < 2:
        j = state[1]
        low, high = window[2], window[3]
        if state[0] == 0:  # rays to the right pass over a point as long as v is less than its own
            if j >= count - 1 or high <= window[0]:
                state[0], state[1] = 1, i - 1
                continue
            state[1] += 1
            if not is_before(section.b[j + 1], section.w[j + 1], b0, w0, b1, w1):
                continue
            low = max(low, crossing(d, section.b[j + 1], section.w[j + 1], b0, w0, b1, w1))
            window[3] = min(window[3], low)
        else:
            if j < 0 or low >= window[1]:
                state[0] = 2
                continue
            state[1] -= 1
            if not is_before(section.b[j], section.w[j], b0, w0, b1, w1):
                continue
            high = min(window[1], crossing(d, section.b[j], section.w[j], b0, w0, b1, w1))
            window[2] = max(window[2], high)
        if high - low > LEAST:
            return j, low, high
    return -1, 0.0, 0.0


@leaf
def tint_along(
    level: int, x: float, t: float, frame: np.void, view: View, tx: float, ty: float, materials: NDArray[np.void],
    section: Section, memory: Mirrors,
) -> tuple[float, float, float, Vector]:  # fmt: skip
    """Follow the ray through the base line's x to the mirror of `level`: where it leaves that, (b, t, w), and what all
    mirrors so far let through."""
    b, w = x, 0.0
    through = (1.0, 1.0, 1.0)
    for k in range(level):
        d, i = memory.eye[k], memory.facet[k + 1]
        b, t, w = onto_facet(d, b, t, w, i, section)
        at = place_in_world(frame, view, tx, ty, b, t, w)
        e = towards(d, at, frame, view, tx, ty)
        colour = mirrored(materials[section.material[i]], dot(normal_of_facet(frame, tx, ty, section, i), e))
        through = (through[0] * colour[0], through[1] * colour[1], through[2] * colour[2])
    return b, t, w, through


@leaf
def onto_facet(d: Floats, b: float, t: float, w: float, i: int, section: Section) -> tuple[float, float, float]:
    """Where the line from D through (b, t, w) meets facet i."""
    b0, w0, b1, w1 = section.b[i], section.w[i], section.b[i + 1], section.w[i + 1]
    v = met(d, b, w, b0, w0, b1, w1)
    b2, w2 = b0 + v * (b1 - b0), w0 + v * (w1 - w0)
    rb, rw = b * d[3] - d[0], w * d[3] - d[2]
    s = ((b2 - b) * rb + (w2 - w) * rw) / (rb * rb + rw * rw)
    return b2, t + s * (t * d[3] - d[1]), w2


@leaf
def towards(d: Floats, at: Vector, frame: np.void, view: View, tx: float, ty: float) -> Vector:
    """The unit vector from a world point to D."""
    if d[3] == 0.0:
        here = place_in_world(frame, view, tx, ty, 0.0, 0.0, 0.0)
        there = place_in_world(frame, view, tx, ty, d[0], d[1], d[2])
        return unit((there[0] - here[0], there[1] - here[1], there[2] - here[2]))
    there = place_in_world(frame, view, tx, ty, d[0], d[1], d[2])
    return unit((there[0] - at[0], there[1] - at[1], there[2] - at[2]))


@leaf
def note(made: int, x0: float, x1: float, red: float, green: float, blue: float, memory: Mirrors) -> int:
    """Write a glimpse: how many there are now, or -1 where there is no room."""
    if made < 0 or made >= GLIMPSES:
        return -1
    row = memory.seen[made]
    row[0], row[1], row[2], row[3], row[4] = min(x0, x1), max(x0, x1), red, green, blue
    return made + 1


@callee
def reflections(
    first: int, low: float, high: float, count: int, bounces: int, spread: float, frame: np.void, view: View,
    tx: float, ty: float, lighting: Lighting, materials: NDArray[np.void], albedo: Floats,
    section: Section, memory: Mirrors,
) -> int:  # fmt: skip
    """Fill `memory.seen` with all that facet `first` of the `count - 1` shows of the others and of the sky, where it is
    seen from `low` to `high` on the base line by memory.eye[0]: how many rows, or -1 where there is no room.

    spread: colours are the mean of what is seen so far on either side along T.
    """
    lights, sky = lighting.lights, lighting.sky
    b0, w0, b1, w1 = section.b[first], section.w[first], section.b[first + 1], section.w[first + 1]
    eye = memory.eye[0]
    v0 = fraction_at(low, b0, w0, b1, w1, eye[0], eye[2], eye[3])
    v1 = fraction_at(high, b0, w0, b1, w1, eye[0], eye[2], eye[3])
    add_mirror(1, first, min(max(v0, 0.0), 1.0), min(max(v1, 0.0), 1.0), frame, view, tx, ty, section, memory)
    sides = 1 if spread == 0.0 else 2
    made, level = 0, 1
    while level > 0 and made >= 0:
        i, d = memory.facet[level], memory.eye[level]
        b0, w0, b1, w1 = section.b[i], section.w[i], section.b[i + 1], section.w[i + 1]
        j, v0, v1 = next_glimpse(level, count, section, memory)
        if j < 0:  # what passes over all sees the sky
            v0, v1 = memory.window[level, 2], memory.window[level, 3]
            if v1 - v0 > LEAST and max(sky[0], sky[1], sky[2]) > 0.0:
                # the ends of the window, seen in the mirror before
                x0 = onto_screen(level - 1, b0 + v0 * (b1 - b0), w0 + v0 * (w1 - w0), section, memory)
                x1 = onto_screen(level - 1, b0 + v1 * (b1 - b0), w0 + v1 * (w1 - w0), section, memory)
                red = green = blue = 0.0
                for side in range(sides):
                    t = 0.0 if sides == 1 else (2.0 * side - 1.0) * spread
                    _, _, _, through = tint_along(
                        level, 0.5 * (x0 + x1), t, frame, view, tx, ty, materials, section, memory
                    )
                    red, green, blue = red + through[0] / sides, green + through[1] / sides, blue + through[2] / sides
                made = note(made, x0, x1, red * sky[0], green * sky[1], blue * sky[2], memory)
            level -= 1
            continue
        c0, z0, c1, z1 = section.b[j], section.w[j], section.b[j + 1], section.w[j + 1]
        u0 = met(d, b0 + v0 * (b1 - b0), w0 + v0 * (w1 - w0), c0, z0, c1, z1)
        u1 = met(d, b0 + v1 * (b1 - b0), w0 + v1 * (w1 - w0), c0, z0, c1, z1)
        if u0 > u1:
            u0, u1 = u1, u0
        material = materials[section.material[j]]
        n = normal_of_facet(frame, tx, ty, section, j)
        for l in range(-1, len(lights)):
            from_u, to_u = u0, u1
            if l >= 0:
                from_u, to_u = max(u0, section.lit[l, j, 0]), min(u1, section.lit[l, j, 1])
            if to_u - from_u <= LEAST:
                continue
            x0 = onto_screen(level, c0 + from_u * (c1 - c0), z0 + from_u * (z1 - z0), section, memory)
            x1 = onto_screen(level, c0 + to_u * (c1 - c0), z0 + to_u * (z1 - z0), section, memory)
            red = green = blue = 0.0
            for side in range(sides):
                t = 0.0 if sides == 1 else (2.0 * side - 1.0) * spread
                b, t, w, through = tint_along(
                    level, 0.5 * (x0 + x1), t, frame, view, tx, ty, materials, section, memory
                )
                b, t, w = onto_facet(d, b, t, w, j, section)
                at = place_in_world(frame, view, tx, ty, b, t, w)
                e = towards(d, at, frame, view, tx, ty)
                colour = ambient(material, lighting, albedo, n, e) if l < 0 else lit_by(lights[l], material, n, e, at)
                red += through[0] * colour[0] / sides
                green += through[1] * colour[1] / sides
                blue += through[2] * colour[2] / sides
            if max(red, green, blue) > 0.0:
                made = note(made, x0, x1, red, green, blue, memory)
        if level < bounces:
            clear = mirrored(material, 0.0)
            if max(clear[0], clear[1], clear[2]) > 0.0:
                level += 1
                add_mirror(level, j, u0, u1, frame, view, tx, ty, section, memory)
    return made
