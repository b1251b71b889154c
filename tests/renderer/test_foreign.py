"""The ground truth against a foreign one: `geometry` and Mitsuba 3 on the same triangles differ by noise alone.

Both are means of RUNS independent pictures with other seeds, from which comes each pixel's variance. Of the P pixels
that see noise, z = (ours - theirs) / its standard error follows Student's distribution (Welch's test) of between
RUNS - 1 and 2 RUNS - 2 degrees of freedom k, for which the mean of z^2 is k / (k - 2) and its variance, as pixels are
independent, 2 k^2 (k - 1) / ((k - 2)^2 (k - 4)) / P: four deviations either way.

What Mitsuba's single precision adds is a systematic difference: shadow rays start off the surface by 1e-4 or so of the
coordinates' size and leave light leaking along edges, in a part of a groove's width; so the plate is small in
units of the scene, and BIAS of the mean is allowed, 0.00017 of which was found on 250 narrow grooves.

On the sphere the truth's normals are those of the map at the very place. Mitsuba gets them at the corners of the
triangles and goes linearly between them: 1e-5 apart.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import schema

from . import foreign
from .scenes import BOX, DITCH, RIDGE, SKEW, Floats, Json, family, line, ring

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

RUNS = 16
SAMPLES = 64
BIAS = 2e-4  # of radiance of about 1
CHORDS = 3e-3  # in a pixel where light grazes, which arcs' normals face and the chords of Mitsuba's mesh do not

PALETTE = {
    "stone": {"base_color": [0.7, 0.65, 0.6], "specular": 0},
    "brick": {"base_color": [0.8, 0.3, 0.2], "specular": 0},
    "moss": {"base_color": [0.1, 0.5, 0.2], "specular": 0},
}
V = [[-0.02, 0.0], [0.0, -0.02], [0.02, 0.0]]
LOW = {"type": "directional", "direction": [-1, 0.3, -0.4], "irradiance": [1.5, 1.2, 2.0]}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
LAMP = {"type": "point", "position": [-0.3, 0.2, 0.6], "intensity": [0.5, 0.6, 0.8]}
SCRATCH = [[-0.14, 0.0], [-0.11, 0.05], [-0.08, 0.0], [0.0, -0.12], [0.08, 0.0], [0.11, 0.05], [0.14, 0.0]]
ROOF = line([-1, 1.4], [3, 1.1], profile=RIDGE, material="brick", priority=2)
BENT = line([0.3, 0.4], [1.1, 1.6], [1.5, 0.6], [1.7, 1.4], profile=SKEW, material=["moss", None, "brick", None])

SCENES: dict[str, tuple[list[Json], list[Json]]] = {
    "parallel": ([family(V, step=0.04, count=60, material=["brick", "moss"])], [SUN]),
    "crossing": (
        [family(SCRATCH, step=0.5, count=5), line([-1, 0.8], [3, 1.2], profile=RIDGE, material="brick")],
        [SUN, LOW, LAMP],
    ),
    "ends and corners": ([BENT, line([0.4, 1.3], [0.8, 1.2], profile=BOX, ends="flat"), ROOF], [SUN, LAMP]),
    "arcs": ([ring(0.5, DITCH, material="moss"), ring(0.2, RIDGE), line([-1, 1], [3, 1.3], profile=SKEW)], [LOW, LAMP]),
}
BALL = {"shape": {"type": "sphere", "radius": 1}, "rotate": [0, 0, 0], "translate": [0, 0, -0.5]}


@pytest.fixture(scope="module")
def mitsuba() -> Any:
    return foreign.load()


@pytest.mark.parametrize("name", SCENES)
def test_the_truth_is_no_private_one(name: str, mitsuba: Any, plate: Plate, radiance: Radiance) -> None:
    grooves, lights = SCENES[name]
    # the plate's edges are not seen: a plate is a window on what goes on for ever, a mesh ends
    camera = {"origin": [0.1, -1.2, 1.1], "target": [0, 0, 0], "fov": 25, "resolution": [32, 24]}
    differ_by_noise(plate(grooves, lights=lights, materials=PALETTE, camera=camera), mitsuba, radiance)


@pytest.mark.parametrize("name", ["crossing", "ends and corners"])
def test_light_from_facet_to_facet(name: str, mitsuba: Any, plate: Plate, radiance: Radiance) -> None:
    grooves, lights = SCENES[name]
    camera = {"origin": [0.1, -1.2, 1.1], "target": [0, 0, 0], "fov": 25, "resolution": [32, 24]}
    scene = plate(grooves, lights=lights, materials=PALETTE, camera=camera, render={"bounces": 3})
    differ_by_noise(scene, mitsuba, radiance)


def test_the_truth_on_a_sphere(mitsuba: Any, plate: Plate, radiance: Radiance) -> None:
    """A ball as a whole, its outline in the picture and its nearest meridian amid it, seen a little from above: grooves
    along meridians and obliquely over them, with ends and corners, cut and raised."""
    cut = [family(SCRATCH, step=0.5, count=5), line([-1, 0.8], [3, 1.2], profile=RIDGE, material="brick"), BENT]
    scene = plate(
        cut, lights=[SUN, LOW, LAMP], materials=PALETTE, mapping={"scale": [6, 3], "offset": [-3.5, -0.5]},
        camera={"origin": [0.3, -2.6, 1.8], "target": [0, -0.2, -0.4], "fov": 36, "resolution": [32, 24]},
    )  # fmt: skip
    scene["objects"][0] |= BALL
    differ_by_noise(scene, mitsuba, radiance)


def differ_by_noise(data: Json, mitsuba: Any, radiance: Radiance) -> None:
    report = schema.check(data)
    assert report.scene is not None
    scene = foreign.foreign_scene(mitsuba, report.scene)
    theirs = np.array([foreign.picture(mitsuba, scene, SAMPLES, seed) for seed in range(RUNS)])
    solids: dict[str, Any] = {}
    ours = np.array(
        [radiance(data, method="geometry", samples=SAMPLES, seed=seed, solids=solids) for seed in range(RUNS)]
    )
    z, (difference, error) = compared(ours, theirs)
    least, most = student(2 * RUNS - 2, len(z)), student(RUNS - 1, len(z))
    found = f"z^2 {np.mean(z**2):.3f} of {len(z)} pixels, means differ by {difference:.2e}, error {error:.2e}"
    assert len(z) > 300
    assert abs(difference) < 4.0 * error + BIAS, found
    assert least[0] - 4.0 * least[1] < np.mean(z**2) < most[0] + 4.0 * most[1], found


def student(k: int, pixels: int) -> tuple[float, float]:
    """The mean of z^2 over so many pixels, and its deviation, for k degrees of freedom."""
    return k / (k - 2), (2 * k**2 * (k - 1) / ((k - 2) ** 2 * (k - 4)) / pixels) ** 0.5


def compared(ours: Floats, theirs: Floats) -> tuple[Floats, tuple[float, float]]:
    """Of pictures (RUNS, H, W, 3) the z of each pixel's luminance that is noisy in theirs, and the difference of the
    means with its standard error."""
    ours, theirs = ours.mean(axis=3), theirs.mean(axis=3)
    noise = (ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)) / len(ours)
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    noisy = theirs.var(axis=0, ddof=1) / len(theirs) > 1e-10
    assert (np.abs(difference) - 4.0 * np.sqrt(noise))[~noisy].max(initial=0.0) < CHORDS
    means = [pictures.mean(axis=(1, 2)) for pictures in (ours, theirs)]
    error = sum(mean.var(ddof=1) / len(mean) for mean in means) ** 0.5
    return difference[noisy] / np.sqrt(noise[noisy]), (float(difference.mean()), float(error))
