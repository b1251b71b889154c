"""Method `lines`: two line samples against their closed form, many against `area`, which is exact."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import schema
from renderer import pipeline

from .scenes import BOX, DITCH, PALETTE, RIDGE, SINGLE, SKEW, Floats, Json, family, line, rms

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

SUNS: list[Json] = [
    {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]},
    {"type": "directional", "direction": [-0.6, 1, -0.7], "irradiance": [0.5, 0.8, 1.0]},
]
BLACK = {"base_color": [0, 0, 0], "specular": 0}
FEATURES = {
    "crossing": [family(DITCH, 0.61, 3), line([-1, 0.9], [3, 1.2])],
    "ends": [line([0.4, 0.5], [1.3, 1.2]), line([0.3, 1.5], [1.1, 1.4], profile=BOX, ends="flat")],
    "corners": [line([0.4, 0.3], [1.2, 1.5], [1.6, 0.5])],
    "ridges": [family(RIDGE, 0.5, 4), line([-1, 1.0], [3, 0.8], profile=RIDGE)],
}


def lamp_beyond(angle: float, plate: Plate) -> tuple[Json, Floats, Floats]:
    """A plate seen from straight above that shines on one side of a straight edge, and the edge as pixels see it.

    The unit normal (2,) of the edge on the screen, towards the light, and the distance of each pixel's centre, pixels.
    """
    far, away, width, height = 3.0, 0.0137, 48, 36
    normal = np.array([math.cos(angle), math.sin(angle)])
    middle, along = (away + 1.0) * normal + 1.0, 9.0 * np.array([-normal[1], normal[0]])
    profile = {"type": "trapezoid", "width": 2.0, "floor": 2.0, "depth": 1e-9}
    groove = {
        "path": {"type": "polyline", "points": [(middle - along).tolist(), (middle + along).tolist()]},
        "profile": profile,
        "material": "lamp",
    }
    scene = plate(
        [groove], lights=[], materials={"stone": BLACK, "lamp": BLACK | {"emissive": [1, 1, 1]}},
        camera={"origin": [0, 0, far], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 10, "resolution": [width, height]},
    )  # fmt: skip
    pixel = 2.0 * far * math.tan(math.radians(5.0)) / height
    x, y = np.meshgrid(np.arange(width) + 0.5 - 0.5 * width, 0.5 * height - 0.5 - np.arange(height))
    return scene, normal * [1.0, -1.0], x * normal[0] + y * normal[1] - away / pixel


ANGLES = [0, 3, 20, 45, 60, 88, 90, 135]


@pytest.mark.parametrize("angle", ANGLES)
def test_two_lines_at_an_edge(angle: float, plate: Plate, radiance: Radiance) -> None:
    """Each line through the middle shows what of it is beyond the edge; sin^2 weighs those that the edge crosses."""
    scene, (a, b), distance = lamp_beyond(math.radians(angle), plate)
    one, other = (np.clip(0.5 + distance / max(abs(n), 1e-300), 0.0, 1.0) for n in (a, b))
    wa, wb = (np.where(np.abs(distance) < 0.5 * abs(n), n * n, 0.0) for n in (a, b))
    none = wa + wb == 0.0
    expected = np.where(none, 0.5 * (one + other), (wa * one + wb * other) / np.where(none, 1.0, wa + wb))
    found = radiance(scene, method="lines", samples=2)[..., 0]
    assert 0.0 < found.mean() < 1.0
    assert np.abs(found - expected).max() < SINGLE


@pytest.mark.parametrize("angle", ANGLES)
def test_two_lines_against_the_area(angle: float, plate: Plate, radiance: Radiance) -> None:
    """With the edge's unit normal (a, b), a >= b >= 0, its distance m from the middle, h and v the lines' shares:

    - m <= (a - b) / 2: the area is 1/2 + m / a = h. Where the edge meets the other line too, m < b / 2, the mean is
      1/2 + m (a + b), wrong by m b (a - b) / a <= b^2 (a - b) / (2 a) or, by m <= (a - b) / 2, less.
    - Beyond, the area is 1 less a corner's triangle, (a + b - 2 m)^2 / (8 a b). Both lines, m < b / 2: the error grows
      with m, to b (a + b) / 2 - 1/2 + a / (8 b) at b / 2, which is greatest at a = b: 1/8. One: h is 1 at m = a / 2,
      the error is b / (8 a) there. None: the triangle itself, less still.

    So it is at most 1/8, and none where a line lies along the edge.
    """
    scene, (a, b), distance = lamp_beyond(math.radians(angle), plate)
    off = np.abs(radiance(scene, method="lines", samples=2) - radiance(scene, method="area"))[..., 0]
    assert off.max() <= 0.125 + SINGLE
    a, b = max(abs(a), abs(b)), min(abs(a), abs(b))
    exact = (np.abs(distance) <= 0.5 * (a - b)) & (np.abs(distance) >= 0.5 * b)
    assert off[exact].max(initial=0.0) < SINGLE
    if b < 1e-9:
        assert off.max() < SINGLE


@pytest.mark.parametrize("name", FEATURES)
def test_many_lines_come_to_the_area(name: str, plate: Plate, picture: Callable[..., pipeline.Picture]) -> None:
    """The error falls at least as one over the number of lines: a step from line to line is off by a part of one.

    Lights are distant and surfaces matt, so that colours are the same all over a face and `area` exact.
    """
    scene = plate(FEATURES[name], lights=SUNS, materials={"stone": PALETTE["stone"]})
    exact = picture(scene, method="area")
    assert exact.shares == pytest.approx({"area": 1.0})
    truth = exact.radiance.astype(np.float64)
    errors = []
    for count in (2, 8, 32, 128):
        found = picture(scene, method="lines", samples=count)
        assert found.shares == pytest.approx({"lines": 1.0})
        errors.append(rms(found.radiance - truth))
    assert errors[0] < 0.1 * truth.std()
    assert errors[2] < errors[1] / 4.0
    assert errors[3] < errors[1] / 16.0


@pytest.mark.parametrize("count", [1, 2, 7])
def test_flat_facets_are_exact(count: int, plate: Plate, radiance: Radiance) -> None:
    """A pixel that sees one facet alone has its colour: each line has it from end to end."""
    materials = {"stone": BLACK, "lamp": BLACK | {"emissive": [1, 0.5, 2]}}
    scene = plate([family(SKEW, 0.5, 4, material="lamp"), line([-1, 0.9], [3, 1.2])], lights=[], materials=materials)
    exact, found = radiance(scene, method="area"), radiance(scene, method="lines", samples=count)
    alike = (exact[..., 0] < 1e-9) | (exact[..., 0] > 1.0 - 1e-9)
    assert alike.mean() > 0.2
    assert np.abs(found - exact)[alike].max() < SINGLE


def test_seed(plate: Plate, radiance: Radiance) -> None:
    """Two lines run through the middle whatever the seed; more are drawn at random."""
    camera = {"origin": [0.1, -0.9, 0.8], "fov": 30}  # sees none of the plate's rim, which is found with the seed
    scene = plate(FEATURES["crossing"], lights=SUNS, camera=camera)
    for count, same in ((2, True), (8, False)):
        one, other = (radiance(scene, method="lines", samples=count, seed=seed) for seed in (0, 1))
        assert (one == other).all() == same


def test_two_lines_unless_told() -> None:
    assert schema.Render().samples_of("lines") == 2
    assert schema.Render().samples_of("csg") == 256
    assert schema.Render(samples=9).samples_of("lines") == 9
