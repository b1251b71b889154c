"""The colours of a cross-section's facets, as the mean over what is seen of them.

Where a colour changes along the footprint it is taken at Gauss's two places each way, exact for cubics: across the
grooves in what is seen, or lit, of a facet, along them as the footprint lies there.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.change import turns
from renderer.geometry.curve import turned
from renderer.geometry.layout import Work
from renderer.geometry.reach import Reach
from renderer.geometry.section import along, fraction_at
from renderer.geometry.view import View, on_plane
from renderer.kernel import leaf
from renderer.shading import Vector, ambient, lit_by, normal_to_world, to_world, unit
from renderer.tables import Floats, Lighting, Pattern

FLAT = 5e-4  # what changes by less, to second order in parts of white, is looked at once: wrong by 1/24 of it
LIVELY = 0.2  # what changes by more is looked at in the middle, too, to tell how wrong Gauss's places are:
CUBIC = 0.4  # by 3 / 4320 f'''' h^4 where the middle is wrong by f'' h^2 / 24, and f is a peak: 3 f''^2 / f
WIDE = 36.0  # a footprint over six times the width of a lobe, squared: the lobe might stand between these places
GAUSS = 0.5 / math.sqrt(3.0)
CLOSEST = 1e-4  # to the centre of curvature, in radii
LEAST = 1e-9  # parts of a footprint as small as this lie anywhere


class Spread(NamedTuple):
    """How a footprint lies about its centre in the frame of parallel grooves, pattern units, root mean squares."""

    across: float
    slant: float  # how far along T its middle goes for a unit across
    along: float  # on either side of that
    inner: float  # so far from its centre on either side across it is all there,
    outer: float  # ... and from here on nothing of it is


@leaf
def spread_of(paper: bool, view: View, r: Reach) -> Spread:
    """The papers' segment lies across, and is looked at in its middle."""
    if paper:
        return Spread(0.0, 0.0, 0.0, math.inf, math.inf)
    p0, q0 = on_plane(view, 1.0, 0.5)
    p1, q1 = on_plane(view, 0.5, 1.0)
    p0, q0, p1, q1 = p0 - view.p, q0 - view.q, p1 - view.p, q1 - view.q
    b0, b1 = q0 * r.tx - p0 * r.ty, q1 * r.tx - p1 * r.ty
    t0, t1 = p0 * r.tx + q0 * r.ty, p1 * r.tx + q1 * r.ty
    square = b0 * b0 + b1 * b1
    slant = (b0 * t0 + b1 * t1) / square if square > 0.0 else 0.0
    rest = t0 * t0 + t1 * t1 - slant * slant * square
    wide, narrow = abs(b0), abs(b1)
    return Spread(math.sqrt(square / 3.0), slant, math.sqrt(max(rest, 0.0) / 3.0), abs(wide - narrow), wide + narrow)


@leaf
def liven(
    still: bool, plain: bool, sharp: float, bright: float, bend: float, sway: float, groups: int, frame: np.void,
    view: View, lights: NDArray[np.void], change: Floats,
) -> tuple[float, float]:  # fmt: skip
    """Write how much colours change along a footprint under each light, and under the sky, to second order, in parts of
    white. Gives the footprint's width in lobes, squared, the most; and of groups that are looked at once each what that
    leaves out, in parts of what is seen.

    still: nothing turns but normals, by the angle `bend`, of which `sway` across the grooves. plain: nor does it matter
    from where they are seen. sharp, bright: the most of `sharpness` and `peak`. groups: so many periods stand for all,
    each looked at once; 0: not so.
    """
    sky = len(lights)
    if not still:
        turns(frame, view, lights, change)
    eye = 0.0 if still else change[sky]
    most = across = 0.0
    for l in range(sky):
        turn = 0.0 if still else change[l] - (eye if plain else 0.0)
        change[l] = sharp * (turn + bend) ** 2
        most = max(most, change[l])
        across = max(across, sharp * (turn + sway) ** 2)
    change[sky] = (eye + bend) ** 2
    return most / bright, across / bright / (24.0 * groups * groups) if groups > 1 else 0.0


@leaf
def bent_at(curvature: float, b: float) -> float:
    """The curvature of what runs beside a path, so far along B; next to the centre of curvature no more than a lot."""
    return curvature / max(1.0 - curvature * b, CLOSEST)


@leaf
def facet_at(i: int, pattern: Pattern, work: Work) -> tuple[int, int, float]:
    """Of facet i: the row of `work.tint` for it, its material's slot, and its path's curvature towards B."""
    if work.owner[i] < 0:
        return -1, 0, 0.0
    near = work.near[work.owner[i]]
    piece = pattern.pieces[near.piece]
    where = pattern.grooves[piece.groove].slot + work.facet[i]
    return 2 * where + (1 if near.turned > 0.0 else 0), pattern.facet_slot[where] + 1, near.turned * piece.curvature


@leaf
def sent(
    light: int, gathers: bool, curved: bool, x: float, b: float, t: float, w: float, across: float, up: float,
    turn: float, frame: np.void, view: View, r: Reach, lighting: Lighting, material: np.void, albedo: Floats,
) -> Vector:  # fmt: skip
    """What a facet that rises by `up` on its way `across` sends to the eye from the place (b, t, w) of the frame of
    parallel grooves: of one light, or of the sky and its own; of this alone where it `gathers` light otherwise. x: the
    place across from where a curved base's bend counts."""
    lights = lighting.lights
    sine, cosine = math.sin(turn * t), math.cos(turn * t)
    bx, by = -r.ty * cosine - r.tx * sine, r.tx * cosine - r.ty * sine
    at = to_world(frame, view.p + b * bx + t * r.tx, view.q + b * by + t * r.ty, w)
    normal = (-up * bx, -up * by, across)
    if curved:
        normal = turned(frame, x * bx + t * r.tx, x * by + t * r.ty, w, normal)
    n = normal_to_world(frame, normal)
    eye = to_world(frame, frame.eye[0], frame.eye[1], frame.eye[2])
    e = unit((eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]))
    if light < len(lights):
        return lit_by(lights[light], material, n, e, at)
    if gathers:
        return material.emissive[0], material.emissive[1], material.emissive[2]
    return ambient(material, lighting, albedo, n, e)


@leaf
def tint_over(
    i: int, light: int, low: float, high: float, change: float, folded: bool, once: bool, gathers: bool, curved: bool,
    folded_at: float, places_b: Floats, heights: Floats, turn: float, spread: Spread, frame: np.void, view: View,
    r: Reach, eye_d: float, eye_h: float, lighting: Lighting, material: np.void, albedo: Floats, work: Work,
) -> tuple[float, float, float, float]:  # fmt: skip
    """The mean of what facet i, -1 for the plane, sends to the eye where it is seen between `low` and `high` on the
    base line, as `sent`; and about how wrong that is, the sum of channels.

    The eye sees its points at `places_b` and `heights`. change: as `liven` has written for that light. folded: it
    stands for copies; once: all over the footprint.
    """
    n_across = n_along = 1
    middle, aside = 0.5 * (low + high), GAUSS * (high - low)
    if change > FLAT:
        n_along = 2
        if not folded and spread.across > 0.0:
            # where the footprint's part between the two lies, on the mean: by Simpson's rule for how much lies before
            bx, by = -r.ty, r.tx
            centre = bx * view.p + by * view.q
            before, after = along(view, bx, by, centre + low), along(view, bx, by, centre + high)
            half = along(view, bx, by, centre + middle)
            if after - before > LEAST:
                middle = low + (high - low) * (after - (before + 4.0 * half + after) / 6.0) / (after - before)
                middle = min(max(middle, low), high)
                aside = min(aside, middle - low, high - middle)
        part = (high - low) / (math.sqrt(12.0) * spread.across) if spread.across > 0.0 else 0.0
        if once or change * part * part > FLAT:
            n_across = 2
    red = green = blue = off = 0.0
    count = n_across * n_along
    for k in range(n_across + (1 if change > LIVELY else 0)):
        side = 0.0 if n_across == 1 or k == n_across else 2.0 * k - 1.0
        x = middle + side * aside
        b, w, across, up, bends = x, 0.0, 1.0, 0.0, 0.0
        if i >= 0:
            u = fraction_at(
                x, places_b[i], heights[i], places_b[i + 1], heights[i + 1], eye_d, frame.eye[2], eye_h
            )  # fmt: skip
            u = min(max(u, 0.0), 1.0)
            across, up = work.b[i + 1] - work.b[i], work.w[i + 1] - work.w[i]
            b, w = work.b[i] + u * across, work.w[i] + u * up
            bends = bent_at(turn, b - work.near[work.owner[i]].axis) if turn != 0.0 else 0.0
        if once:
            x = b = side * spread.across
        for j in range(1 if k == n_across else n_along):
            way = 0.0 if n_along == 1 or k == n_across else 2.0 * j - 1.0
            t = r.eye_t * w + spread.slant * x + way * spread.along
            colour = sent(
                light, gathers, curved, x if once else b - folded_at, b, t, w, across, up, bends, frame, view, r,
                lighting, material, albedo,
            )  # fmt: skip
            if k < n_across:
                red, green, blue = red + colour[0], green + colour[1], blue + colour[2]
                continue
            one, mean = colour[0] + colour[1] + colour[2], (red + green + blue) / count
            off = CUBIC * (mean - one) ** 2 / max(mean, one, 1e-300)
    return red / count, green / count, blue / count, off
