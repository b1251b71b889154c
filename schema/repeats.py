"""Repeats: many grooves from one."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from .base import MAX_COORDINATE, Array, Coordinate, Count, Degrees, Fault, Model, Point2, Seed

PlacedScale = Annotated[float, Field(ge=1e-3, le=1000)]


def _step_faults(at: tuple[str | int, ...], step: tuple[float, ...], count: int) -> Iterator[Fault]:
    if count > 1 and not any(step):
        yield Fault(at, "a step that is not zero, as there is more than one copy", "a step of zero")
    reach = math.hypot(*step) * (count - 1)
    if reach > MAX_COORDINATE:
        yield Fault(at, f"a last copy within {MAX_COORDINATE:g} of the first", f"one {reach:g} away")


class LinearRepeat(Model):
    """Copies in a row: copy i is moved by i * step."""

    type: Literal["linear"] = Field(description="The kind of repeat.")
    count: Count = Field(description="The number of grooves, the first included.")
    step: Point2 = Field(description="From a groove to the next, [p, q] in pattern units; not zero.")

    def faults(self) -> Iterator[Fault]:
        yield from _step_faults(("step",), self.step, self.count)

    def placed(self) -> int:
        """The number of grooves made."""
        return self.count


class GridRepeat(Model):
    """Copies in a grid: copy (i, j) is moved by i * steps[0] + j * steps[1]."""

    type: Literal["grid"] = Field(description="The kind of repeat.")
    counts: Annotated[tuple[Count, Count], Array] = Field(description="The number of grooves in each direction.")
    steps: Annotated[tuple[Point2, Point2], Array] = Field(
        description="From a groove to the next in each direction, [p, q] in pattern units; not zero."
    )

    def faults(self) -> Iterator[Fault]:
        for index, (count, step) in enumerate(zip(self.counts, self.steps, strict=True)):
            yield from _step_faults(("steps", index), step, count)

    def placed(self) -> int:
        """The number of grooves made."""
        return self.counts[0] * self.counts[1]


class ConcentricRepeat(Model):
    """Circles about one centre: circle i has the radius + i * step. For circle paths alone."""

    type: Literal["concentric"] = Field(description="The kind of repeat.")
    count: Count = Field(description="The number of grooves, the first included.")
    step: Coordinate = Field(description="Added to the radius from a circle to the next, pattern units; not zero.")

    def faults(self) -> Iterator[Fault]:
        yield from _step_faults(("step",), (self.step,), self.count)

    def placed(self) -> int:
        """The number of grooves made."""
        return self.count


class ScatterRepeat(Model):
    """Random copies, the same for one seed on every machine.

    Each is the groove turned about (0, 0) by a uniformly random angle, scaled about (0, 0) as a whole (the
    cross-section with it) and moved by a uniformly random point of `bounds`.
    """

    type: Literal["scatter"] = Field(description="The kind of repeat.")
    count: Count = Field(description="The number of grooves.")
    seed: Seed = Field(description="The seed of the random numbers, a whole number.")
    bounds: Annotated[tuple[Coordinate, Coordinate, Coordinate, Coordinate], Array] = Field(
        description="Where (0, 0) may go: [p0, q0, p1, q1] in pattern units, p0 <= p1 and q0 <= q1."
    )
    angle: Annotated[tuple[Degrees, Degrees], Array] = Field(
        default=(0.0, 360.0), description="The least and the greatest angle, degrees. Default: [0, 360]."
    )
    scale: Annotated[tuple[PlacedScale, PlacedScale], Array] = Field(
        default=(1.0, 1.0), description="The least and the greatest factor, pure numbers. Default: [1, 1]."
    )

    def faults(self) -> Iterator[Fault]:
        p0, q0, p1, q1 = self.bounds
        for index, low, high in ((2, p0, p1), (3, q0, q1)):
            if high < low:
                yield Fault(("bounds", index), f"at least {low:.12g}, the lower bound", f"{high:.12g}")
        for name, (low, high) in (("angle", self.angle), ("scale", self.scale)):
            if high < low:
                yield Fault((name, 1), f"at least {low:.12g}, the lower end of the range", f"{high:.12g}")

    def placed(self) -> int:
        """The number of grooves made."""
        return self.count


Repeat = Annotated[LinearRepeat | GridRepeat | ConcentricRepeat | ScatterRepeat, Field(discriminator="type")]
