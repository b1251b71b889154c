"""Profiles: a groove's cross-section as a polyline of (b, w).

`b` is the signed distance from the path, positive to the left of its direction; `w` the height, 0 on the surface.
Both in pattern units. Every profile can say its polyline; the renderer needs no more of it.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from . import overhang
from .base import MAX_LENGTH, MIN_LENGTH, Array, Fault, Length, LengthOrZero, Model, Point2

MAX_FACETS = 512
Points = tuple[tuple[float, float], ...]
Depth = Annotated[float, Field(ge=-MAX_LENGTH, le=MAX_LENGTH)]


def _depth_faults(depth: float) -> Iterator[Fault]:
    if abs(depth) < MIN_LENGTH:
        yield Fault(("depth",), f"a depth of at least {MIN_LENGTH:g} either way", f"{depth:g}")


class PolylineProfile(Model):
    """Any cross-section: one facet between each two points."""

    type: Literal["polyline"] = Field(description="The kind of profile.")
    points: Annotated[tuple[Point2, ...], Array] = Field(
        min_length=2,
        max_length=MAX_FACETS + 1,
        description="Points [b, w] in pattern units. The first and the last have w = 0; equal b of neighbours make a "
        "vertical wall. Where b decreases the profile overhangs, as a dovetail does: such a polyline must not meet "
        f"itself and has at most {overhang.MAX_FACETS + 1} points. From either end facets are external while it does "
        "not descend, and internal in between. The groove removes what lies between the internal facets and the "
        "vertical lines that rise from the first and the last internal point, undercuts included, and adds what the "
        "polyline encloses with w = 0 above it. Its band and its half-widths reach to the least and the greatest b.",
    )

    def faults(self) -> Iterator[Fault]:
        sound = True
        for index in (0, len(self.points) - 1):
            if self.points[index][1] != 0:
                sound = False
                yield Fault(
                    ("points", index, 1), "0, as a profile ends on the surface", f"{self.points[index][1]:.12g}"
                )
        for index in range(1, len(self.points)):
            before, here = self.points[index - 1], self.points[index]
            if here == before:
                sound = False
                yield Fault(
                    ("points", index), "a point apart from the one before", f"[{here[0]:.12g}, {here[1]:.12g}] again"
                )
        if overhang.overhangs(self.points):
            if sound:
                yield from overhang.faults(self.points)
            return
        width = self.points[-1][0] - self.points[0][0]
        if width < MIN_LENGTH:
            yield Fault(("points",), f"a profile at least {MIN_LENGTH:g} wide", f"a width of {width:g}")

    def polyline(self) -> Points:
        """The points (b, w), from left (the least b) to right."""
        return self.points


class VProfile(Model):
    """Two facets that meet at (0, -depth)."""

    type: Literal["v"] = Field(description="The kind of profile.")
    width: Length = Field(description="The whole width at the surface, pattern units.")
    depth: Depth = Field(description="How deep below the surface, pattern units, not 0; negative makes a ridge.")

    def faults(self) -> Iterator[Fault]:
        yield from _depth_faults(self.depth)

    def polyline(self) -> Points:
        """The points (b, w), from left (the least b) to right."""
        half = self.width / 2
        return ((-half, 0.0), (0.0, -self.depth), (half, 0.0))


class TrapezoidProfile(Model):
    """Two walls and a flat floor. A floor as wide as the groove makes vertical walls; no floor makes a v."""

    type: Literal["trapezoid"] = Field(description="The kind of profile.")
    width: Length = Field(description="The whole width at the surface, pattern units.")
    floor: LengthOrZero = Field(description="The width of the floor, pattern units, at most `width`.")
    depth: Depth = Field(description="How deep below the surface, pattern units, not 0; negative makes a ridge.")

    def faults(self) -> Iterator[Fault]:
        yield from _depth_faults(self.depth)
        if self.floor > self.width:
            yield Fault(("floor",), f"a floor of at most the width, {self.width:.12g}", f"{self.floor:.12g}")

    def polyline(self) -> Points:
        """The points (b, w), from left (the least b) to right."""
        half, floor = self.width / 2, self.floor / 2
        bottom = ((-floor, -self.depth), (floor, -self.depth)) if floor > 0 else ((0.0, -self.depth),)
        return ((-half, 0.0), *bottom, (half, 0.0))


class RoundProfile(Model):
    """A curve through (-width/2, 0), (0, -depth) and (width/2, 0), cut into facets at equal angles.

    A circular arc up to a depth of half the width, where it is a half circle; beyond that the half ellipse.
    """

    type: Literal["round"] = Field(description="The kind of profile.")
    width: Length = Field(description="The whole width at the surface, pattern units.")
    depth: Depth = Field(description="How deep below the surface, pattern units, not 0; negative makes a ridge.")
    facets: int = Field(default=16, ge=2, le=256, description="The number of facets. Default: 16.")

    def faults(self) -> Iterator[Fault]:
        yield from _depth_faults(self.depth)

    def polyline(self) -> Points:
        """The points (b, w), from left (the least b) to right."""
        half, deep = self.width / 2, abs(self.depth)
        if deep <= half:
            # The circle through the three points, and the half of its angle between the ends.
            side, upright = (half * half + deep * deep) / (2 * deep), (half * half + deep * deep) / (2 * deep)
            reach = 2 * math.atan2(deep, half)
        else:
            side, upright, reach = half, deep, math.pi / 2
        inner = []
        for index in range(1, self.facets):
            angle = reach * (2 * index - self.facets) / self.facets
            rise = upright * 2 * math.sin(angle / 2) ** 2  # 1 - cos, without the loss for flat arcs
            inner.append((side * math.sin(angle), math.copysign(1.0, self.depth) * (rise - deep)))
        return ((-half, 0.0), *inner, (half, 0.0))


class ScratchProfile(Model):
    """A v with a triangular lip of pushed-up material along either side; no lip where it has no width or height."""

    type: Literal["scratch"] = Field(description="The kind of profile.")
    width: Length = Field(description="The width of the v at the surface, without the lips, pattern units.")
    depth: Depth = Field(description="How deep below the surface, pattern units, not 0; negative makes a ridge.")
    lip_width: LengthOrZero = Field(default=0.0, description="The width of each lip, pattern units. Default: 0.")
    lip_height: LengthOrZero = Field(
        default=0.0, description="The height of each lip, at the middle of its width, pattern units. Default: 0."
    )

    def faults(self) -> Iterator[Fault]:
        yield from _depth_faults(self.depth)

    def polyline(self) -> Points:
        """The points (b, w), from left (the least b) to right."""
        half, lip, height = self.width / 2, self.lip_width, self.lip_height
        v = ((-half, 0.0), (0.0, -self.depth), (half, 0.0))
        if lip == 0 or height == 0:
            return v
        left = ((-half - lip, 0.0), (-half - lip / 2, height))
        right = ((half + lip / 2, height), (half + lip, 0.0))
        return (*left, *v, *right)


Profile = Annotated[
    PolylineProfile | VProfile | TrapezoidProfile | RoundProfile | ScratchProfile, Field(discriminator="type")
]
