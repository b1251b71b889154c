"""Lights, after Mitsuba. All powers are linear RGB."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from .base import MIN_LENGTH, Degrees, Fault, FileName, Model, Point3, Radiometric, Rgb


class DirectionalLight(Model):
    """Parallel light from infinitely far."""

    type: Literal["directional"] = Field(description="The kind of light.")
    direction: Point3 = Field(description="The way the light travels, world axes; any length but 0.")
    irradiance: Rgb = Field(description="Irradiance on a surface at right angles to the light, W/m^2.")

    def faults(self) -> Iterator[Fault]:
        if max(map(abs, self.direction)) < MIN_LENGTH:
            yield Fault(("direction",), "a direction", "a vector of no length")


class PointLight(Model):
    """Light from one point, the same in all directions."""

    type: Literal["point"] = Field(description="The kind of light.")
    position: Point3 = Field(description="Where it is, world units.")
    intensity: Rgb = Field(description="Radiant intensity, W/sr: the irradiance at distance 1.")


class ConstantLight(Model):
    """A sky of one radiance all around."""

    type: Literal["constant"] = Field(description="The kind of light.")
    radiance: Rgb = Field(description="Radiance from every direction, W/(m^2 sr).")


class EnvmapLight(Model):
    """A sky from an equirectangular picture."""

    type: Literal["envmap"] = Field(description="The kind of light.")
    file: FileName = Field(description="An EXR, HDR or PNG file, relative to the scene file.")
    scale: Radiometric = Field(default=1.0, description="Factor on the picture's radiance, a pure number. Default: 1.")
    rotate: Degrees = Field(default=0.0, description="Turn about the world's z axis, degrees. Default: 0.")


Light = Annotated[DirectionalLight | PointLight | ConstantLight | EnvmapLight, Field(discriminator="type")]
