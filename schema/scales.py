"""Scales: the factor on the whole cross-section along a path, by its arc length t from 0 to 1."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from .base import Array, Degrees, Factor, Fault, Model, Unit

MAX_TABLE = 10_000


class ConstantScale(Model):
    """The same factor everywhere."""

    type: Literal["constant"] = Field(description="The kind of scale.")
    value: Factor = Field(default=1.0, description="The factor, a pure number. Default: 1.")

    def largest(self) -> float:
        """The largest factor along the path."""
        return self.value


class LinearScale(Model):
    """From one factor to another."""

    type: Literal["linear"] = Field(description="The kind of scale.")
    start: Factor = Field(description="The factor at t = 0, a pure number.")
    end: Factor = Field(description="The factor at t = 1, a pure number.")

    def largest(self) -> float:
        """The largest factor along the path."""
        return max(self.start, self.end)


class SineScale(Model):
    """1 + amplitude * sin(2 pi periods t + phase)."""

    type: Literal["sine"] = Field(description="The kind of scale.")
    amplitude: Unit = Field(description="The amplitude, a pure number.")
    periods: float = Field(ge=0, le=10_000, description="The number of periods along the whole path.")
    phase: Degrees = Field(default=0.0, description="The phase at t = 0, degrees. Default: 0.")

    def largest(self) -> float:
        """A bound of the factor along the path."""
        return 1 + self.amplitude


class TableScale(Model):
    """Values at given places, linear in between."""

    type: Literal["table"] = Field(description="The kind of scale.")
    t: Annotated[tuple[Unit, ...], Array] = Field(
        min_length=2, max_length=MAX_TABLE, description="Places along the path: ascending, from 0 to 1."
    )
    values: Annotated[tuple[Factor, ...], Array] = Field(
        min_length=2, max_length=MAX_TABLE, description="The factor at each place, a pure number; as many as `t`."
    )

    def faults(self) -> Iterator[Fault]:
        for index, wanted in ((0, 0), (len(self.t) - 1, 1)):
            if self.t[index] != wanted:
                yield Fault(("t", index), f"{wanted}, as the table spans the path", f"{self.t[index]:.12g}")
        for index in range(1, len(self.t)):
            if not self.t[index] > self.t[index - 1]:
                yield Fault(("t", index), f"a place after {self.t[index - 1]:.12g}", f"{self.t[index]:.12g}")
        if len(self.values) != len(self.t):
            yield Fault(("values",), f"{len(self.t)} values, one for each t", f"{len(self.values)}")

    def largest(self) -> float:
        """The largest factor along the path."""
        return max(self.values)


Scale = Annotated[ConstantScale | LinearScale | SineScale | TableScale, Field(discriminator="type")]
