"""Shapes: the bare surfaces that carry patterns, centred in their own frame."""

from typing import Annotated, Literal

from pydantic import Field

from .base import FileName, Length, Model, Size2


class Rectangle(Model):
    """In the xy plane, centred, normal +z; uv (0, 0) at its lower left, (1, 1) at its upper right.

    A window on an engraved plane: what lies under its edge, or shades it from outside, is the pattern gone on.
    """

    type: Literal["rectangle"] = Field(description="The kind of shape.")
    size: Size2 = Field(description="[width, height] along x and y, world units.")


class Sphere(Model):
    """Centred; u = longitude / 360 degrees from +x towards +y, v from 0 at the -z pole to 1 at the +z pole.

    The pattern ends at u = 0 and 1, unless it tiles: a groove on the seam is drawn on both sides. Heights go along the
    radius, by a unit that vanishes at the poles.
    """

    type: Literal["sphere"] = Field(description="The kind of shape.")
    radius: Length = Field(description="The radius, world units.")


class Cylinder(Model):
    """About the z axis, centred, closed by two bare caps that carry no pattern.

    Grooves run out at the caps, ridges end flat there.
    u = angle / 360 degrees, counter-clockwise from +x seen from +z; v from 0 at the bottom to 1 at the top. The
    pattern ends at u = 0 and 1, unless it tiles.
    """

    type: Literal["cylinder"] = Field(description="The kind of shape.")
    radius: Length = Field(description="The radius, world units.")
    height: Length = Field(description="The height along z, world units.")


class Mesh(Model):
    """Triangles from a file, with its own uv. Smooth where the file has normals, else with flat facets.

    Heights go along the smooth normals. Their unit is each triangle's own; where the grooves are meshed, which must not
    tear at the edges, the mean of those that meet at a corner.
    """

    type: Literal["mesh"] = Field(description="The kind of shape.")
    file: FileName = Field(description="An OBJ, PLY or GLB file with uv, relative to the scene file.")


Shape = Annotated[Rectangle | Sphere | Cylinder | Mesh, Field(discriminator="type")]
