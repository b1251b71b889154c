"""Materials, after glTF 2.0."""

from pydantic import Field

from .base import Color, Model, Rgb, Unit


class Material(Model):
    """A mix of metal and dielectric by `metallic`.

    Dielectric: mix(base_color / pi, GGX, F) with Schlick's Fresnel F, F0 = specular * ((ior - 1) / (ior + 1))^2 and
    F90 = specular. Metal: GGX with F0 = base_color, F90 = 1. GGX has the height-correlated Smith term and
    alpha = roughness^2. `specular: 0, roughness: 1` is pure Lambert, base_color / pi. `roughness: 0` is an ideal
    mirror or refractor, seen by bounces alone; any other below 0.001 counts as 0.001.

    With `transmission` a surface is where a body of `ior` meets the air: light goes into it and out of it, a bounce
    each, times `base_color`, and is reflected totally from within beyond the critical angle. A sphere, a cylinder or a
    closed mesh is solid; a rectangle bounds all that is behind it, and two back to back are a pane. The sky, envmaps
    and other objects are seen through it; lights that are points or directions are not, for which it casts a shadow as
    any other. From within, its surface shows no light that meets it, only what it emits.
    """

    base_color: Color = Field(default=(1.0, 1.0, 1.0), description="Linear RGB, 0 to 1 each. Default: [1, 1, 1].")
    metallic: Unit = Field(default=0.0, description="0: dielectric, 1: metal. Default: 0.")
    roughness: Unit = Field(default=1.0, description="0: ideal mirror, 1: roughest; alpha is its square. Default: 1.")
    specular: Unit = Field(default=1.0, description="Strength of the dielectric's coat; 0 turns it off. Default: 1.")
    ior: float = Field(default=1.5, gt=1, le=4, description="Index of refraction of the body, above 1. Default: 1.5.")
    transmission: Unit = Field(
        default=0.0,
        description="The share of the dielectric's diffuse light that is refracted instead, which bounces alone show. "
        "Default: 0.",
    )
    emissive: Rgb = Field(
        default=(0.0, 0.0, 0.0), description="Emitted radiance, linear RGB, W/(m^2 sr). Default: [0, 0, 0]."
    )
