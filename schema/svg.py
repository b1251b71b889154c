"""SVG path data (SVG 1.1, 8.3.9) read for checks alone: is it well formed, does it draw, how tight does it bend.

A reader of our own because the checks need what drawing libraries drop: where a fault is, and that there is one.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

Xy = tuple[float, float]

_SPACE = re.compile(r"[ \t\r\n\f]*")
_COMMA = re.compile(r"[ \t\r\n\f]*,?[ \t\r\n\f]*")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FLAG = re.compile(r"[01]")
# One letter an argument: n a number, f a flag.
_ARGUMENTS = {"M": "nn", "L": "nn", "H": "n", "V": "n", "C": "n" * 6, "S": "nnnn", "Q": "nnnn", "T": "nn"}
_ARGUMENTS |= {"A": "nnnffnn", "Z": ""}
_SAMPLES = tuple(i / 8 for i in range(9))


class SvgError(ValueError):
    """Path data that are not well formed."""

    def __init__(self, expected: str, found: str) -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected = expected
        self.found = found


@dataclass(frozen=True, slots=True)
class Segment:
    """A line, a Bezier curve with its control points, or an elliptical arc's two ends."""

    kind: Literal["line", "curve", "arc"]
    points: tuple[Xy, ...]
    radii: Xy = (0.0, 0.0)
    rotation: float = 0.0

    def is_drawn(self) -> bool:
        """Whether the segment has any length."""
        return any(point != self.points[0] for point in self.points)

    def tightest_radius(self) -> float:
        """About the smallest radius of curvature; infinite for a line."""
        if self.kind == "curve":
            return _bezier_radius(self.points)
        if self.kind == "arc":
            small, large = sorted(_grown_radii(self))
            return small * small / large
        return math.inf


def _bezier_radius(points: tuple[Xy, ...]) -> float:
    """The smallest of some samples; rough, and quick enough for path data of a megabyte."""
    p = [complex(*point) for point in points]
    # The velocity is a + b t + c t^2.
    if len(p) == 3:
        a, b, c = 2 * (p[1] - p[0]), 2 * (p[2] - 2 * p[1] + p[0]), 0j
    else:
        a, b, c = 3 * (p[1] - p[0]), 6 * (p[2] - 2 * p[1] + p[0]), 3 * (p[3] - 3 * p[2] + 3 * p[1] - p[0])
    smallest = math.inf
    for t in _SAMPLES:
        velocity = a + (b + c * t) * t
        bend = abs((velocity.conjugate() * (b + 2 * c * t)).imag)
        # A control point on an end makes the velocity 0 there; the samples beside it tell the curvature.
        if bend > 0:
            smallest = min(smallest, abs(velocity) ** 3 / bend)
    return smallest


def _grown_radii(arc: Segment) -> Xy:
    """The radii, scaled up where they are too small to join the ends (SVG 1.1, F.6.6)."""
    (x0, y0), (x1, y1) = arc.points
    half = complex(x0 - x1, y0 - y1) / 2 * complex(math.cos(arc.rotation), -math.sin(arc.rotation))
    growth = max(1.0, math.hypot(half.real / arc.radii[0], half.imag / arc.radii[1]))
    return arc.radii[0] * growth, arc.radii[1] * growth


def _commands(d: str) -> Iterator[tuple[str, list[float]]]:
    """Each command with its arguments; repeated arguments repeat the command."""
    at = _skip(_SPACE, d, 0)
    while at < len(d):
        command = d[at]
        if command.upper() not in _ARGUMENTS:
            raise SvgError("an SVG path command (one of MLHVCSQTAZ, in either case)", _place(d, at))
        at = _skip(_SPACE, d, at + 1)
        kinds = _ARGUMENTS[command.upper()]
        more = True
        while more:
            arguments: list[float] = []
            for index, kind in enumerate(kinds):
                if index:
                    at = _skip(_COMMA, d, at)
                match = (_FLAG if kind == "f" else _NUMBER).match(d, at)
                if match is None:
                    wanted = "0 or 1" if kind == "f" else "a number"
                    raise SvgError(f"{wanted} as argument {index + 1} of {command}", _place(d, at))
                value = float(match.group())
                if not math.isfinite(value):
                    raise SvgError("a finite number", _place(d, at))
                arguments.append(value)
                at = match.end()
            yield command, arguments
            command = {"M": "L", "m": "l"}.get(command, command)
            after = _skip(_COMMA, d, at)
            more = bool(kinds) and _NUMBER.match(d, after) is not None
            at = after if more else _skip(_SPACE, d, at)


def _skip(pattern: re.Pattern[str], d: str, at: int) -> int:
    match = pattern.match(d, at)
    return match.end() if match else at


def _place(d: str, at: int) -> str:
    if at >= len(d):
        return "the end of the path data"
    return f"{d[at : at + 12]!r} at character {at + 1}"


@dataclass(frozen=True, slots=True)
class Outline:
    """What path data amount to."""

    pieces: int
    is_drawn: bool
    reach: float


def outline(d: str) -> Outline:
    """Reads path data once, keeping none of them; raises SvgError where they are not well formed."""
    pieces, is_drawn, reach = 0, False, 0.0
    for segment in segments(d):
        pieces += 1
        is_drawn = is_drawn or segment.is_drawn()
        reach = max(reach, *(abs(x) for point in segment.points for x in point))
    return Outline(pieces, is_drawn, reach)


def segments(d: str) -> Iterator[Segment]:
    """All segments of path data in absolute coordinates; raises SvgError where they are not well formed."""
    here: Xy = (0.0, 0.0)
    start: Xy | None = None
    control, last = here, ""
    for command, arguments in _commands(d):
        name, base = command.upper(), here if command.islower() else (0.0, 0.0)
        if start is None and name != "M":
            raise SvgError("path data that begin with M or m", repr(command))
        if name == "Z":
            end = start or here
            yield Segment("line", (here, end))
            here, control, last = end, end, name
            continue
        if name in "HV":
            end = (arguments[0] + base[0], here[1]) if name == "H" else (here[0], arguments[0] + base[1])
        else:
            end = (arguments[-2] + base[0], arguments[-1] + base[1])
        pairs = [(x + base[0], y + base[1]) for x, y in zip(arguments[0:-2:2], arguments[1:-2:2], strict=False)]
        mirrored = (2 * here[0] - control[0], 2 * here[1] - control[1])
        if name == "M":
            start = end
        elif name in "CQ":
            yield Segment("curve", (here, *pairs, end))
            control = pairs[-1]
        elif name == "S":
            yield Segment("curve", (here, mirrored if last in "CS" else here, pairs[0], end))
            control = pairs[0]
        elif name == "T":
            control = mirrored if last in "QT" else here
            yield Segment("curve", (here, control, end))
        elif name == "A" and arguments[0] and arguments[1]:
            radii = (abs(arguments[0]), abs(arguments[1]))
            yield Segment("arc", (here, end), radii, math.radians(arguments[2]))
        else:
            yield Segment("line", (here, end))
        if name not in "CSQT":
            control = end
        here, last = end, name
