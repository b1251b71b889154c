"""No jump in a pixel as a groove slides across it, or as the camera backs away.

Under distant lights a groove's cross-section falls into stretches of one colour, which end at points of it: corners,
and where a shadow ends. A pixel is the mean over its footprint, so that it changes by no more than the area that those
ends sweep there, times M, the brightest that a facet may be. Each of at most EDGES ends of a groove sweeps, of the
footprint, a strip as wide as it moves (through the eye, D_w / (D_w - w) as far for a point at height w) and as long as
the footprint at the most.

A change over a step thus shrinks with the step, and a jump does not. Steps of a fiftieth of a groove's width find
where a picture changes most; halving that step again and again, towards the greater change, must bring the change under
the bound for so small a step, which is 1 / 4096 of that for the first. As the camera backs away the footprint's edges
move as well, by a known amount.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from renderer import pipeline
from renderer.compile import PatternCache

from .scenes import BOX, DITCH, RIDGE, SKEW, Floats, Json, family, line

Plate = Callable[..., Json]

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


@pytest.mark.parametrize("method", ["line", "area", "auto"])
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


def swept(step: float, distance: float, rise: float, pixel: float, profile: list[list[float]], period: float) -> float:
    """How much of its footprint may change in a pixel whose corner sees what the camera looks at, as the camera backs
    away from `distance` by the factor r = exp(step).

    That place is the origin, at height 0, and the camera goes along a line through it: the footprint F grows about it
    to r F, which holds F, convex and with the origin for a corner. So r F is F and a part 1 - 1/r^2 of its own area.

    The end of a stretch, at X across the grooves and at height w, is seen from height h = rise distance, k h to the
    side, on the base plane at x = (X - k w) h / (h - w): it moves by |x w| (r - 1) / (r h - w). Of a convex F with the
    extent e across the grooves a strip fills at most 2 / e of its width: the hull of the longest chord and of the two
    places farthest apart is as large as half of chord times extent. As |x| <= r e, each of the ends in r F sweeps at
    most 2 r |w| (r - 1) / (h - top) of it: the less, the farther away. e is at most the diagonal of the pixel, drawn
    out by 1 / rise.
    """
    r = math.exp(step)
    top, far = max(w for _, w in profile), max(abs(w) for _, w in profile)
    extent = 1.01 * math.sqrt(2.0) * pixel * distance / rise
    grooves = r * extent / period + 2.0
    ends = len(profile) + len(LIGHTS) * (len(profile) - 1)
    return 1.0 - r**-2 + grooves * ends * 2.0 * r * far * (r - 1.0) / (rise * distance - top)


@pytest.mark.parametrize("method", ["line", "auto"])
@pytest.mark.parametrize("name", ["v", "skew"])
def test_the_camera_backs_away(name: str, method: str, plate: Plate, check: Callable[..., object]) -> None:
    """From grooves of 30 pixels to 300 grooves a pixel; each of four pixels touches what the camera looks at.

    `auto` needs no samples: all grooves are parallel, and no end of them or of the plate is seen.
    """
    period = 0.04
    profile = {"v": [[-0.02, 0.0], [0.0, -0.02], [0.02, 0.0]], "skew": [[0.15 * b, 0.15 * w] for b, w in SKEW]}[name]
    repeat = {"type": "linear", "count": 2000, "step": [period, 0]}
    scene = plate(
        [line([-40, -100], [-40, 100], profile=profile, repeat=repeat)], lights=LIGHTS, size=[70, 120],
        mapping={"scale": [70, 120], "offset": [-35.011, -60]}, camera={"fov": 0.2, "resolution": [2, 2]},
    )  # fmt: skip
    way = np.array([0.5, -0.6, 0.0])
    way[2] = math.sqrt(1.0 - way @ way)
    pixel = math.tan(math.radians(0.1))
    cache = PatternCache()

    def picture(log_distance: float) -> Floats:
        scene["camera"] |= {"origin": (math.exp(log_distance) * way).tolist(), "target": [0, 0, 0]}
        found = pipeline.render(check(scene), method=method, threads=1, patterns=cache)  # type: ignore[arg-type]
        assert "csg" not in found.shares
        return found.radiance.astype(np.float64)

    low, high = math.log(period / 30 / pixel), math.log(300 * period / pixel)
    changes, step = closing_in(picture, low, high, math.ceil((high - low) / math.log(1.02)))
    assert changes[0] > 1e-3
    share = [swept(step / 2**k, math.exp(low), way[2], pixel, profile, period) for k in range(HALVINGS + 1)]
    assert (changes <= BRIGHTEST * np.array(share) + 1e-6).all()
