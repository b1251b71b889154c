"""Outlines: grooves cut notches into those of spheres and cylinders, and ridges stand over them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Json = dict[str, Any]
Floats = NDArray[np.float64]
Radiance = Callable[..., Floats]

EYES = {"side": [1, -6, 0.3], "above": [0.6, -4.2, 3.4], "axis": [0.1, -0.2, 7]}
RIDGE = {"type": "v", "width": 0.12, "depth": -0.12}


def drum(radius: float, band: float, eye: str, **parts: Any) -> Json:
    """A cylinder of the height 2 whose side is raised by `band` as a whole; a unit of height is a unit of length."""
    points = [[-3, 0], [-3, band], [3, band], [3, 0]]
    groove = {
        "path": {"type": "polyline", "points": [[-9, 0], [19, 0]]},
        "profile": {"type": "polyline", "points": points},
    }
    shape = {"type": "cylinder", "radius": radius, "height": 2}
    around = 2 * np.pi * radius
    return scene(shape, [groove] if band else [], [around, 2], eye, **parts)


def scene(shape: Json, grooves: list[Json], scale: list[float], eye: str, **parts: Any) -> Json:
    return {
        "intaglio": 1,
        "camera": {"origin": EYES[eye], "target": [0, 0, 0], "up": [0, 0.1, 1], "fov": 32, "resolution": [40, 32]},
        "lights": [
            {"type": "directional", "direction": [1, 1, -0.8], "irradiance": [2, 2, 2]},
            {"type": "constant", "radiance": [0.3, 0.2, 0.1]},
        ],
        "materials": {"stone": {"base_color": [0.7, 0.6, 0.5], "specular": 0}},
        "patterns": {"cut": {"grooves": grooves}} if grooves else {},
        "objects": [
            {"shape": shape, "mapping": {"scale": scale}, "material": "stone", "pattern": "cut" if grooves else None}
        ],
    } | parts


@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize("band", [0.2, -0.2])
@pytest.mark.parametrize("method", ["csg", "auto"])
def test_a_side_that_is_raised_or_sunk_as_a_whole(method: str, band: float, eye: str, radiance: Radiance) -> None:
    """It is that of a thicker or a thinner cylinder, at its rims and ends, too; but for what `auto` leaves amid it."""
    found = radiance(drum(1.0, band, eye), method=method, samples=1024)
    expected = radiance(drum(1.0 + band, 0.0, eye), method="auto")
    assert np.abs(found - radiance(drum(1.0, 0.0, eye), method="auto")).mean() > 0.005  # it is another picture
    assert np.abs(found - expected).max() <= 0.02
    assert np.abs(found - expected).mean() <= 0.0006


@pytest.mark.parametrize("eye", ["side", "above"])
def test_what_stands_behind_is_seen_by_the_ridges(eye: str, radiance: Radiance) -> None:
    """A wall behind the cylinder shows where it is not hidden."""
    wall = {"shape": {"type": "rectangle", "size": [20, 20]}, "translate": [0, 4, 0], "rotate": [90, 0, 0]}
    pictures = []
    for radius, band in ((1.0, 0.2), (1.2, 0.0)):
        data = drum(radius, band, eye, lights=[{"type": "constant", "radiance": [0.3, 0.2, 0.1]}])
        data["objects"].append(wall | {"material": "wall"})
        data["materials"]["wall"] = {"base_color": [0, 0.9, 0], "specular": 0}
        pictures.append(radiance(data, method="auto", samples=256))
    assert np.abs(pictures[0] - pictures[1]).mean() <= 0.002


@pytest.mark.parametrize("shape", ["sphere", "cylinder"])
@pytest.mark.parametrize("method", ["auto", "csg"])
def test_ridges_and_notches_are_those_of_the_geometry(method: str, shape: str, radiance: Radiance) -> None:
    lines = [{"path": {"type": "polyline", "points": [[0.1, -1], [0.1, 5]]}, "profile": RIDGE,
              "repeat": {"type": "linear", "count": 21, "step": [0.6, 0]}},
             {"path": {"type": "polyline", "points": [[-1, 0.4], [14, 0.4]]},
              "profile": {"type": "trapezoid", "width": 0.2, "floor": 0.1, "depth": 0.1},
              "repeat": {"type": "linear", "count": 5, "step": [0, 0.8]}}]  # fmt: skip
    base: Json = {"sphere": {"type": "sphere", "radius": 1}, "cylinder": {"type": "cylinder", "radius": 1, "height": 2}}
    data = scene(base[shape], lines, [4 * np.pi, 4], "above", render={"tolerance": 0.002})
    truth = radiance(data, method="geometry", samples=1024)
    found = radiance(data, method=method, samples=1024)
    assert np.abs(found - truth).mean() <= 0.002
    assert np.abs(found - truth).max() <= 0.05
