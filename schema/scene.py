"""The scene file. World space is right-handed, angles are degrees, colours linear RGB."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from .base import MAX_ENTRIES, MIN_LENGTH, Array, Degrees3, Fault, Model, Name, Point2, Point3, Seed
from .errors import pointer
from .lights import Light
from .materials import Material
from .patterns import Pattern
from .shapes import Shape

MAX_PIXELS = 33_554_432
# The sine of the least angle between the view and `up`, below which `up` no longer tells which way the image stands.
MIN_UP_SINE = 1e-6
LINES = 2  # samples of method `lines` where none are told

Side = Annotated[int, Field(ge=1, le=8192)]
MappingScale = Annotated[float, Field(ge=1e-6, le=1e6)]


class Camera(Model):
    """A pinhole camera; y of the image points down, `up` of the scene up."""

    origin: Point3 = Field(description="The pinhole, world units.")
    target: Point3 = Field(description="A point seen in the middle of the image, world units; not the origin.")
    up: Point3 = Field(
        default=(0.0, 0.0, 1.0),
        description="The direction that is up in the image, not along the view; any length but 0. Default: [0, 0, 1].",
    )
    fov: float = Field(default=40.0, ge=0.1, le=179, description="Vertical field of view, degrees. Default: 40.")
    resolution: Annotated[tuple[Side, Side], Array] = Field(
        default=(640, 480),
        description=f"[width, height] in pixels, at most {MAX_PIXELS} pixels in all. Default: [640, 480].",
    )

    def faults(self) -> Iterator[Fault]:
        width, height = self.resolution
        if width * height > MAX_PIXELS:
            yield Fault(("resolution",), f"at most {MAX_PIXELS} pixels in all", f"{width * height}")
        view = [t - o for t, o in zip(self.target, self.origin, strict=True)]
        seen, raised = math.hypot(*view), math.hypot(*self.up)
        if seen < MIN_LENGTH:
            yield Fault(("target",), "a target apart from the origin", "the origin")
        if raised < MIN_LENGTH:
            yield Fault(("up",), "a direction", "a vector of no length")
        if seen < MIN_LENGTH or raised < MIN_LENGTH:
            return
        (x, y, z), (a, b, c) = [v / seen for v in view], [u / raised for u in self.up]
        if math.hypot(y * c - z * b, z * a - x * c, x * b - y * a) < MIN_UP_SINE:
            yield Fault(("up",), "a direction across the view", "one along the view from origin to target")


class Mapping(Model):
    """From the surface's uv to the pattern's plane: (p, q) = uv * scale + offset."""

    scale: Annotated[tuple[MappingScale, MappingScale], Array] = Field(
        default=(1.0, 1.0), description="Pattern units a unit of u and of v. Default: [1, 1]."
    )
    offset: Point2 = Field(default=(0.0, 0.0), description="[p, q] at uv (0, 0), pattern units. Default: [0, 0].")


class Object(Model):
    """A shape in the world with its material and, engraved, its pattern. Seen from behind a surface is bare."""

    shape: Shape = Field(description="The bare surface.")
    translate: Point3 = Field(
        default=(0.0, 0.0, 0.0), description="Where the shape's origin goes, world units. Default: [0, 0, 0]."
    )
    rotate: Degrees3 = Field(
        default=(0.0, 0.0, 0.0),
        description="Turns about the fixed x, then y, then z axis, degrees, before it is moved. Default: [0, 0, 0].",
    )
    mapping: Mapping = Field(default=Mapping(), description="From uv to the pattern's plane. Default: (p, q) = uv.")
    material: Name = Field(description="The name of one of the scene's materials.")
    pattern: Name | None = Field(
        default=None, description="The name of one of the scene's patterns. Default: null, a bare surface."
    )


class Render(Model):
    """How to render."""

    method: Literal["auto", "base", "segment", "line", "lines", "area", "csg", "geometry", "relief"] = Field(
        default="auto",
        description="auto takes the cheapest that keeps within `tolerance`; base leaves the grooves out; lines looks "
        "along `samples` lines across a pixel, area at all of it; geometry meshes the grooves; relief marches rays "
        "through a texture of their heights. Default: auto.",
    )
    samples: int = Field(
        default=256,
        ge=1,
        le=65_536,
        description="Samples a pixel of a method that samples, evenly spread; auto takes what its tolerance asks for, "
        "at most these where `bounces` are followed. Default: 256; 2 of method lines.",
    )
    texels: int = Field(
        default=1024,
        ge=16,
        le=8192,
        description="Texels along the longer side of method relief's texture: of a surface, with a margin, or of one "
        "tile. Default: 1024.",
    )
    bounces: int = Field(
        default=0,
        ge=0,
        le=16,
        description="How often light is followed on, from facet to facet and from object to object, by whatever "
        "they are made of. Where the last of these rays ends, a surface is lit by the lights and by all of the sky; "
        "so 0 is direct light, under a sky that nothing hides. Default: 0.",
    )
    tolerance: float = Field(
        default=0.002,
        ge=1e-5,
        le=1,
        description="The error that auto keeps within, of a pixel's radiance (mean of the channels), relative to a "
        "white matt surface turned to each light of the scene. On curved shapes every method but geometry splits "
        "pixels over which the surface turns by more than it allows. Default: 0.002.",
    )
    exposure: float = Field(
        default=1.0, ge=1e-6, le=1e6, description="Factor on the radiance in PNG files, a pure number. Default: 1."
    )
    seed: Seed = Field(default=0, description="The seed of all random samples, a whole number. Default: 0.")

    def samples_of(self, method: str) -> int:
        """How many samples a method takes."""
        return LINES if method == "lines" and "samples" not in self.model_fields_set else self.samples


class Scene(Model):
    """A whole scene of grooved surfaces."""

    # Not Literal[1], which would take true and 1.0.
    intaglio: int = Field(ge=1, le=1, description="The version of the format, 1.")
    camera: Camera = Field(description="The camera.")
    lights: Annotated[tuple[Light, ...], Array] = Field(
        default=(), max_length=MAX_ENTRIES, description="The lights; may be empty. Default: []."
    )
    materials: dict[Name, Material] = Field(max_length=MAX_ENTRIES, description="The materials by name.")
    patterns: dict[Name, Pattern] = Field(
        default={}, max_length=MAX_ENTRIES, description="The patterns by name. Default: {}."
    )
    objects: Annotated[tuple[Object, ...], Array] = Field(
        min_length=1, max_length=MAX_ENTRIES, description="The objects, at least one."
    )
    render: Render = Field(default=Render(), description="How to render.")

    def faults(self) -> Iterator[Fault]:
        pictures = [index for index, light in enumerate(self.lights) if light.type == "envmap"]
        if len(pictures) > 1:
            yield Fault(("lights", pictures[1]), "one envmap at most", "a second one")


def files(scene: Scene) -> Iterator[tuple[str, str]]:
    """The files that a scene names, meshes and envmaps: where it does, as a JSON pointer, and their names."""
    for index, item in enumerate(scene.objects):
        if item.shape.type == "mesh":
            yield pointer("objects", index, "shape", "file"), item.shape.file
    for index, light in enumerate(scene.lights):
        if light.type == "envmap":
            yield pointer("lights", index, "file"), light.file
