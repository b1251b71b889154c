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
    """A sky from an equirectangular picture, one in a scene at most.

    Rows go from the zenith (+z) down to -z, columns to the right for one who looks around from inside: the left edge is
    in the direction +y, the first quarter +x, the middle -y, the third quarter -x. So it is Mitsuba's envmap, turned as
    all that is y up there and z up here: (x, y, z) there is (x, -z, y) here. Values between the middles of texels are
    bilinear.
    """

    type: Literal["envmap"] = Field(description="The kind of light.")
    file: FileName = Field(
        description="An EXR, HDR or PNG file, relative to the scene file: linear radiance, W/(m^2 sr), but PNG, which "
        "is sRGB. Its first row is the zenith, its middle lies in the direction -y, its left edge +y, its first "
        "quarter +x. Small suns become directional lights."
    )
    scale: Radiometric = Field(default=1.0, description="Factor on the picture's radiance, a pure number. Default: 1.")
    rotate: Degrees = Field(
        default=0.0,
        description="Turn about the world's z axis, degrees, counterclockwise as seen from above. Default: 0.",
    )


Light = Annotated[DirectionalLight | PointLight | ConstantLight | EnvmapLight, Field(discriminator="type")]
