"""What all models share: strictness, bounds, and checks of meaning that keep their place in the file."""

from collections.abc import Iterator
from typing import Annotated, NamedTuple, Self

from pydantic import BaseModel, ConfigDict, Field, Strict, model_validator
from pydantic_core import PydanticCustomError

MAX_COORDINATE = 1e6
MIN_LENGTH = 1e-9
MAX_LENGTH = 1e6
MAX_POINTS = 100_000
MAX_SEED = 2**32 - 1

Coordinate = Annotated[float, Field(ge=-MAX_COORDINATE, le=MAX_COORDINATE)]
Length = Annotated[float, Field(ge=MIN_LENGTH, le=MAX_LENGTH)]
LengthOrZero = Annotated[float, Field(ge=0, le=MAX_LENGTH)]
Degrees = Annotated[float, Field(ge=-36_000, le=36_000)]
Unit = Annotated[float, Field(ge=0, le=1)]
Radiometric = Annotated[float, Field(ge=0, le=1e6)]
Factor = Annotated[float, Field(ge=0, le=1000)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]
Seed = Annotated[int, Field(ge=0, le=MAX_SEED)]
Name = Annotated[str, Field(min_length=1, max_length=64)]
FileName = Annotated[str, Field(min_length=1, max_length=4096)]

# A JSON array arrives as a list, which a strict tuple refuses. Strict(False) opens the array alone: the
# numbers inside stay strict.
Array = Strict(False)
Point2 = Annotated[tuple[Coordinate, Coordinate], Array]
Point3 = Annotated[tuple[Coordinate, Coordinate, Coordinate], Array]
Degrees3 = Annotated[tuple[Degrees, Degrees, Degrees], Array]
Color = Annotated[tuple[Unit, Unit, Unit], Array]
Rgb = Annotated[tuple[Radiometric, Radiometric, Radiometric], Array]
Size2 = Annotated[tuple[Length, Length], Array]


class Fault(NamedTuple):
    """A value of the right type that makes no sense, `at` a place below the model that found it."""

    at: tuple[str | int, ...]
    expected: str
    found: str


class Model(BaseModel):
    """A strict, closed, immutable record. NaN and infinities are refused everywhere."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)

    def faults(self) -> Iterator[Fault]:
        """What is wrong with the record though every field has the right type and is in bounds."""
        return iter(())

    @model_validator(mode="after")
    def _means_something(self) -> Self:
        faults = tuple(self.faults())
        if faults:
            text = "; ".join(f"expected {fault.expected}, found {fault.found}" for fault in faults)
            raise PydanticCustomError("meaning", "{text}", {"text": text, "faults": faults})
        return self
