"""Patterns: grooves on the texture plane (p, q, w)."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from .base import Array, Fault, Model, Name, Size2
from .paths import CirclePath, Path
from .profiles import MAX_FACETS, Profile
from .repeats import ConcentricRepeat, Repeat
from .scales import ConstantScale, Scale

MAX_GROOVES = 10_000
MAX_PLACED = 1_000_000
MAX_PIECES = 10_000_000


def _material_kind(value: Any) -> str | None:
    """The JSON type of a groove's material, which is also the tag of the union."""
    if isinstance(value, str):
        return "string"
    return "array" if isinstance(value, list | tuple) else None


FacetMaterials = Annotated[tuple[Name | None, ...], Array, Field(min_length=1, max_length=MAX_FACETS)]
GrooveMaterial = Annotated[
    Annotated[Name, Tag("string")] | Annotated[FacetMaterials, Tag("array")], Discriminator(_material_kind)
]


class Groove(Model):
    """A cross-section swept along a path."""

    path: Path = Field(description="Where the groove runs.")
    profile: Profile = Field(description="Its cross-section.")
    scale: Scale = Field(
        default=ConstantScale(type="constant"),
        description="The factor on the whole cross-section along the path. Default: constant 1.",
    )
    material: GrooveMaterial | None = Field(
        default=None,
        description="The material of its facets: null (the object's), a name, or a list with one name or null a "
        "facet, from left (the least b) to right. Default: null.",
    )
    priority: int = Field(
        default=0, ge=-1000, le=1000, description="A groove of a higher priority predominates. Default: 0."
    )
    ends: Literal["profile", "flat"] = Field(
        default="profile",
        description="How an open path ends: closed with the right half of the groove's profile (b > 0), or cut "
        "square at the end point. A wall that no facet makes is of the object's material. "
        "Default: profile.",
    )
    repeat: Repeat | None = Field(default=None, description="Copies of the groove. Default: null, just the one.")

    def faults(self) -> Iterator[Fault]:
        facets = len(self.profile.polyline()) - 1
        if isinstance(self.material, tuple) and len(self.material) != facets:
            yield Fault(("material",), f"{facets} materials, one a facet", f"{len(self.material)}")
        if isinstance(self.repeat, ConcentricRepeat):
            if not isinstance(self.path, CirclePath):
                yield Fault(
                    ("repeat", "type"), "a repeat other than concentric, as the path is no circle", '"concentric"'
                )
                return
            last = self.path.radius + (self.repeat.count - 1) * self.repeat.step
            if last <= 0:
                yield Fault(("repeat", "step"), "circles with radii above 0", f"a last radius of {last:g}")

    def placed(self) -> int:
        """The number of grooves that this one makes."""
        return 1 if self.repeat is None else self.repeat.placed()

    def half_width(self) -> float:
        """How far the groove reaches from its path where it is widest, pattern units."""
        return max(abs(b) for b, _ in self.profile.polyline()) * self.scale.largest()


class Pattern(Model):
    """A set of grooves, drawn once or tiled over the plane."""

    tile: Size2 | None = Field(
        default=None,
        description="[width, height] in pattern units after which the pattern repeats for ever. Default: null, once.",
    )
    grooves: Annotated[tuple[Groove, ...], Array] = Field(
        min_length=1, max_length=MAX_GROOVES, description="The grooves, in any order."
    )

    def faults(self) -> Iterator[Fault]:
        placed = sum(groove.placed() for groove in self.grooves)
        if placed > MAX_PLACED:
            yield Fault(("grooves",), f"at most {MAX_PLACED} grooves with all repeats", f"{placed}")
        pieces = sum(groove.placed() * groove.path.pieces() for groove in self.grooves)
        if pieces > MAX_PIECES:
            yield Fault(("grooves",), f"at most {MAX_PIECES} lines and curves with all repeats", f"{pieces}")
