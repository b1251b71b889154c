"""What all models share: strictness, bounds, and checks of meaning that keep their place in the file."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    Strict,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic_core import PydanticCustomError

MAX_COORDINATE = 1e6
MIN_LENGTH = 1e-9
MAX_LENGTH = 1e6
MAX_POINTS = 100_000
MAX_ENTRIES = 1000
MAX_INNER = 16  # an array in an array is a point
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


class TooManyErrors(Exception):
    """Stops a validation. No ValueError, which pydantic would collect as one error more."""


@dataclass(slots=True)
class ErrorBudget:
    """The validation's context: a file of rubbish must not cost gigabytes of error details."""

    left: int

    def spend(self, count: int) -> None:
        """Counts errors; about, as each record that holds the record counts them again."""
        self.left -= count
        if self.left < 0:
            raise TooManyErrors


def _failed(faults: tuple[Fault, ...]) -> PydanticCustomError:
    text = "; ".join(f"expected {fault.expected}, found {fault.found}" for fault in faults)
    return PydanticCustomError("meaning", "{text}", {"text": text, "faults": faults})


def _oversized(data: dict[Any, Any]) -> Iterator[Fault]:
    """Arrays far beyond what any field takes. Pydantic would look at every item before it tells of the length."""
    if len(data) > MAX_ENTRIES:
        yield Fault((), f"an object of at most {MAX_ENTRIES} keys", f"{len(data)}")
    for key, value in data.items():
        if isinstance(value, dict) and len(value) > MAX_ENTRIES:
            yield Fault((key,), f"an object of at most {MAX_ENTRIES} keys", f"{len(value)}")
        if not isinstance(value, list | tuple):
            continue
        if len(value) > MAX_POINTS:
            yield Fault((key,), f"an array of at most {MAX_POINTS}", f"{len(value)}")
            continue
        for index, item in enumerate(value):
            if isinstance(item, list) and len(item) > MAX_INNER:
                yield Fault((key, index), f"an array of at most {MAX_INNER}", f"{len(item)}")


class Model(BaseModel):
    """A strict, closed, immutable record. NaN and infinities are refused everywhere."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)

    def faults(self) -> Iterator[Fault]:
        """What is wrong with the record though every field has the right type and is in bounds."""
        return iter(())

    @model_validator(mode="wrap")
    @classmethod
    def _checked(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        if isinstance(data, dict):
            oversized = tuple(_oversized(data))
            if oversized:
                raise _failed(oversized)
        try:
            record = handler(data)
        except ValidationError as error:
            if isinstance(info.context, ErrorBudget):
                info.context.spend(error.error_count())
            raise
        faults = tuple(record.faults())
        if faults:
            raise _failed(faults)
        return record
