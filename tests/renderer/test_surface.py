"""World points on surfaces: where they land in the pattern's plane, and that a path drawn so is the same groove."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer.compile.scene import place
from renderer.meshfile import TriangleSoup
from renderer.surface import Surface
from renderer.tables import OBJECT

Json = dict[str, Any]


def surface(shape: Json, soup: TriangleSoup | None = None, **more: Any) -> Surface:
    scene = schema.check(
        {
            "intaglio": 1,
            "camera": {"origin": [0, 0, 9], "target": [0, 0.1, 0]},
            "materials": {"m": {}},
            "objects": [{"shape": shape, "material": "m", **more}],
        }
    ).scene
    assert scene is not None
    row = np.zeros(1, OBJECT)[0]
    place(row, scene.objects[0])
    return Surface(row, soup)


def test_rectangle() -> None:
    """A 4 x 2 rectangle moved by (1, 0, 0) and turned by 90 degrees about x: its y axis is the world's z."""
    on = surface({"type": "rectangle", "size": [4, 2]}, rotate=[90, 0, 0], translate=[1, 0, 0])
    # its middle; its lower left corner, from 5 before it
    assert on.project([(1, 0, 0), (-1, -5, -1)]) == [pytest.approx((0.5, 0.5)), pytest.approx((0, 0), abs=1e-12)]


def test_sphere_and_mapping() -> None:
    """Along the radius: longitude 90 degrees is u = 1/4, latitude 30 degrees v = 2/3; then times scale, plus offset."""
    on = surface({"type": "sphere", "radius": 1}, mapping={"scale": [8, 3], "offset": [1, -1]})
    (found,) = on.project([(0, 7 * math.cos(math.pi / 6), 7 * math.sin(math.pi / 6))])
    assert found == pytest.approx((8 / 4 + 1, 3 * 2 / 3 - 1))


def test_a_path_over_the_seam_stays_in_one_piece() -> None:
    on = surface({"type": "cylinder", "radius": 1, "height": 2})
    turns = np.radians([340, 355, 370, 385])
    u = [p for p, _ in on.project([(math.cos(t), math.sin(t), 0) for t in turns])]
    assert u == pytest.approx([340 / 360, 355 / 360, 370 / 360, 385 / 360])


def test_mesh() -> None:
    """The nearest point of a triangle whose uv are its x and y halved."""
    corners = np.array([[[0, 0, 0], [2, 0, 0], [0, 2, 0]]], float)
    soup = TriangleSoup(corners, corners[:, :, :2] / 2, np.tile([0.0, 0.0, 1.0], (1, 3, 1)))
    on = surface({"type": "mesh", "file": "t.obj"}, soup)
    # above the inside; beyond the long side, whose middle is (1, 1)
    assert on.project([(0.5, 0.25, 3), (5, 5, 0)]) == [pytest.approx((0.25, 0.125)), pytest.approx((0.5, 0.5))]


def test_a_path_in_world_space_is_the_same_groove(
    plate: Callable[..., Json], radiance: Callable[..., NDArray[np.float32]]
) -> None:
    """The plate is 2 x 2 about the origin, with pattern coordinates 0 to 1 from its lower left corner."""
    profile = {"type": "v", "width": 0.2, "depth": 0.1}
    flat = {"path": {"type": "polyline", "points": [[0.1, 0.2], [0.9, 0.6]]}, "profile": profile}
    world = {
        "path": {"type": "polyline", "points": [[-0.8, -0.6, 1], [0.8, 0.2, -3]], "space": "world"}, "profile": profile
    }  # fmt: skip
    one, other = (
        radiance(plate([groove], mapping={"scale": [1, 1]}), method="line", resolution=(24, 18))
        for groove in (flat, world)
    )
    assert np.ptp(one) > 0.1
    assert np.abs(one - other).max() < 1e-6
