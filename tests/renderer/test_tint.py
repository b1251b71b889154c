"""Colours that change within a footprint: highlights of near lamps on gloss, bends of paths."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Json = dict[str, Any]
Plate = Callable[..., Json]
Radiance = Callable[..., NDArray[np.float64]]

HEIGHT = 0.5
# A white matt surface under it sends 1 to the eye, and elsewhere less.
LAMP = {"type": "point", "position": [0.3, 0.1, HEIGHT], "intensity": [np.pi * HEIGHT**2] * 3}
CAMERA = {"origin": [0.5, -1.2, 1.6], "target": [0.35, -0.2, 0], "fov": 24, "resolution": [48, 36]}
METAL = {"base_color": [0.8, 0.7, 0.6], "roughness": 0.3, "metallic": 1}
LACQUER = {"base_color": [0.8, 0.7, 0.6], "roughness": 0.3}
MATT = {"base_color": [0.8, 0.7, 0.6], "specular": 0}


def rows(pitch: float) -> Json:
    return {
        "path": {"type": "polyline", "points": [[-4, pitch], [6, pitch]]},
        "profile": {"type": "v", "width": pitch, "depth": 0.4 * pitch},
        "repeat": {"type": "linear", "count": round(2 / pitch) - 1, "step": [0, pitch]},
    }


def circles(pitch: float) -> Json:
    return {
        "path": {"type": "circle", "center": [1, 1], "radius": 2 * pitch},
        "profile": {"type": "v", "width": pitch, "depth": 0.4 * pitch},
        "repeat": {"type": "concentric", "count": round(0.9 / pitch), "step": pitch},
    }


def under_a_lamp(groove: Json, material: Json, plate: Plate) -> Json:
    return plate([groove], lights=[LAMP], materials={"stone": material}, camera=CAMERA)


def off_by(data: Json, radiance: Radiance, **options: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Each pixel's error in parts of white, and by what the halves of its reference differ."""
    one, two = (radiance(data, method="geometry", samples=1024, seed=seed) for seed in (1, 2))
    off = np.abs(radiance(data, **options) - 0.5 * (one + two)).mean(axis=2)
    return off, np.abs((one - two).mean(axis=2))


@pytest.mark.parametrize("material", [METAL, LACQUER, MATT])
@pytest.mark.parametrize("groove", [rows(0.1), rows(0.012), circles(0.1), circles(0.02)])
def test_highlights_of_lamps(groove: Json, material: Json, plate: Plate, radiance: Radiance) -> None:
    """Metal is up to 30 times as bright as white here, and its highlights a few pixels wide."""
    off, noise = off_by(under_a_lamp(groove, material, plate), radiance, method="auto", tolerance=0.003)
    assert np.median(noise) < 0.003
    assert np.mean(off <= 0.003 + noise) >= 0.95


@pytest.mark.parametrize("pitch", [0.1, 0.012])
def test_lines_look_at_what_is_lit(pitch: float, plate: Plate, radiance: Radiance) -> None:
    """Straight grooves have `line` for it, close and folded: nothing but colours can be wrong. The middle of what is
    seen, lit or not, once for all grooves of a footprint, was wrong by up to .8."""
    off, noise = off_by(under_a_lamp(rows(pitch), METAL, plate), radiance, method="line")
    assert np.mean(off <= 0.01 + noise) >= 0.95
    assert off.max() < 0.2


def test_bent_paths_are_left_to_areas_where_it_counts(plate: Plate, picture: Callable[..., Any]) -> None:
    """Rims of footprints along which circles run: lines take them for straight, and say what that is worth."""
    data = under_a_lamp(circles(0.02), MATT, plate)
    line, auto = picture(data, method="line"), picture(data, method="auto", tolerance=0.0002)
    told = line.aovs["error"]
    assert told.max() > 0.0002
    off = np.abs(line.radiance - auto.radiance).mean(axis=2)
    assert np.mean(off <= told + 0.0002) >= 0.95


def test_paths_that_bend_across_slanted_footprints(plate: Plate, radiance: Radiance) -> None:
    """Seen from aside a footprint's far end lies farther along the paths, where normals have turned: one colour for all
    like facets of a footprint was wrong by 0.005 in the middle of the pictures."""
    groove = circles(0.02)
    groove["path"]["radius"], groove["profile"]["depth"] = 0.15, 0.012
    camera = {"origin": [0.1, -1.9, 1.0], "target": [0, 0.02, 0], "fov": 20, "resolution": [32, 24]}
    sun = {"type": "directional", "direction": [1, 0.45, -1.5], "irradiance": [np.pi] * 3}
    data = plate([groove], lights=[sun], materials={"stone": MATT}, camera=camera)
    line, area = radiance(data, method="line", tolerance=0.0002), radiance(data, method="area", tolerance=0.0002)
    assert np.median(np.abs(line - area)) < 0.0002
