"""The scenes: special cases from close, two families of scratches from far, scratches few and many.

Those from close are the scenes that the tests hold against the truth, seen from nearer, so that no pixel sees the
plate's edge: how an outline is split is no matter of the method.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import schema
from tests.renderer.conftest import checked, plate_scene
from tests.renderer.test_truth import OTHERS

Json = dict[str, Any]

SMALL = (48, 36)  # pixels, from close
FAR, FAR_FOV = (16, 12), 13.5
CLOSE = ("crossing", "profile ends", "flat ends", "corner", "acute corner", "tee", "groove above groove")
NEARER = {"fov": 20}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
PLATE = 1.2  # world units, seen from far
V = {"type": "v", "width": 0.6, "depth": 0.3}  # in pitches
LIPS = {"type": "scratch", "width": 0.45, "depth": 0.225, "lip_width": 0.15, "lip_height": 0.075}
COVERED = 0.05  # of the plate, by scattered scratches


class Far(NamedTuple):
    """Families of such slopes in the plate's plane, so far apart, world units."""

    slopes: tuple[float, float]
    profile: Json
    pitch: float


def fine(profile: Json, pitch: float) -> Json:
    """A profile in pitches, in world units."""
    return {key: value if key == "type" else pitch * value for key, value in profile.items()}


def close(name: str, one_light: bool = False) -> schema.Scene:
    """One of CLOSE. one_light: the sun alone, of which a path tracer need not choose."""
    grooves, parts = OTHERS[name]
    lights: Json = {"lights": [SUN]} if one_light else {}
    return checked(plate_scene(grooves, **lights, **parts, camera=NEARER))


def far(case: Far) -> schema.Scene:
    """A white plate with two families of scratches, oblique to the picture and to each other."""
    grooves = []
    middle, reach = 0.5 * PLATE, 0.7 * PLATE
    for slope in case.slopes:
        step = case.pitch * (1.0 + slope * slope) ** 0.5
        low = middle - 0.5 * PLATE * (1.0 + abs(slope)) - step
        ends = [[middle + x, low + slope * x] for x in (-reach, reach)]
        count = int(PLATE * (1.0 + abs(slope)) / step) + 2
        repeat = {"type": "linear", "count": count, "step": [0, step]}
        grooves.append(
            {"path": {"type": "polyline", "points": ends}, "profile": fine(case.profile, case.pitch), "repeat": repeat}
        )
    camera = {"fov": FAR_FOV, "resolution": list(FAR)}
    materials = {"stone": {"base_color": [1, 1, 1], "specular": 0}}
    lights = [SUN | {"irradiance": [math.pi] * 3}]
    return checked(plate_scene(grooves, size=[PLATE, PLATE], lights=lights, materials=materials, camera=camera))


def scattered(count: int) -> schema.Scene:
    """So many scratches at random, all alike, that cover COVERED of the plate of 4 units, each over the others."""
    width = (COVERED * 4.0 / (20.0 * count)) ** 0.5
    groove = {
        "path": {"type": "polyline", "points": [[-10.0 * width, 0], [10.0 * width, 0]]},
        "profile": {"type": "scratch", "width": 0.6 * width, "depth": 0.3 * width, "lip_width": 0.2 * width,
                    "lip_height": 0.1 * width},
        "repeat": {"type": "scatter", "count": count, "seed": 5, "bounds": [0, 0, 2, 2], "angle": [0, 360]},
    }  # fmt: skip
    return checked(plate_scene([groove], camera=NEARER))
