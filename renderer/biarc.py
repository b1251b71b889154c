"""Curves as circular arcs: pairs of arcs (biarcs) within a tolerance of a curve, tangents continuous.

The biarc is the one of E. Bertolazzi and M. Frego, "A note on robust biarc computation", Computer-Aided Design &
Applications 16(5), 2019, 822-835: an analytic solution without cases. In short: let the chord from the first to the
last point have the length d and the direction 0, and let the given tangents have the angles a and b. Two arcs that
turn by 2 h and 2 k and have the chords l and m join smoothly where

    2 h = j - a,  2 k = b - j,   l e^(i (a + j) / 2) + m e^(i (j + b) / 2) = d,

with j the angle of the tangent at the joint, which is free. For j = -(a + b) / 2 the directions of the two chords are
(a - b) / 4 and -(a - b) / 4, so that both chords are equally long:

    l = m = d / (2 cos((a - b) / 4)),   h = -(3 a + b) / 4,   k = (3 b + a) / 4.

Nothing there divides by a small number unless both tangents point backwards, which never passes the limit on an arc's
angle. An arc of half-angle h over a chord l has the length l h / sin h and the curvature 2 sin h / l.

Lengths are in pattern units, angles in radians. All functions work on many pieces at a time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.tables import SEGMENT, Floats

Curve = Callable[[Floats], tuple[Floats, Floats]]
"""Points (n, 2) and unit tangents (n, 2) at the parameters (n,), which run from 0 to 1."""

LARGEST_ARC = 2 * math.pi / 3
"""The largest angle of one arc, radians."""

MOST_SEGMENTS = 200_000
"""The largest number of segments that one path may need."""

_SAMPLES = 24  # points at which a biarc is compared with its piece of the curve
_MARGIN = 0.9  # of the tolerance, for what lies between the samples
_STRAIGHT = 5e-13  # half-angles below this make a line: the tangents still agree to 1e-12
_SLACKS = (1.02, 1.02, 1.06, 1.12, 1.25)  # rounds of moving the ends of pieces: more than the shares alone ask for
_DEEPEST = 44  # bisections, after which a piece is taken as it is


def turned(vectors: Floats, angles: Floats | float) -> Floats:
    """Vectors (..., 2) turned to the left by angles (...)."""
    c, s = np.cos(angles), np.sin(angles)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def arc_over(chord: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Length and curvature of arcs that turn by twice `half` (n,), below pi each, over chords `chord` (n,) long."""
    sine = np.sin(half)
    with np.errstate(divide="ignore", invalid="ignore"):
        length = np.where(np.abs(half) < 1e-8, chord, chord * half / sine)
        return length, np.where(chord > 0, 2 * sine / chord, 0.0)


def biarc(p0: Floats, t0: Floats, p1: Floats, t1: Floats) -> tuple[NDArray[np.void], Floats]:
    """The biarcs from points p0 (n, 2) with unit tangents t0 (n, 2) to points p1 with unit tangents t1.

    Returns the arcs (n, 2) SEGMENT and the larger half-angle of the two (n,). Where p0 = p1 there is no biarc: the
    half-angle is infinite.
    """
    v = p1 - p0
    d = np.hypot(v[:, 0], v[:, 1])
    a = np.arctan2(v[:, 0] * t0[:, 1] - v[:, 1] * t0[:, 0], v[:, 0] * t0[:, 0] + v[:, 1] * t0[:, 1])
    b = np.arctan2(v[:, 0] * t1[:, 1] - v[:, 1] * t1[:, 0], v[:, 0] * t1[:, 0] + v[:, 1] * t1[:, 1])
    h, k = -(3 * a + b) / 4, (3 * b + a) / 4
    ratio = 0.5 / np.maximum(np.cos((a - b) / 4), 1e-3)  # of a chord to d; the bound only meets refused pieces
    chord = d * ratio
    joint = p0 + turned(v, (a - b) / 4) * ratio[:, None]
    arcs = np.zeros((len(d), 2), SEGMENT)
    middle = turned(t0, 2 * h)
    for row, (point, tangent, half) in enumerate([(p0, t0, h), (joint, middle, k)]):
        arcs["x"][:, row], arcs["y"][:, row] = point[:, 0], point[:, 1]
        arcs["tx"][:, row], arcs["ty"][:, row] = tangent[:, 0], tangent[:, 1]
        arcs["length"][:, row], arcs["curvature"][:, row] = arc_over(chord, half)
    return arcs, np.where(d > 0, np.maximum(np.abs(h), np.abs(k)), np.inf)


def ends(segments: NDArray[np.void]) -> tuple[Floats, Floats]:
    """End points (..., 2) and unit tangents (..., 2) there of segments (...) SEGMENT."""
    return at(segments, segments["length"])


def at(segments: NDArray[np.void], s: Floats) -> tuple[Floats, Floats]:
    """Points (..., 2) and unit tangents (..., 2) of segments (...) SEGMENT at arc lengths s (...) from their starts."""
    half = segments["curvature"] * s / 2
    start = np.stack([segments["x"], segments["y"]], axis=-1)
    tangent = np.stack([segments["tx"], segments["ty"]], axis=-1)
    chord = s * np.sinc(half / np.pi)
    return start + turned(tangent, half) * chord[..., None], turned(tangent, 2 * half)


def distance(segments: NDArray[np.void], points: Floats) -> Floats:
    """Distances (...) of points (..., 2) from segments (...) SEGMENT, whose shapes broadcast against each other."""
    dx, dy = points[..., 0] - segments["x"], points[..., 1] - segments["y"]
    tx, ty, k = segments["tx"], segments["ty"], segments["curvature"]
    x, y = dx * tx + dy * ty, dy * tx - dx * ty
    # The circle is k (x^2 + y^2) - 2 y = 0; divided by the sum of the distances to the two sides, nothing cancels.
    far = np.hypot(k * x, 1 - k * y)
    off = np.abs(k * (x * x + y * y) - 2 * y) / (1 + far)
    angle = np.arctan2(k * x, 1 - k * y)  # k s of the nearest point of the circle
    half = k * segments["length"] / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        inside_arc = np.abs(np.remainder(angle - half + np.pi, 2 * np.pi) - np.pi) <= np.abs(half)
    inside = np.where(np.abs(half) < 1e-6, (x >= 0) & (x <= segments["length"]), inside_arc)
    chord = segments["length"] * np.sinc(half / np.pi)
    at_ends = np.minimum(np.hypot(x, y), np.hypot(x - chord * np.cos(half), y - chord * np.sin(half)))
    return np.asarray(np.where(inside, off, at_ends))


def deviation(curve: Curve, u0: Floats, u1: Floats, arcs: NDArray[np.void]) -> Floats:
    """The largest distance (n,) from the curve's pieces between u0 and u1 (n,) to their biarcs (n, 2) SEGMENT.

    Measured at evenly spaced parameters between the ends.
    """
    share = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    u = u0[:, None] + (u1 - u0)[:, None] * share
    points = curve(u.ravel())[0].reshape(len(u0), _SAMPLES, 2)
    off = np.minimum(distance(arcs[:, :1], points), distance(arcs[:, 1:], points))
    return np.asarray(off.max(axis=1))


class _Fit(NamedTuple):
    """Pieces in order: where each begins (n,), its biarc (n, 2) SEGMENT, and its share (n,) of what a piece may span.

    The share goes with the piece's length: it is the cube root of the deviation over the limit (the deviation goes
    with the cube of the length: D. S. Meek and D. J. Walton, "Approximating smooth planar curves by arc splines",
    Journal of Computational and Applied Mathematics 59, 1995), or the angle over its limit where that is more.
    """

    starts: Floats
    arcs: NDArray[np.void]
    shares: Floats

    def segments(self) -> NDArray[np.void]:
        flat = self.arcs.ravel()
        return np.asarray(flat[flat["length"] > 0])


def fit(
    curve: Curve,
    tolerance: float,
    breaks: Sequence[float] | Floats = (0.0, 1.0),
    *,
    fixed: Sequence[float] | Floats = (0.0, 1.0),
    start: tuple[Floats, Floats] | None = None,
    finish: tuple[Floats, Floats] | None = None,
) -> NDArray[np.void]:
    """Arcs and lines (n,) SEGMENT within `tolerance` of a curve, few of them.

    Pieces are bisected until their biarcs fit; then their ends are moved so that fewer pieces deviate evenly, and
    bisected again where that was too few. `breaks` are the parameters, ascending from 0 to 1, between which the first
    biarcs are tried; those of them in `fixed` stay the ends of pieces. `start` and `finish` are (point, unit
    tangent), (2,) each, to be used at the two ends instead of the curve's own. Every piece starts at a point and a
    tangent of the curve, which its neighbour shares: errors do not add up. A biarc without curvature becomes one
    line; no arc turns by more than LARGEST_ARC. Near a cusp, which has no tangent, pieces end as lines.

    Raises ValueError where the tolerance is not positive, or needs more than MOST_SEGMENTS segments.
    """
    if not tolerance > 0:
        raise ValueError(f"expected a tolerance above 0, found {tolerance}")
    fixed = np.asarray(fixed, float)
    best = last = _bisected(curve, tolerance, np.asarray(breaks, float), start, finish)
    for slack in _SLACKS:
        if len(best.starts) < len(fixed) or slack * best.shares.sum() > len(best.starts) + 1:
            break
        last = _bisected(curve, tolerance, _evened(last, fixed, slack), start, finish)
        if len(last.starts) < len(best.starts):
            best = last
    segments = best.segments()
    if len(segments) > MOST_SEGMENTS:
        raise _too_many(len(segments), tolerance)
    return segments


def _evened(pieces: _Fit, fixed: Floats, slack: float) -> Floats:
    """Ends of pieces of about equal shares, `slack` times as many as the shares ask for, the `fixed` among them."""
    knots = np.append(pieces.starts, 1.0)
    total = np.concatenate([[0.0], np.cumsum(pieces.shares)])
    stops = np.interp(fixed, knots, total)
    moved = [np.zeros(1)]
    for low, high, u in zip(stops[:-1], stops[1:], fixed[1:], strict=True):
        wanted = np.linspace(low, high, max(1, math.ceil((high - low) * slack)) + 1)[1:]
        ends_here = np.interp(wanted, total, knots)
        ends_here[-1] = u
        moved.append(ends_here)
    return np.unique(np.concatenate(moved))


def _bisected(
    curve: Curve,
    tolerance: float,
    knots: Floats,
    start: tuple[Floats, Floats] | None,
    finish: tuple[Floats, Floats] | None,
) -> _Fit:
    points, tangents = curve(knots)
    points, tangents = np.array(points), np.array(tangents)
    for row, end in ((0, start), (-1, finish)):
        if end is not None:
            points[row], tangents[row] = end
    limit = max(_MARGIN * tolerance, 4e-15 * float(np.abs(points).max()))
    u0, u1, p0, t0, p1, t1 = knots[:-1], knots[1:], points[:-1], tangents[:-1], points[1:], tangents[1:]
    done: list[_Fit] = []
    total = 0
    for depth in range(_DEEPEST + 1):
        arcs, half = biarc(p0, t0, p1, t1)
        good = half <= LARGEST_ARC / 2 + 1e-12
        share = np.minimum(half / (LARGEST_ARC / 2), 1.0)
        off = deviation(curve, u0[good], u1[good], arcs[good])
        share[good] = np.maximum(share[good], np.cbrt(off / limit))
        good[good] = off <= limit
        straight = good & (half <= _STRAIGHT)
        if depth == _DEEPEST:
            straight |= ~good
            good[:] = True
        _straighten(arcs, straight, p0, p1)
        total += int(good.sum())
        done.append(_Fit(u0[good], arcs[good], share[good]))
        bad = ~good
        if not bad.any():
            break
        if total + 2 * int(bad.sum()) > MOST_SEGMENTS:  # even if the ends were spread better
            raise _too_many(2 * (total + 2 * int(bad.sum())), tolerance)
        middle = (u0[bad] + u1[bad]) / 2
        point, tangent = curve(middle)
        u0, u1 = np.concatenate([u0[bad], middle]), np.concatenate([middle, u1[bad]])
        p0, p1 = np.concatenate([p0[bad], point]), np.concatenate([point, p1[bad]])
        t0, t1 = np.concatenate([t0[bad], tangent]), np.concatenate([tangent, t1[bad]])
    starts, fitted, shares = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(starts, kind="stable")
    return _Fit(starts[order], fitted[order], shares[order])


def _too_many(count: int, tolerance: float) -> ValueError:
    return ValueError(
        f"expected a path of at most {MOST_SEGMENTS} arcs, found one of about {count} at the tolerance {tolerance:g}"
    )


def _straighten(arcs: NDArray[np.void], which: NDArray[np.bool_], p0: Floats, p1: Floats) -> None:
    """Makes one line each of the biarcs at `which` (n,), in place: the second arc gets the length 0."""
    v = p1[which] - p0[which]
    length = np.hypot(v[:, 0], v[:, 1])
    v /= np.where(length > 0, length, 1)[:, None]
    lines = np.zeros((len(v), 2), SEGMENT)
    lines["x"][:, 0], lines["y"][:, 0] = p0[which].T
    lines["tx"][:, 0], lines["ty"][:, 0] = v.T
    lines["length"][:, 0] = length
    arcs[which] = lines
