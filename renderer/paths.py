"""Paths as chains of lines and circular arcs (2, stage 1): polylines, circles, spirals and SVG path data.

Lengths are in pattern units; angles are radians but for arguments said to be in degrees. What a line or an arc is
exactly stays exact; everything else becomes biarcs (see renderer.biarc) within a tolerance. Neighbours share their
end points; where neither is bent to the other, their tangents may differ: a corner, which is mitred. A corner that
is too sharp to be mitred ends the chain, and another begins there.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from renderer.biarc import LARGEST_ARC, MOST_SEGMENTS, Curve, arc_over, ends, fit, turned
from renderer.tables import SEGMENT, Chain, Floats

if TYPE_CHECKING:
    import svgelements

Point = tuple[float, float]

MITRE_LIMIT = 10.0
"""The largest tan of half the turn at a corner (about 168.6 degrees); a sharper one ends the chain."""

SNAP = 1e-4
"""Joints of SVG segments that turn by less, in radians, are made smooth where one of the two is curved."""

_LARGEST = 1e9  # coordinates beyond this are refused: squares of them must stay far from overflow
_EXACT = 1e-12  # rounding: joints of lines and arcs that turn by less are smooth as they are


def polyline(points: Sequence[Point], closed: bool) -> list[Chain]:
    """Straight lines from point to point, and from the last to the first where `closed`; [] where there is no length.

    Points (p, q) that repeat the one before are dropped. Raises ValueError where a coordinate is not a finite number
    up to 1e9.
    """
    corners = _finite(np.array(points, float).reshape(-1, 2))
    if closed:
        corners = np.concatenate([corners, corners[:1]])
    steps = np.diff(corners, axis=0)
    length = np.hypot(steps[:, 0], steps[:, 1])
    lines = np.zeros(len(steps), SEGMENT)
    lines["x"], lines["y"] = corners[:-1].T
    lines["length"] = length
    lines, steps = lines[length > 0], steps[length > 0]
    lines["tx"], lines["ty"] = steps.T / lines["length"]
    return _chains(lines, closed)


def circle(center: Point, radius: float) -> list[Chain]:
    """A whole circle, counter-clockwise from center + (radius, 0), as one arc.

    Raises ValueError where the radius is not positive.
    """
    if not radius > 0:
        raise ValueError(f"expected a radius above 0, found {radius}")
    _finite(np.array([*center, radius], float))
    arc = np.array([(center[0] + radius, center[1], 0.0, 1.0, 2 * math.pi * radius, 1 / radius)], SEGMENT)
    return [Chain(arc, closed=True)]


def spiral(
    center: Point, inner_radius: float, outer_radius: float, turns: float, angle: float, tolerance: float
) -> list[Chain]:
    """An Archimedean spiral from its inner end outwards, as arcs within `tolerance`, tangents continuous.

    `angle` (degrees) is the direction of the inner end from the centre; positive turns run counter-clockwise. The
    biarcs' ends are spread so that all pieces deviate about equally, as widely as the tolerance allows: the deviation
    of a biarc goes with the change of the curvature along it times the cube of its length (D. S. Meek and D. J.
    Walton, "Approximating smooth planar curves by arc splines", Journal of Computational and Applied Mathematics 59,
    1995), so the ends lie evenly in the integral of the cube root of the former.

    Raises ValueError where the radii are not 0 <= inner <= outer > 0, turns is 0, the tolerance is not positive, or
    more than MOST_SEGMENTS arcs would be needed.
    """
    _finite(np.array([*center, inner_radius, outer_radius, turns, angle], float))
    if not (0 <= inner_radius <= outer_radius and outer_radius > 0):
        raise ValueError(f"expected radii 0 <= inner <= outer, outer > 0, found {inner_radius:g} and {outer_radius:g}")
    if turns == 0:
        raise ValueError("expected a number of turns other than 0, found 0")
    if not tolerance > 0:
        raise ValueError(f"expected a tolerance above 0, found {tolerance}")
    first, sweep = math.radians(angle), abs(turns) * 2 * math.pi
    sense = math.copysign(1.0, turns)
    growth = (outer_radius - inner_radius) / sweep  # of the radius, a radian

    def curve(u: Floats) -> tuple[Floats, Floats]:
        theta = first + sense * sweep * u
        radius = inner_radius + (outer_radius - inner_radius) * u
        outward = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        along = np.stack([-outward[:, 1], outward[:, 0]], axis=1) * sense
        direction = growth * outward + radius[:, None] * along
        return np.array(center) + radius[:, None] * outward, direction / np.hypot(*direction.T)[:, None]

    def bounded(pieces: float) -> None:
        if 2 * pieces > MOST_SEGMENTS:
            raise ValueError(f"expected a spiral of at most {MOST_SEGMENTS} arcs, found one of about {2 * pieces:.0f}")

    if growth == 0:
        bounded(sweep / LARGEST_ARC / 2)
        arcs = _arc(np.array(center), curve(np.zeros(1))[0][0], curve(np.ones(1))[0][0], sense * sweep)
        return _chains(arcs, closed=False)

    # The angle from where the radius would be 0: beyond 50, curvature and density hardly change any more.
    begin = inner_radius / growth
    near = np.linspace(begin, min(begin + sweep, max(begin, 50.0) + 1), 2001)
    x = np.unique(np.concatenate([near, np.geomspace(near[-1], max(begin + sweep, near[-1]), 201)]))
    x = x[x <= begin + sweep]
    x[-1] = begin + sweep
    # The error is the density's cube times a constant and the angle's. At the centre the curvature stands still, but
    # not along a whole piece: hence 0.25.
    r2 = x * x + 0.25**2
    density = np.cbrt(growth * np.sqrt(r2) * (r2 + 4) / (r2 + 1) ** 1.5)
    turning = (x * x + 2) / (x * x + 1) / (1.96 * LARGEST_ARC)  # no arc may turn too far

    rate = 1.04 * (324 * tolerance) ** (-1 / 3)

    weight = np.maximum(rate * density, turning)
    total = np.concatenate([[0.0], np.cumsum((weight[1:] + weight[:-1]) / 2 * np.diff(x))])
    bounded(total[-1])
    knots = np.interp(np.linspace(0, total[-1], math.ceil(total[-1]) + 1), total, x)
    return _chains(fit(curve, tolerance, ((knots - begin) / sweep).clip(0, 1)), closed=False)


def svg(d: str, flip_y: bool, tolerance: float) -> list[Chain]:
    """SVG path data (SVG 1.1, 8.3) as chains, one or more a subpath that draws anything; all commands.

    The data's coordinates are pattern coordinates, y up, as they stand; `flip_y` negates y. Lines and circular arcs
    stay exact, Béziers and elliptical arcs become arcs within `tolerance` (it may be
    infinite: as few arcs as can be). Joints that turn by less than SNAP are
    made smooth: curves take the tangent of a line or an arc that they meet, two curves meet in the mean, an arc that
    misses its neighbour's direction gives way and is fitted. Two lines keep even the slightest corner. `Z` closes.

    Raises ValueError (where, what was expected, what was found) where the data are malformed or a coordinate exceeds
    1e9, or where more than MOST_SEGMENTS segments would be needed.
    """
    if not tolerance > 0:
        raise ValueError(f"expected a tolerance above 0, found {tolerance}")
    import svgelements  # slow to load, and only SVG paths need it

    chains: list[Chain] = []
    total = 0
    for elements, closed in _subpaths(svgelements.Path(_canonical(d)), -1.0 if flip_y else 1.0, tolerance):
        if not elements:
            continue
        _smooth(elements, closed)
        segments = np.concatenate([element.segments(tolerance) for element in elements])
        total += len(segments)
        if total > MOST_SEGMENTS:
            raise ValueError(f"expected a path of at most {MOST_SEGMENTS} segments, found one of more at {tolerance:g}")
        chains += _chains(segments, closed)
    return chains


def _chains(segments: NDArray[np.void], closed: bool) -> list[Chain]:
    """The chains of consecutive segments (n,) SEGMENT, split where a corner is sharper than MITRE_LIMIT."""
    segments = segments[segments["length"] > 0]
    if not len(segments):
        return []
    leaving = ends(segments)[1]
    entering = np.stack([segments["tx"], segments["ty"]], axis=1)
    difference = np.roll(entering, -1, axis=0) - leaving
    # |a - b| / |a + b| is the tan of half the angle between unit vectors.
    sharp = np.hypot(*difference.T) > MITRE_LIMIT * np.hypot(*(difference + 2 * leaving).T)
    if not closed:
        sharp[-1] = False
    if not sharp.any():
        return [Chain(segments, closed)]
    cuts = np.flatnonzero(sharp) + 1  # where a chain begins
    if closed:
        segments = np.roll(segments, -cuts[-1])
        cuts = (cuts - cuts[-1])[:-1] % len(segments)
    return [Chain(part, closed=False) for part in np.split(segments, cuts) if len(part)]


def _finite(values: Floats) -> Floats:
    if not (np.abs(values) <= _LARGEST).all():
        worst = values.ravel()[~(np.abs(values.ravel()) <= _LARGEST)][0]
        raise ValueError(f"expected finite numbers within {_LARGEST:g} of zero, found {worst}")
    return values


def _arc(center: Floats, p0: Floats, p1: Floats, turn: float) -> NDArray[np.void]:
    """The arc about a centre (2,) from p0 to p1 (2,) that turns by `turn`, as equal segments (n,) SEGMENT.

    Each is laid over the chord between its end points, so that rounding does not add up.
    """
    count = max(1, math.ceil(abs(turn) / LARGEST_ARC - 1e-9))
    angles = np.linspace(0, turn, count + 1)
    points = np.asarray(center + turned(p0 - center, angles))
    points[0], points[-1] = p0, p1
    chords = np.diff(points, axis=0)
    size = np.hypot(*chords.T)
    half = np.full(count, turn / count / 2)
    arcs = np.zeros(count, SEGMENT)
    arcs["x"], arcs["y"] = points[:-1].T
    arcs["tx"], arcs["ty"] = turned(chords / np.where(size > 0, size, 1)[:, None], -half).T
    arcs["length"], arcs["curvature"] = arc_over(size, half)
    return arcs


# -- the parts of SVG data --------------------------------------------------------------------------------------


@dataclass
class _Element:
    """A line, an arc (center, turn) or a curve (curve, breaks) from p0 to p1 with unit tangents there."""

    p0: Floats
    p1: Floats
    t0: Floats
    t1: Floats
    center: Floats | None = None
    turn: float = 0.0
    curve: Curve | None = None
    breaks: Sequence[float] = (0.0, 1.0)

    def segments(self, tolerance: float) -> NDArray[np.void]:
        if self.curve is not None:
            at_ends = {"start": (self.p0, self.t0), "finish": (self.p1, self.t1)}
            return fit(self.curve, tolerance, self.breaks, fixed=self.breaks, **at_ends)
        if self.center is not None:
            return _arc(self.center, self.p0, self.p1, self.turn)
        line = np.zeros(1, SEGMENT)
        line["x"], line["y"], line["tx"], line["ty"] = *self.p0, *self.t0
        line["length"] = math.hypot(*(self.p1 - self.p0))
        return line

    def soften(self) -> None:
        """Makes a curve of an arc, so that its tangents can be bent."""
        if self.center is None or self.curve is not None:
            return
        center, start, turn = self.center, self.p0 - self.center, self.turn

        def curve(u: Floats) -> tuple[Floats, Floats]:
            radius = turned(start, turn * u)
            return center + radius, turned(radius / math.hypot(*start), math.copysign(math.pi / 2, turn))

        self.curve = curve
        self.breaks = [float(u) for u in np.linspace(0, 1, max(1, math.ceil(abs(turn) / LARGEST_ARC)) + 1)]


def _smooth(elements: list[_Element], closed: bool) -> None:
    """Makes joints that turn by less than SNAP smooth, in place."""
    for index, before in enumerate(elements):
        if index == len(elements) - 1 and not closed:
            break
        after = elements[(index + 1) % len(elements)]
        turn = abs(_angle(before.t1, after.t0))
        if turn >= SNAP:
            continue
        if turn > _EXACT and before.curve is None and after.curve is None:
            after.soften()
            if after.curve is None:
                before.soften()
        if before.curve is not None and after.curve is not None:
            before.t1 = after.t0 = _unit(before.t1 + after.t0)
        elif before.curve is not None:
            before.t1 = after.t0
        elif after.curve is not None:
            after.t0 = before.t1


def _subpaths(path: svgelements.Path, sign: float, tolerance: float) -> Iterator[tuple[list[_Element], bool]]:
    """The elements of each subpath and whether it is closed; y is multiplied by `sign`."""

    def point(value: svgelements.Point) -> Floats:
        return _finite(np.array([float(value.x), sign * float(value.y)]))

    elements: list[_Element] = []
    here = start = np.zeros(2)
    control, last = here, ""  # for the smooth commands, of which svgelements takes any curve's control point
    for segment in path:
        kind = type(segment).__name__
        if kind == "Move":
            yield elements, False
            elements, start = [], point(segment.end)
            here = start
        elif kind == "Close":
            _close(elements, here, start)
            yield elements, True
            elements, here = [], start
        else:
            end = point(segment.end)
            if kind == "Line":
                elements += _lines([here, end])
            elif kind == "Arc":
                elements += _elliptical(segment, here, end, point)
            else:
                names = ("control",) if kind == "QuadraticBezier" else ("control1", "control2")
                controls = [point(getattr(segment, name)) for name in names]
                if segment.smooth:
                    controls[0] = 2 * here - control if last == kind else here
                control = controls[-1]
                if len(controls) == 1:
                    controls = [(here + 2 * control) / 3, (end + 2 * control) / 3]
                elements += _bezier(np.array([here, *controls, end]), tolerance)
            here = end
        last = kind
    yield elements, False


def _close(elements: list[_Element], here: Floats, start: Floats) -> None:
    """Adds the line of a Z, or, where only rounding is left of it, moves the last end instead."""
    gap = math.hypot(*(start - here))
    if elements and 0 < gap <= 1e-10 * max(float(np.abs(e.p1 - start).max()) for e in elements):
        last = elements[-1]
        if last.center is None and last.curve is None:
            elements[-1:] = _lines([last.p0, start])
        else:
            last.p1 = start
    else:
        elements += _lines([here, start])


def _lines(points: Sequence[Floats]) -> list[_Element]:
    lines = []
    for p0, p1 in pairwise(points):
        size = math.hypot(*(p1 - p0))
        if size > 0:
            tangent = (p1 - p0) / size
            lines.append(_Element(p0, p1, tangent, tangent))
    return lines


def _bezier(p: Floats, tolerance: float, whole: bool = True) -> list[_Element]:
    """A cubic Bézier with the control points p (4, 2): lines where they lie on one, else a curve.

    A hairpin whose radius is below a hundredth of the tolerance counts as a cusp: two curves, in opposite directions.
    """
    p = p.copy()
    tolerance = min(
        tolerance, float(np.hypot(*(p - p[0]).T).max())
    )  # a coarse tolerance leaves something of all curves
    for inner, outer in ((1, 0), (2, 3)):  # a handle this short would only make a hook of a thousandth of the tolerance
        if math.hypot(*(p[inner] - p[outer])) < 1e-3 * tolerance:
            p[inner] = p[outer]
    legs = p - p[0]
    sizes = np.hypot(*legs.T)
    scale = float(sizes.max())
    if scale == 0:
        return _lines([p[0], p[3]])
    axis = legs[sizes.argmax()] / scale
    if np.abs(axis[0] * legs[:, 1] - axis[1] * legs[:, 0]).max() <= 1e-12 * scale:
        return _lines([p[0], *_turning_points(p, legs @ axis, axis), p[3]])

    a, b, c = (
        3 * (legs[3] - 3 * legs[2] + 3 * legs[1]),
        6 * (legs[2] - 2 * legs[1]),
        3 * legs[1],
    )  # p' = a u^2 + b u + c
    breaks = [0.0, 1.0]
    if whole:
        slopes = np.roots([4 * (a @ a), 6 * (a @ b), 2 * (b @ b + 2 * (a @ c)), 2 * (b @ c)])  # of |p'|^2
        for u in sorted(float(root.real) for root in slopes if abs(root.imag) < 1e-7 and 1e-6 < root.real < 1 - 1e-6):
            speed, bend = math.hypot(*((a * u + b) * u + c)), math.hypot(*(2 * a * u + b))
            if bend * scale > 0 and (speed < 1e-6 * scale or speed * speed / bend < 1e-2 * tolerance):
                return _cusp(p, u, (2 * a * u + b) / bend, tolerance)
            if speed < 0.05 * scale:
                breaks.insert(-1, u)

    def curve(u: Floats) -> tuple[Floats, Floats]:
        u = u[:, None]
        v = 1 - u
        points = p[0] + u * (3 * v * v * legs[1] + u * (3 * v * legs[2] + u * legs[3]))
        speed = (a * u + b) * u + c
        size = np.hypot(*speed.T)[:, None]
        return points, np.where(size > 0, speed / np.where(size > 0, size, 1), axis)

    t0 = next(_unit(q - p[0]) for q in p[1:] if (q != p[0]).any())
    t1 = next(_unit(p[3] - q) for q in p[2::-1] if (q != p[3]).any())
    return [_Element(p[0], p[3], t0, t1, curve=curve, breaks=breaks)]


def _cusp(p: Floats, u: float, back: Floats, tolerance: float) -> list[_Element]:
    """The parts of a Bézier before and after a cusp at u, which it leaves in the direction `back`; no tiny parts."""
    parts = []
    for half in _halves(p, u):
        tiny = np.hypot(*(half - half[0]).T).max() <= 1e-2 * tolerance
        parts.append([] if tiny else _bezier(half, tolerance, whole=False))
    before, after = parts
    if before and before[-1].curve is not None:
        before[-1].t1 = -back
    if after and after[0].curve is not None:
        after[0].t0 = back
    elements = before + after
    if not elements:
        return _lines([p[0], p[3]])
    elements[0].p0, elements[-1].p1 = p[0], p[3]
    return [
        e for element in elements for e in (_lines([element.p0, element.p1]) if element.curve is None else [element])
    ]


def _turning_points(p: Floats, along: Floats, axis: Floats) -> list[Floats]:
    """Where a Bézier on a line through p[0] turns back; `along` (4,) are its control points' places on the line."""
    slope = [along[3] - 3 * along[2] + 3 * along[1], 2 * (along[2] - 2 * along[1]), along[1]]
    turns = []
    for u in sorted(
        float(root.real) for root in np.roots(slope) if abs(root.imag) < 1e-7 and 1e-7 < root.real < 1 - 1e-7
    ):
        place = ((along[3] * u + 3 * (1 - u) * along[2]) * u + 3 * (1 - u) ** 2 * along[1]) * u
        turns.append((place, slope[0] * 2 * u + slope[1]))
    size = float(np.abs(along).max())
    return [p[0] + place * axis for place, bend in turns if abs(bend) > 1e-6 * size]


def _halves(p: Floats, u: float) -> tuple[Floats, Floats]:
    """The control points of a Bézier's parts before and after u (de Casteljau)."""
    before, after = [p[0]], [p[-1]]
    while len(p) > 1:
        p = (1 - u) * p[:-1] + u * p[1:]
        before.append(p[0])
        after.append(p[-1])
    return np.array(before), np.array(after[::-1])


def _elliptical(
    arc: svgelements.Arc, p0: Floats, p1: Floats, point: Callable[[svgelements.Point], Floats]
) -> list[_Element]:
    """An A command: an exact arc where its radii are equal, else a curve; a line where a radius is 0."""
    center = point(arc.center)
    a, b = point(arc.prx) - center, point(arc.pry) - center
    ra, rb = math.hypot(*a), math.hypot(*b)
    chord = math.hypot(*(p1 - p0))
    if chord == 0 or ra == 0 or rb == 0 or arc.sweep == 0:
        return _lines([p0, p1])
    large, sense = abs(arc.sweep) > math.pi, math.copysign(1.0, arc.sweep)
    if abs(ra - rb) <= 1e-9 * ra:
        # From the chord and the radius: the centre and the angles that svgelements gives are less exact.
        sense *= math.copysign(1.0, a[0] * b[1] - a[1] * b[0])
        sine = chord / (2 * ra)
        half = math.pi / 2 if sine > 1 - 1e-12 else math.asin(sine)
        if large and sine <= 1 - 1e-12:
            half = math.pi - half
        direction = (p1 - p0) / chord
        radius = chord / 2 / math.sin(half)
        normal = np.array([-direction[1], direction[0]])
        center = (p0 + p1) / 2 + sense * radius * math.cos(half) * normal
        t0, t1 = turned(direction, np.array(-sense * half)), turned(direction, np.array(sense * half))
        return [_Element(p0, p1, t0, t1, center=center, turn=2 * sense * half)]

    def parameter(q: Floats) -> float:
        return math.atan2((q - center) @ b / (rb * rb), (q - center) @ a / (ra * ra))

    first = parameter(p0)
    sweep = sense * ((sense * (parameter(p1) - first)) % (2 * math.pi))
    if abs(sweep - arc.sweep) > math.pi:  # a whole turn, or none, but for rounding
        sweep = arc.sweep

    def ellipse(u: Floats) -> Floats:
        angle = (first + sweep * u)[:, None]
        return np.asarray(center + a * np.cos(angle) + b * np.sin(angle))

    miss0, miss1 = p0 - ellipse(np.zeros(1))[0], p1 - ellipse(np.ones(1))[0]

    def curve(u: Floats) -> tuple[Floats, Floats]:
        angle = (first + sweep * u)[:, None]
        speed = sense * (b * np.cos(angle) - a * np.sin(angle))
        size = np.hypot(*speed.T)[:, None]
        return ellipse(u) + (1 - u[:, None]) * miss0 + u[:, None] * miss1, speed / size

    quarters = [(k * math.pi / 2 - first) / sweep for k in range(-12, 13)]
    breaks = [0.0, *sorted(u for u in quarters if 1e-6 < u < 1 - 1e-6), 1.0]
    tangents = curve(np.array([0.0, 1.0]))[1]
    return [_Element(p0, p1, tangents[0], tangents[1], curve=curve, breaks=breaks)]


def _angle(a: Floats, b: Floats) -> float:
    return math.atan2(a[0] * b[1] - a[1] * b[0], a @ b)


def _unit(v: Floats) -> Floats:
    return np.asarray(v / math.hypot(*v))


# -- the grammar ------------------------------------------------------------------------------------------------

_COMMAND = re.compile(r"\s*([MmLlHhVvCcSsQqTtAaZz])\s*")
_ARGUMENTS = {"M": "nn", "L": "nn", "H": "n", "V": "n", "C": "nnnnnn", "S": "nnnn", "Q": "nnnn", "T": "nn", "Z": ""}
_ARGUMENTS["A"] = "rrnffnn"  # n: a number, r: a radius, f: a flag
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_FLAG = re.compile("[01]")
_COMMA = re.compile(r"\s*,?\s*")


def _canonical(d: str) -> str:
    """The same path data, checked and spelt so that svgelements reads them.

    svgelements stops without a word at the first thing it does not know, passes over missing arguments, and misreads
    numbers such as `1.` and negative radii.
    """
    words: list[str] = []
    end = len(d.rstrip())
    here = 0
    while here < end:
        match = _COMMAND.match(d, here)
        if match is None:
            raise _malformed(d, here, "a path command")
        command = match[1]
        if not words and command not in "Mm":
            raise _malformed(d, here, "path data that begin with M or m")
        words.append(command)
        here = match.end()
        kinds = _ARGUMENTS[command.upper()]
        more = bool(kinds)
        while more:
            for index, kind in enumerate(kinds):
                here = _after(d, here) if index else here
                match = (_FLAG if kind == "f" else _NUMBER).match(d, here)
                if match is None:
                    raise _malformed(d, here, ("0 or 1" if kind == "f" else "a number") + f" for {command}")
                value = float(match[0])
                if not abs(value) <= _LARGEST:
                    raise _malformed(d, here, f"a number within {_LARGEST:g} of zero for {command}")
                words.append(match[0] if kind == "f" else repr(abs(value) if kind == "r" else value))
                here = match.end()
            following = _after(d, here)
            more = _NUMBER.match(d, following) is not None
            here = following if more else here
    return " ".join(words)


def _after(d: str, here: int) -> int:
    match = _COMMA.match(d, here)
    return match.end() if match else here


def _malformed(d: str, here: int, expected: str) -> ValueError:
    here += len(d[here:]) - len(d[here:].lstrip())
    found = f"{d[here : here + 12]!r} at character {here + 1}" if here < len(d) else "the end of the path data"
    return ValueError(f"expected {expected}, found {found}")
