"""No jump in a pixel as a groove slides across it, or as the camera backs away.

Under distant lights a groove's cross-section falls into stretches of one colour, which end at points of it: corners,
and where a shadow ends. A pixel is the mean over its footprint, so that it changes by no more than the area that those
ends sweep there, times M, the brightest that a facet may be. Each of at most EDGES ends of a groove sweeps, of the
footprint, a strip as wide as it moves (through the eye, D_w / (D_w - w) as far for a point at height w) and as long as
the footprint at the most.

A change over a step thus shrinks with the step, and a jump does not. Steps of a fiftieth of a groove's width find
where a picture changes most; halving that step again and again, towards the greater change, must bring the change under
the bound for so small a step, which is 1 / 4096 of that for the first.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from renderer import pipeline
from renderer.compile import PatternCache

from .scenes import BOX, DITCH, RIDGE, SKEW, Floats, Json, family

Plate = Callable[..., Json]
Check = Callable[[Json], object]

HALVINGS = 12
BRIGHTEST = 0.7 * (2.0 + 1.0) / math.pi  # Lambert, base_color / pi of what the lights send to a plane facing them
LIGHTS = [
    {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]},
    {"type": "directional", "direction": [-1, 0.1, -0.4], "irradiance": [1.0, 1.0, 1.0]},
]
PROFILES = {"skew": SKEW, "ridge": RIDGE, "box": BOX, "ditch": DITCH}


def closing_in(picture: Callable[[float], Floats], low: float, high: float, steps: int) -> tuple[Floats, float]:
    """The greatest change of a pixel over a step of (high - low) / steps, and over that halved HALVINGS times, each
    time within the half where it is the greater: (HALVINGS + 1,); and the first step."""
    step = (high - low) / steps
    pictures = [picture(low + i * step) for i in range(steps + 1)]
    changes = np.array([np.abs(b - a) for a, b in pairwise(pictures)])
    at = np.unravel_index(int(changes.argmax()), changes.shape)
    index, pixel = int(at[0]), tuple(at[1:])
    found = [float(changes.max())]
    here, one, other = low + index * step, pictures[index][pixel], pictures[index + 1][pixel]
    for k in range(1, HALVINGS + 1):
        amid = picture(here + step / 2**k)[pixel]
        if abs(amid - one) >= abs(other - amid):
            other = amid
        else:
            here, one = here + step / 2**k, amid
        found.append(float(abs(other - one)))
    return np.array(found), step


@pytest.mark.parametrize("method", ["line", "auto"])
@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("reach", [0.4, 3.0])
def test_a_groove_slides(name: str, method: str, reach: float, plate: Plate, check: Callable[..., object]) -> None:
    """The mapping's offset slides by a groove's width and a half.

    Pixels are squares of the screen s wide at a unit's distance. From a camera at height h over the pixel and distance
    d, the footprint is at least s d wide and as long as it is wide or longer: an end that moves by m sweeps a part of
    it of at most m / (s d), whichever way it runs.
    """
    profile = PROFILES[name]
    width = profile[-1][0] - profile[0][0]
    height = max(w for _, w in profile)
    scene = plate(
        [family(profile, step=0.5, count=9)], lights=LIGHTS, size=[40, 40],
        mapping={"scale": [40, 40], "offset": [-18, -18]},
        camera={"origin": [0.1, -reach, 0.8 * reach], "fov": 30 / (1 + reach), "resolution": [8, 6]},
    )  # fmt: skip
    cache = PatternCache()

    def picture(offset: float) -> Floats:
        scene["objects"][0]["mapping"]["offset"] = [-18 + offset, -18]
        found = pipeline.render(check(scene), method=method, threads=1, patterns=cache)  # type: ignore[arg-type]
        return found.radiance.astype(np.float64)

    changes, step = closing_in(picture, 0.0, 1.5 * width, 75)
    pixel = 2.0 * math.tan(math.radians(30 / (1 + reach) / 2)) / 6
    high = 0.8 * reach
    edges = len(profile) + len(LIGHTS) * (len(profile) - 1)
    grooves = 1 + 4.0 * pixel * reach / 0.5  # the footprint is less than four pixels long
    sweep = step * high / (high - height) / (pixel * 1.2 * reach)
    assert changes[0] > 1e-3
    bound = BRIGHTEST * edges * grooves * sweep / 2.0 ** np.arange(HALVINGS + 1)
    assert (changes <= bound + 1e-6).all()
