"""What the tests of exported solids share: cross-sections, and that a solid is closed."""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
import trimesh

from renderer.export import Body, unpaired

from .scenes import Json

TURN = 2.0 * math.pi
ROUNDING = 2.0**-23  # how far single precision moves a point whose coordinates are below 2

V = {"type": "v", "width": 0.3, "depth": 0.1}
RIDGE = {"type": "v", "width": 0.3, "depth": -0.1}
BOX = {"type": "trapezoid", "width": 0.2, "floor": 0.2, "depth": 0.15}
TOWER = {"type": "trapezoid", "width": 0.5, "floor": 0.5, "depth": -0.1}


def groove(points: list[list[float]], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": points}, "profile": profile, **more}


def tracer(solid: Body) -> trimesh.Trimesh:
    return trimesh.Trimesh(solid.vertices.astype(np.float64), solid.triangles, process=False)


def assert_closed(solid: Body) -> trimesh.Trimesh:
    """It is one closed body, as a reader of its file finds it too; what that reads."""
    assert not len(unpaired(solid.triangles))
    assert len(np.unique(solid.vertices, axis=0)) == len(solid.vertices)
    read = trimesh.load(io.BytesIO(tracer(solid).export(file_type="stl")), file_type="stl")  # single points, merged
    assert isinstance(read, trimesh.Trimesh)
    assert len(read.faces) == len(solid.triangles)
    assert read.is_watertight
    assert read.is_winding_consistent
    assert read.body_count == 1
    return read
