"""Rays through the grooves of a sphere or a cylinder, exactly but for as much as is asked for (more next to the poles).

The solid over such a base is P(p, q) + w sigma N (DESIGN 1.2), which can be turned round in closed form: a place in the
object's axes has its (p, q, w), and a ray is a curve in pattern space. Through the shell that the grooves fill it is
followed by chords, which `solid.meet` takes as straight rays; their ends lie on the ray itself. `curve` has the same to
second order around one place, for footprints and for meshes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.curve import is_curved
from renderer.geometry.query import Nearby
from renderer.geometry.shapes import Vector, local, out_of, solve
from renderer.geometry.solid import (
    DOWN,
    OPEN,
    RISE,
    SHADOW,
    SINK,
    UP,
    Meeting,
    leveled,
    meet,
    polish,
    thin_of,
)
from renderer.geometry.spans import BODY, END, NO, PLANE, YES, Events
from renderer.kernel import callee, leaf
from renderer.shading import unit
from renderer.tables import CYLINDER, POINT, SPHERE, Pattern

STRAY = 0.003  # of the grooves' height: so far a chord may be from its ray, the most
LEVEL = (
    1e-3  # a ray's slope to the plane is taken for at least this: more level ones run over very many grooves to no end
)
POLAR = 0.1  # the cosine of a latitude, at least, where the length of chords goes by it
CHORDS = 1000  # of a ray, at most


class Passage(NamedTuple):
    """What a ray meets in the shell, and where it is then."""

    meeting: Meeting
    x: float  # pattern space; where nothing was met, the place is that where the ray leaves the shell
    y: float
    w: float
    gp: float  # the slope of the chord
    gq: float
    descends: bool
    leaves: bool  # where nothing was met: it goes on in the air, or in the body below the grooves


@leaf
def is_round(obj: np.void, frame: np.void) -> bool:
    """Whether the frame is one of a sphere, or of a cylinder's side."""
    return bool(obj.shape == SPHERE or obj.shape == CYLINDER) and is_curved(frame)


@leaf
def sigma_at(obj: np.void, cosine: float) -> float:
    """World units a unit of height, at a latitude of this cosine."""
    m = obj.mapping
    if obj.shape == CYLINDER:
        return math.sqrt(2.0 * math.pi * obj.size[0] * obj.size[1] / (m[0] * m[1]))
    return obj.size[0] * math.pi * math.sqrt(2.0 * max(cosine, 1e-12) / (m[0] * m[1]))


@leaf
def chart(obj: np.void, x: Vector) -> Vector:
    """(p, q, w) of a place in the object's axes, p in its first turn."""
    m = obj.mapping
    ring = math.sqrt(x[0] * x[0] + x[1] * x[1])
    turn = math.atan2(x[1], x[0]) / (2.0 * math.pi)
    p = m[2] + m[0] * (turn if turn >= 0.0 else turn + 1.0)
    if obj.shape == CYLINDER:
        return p, m[3] + m[1] * (x[2] / obj.size[1] + 0.5), (ring - obj.size[0]) / sigma_at(obj, 1.0)
    radius = math.sqrt(ring * ring + x[2] * x[2])
    q = m[3] + m[1] * (math.atan2(x[2], ring) / math.pi + 0.5)
    return p, q, (radius - obj.size[0]) / sigma_at(obj, ring / radius)


@leaf
def carried(obj: np.void, p: float, q: float, w: float) -> Vector:
    """The place in the object's axes of (p, q, w)."""
    m = obj.mapping
    turn = 2.0 * math.pi * (p - m[2]) / m[0]
    if obj.shape == CYLINDER:
        ring = obj.size[0] + w * sigma_at(obj, 1.0)
        return ring * math.cos(turn), ring * math.sin(turn), obj.size[1] * ((q - m[3]) / m[1] - 0.5)
    tilt = math.pi * ((q - m[3]) / m[1] - 0.5)
    cosine = math.cos(tilt)
    radius = obj.size[0] + w * sigma_at(obj, cosine)
    return radius * cosine * math.cos(turn), radius * cosine * math.sin(turn), radius * math.sin(tilt)


@leaf
def placed(obj: np.void, p: float, q: float, w: float) -> Vector:
    """The place in the world of (p, q, w)."""
    x, s = out_of(obj, carried(obj, p, q, w)), obj.translation
    return s[0] + x[0], s[1] + x[1], s[2] + x[2]


@leaf
def from_world(obj: np.void, at: Vector) -> Vector:
    """A place of the world in the object's axes."""
    s = obj.translation
    return local(obj, at[0] - s[0], at[1] - s[1], at[2] - s[2])


@leaf
def raised(obj: np.void, p: float, q: float, w: float, n: Vector) -> Vector:
    """A normal of pattern space at (p, q, w) in the world, unit: n_p grad p + n_q grad q + n_w grad w."""
    m = obj.mapping
    turn = 2.0 * math.pi * (p - m[2]) / m[0]
    ct, st = math.cos(turn), math.sin(turn)
    if obj.shape == CYLINDER:
        sigma = sigma_at(obj, 1.0)
        east, out = n[0] * m[0] / (2.0 * math.pi * (obj.size[0] + w * sigma)), n[2] / sigma
        x = (out * ct - east * st, out * st + east * ct, n[1] * m[1] / obj.size[1])
    else:
        tilt = math.pi * ((q - m[3]) / m[1] - 0.5)
        cosine, sine = max(math.cos(tilt), 1e-12), math.sin(tilt)
        sigma = sigma_at(obj, cosine)
        radius = obj.size[0] + w * sigma
        east, out = n[0] * m[0] / (2.0 * math.pi * radius * cosine), n[2] / sigma
        north = (n[1] * m[1] / math.pi + 0.5 * n[2] * w * sine / cosine) / radius
        ring = out * cosine - north * sine
        x = (ring * ct - east * st, ring * st + east * ct, out * sine + north * cosine)
    return unit(out_of(obj, x))


@leaf
def round_turns(obj: np.void, p: float) -> float:
    """What of a way around is whole turns."""
    return float(obj.mapping[0] * math.floor(p / obj.mapping[0]))


@leaf
def ahead(o: Vector, d: Vector, t: float) -> Vector:
    return o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]


@leaf
def moments(obj: np.void, o: Vector, d: Vector) -> Vector:
    """a, b, c: the square of the distance from the centre, or the axis, is a t^2 + 2 b t + c along o + t d."""
    along = 0.0 if obj.shape == CYLINDER else 1.0
    return (
        d[0] * d[0] + d[1] * d[1] + along * d[2] * d[2],
        o[0] * d[0] + o[1] * d[1] + along * o[2] * d[2],
        o[0] * o[0] + o[1] * o[1] + along * o[2] * o[2],
    )


@leaf
def crossings(obj: np.void, m: Vector, height: float) -> tuple[float, float]:
    """Where a ray of these moments is so high, pattern units; NaN: nowhere."""
    radius = max(obj.size[0] + height * sigma_at(obj, 1.0), 0.0)
    return solve(m[0], m[1], m[2] - radius * radius)


@leaf
def sideways(m: Vector, t: float) -> float:
    """The square of the speed at t across the way to the centre, or the axis."""
    square = (m[0] * t + 2.0 * m[1]) * t + m[2]
    return m[0] - (m[1] + m[0] * t) ** 2 / square if square > 0.0 else 0.0


@leaf
def entered(pattern: Pattern, obj: np.void, o: Vector, d: Vector, within: bool, hit: float) -> float:
    """Where the ray that meets the bare shape at t = `hit` has come into the shell before that, not before 0."""
    if len(pattern.pieces) == 0:
        return hit
    m = moments(obj, o, d)
    t = crossings(obj, m, -pattern.depth - thin_of(pattern))[1]
    if not within:
        t = crossings(obj, m, pattern.height + thin_of(pattern))[0]
    if math.isnan(t):
        t = 0.0
    if obj.shape == CYLINDER and d[2] != 0.0:
        t = max(t, (-math.copysign(0.5 * obj.size[1], d[2]) - o[2]) / d[2])
    return min(max(t, 0.0), hit)


@leaf
def left_at(
    pattern: Pattern, obj: np.void, o: Vector, d: Vector, m: Vector, begin: float, within: bool
) -> tuple[float, bool]:
    """Where the ray that is in the shell at t = `begin` leaves it, and whether it goes on: not within a ridge."""
    t = crossings(obj, m, -pattern.depth - thin_of(pattern))[0]
    leaves = within
    if not t > begin:
        leaves = not within
        t = crossings(obj, m, pattern.height + thin_of(pattern))[1]
        if math.isnan(t):
            t = begin if m[0] > 0.0 else math.inf
    if obj.shape == CYLINDER and d[2] != 0.0:
        end = (math.copysign(0.5 * obj.size[1], d[2]) - o[2]) / d[2]
        if end < t:
            t, leaves = end, not within or (m[0] * end + 2.0 * m[1]) * end + m[2] <= obj.size[0] ** 2
    return max(t, begin), leaves


@callee
def pass_through(
    pattern: Pattern, found: Nearby, spans: Events, obj: np.void, o: Vector, d: Vector, here: Vector, begin: float,
    end: float, within: bool, asks: bool, stray: float,
) -> Passage:  # fmt: skip
    """What the ray o + t d (the object's axes) meets from t = `begin` on, where it is in the shell, `here` in pattern
    space, to t = `end`.

    within: it is inside the body. asks: whether it meets anything is all that matters. stray: how far chords may be
    from it, pattern units.
    """
    t = begin
    m = moments(obj, o, d)
    if len(pattern.pieces) == 0:
        rises = m[1] + m[0] * t > 0.0
        meeting = Meeting(0.0, PLANE, -1, BODY) if rises == within else OPEN
        return Passage(meeting, here[0], here[1], 0.0, 0.0, 0.0, not rises, rises != within)
    final, leaves = left_at(pattern, obj, o, d, m, begin, within)
    final = min(final, end)
    if final <= begin:
        return Passage(OPEN, here[0], here[1], here[2], 0.0, 0.0, True, leaves)
    nearest = min(max(-m[1] / m[0], begin), final) if m[0] > 0.0 else begin  # where it is deepest, and most level
    speed = math.sqrt(max(sideways(m, begin), sideways(m, nearest), sideways(m, final), 0.0))
    sinks = math.nan  # chords of a ray that turns within the shell lie above it: they end where it has dipped into the
    if begin < nearest < final:  # body, by more than rounding
        sinks = crossings(obj, m, -thin_of(pattern))[0]
    seam = -o[1] / d[1] if d[1] != 0.0 else math.nan  # where p begins again, or half a turn from there
    bow, least = 8.0 * stray, (final - begin) / CHORDS
    gp = gq = 0.0
    descends = True
    for _ in range(CHORDS + 4):  # it ends at three places more
        ring, cosine = obj.size[0], 1.0
        if obj.shape == SPHERE:  # nearer to the poles parallels are bent more, and grooves are smaller
            x = ahead(o, d, t)
            ring = max(math.sqrt(x[0] * x[0] + x[1] * x[1]), POLAR * obj.size[0])
            cosine = ring / obj.size[0]
        step = math.sqrt(bow * sigma_at(obj, cosine) * ring) / speed if speed > 0.0 else math.inf
        step = max(step, least)
        until = t + step if t + 1.25 * step < final else final
        for stop in (nearest, sinks, seam):
            if t < stop < until:
                until = stop
        place = chart(obj, ahead(o, d, until))
        along, up = place[0] - here[0], place[1] - here[1]
        along -= round_turns(obj, along + 0.5 * obj.mapping[0])
        p0 = here[0] - round_turns(obj, here[0] + 0.5 * along - obj.mapping[2])
        rise = leveled(along, up, place[2] - here[2], LEVEL)
        if rise == 0.0:
            rise = 1e-300
        gp, gq, descends = along / rise, up / rise, rise < 0.0
        p, q = p0 - here[2] * gp, here[1] - here[2] * gq
        top, bottom, way = here[2], here[2] + rise, SINK if within else DOWN
        if not descends:
            top, bottom, way = bottom, top, RISE if within else (SHADOW if asks else UP)
        met = meet(pattern, found, spans, -1, p, q, gp, gq, top, bottom, way)
        if met.w > -math.inf:
            w = met.w if asks else polish(pattern, found, met, p, q, gp, gq)
            return Passage(met, p + w * gp, q + w * gq, w, gp, gq, descends, False)
        t, here = until, place
        if t >= final:
            break
    return Passage(OPEN, here[0], here[1], here[2], gp, gq, descends, leaves)


@leaf
def seen_from(
    pattern: Pattern, found: Nearby, spans: Events, obj: np.void, eye: Vector, way: Vector, beside: bool,
    stray: float,
) -> Passage:  # fmt: skip
    """What the ray from the eye along `way` (world) sees. Where it passes by at the outline, through grooves or over
    ridges, OPEN.

    A ray beside the bare shape may meet a ridge, and one through a cylinder's end what grooves have left of that, if
    the footprint is `beside` the shape. Else such a ray is moved to the outline, as its footprint is there.
    """
    o, d = from_world(obj, eye), local(obj, way[0], way[1], way[2])
    m = moments(obj, o, d)
    bare = crossings(obj, m, 0.0)[0]
    if beside:
        high, low = pattern.height + thin_of(pattern), -pattern.depth - thin_of(pattern)
        begin, final = crossings(obj, m, high)
        if m[0] == 0.0 and m[2] <= (obj.size[0] + high * sigma_at(obj, 1.0)) ** 2:  # along a cylinder
            begin, final = 0.0, math.inf
        ended = False
        if obj.shape == CYLINDER:
            top = math.copysign(0.5 * obj.size[1], d[2])
            first, last = ((-top - o[2]) / d[2], (top - o[2]) / d[2]) if d[2] != 0.0 else (-math.inf, math.inf)
            ended = first > max(begin, 0.0)
            begin, final = max(begin, first), min(final, last)
        begin = max(begin, 0.0)
        if not begin < final or (d[2] == 0.0 and obj.shape == CYLINDER and abs(o[2]) > 0.5 * obj.size[1]):
            return Passage(OPEN, 0.0, 0.0, 0.0, 0.0, 0.0, True, True)
        here = chart(obj, ahead(o, d, begin))
        if ended:
            ground = meet(pattern, found, spans, -1, here[0], here[1], 0.0, 0.0, high, low, DOWN).w
            if here[2] < ground:
                return Passage(Meeting(here[2], END, PLANE, BODY), here[0], here[1], here[2], 0.0, 0.0, True, False)
        return pass_through(pattern, found, spans, obj, o, d, here, begin, math.inf, NO, NO, stray)
    if math.isnan(bare):
        bare = -m[1] / m[0]
        x = ahead(o, d, bare)
        inwards = obj.size[0] / math.sqrt(m[2] - m[1] * m[1] / m[0]) * (1.0 - 1e-9) - 1.0
        o = (o[0] + inwards * x[0], o[1] + inwards * x[1], o[2] + (0.0 if obj.shape == CYLINDER else inwards * x[2]))
    begin = entered(pattern, obj, o, d, False, bare)
    here = chart(obj, ahead(o, d, begin))
    passed = pass_through(pattern, found, spans, obj, o, d, here, begin, math.inf, NO, NO, stray)
    if passed.meeting.w > -math.inf:
        return passed
    x = chart(obj, ahead(o, d, bare))
    meeting = OPEN if len(pattern.pieces) > 0 else Meeting(0.0, PLANE, -1, BODY)
    return Passage(meeting, x[0], x[1], 0.0, 0.0, 0.0, True, True)


@leaf
def is_shaded(
    pattern: Pattern, found: Nearby, spans: Events, obj: np.void, light: np.void, x: float, y: float, w: float,
    stray: float,
) -> bool:  # fmt: skip
    """Whether the grooves, or the body, keep a light from a point off the surface, pattern space."""
    v, end, o = light.vector, math.inf, carried(obj, x, y, w)
    if light.kind == POINT:
        end, at = 1.0, from_world(obj, (v[0], v[1], v[2]))
        d = (at[0] - o[0], at[1] - o[1], at[2] - o[2])
    else:
        d = local(obj, v[0], v[1], v[2])
    return pass_through(pattern, found, spans, obj, o, d, (x, y, w), 0.0, end, NO, YES, stray).meeting.w > -math.inf
