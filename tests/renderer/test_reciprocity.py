"""A grooved surface as a whole is reciprocal, whatever hides and shades what.

Seen from direction a and lit from b with irradiance E (on a plane facing it), an area A of the base plane sends
the intensity  sum over facets dS of f E (n.a) (n.b) V_a V_b  towards a, which is symmetric in a and b. Its mean
radiance L, over the base plane as the camera sees it, is that over A cos(a): so L(a, b) cos(a) = L(b, a) cos(b),
exactly so where A is whole periods of the pattern.

A pixel of a distant camera whose `up` lies along q sees a parallelogram of the base plane: one edge runs along q, with
length s / m where s is the pixel's width at that distance and m^2 = 1 - a_q^2; the other gets s m / a_w along p, as the
area is s^2 / a_w. The ratio of the two is m^2 / a_w =: c. For directions of the same c the periods of a
pattern, c by 1, thus fill pixels of a picture exactly, both there and back.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from .scenes import DITCH, SKEW, Floats, Json, line

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

C = 0.9
PIXELS = 16  # along q
FOV = 0.1


def towards(w: float, p_side: int, q_side: int) -> Floats:
    """The unit vector of height w with a_p^2 + a_w^2 = C a_w."""
    p = math.sqrt(C * w - w * w)
    return np.array([p_side * p, q_side * math.sqrt(1.0 - C * w), w])


PAIRS = [
    (towards(0.8, 1, -1), towards(0.35, 1, 1)),
    (towards(0.5, -1, -1), towards(0.85, 1, -1)),
    (towards(0.3, -1, -1), towards(0.6, 1, -1)),
]
MATT = {"base_color": [0.8, 0.5, 0.2], "specular": 0}
GLOSS = {"base_color": [0.8, 0.5, 0.2], "metallic": 1, "roughness": 0.6}


def periods(*ends: list[float], profile: list[list[float]] = SKEW, along_q: int = 1) -> Json:
    """A groove in each period, of 5 along p and so many along q."""
    first = [[p - 2.0 * C, q - along_q // 2] for p, q in ends]
    repeat = {"type": "grid", "counts": [5, along_q], "steps": [[C, 0], [0, 1]]}
    return line(*first, profile=profile, repeat=repeat)


PARALLEL = [periods([0.3, -30], [0.3, 30], profile=DITCH), periods([0.66, -30], [0.66, 30])]
ROWS = {"type": "linear", "count": 25, "step": [0, 1]}
ACROSS = line([-9, -11.6], [9, -11.6], profile=[[-0.15, 0], [0.0, 0.12], [0.15, 0]], repeat=ROWS)
CROSSING = [*PARALLEL, ACROSS, periods([0.1, 0.7], [0.7, 0.9], profile=DITCH, along_q=25)]


def seen(
    radiance: Radiance, plate: Plate, grooves: list[Json], material: Json, a: Floats, b: Floats, method: str
) -> Floats:
    """Radiance (PIXELS, 1, 3) times cos(a): each pixel sees one period, but for the picture's angle of 1/600."""
    distance = math.sqrt(1.0 - a[1] ** 2) * PIXELS / (2.0 * math.tan(math.radians(FOV / 2)))
    scene = plate(
        grooves, size=[40, 40], mapping={"scale": [40, 40], "offset": [-19.9, -19.8]},
        materials={"stone": material},
        camera={"origin": (distance * a).tolist(), "target": [0, 0, 0], "up": [0, 1, 0], "fov": FOV,
                "resolution": [1, PIXELS]},
        lights=[{"type": "directional", "direction": (-b).tolist(), "irradiance": [3, 3, 3]}],
    )  # fmt: skip
    return np.asarray(radiance(scene, method=method, samples=4096) * a[2], np.float64)


@pytest.mark.parametrize("material", [MATT, GLOSS], ids=["matt", "gloss"])
@pytest.mark.parametrize(("a", "b"), PAIRS, ids=["one side", "across", "low"])
def test_parallel_grooves(a: Floats, b: Floats, material: Json, plate: Plate, radiance: Radiance) -> None:
    """`line`: the directions spread evenly around a, and leave the square of the picture's angle, 3e-6."""
    there, back = (
        seen(radiance, plate, PARALLEL, material, x, y, "line").mean(axis=(0, 1)) for x, y in ((a, b), (b, a))
    )
    assert there.max() > 0.01
    assert there == pytest.approx(back, rel=1e-4)


@pytest.mark.parametrize(
    ("method", "a", "b"),
    [*(("csg", *pair) for pair in PAIRS), ("geometry", *PAIRS[1])],
    ids=["csg-one side", "csg-across", "csg-low", "geometry-across"],
)
def test_crossing_grooves(method: str, a: Floats, b: Floats, plate: Plate, radiance: Radiance) -> None:
    """The means over all pixels: four standard errors, and the square of the picture's angle, 3e-6. Each pixel sees the
    same, so that the pixels' own spread is the samples' noise."""
    there, back = (seen(radiance, plate, CROSSING, MATT, x, y, method) for x, y in ((a, b), (b, a)))
    error = np.hypot(there.std(axis=(0, 1)), back.std(axis=(0, 1))) / PIXELS**0.5
    assert (error < 0.002 * there.mean(axis=(0, 1))).all()
    assert (np.abs(there.mean(axis=(0, 1)) - back.mean(axis=(0, 1))) < 4.0 * error + 1e-5).all()
