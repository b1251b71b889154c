"""Paths: where a groove runs. Pattern units (p, q) unless a polyline says `space: world`."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Literal

from pydantic import ConfigDict, Field
from pydantic.config import JsonDict

from . import svg
from .base import MAX_COORDINATE, MAX_POINTS, Array, Coordinate, Degrees, Fault, Length, LengthOrZero, Model, Point2

MAX_SVG_CHARACTERS = 1_000_000
SPIRAL_PIECES_PER_TURN = 8

_WORLD_NEEDS_THREE: JsonDict = {
    "if": {"properties": {"space": {"const": "world"}}, "required": ["space"]},
    "then": {"properties": {"points": {"items": {"minItems": 3}}}},
    "else": {"properties": {"points": {"items": {"maxItems": 2}}}},
}


class PolylinePath(Model):
    """Straight lines from point to point, mitred at the corners."""

    model_config = ConfigDict(json_schema_extra=_WORLD_NEEDS_THREE)

    type: Literal["polyline"] = Field(description="The kind of path.")
    points: Annotated[
        tuple[Annotated[tuple[Coordinate, ...], Array, Field(min_length=2, max_length=3)], ...], Array
    ] = Field(
        min_length=2,
        max_length=MAX_POINTS,
        description="The corners: [p, q] in pattern units, or [x, y, z] in world units where `space` is world.",
    )
    closed: bool = Field(default=False, description="Whether the last point is joined to the first. Default: false.")
    space: Literal["pattern", "world"] = Field(
        default="pattern",
        description="The space of the points; points of the world are projected to the object's surface. "
        "Default: pattern.",
    )

    def faults(self) -> Iterator[Fault]:
        size, kind = (3, "[x, y, z]") if self.space == "world" else (2, "[p, q]")
        for index, point in enumerate(self.points):
            if len(point) != size:
                found = f"an array of {len(point)} numbers"
                yield Fault(("points", index), f"a point {kind}, as space is {self.space}", found)
        if all(point == self.points[0] for point in self.points):
            yield Fault(("points",), "a path of some length", "points that all coincide")

    def pieces(self) -> int:
        """The number of lines and curves of the path."""
        return len(self.points) - 1 + int(self.closed)


class CirclePath(Model):
    """A full circle, counter-clockwise, beginning at center + (radius, 0)."""

    type: Literal["circle"] = Field(description="The kind of path.")
    center: Point2 = Field(description="The centre [p, q], pattern units.")
    radius: Length = Field(description="The radius, pattern units.")

    def pieces(self) -> int:
        """The number of lines and curves of the path."""
        return 1


class SpiralPath(Model):
    """An Archimedean spiral, counter-clockwise from the inner to the outer radius."""

    type: Literal["spiral"] = Field(description="The kind of path.")
    center: Point2 = Field(description="The centre [p, q], pattern units.")
    inner_radius: LengthOrZero = Field(description="The radius where the path begins, pattern units.")
    outer_radius: Length = Field(description="The radius where it ends, pattern units; above the inner radius.")
    turns: float = Field(ge=1e-3, le=10_000, description="The number of turns between the two radii.")
    angle: Degrees = Field(
        default=0.0, description="The direction of the beginning from the centre, degrees from +p to +q. Default: 0."
    )

    def faults(self) -> Iterator[Fault]:
        if not self.outer_radius > self.inner_radius:
            expected = f"a radius above the inner radius, {self.inner_radius:.12g}"
            yield Fault(("outer_radius",), expected, f"{self.outer_radius:.12g}")

    def pieces(self) -> int:
        """About the number of arcs that the path is approximated by."""
        return math.ceil(self.turns * SPIRAL_PIECES_PER_TURN)


class SvgPath(Model):
    """SVG path data with all its commands. Every subpath is a groove of its own."""

    type: Literal["svg"] = Field(description="The kind of path.")
    d: str = Field(
        min_length=1, max_length=MAX_SVG_CHARACTERS, description="SVG path data (its `d` attribute), pattern units."
    )
    flip_y: bool = Field(
        default=False,
        description="Whether y points down, as in SVG files: then q = -y. If not, q = y. Default: false (y up).",
    )

    def faults(self) -> Iterator[Fault]:
        try:
            outline = self._outline
        except svg.SvgError as error:
            yield Fault(("d",), error.expected, error.found)
            return
        if not outline.is_drawn:
            yield Fault(("d",), "a path of some length", "path data that draw nothing")
        if not outline.reach <= MAX_COORDINATE:
            yield Fault(
                ("d",), f"coordinates within {MAX_COORDINATE:g} of zero", f"a path that reaches {outline.reach:g}"
            )

    @cached_property
    def _outline(self) -> svg.Outline:
        return svg.outline(self.d)

    def pieces(self) -> int:
        """The number of lines and curves of the path."""
        return self._outline.pieces


Path = Annotated[PolylinePath | CirclePath | SpiralPath | SvgPath, Field(discriminator="type")]
